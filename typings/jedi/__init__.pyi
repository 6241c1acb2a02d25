"""The part of jedi that the workbench uses."""

from collections.abc import Sequence
from pathlib import Path
from typing import Any

from jedi import settings as settings

class BaseName:
    name: str
    type: str
    description: str
    full_name: str | None
    module_name: str
    module_path: Path | None
    line: int | None
    column: int
    def docstring(self, raw: bool = False, fast: bool = True) -> str: ...
    def get_signatures(self) -> list[BaseSignature]: ...

class Completion(BaseName):
    name_with_symbols: str
    complete: str | None

class BaseSignature(BaseName):
    index: int | None
    params: list[ParamName]
    def to_string(self) -> str: ...

class ParamName(BaseName):
    def to_string(self) -> str: ...

class Project:
    def __init__(self, path: Path, *, sys_path: Sequence[str] | None = None, smart_sys_path: bool = True) -> None: ...

class Script:
    def __init__(self, code: str, *, path: Path, project: Project, environment: Any) -> None: ...
    def complete(self, line: int, column: int) -> list[Completion]: ...
    def help(self, line: int, column: int) -> list[BaseName]: ...
    def infer(self, line: int, column: int) -> list[BaseName]: ...
    def goto(self, line: int, column: int, *, follow_imports: bool = False, follow_builtin_imports: bool = False) -> list[BaseName]: ...
    def get_signatures(self, line: int, column: int) -> list[BaseSignature]: ...
    def get_references(self, line: int, column: int, *, scope: str, include_builtins: bool = True) -> list[BaseName]: ...

"""Answers questions about plain Python by jedi, which reads texts; nothing is imported or executed."""

from __future__ import annotations

import builtins
import re
import sys
from collections.abc import Callable, Iterator
from contextlib import suppress
from importlib import import_module
from importlib.util import find_spec
from pathlib import Path
from typing import Any

import jedi
from jedi import settings
from jedi.api.environment import InterpreterEnvironment
from jedi.inference.compiled.subprocess import InferenceStateSameProcess
from parso.file_io import KnownContentFileIO

from actr3d.actr.compat import old_names
from actr3d.actr.compat.old_names import is_old_name, is_package, text_of
from actr3d.actr.kernel.read_attributes import is_read_of_itself
from workbench.language.answers import Definition, Documentation, Item, Signature
from workbench.language.explicit_names import ExplicitText
from workbench.language.field_texts import parameter_text, text_at
from workbench.language.library_words import is_called_by_library

settings.auto_import_modules = []
settings.allow_unsafe_interpreter_executions = False

_CACHE, _GRAMMAR = import_module("parso.cache"), import_module("parso.grammar")  # jedi's parser


def _load_parsed(*given: Any, **named: Any) -> Any:
    """Returns the parsed text of a file from jedi's folder of them on the disk; None to parse it again.

    A file there may be incomplete: another process is writing it, or was killed while it did. Then pickle raises any kind of error.
    """
    try:
        return _CACHE.load_module(*given, **named)
    except Exception:  # noqa: BLE001 - see above
        return None


def _keep_parsed(*given: Any, **named: Any) -> None:
    """Writes a parsed text into that folder, if there is room for it."""
    with suppress(OSError):
        _CACHE.try_to_save_module(*given, **named)


vars(_GRAMMAR).update(load_module=_load_parsed, try_to_save_module=_keep_parsed)

KINDS = {
    "module": "namespace",
    "class": "class",
    "instance": "variable",
    "function": "function",
    "param": "property",
    "property": "property",
    "keyword": "keyword",
    "statement": "variable",
}
"""The kinds of the page's completions, by jedi's."""
_OLD_NAMES = Path(old_names.__file__).with_suffix("")
MAX_ITEMS = 400
LONGEST_DOCUMENTATION = 4_000
"""How much of a documentation is shown [characters]."""


_IMPORTING = re.compile(r"^[ \t]*from[ \t]+(actr3d[\w.]*)[ \t]+import[ \t]+(?:\([^)]*|[^\n()]*)\Z", re.MULTILINE)


class _TextsOfModules(InferenceStateSameProcess):
    """Passes to jedi the modules of a text: compiled ones only if this process has imported them already, and the library's old names."""

    def get_module_info(self, *, full_name: str, **more: Any) -> tuple[Any, bool | None]:
        """Returns the text of a module and whether it is a package; of an old name, the text of the names that the loader gives it."""
        if not is_old_name(full_name):
            return self.__getattr__("get_module_info")(full_name=full_name, **more)
        text = text_of(full_name)
        if text is None:
            return None, None
        # No file has this path. jedi keeps what it has read by path.
        return KnownContentFileIO(str(_OLD_NAMES.joinpath(*full_name.split("."), "__init__.py")), text), is_package(full_name)

    def load_module(self, dotted_name: str, sys_path: list[str]) -> Any:
        """Returns a module that is loaded already; None for any other, of which jedi then knows only what its stubs say."""
        return self.__getattr__("load_module")(dotted_name=dotted_name, sys_path=sys_path) if dotted_name in sys.modules else None


class _Environment(InterpreterEnvironment):
    """This interpreter, and the folders of its installed packages."""

    def get_inference_state_subprocess(self, inference_state: Any) -> InferenceStateSameProcess:
        """Returns jedi's access to compiled modules."""
        return _TextsOfModules(inference_state)


class PythonAnswers:
    """Answers questions about the texts of a folder.

    Args:
        folder: The models folder, whose files may import each other.
    """

    def __init__(self, folder: Path) -> None:
        self._folder = folder
        self._environment = _Environment()
        self._scripts: dict[tuple[str, str], jedi.Script] = {}
        self._inferred: dict[tuple[str, str], set[str] | None] = {}

    def forget(self) -> None:
        """Forgets what was read: the files of the folder may have changed."""
        self._scripts.clear()
        self._inferred.clear()

    def _script(self, text: str, path: str) -> jedi.Script:
        if (text, path) not in self._scripts:
            self._scripts.clear()  # jedi changes what it has read of a file when it reads another text of it
            where = self._folder / path
            sources = list(dict.fromkeys([str(where.parent), str(self._folder), *sys.path]))
            project = jedi.Project(self._folder, sys_path=sources, smart_sys_path=False)
            self._scripts[text, path] = jedi.Script(text, path=where, project=project, environment=self._environment)
        return self._scripts[text, path]

    def complete(self, explicit: ExplicitText, path: str, at: int) -> list[Item]:
        """Returns what can be written at a position; nothing in a string or a comment. Private names are left out until one begins."""
        script, (line, column) = self._script(explicit.text, path), explicit.place(at)
        *above, current = explicit.text.split("\n")[:line]
        public = _public_names("\n".join([*above, current[:column]]))
        named = [one for one in script.complete(line, column) if public is None or one.name in public]
        found = [one for one in named if one.type != "path"]
        start = column - len(found[0].name_with_symbols) + len(found[0].complete or "") if found else column
        if start == column or _before(explicit, line, start + 1) != "_":
            found = [one for one in found if not one.name.startswith("_")]
        found = [one for one in found if not _is_called_by_library(one)]
        owners: list[str] = []
        if start > 1 and _before(explicit, line, start) == ".":
            owners = [f"{one.full_name}." for one in script.infer(line, start - 2)]
        else:
            found = [one for one in found if one.type == "param" or _is_known_by_name(one)]
        return [_item(one, tuple(owners)) for one in found[:MAX_ITEMS]]

    def document_item(self, explicit: ExplicitText, path: str, at: int, label: str) -> Documentation | None:
        """Returns the documentation of one of the completions."""
        found = self._script(explicit.text, path).complete(*explicit.place(at))
        return next((_documentation(one) for one in found if one.name_with_symbols == label), None)

    def document(self, explicit: ExplicitText, path: str, at: int) -> Documentation | None:
        """Returns the documentation of the name at a position."""
        found = self._script(explicit.text, path).help(*explicit.place(at))
        return next((_documentation(one) for one in found), None)

    def signatures(self, explicit: ExplicitText, path: str, at: int) -> list[Signature]:
        """Returns the signatures of the call whose parentheses contain a position."""
        return [_signature(one) for one in self._script(explicit.text, path).get_signatures(*explicit.place(at))][:10]

    def after(self, text: str, path: str) -> PythonExpressions:
        """Returns what is known of expressions that are written after the end of a text."""
        return PythonExpressions(lambda code: self._script(code, path), text)

    def define(self, explicit: ExplicitText, path: str, at: int) -> Definition | None:
        """Returns where the name at a position is defined."""
        return next(self.definitions(explicit, path, at), None)

    def definitions(self, explicit: ExplicitText, path: str, at: int) -> Iterator[Definition]:
        """Yields all places where the name at a position may be defined."""
        script = self._script(explicit.text, path)
        line, column = explicit.place(at)
        for one in script.goto(line, column, follow_imports=True, follow_builtin_imports=True):
            if one.module_path is None or one.line is None:
                continue
            if one.module_path == self._folder / path:
                position = explicit.position(one.line, one.column)
                if position is not None:
                    yield Definition(path=path, at=position, name=one.name)
            elif one.module_path.is_relative_to(self._folder):
                inside = one.module_path.relative_to(self._folder).as_posix()
                yield Definition(path=inside, line=one.line, name=one.name)
            else:
                yield Definition(path=None, line=one.line, name=one.name, module=one.module_name)

    def origin(self, explicit: ExplicitText, path: str, name: str) -> str:
        """Returns the module from which a name at the end of a text is imported; empty if it is not imported."""
        code = f"{explicit.text}\n\n{name}"
        script, line = self._script(code, path), code.count("\n") + 1
        if not any(_is_known_by_name(one) for one in script.goto(line, 0)):
            return ""
        found = script.goto(line, 0, follow_imports=True)
        return next((one.module_name for one in found if one.module_path != self._folder / path), "")

    def kinds(self, explicit: ExplicitText, path: str, place: tuple[int, int]) -> set[str] | None:
        """Returns the classes of the expression that ends at a line and column of the explicit text, those of others as `module:name`;
        None if they are not known."""
        return self._kinds(self._script(explicit.text, path).infer(*place), path)

    def kinds_of(self, explicit: ExplicitText, path: str, expression: str) -> set[str] | None:
        """Returns the classes of an expression at the end of a text, as `kinds` does."""
        code = f"{explicit.text}\n\n{expression}"
        if (code, path) not in self._inferred:
            found = self._script(code, path).infer(code.count("\n") + 1, len(expression))
            self._inferred[code, path] = self._kinds(found, path)
        return self._inferred[code, path]

    def _kinds(self, found: list[Any], path: str) -> set[str] | None:
        own = self._folder / path
        names = [(one, one.module_name or "") for one in found]  # what jedi makes up itself, such as a named tuple, is in no module
        names = [(one, module, (one.full_name or one.name).removeprefix(module).removeprefix(".")) for one, module in names]
        return {name if one.module_path == own else f"{module}:{name}" for one, module, name in names} or None

    @staticmethod
    def ancestors(kinds: set[str] | None) -> set[str] | None:
        """Returns classes of other texts, as `kinds` names them, and all from which these inherit; None if they are not known."""
        found: set[str] = set()
        for kind in kinds or {""}:
            one = _class(kind)
            if one is None:
                return None
            found |= {f"{base.__module__}:{base.__qualname__}" for base in one.__mro__}
        return found

    def classes_of(self, explicit: ExplicitText, path: str, expression: str) -> list[type]:
        """Returns the classes of the library that an expression names, or of which it is an object."""
        kinds = [_class(kind) for kind in self.kinds_of(explicit, path, expression) or ()]
        return [kind for kind in kinds if kind is not None]

    def attribute(self, explicit: ExplicitText, path: str, owner: str, name: str) -> str:
        """Returns what a name is of the objects of a class: "a method" or "an attribute"; empty if they do not have it."""
        code = f"{explicit.text}\n\n{owner}()."
        found = self._script(f"{code}{name}", path).goto(code.count("\n") + 1, len(owner) + len("()."))
        kind = "" if not found else "a method" if found[0].type == "function" else "an attribute"
        read = not kind and any(is_read_of_itself(one, name) for one in self.classes_of(explicit, path, owner))
        return "an attribute" if read else kind

    def may_have(self, path: str, kind: str, name: str) -> bool:
        """Returns whether objects of a class of another text, as `kinds` names it, have an attribute; True if that is not known."""
        module, _, owner = kind.partition(":")
        if module in ("builtins", "types"):  # jedi knows `None` by a class that has no name in Python
            return hasattr(getattr(builtins, owner, None), name)
        code = f"from {module} import {owner.partition('.')[0]}\n{owner}()."
        script = self._script(f"{code}{name}", path)
        return not script.infer(2, len(owner) - 1) or bool(script.goto(2, len(owner) + len("().")))


class PythonExpressions:
    """Answers questions about expressions that are written after the end of a text."""

    def __init__(self, script: Callable[[str], jedi.Script], text: str) -> None:
        self._script = script
        self._text = text

    def _after(self, expression: str) -> tuple[jedi.Script, int, int]:
        code = f"{self._text}\n\n{expression}"
        lines = code.split("\n")
        return self._script(code), len(lines), len(lines[-1])

    def attributes(self, expression: str) -> list[tuple[str, str]]:
        """Returns the public attributes of an expression that its own class defines or that have a docstring, each with its docstring."""
        script, line, column = self._after(f"{expression}.")
        owners = tuple(f"{one.full_name}." for one in script.infer(line, column - 2))
        found = [one for one in script.complete(line, column) if one.type in ("statement", "instance", "property") and one.name[0] != "_"]
        said = [(one, _field_text(one) or one.docstring(raw=True)) for one in found]
        return [(one.name, text) for one, text in said if text or (owners and (one.full_name or "").startswith(owners))]

    def parameters(self, expression: str) -> list[tuple[str, str]]:
        """Returns the parameters of the function that an expression names, each with its documentation."""
        script, line, column = self._after(f"{expression}(")
        found = [one for signature in script.get_signatures(line, column) for one in signature.params]
        return [(one.name, _field_text(one)) for one in found]

    def is_truth(self, expression: str) -> bool:
        """Returns whether an expression is True or False."""
        script, line, column = self._after(expression)
        return any(one.full_name == "builtins.bool" for one in script.infer(line, column - 1))


def _class(kind: str) -> type | None:
    """Returns a class of another text, as `PythonAnswers.kinds` names it; None if it is not known."""
    module, _, name = kind.partition(":")
    # The library itself may be imported; its classes are those that a text can inherit from.
    source = import_module(module) if module.startswith("actr3d.") and find_spec(module) else sys.modules.get(module)
    found = getattr(source, name, None)
    return found if isinstance(found, type) else None


def _public_names(before: str) -> list[str] | None:
    """Returns the names that a package of the library offers, if the text before a place begins to import some from it; otherwise None."""
    found = _IMPORTING.search(before)
    module = sys.modules.get(found[1]) if found else None
    return getattr(module, "__all__", None)


def _is_known_by_name(one: jedi.BaseName) -> bool:
    """Returns whether a name that jedi finds is really there: it reads the list of a module's public names only if that is simple."""
    if one.module_name == "builtins" and one.type != "keyword":
        return hasattr(builtins, one.name)
    public = getattr(sys.modules.get(one.module_name), "__all__", None) if one.module_name.startswith("actr3d.") else None
    return public is None or one.name in public


def _is_called_by_library(one: jedi.Completion) -> bool:
    """Returns whether what jedi finds is a method that models do not call."""
    if one.type != "function" or not one.module_name.startswith("actr3d."):
        return False
    owner, _, name = (one.full_name or "").removeprefix(f"{one.module_name}.").rpartition(".")
    kind = getattr(sys.modules.get(one.module_name), owner, None)
    return isinstance(kind, type) and is_called_by_library(kind, name)


def _before(explicit: ExplicitText, line: int, column: int) -> str:
    """Returns the character before a place."""
    return explicit.text.split("\n")[line - 1][column - 1 : column]


def _item(one: jedi.Completion, owners: tuple[str, ...]) -> Item:
    """Returns a completion; methods of an object's own class come before its other attributes, and these before those that it inherits."""
    own = bool(owners) and (one.full_name or "").startswith(owners)
    own_rank = 2 if own and one.type == "function" else 1 if own else 0
    boost = -2 if one.name.startswith("_") else 2 if one.type == "param" else -1 if one.type == "keyword" else own_rank
    return Item(label=one.name_with_symbols, type=KINDS.get(one.type, "variable"), boost=boost)


def _declared(one: jedi.BaseName) -> jedi.BaseName:
    """Returns the annotation of an attribute in the body of its class, if there is one, which says more than an assignment in a method."""
    method = one.parent() if one.type == "statement" else None
    owner = method.parent() if method is not None and method.type == "function" else None
    fields = owner.defined_names() if owner is not None and owner.type == "class" else []
    return next((field for field in fields if field.name == one.name and field.type == "statement"), one)


def _documentation(name: jedi.BaseName) -> Documentation:
    one = _declared(name)
    # What is called to make the value of a variable says nothing about the variable.
    signatures = [signature.to_string() for signature in one.get_signatures()] if one.type in ("function", "class") else []
    title = "\n".join(signatures[:3]) or (one.description.removeprefix("param ") if one.type not in ("module", "keyword") else one.name)
    text = _text_of_parameter(one) if one.type == "param" else one.docstring(raw=True)
    return Documentation(title=title[:LONGEST_DOCUMENTATION], text=(text or _field_text(one))[:LONGEST_DOCUMENTATION])


def _text_of_parameter(one: Any) -> str:
    """Returns what the docstring of its function says of a parameter, or that of its class."""
    function = one.parent()
    owners = [function, *([function.parent()] if function.name == "__init__" else [])]
    return next((text for owner in owners if (text := parameter_text(owner.docstring(raw=True), one.name.rstrip("=")))), "")


def _signature(one: jedi.BaseSignature) -> Signature:
    parameters = [parameter.to_string() for parameter in one.params]
    active = one.params[one.index] if one.index is not None and one.index < len(one.params) else None
    text = one.docstring(raw=True)
    said = "" if active is None else _field_text(active) or parameter_text(text, active.name)
    return Signature(name=one.name, parameters=parameters, active=one.index, text=said or text.split("\n\n")[0][:LONGEST_DOCUMENTATION])


def _field_text(one: jedi.BaseName) -> str:
    """Returns the text below the definition of a field of a dataclass, or of any other attribute."""
    path, line = one.module_path, one.line
    return text_at(path, line) if path is not None and line is not None and path.suffix == ".py" else ""

"""The names of things in a run: those of parts in its trace, and those of productions, buffers and bodies at which it can be stopped."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, NamedTuple

from actr3d.actr.kernel.buffer import Buffer
from actr3d.actr.kernel.model import Model
from actr3d.actr.kernel.source_code import syntax_tree
from actr3d.actr.kernel.tree import path_of, subtree
from actr3d.actr.procedural.production_system import ProductionSystem, procedural_state_of
from actr3d.errors import Actr3dError, did_you_mean
from workbench.loader import ModelListing
from workbench.worker.messages import Notice, notice

MAX_NAMES = 12
"""Maximum number of known names in an error message about an unknown one."""


PATHS = frozenset(("agent", "system", "memory", "module"))
"""The keys under which answers contain paths of parts."""


class Top(NamedTuple):
    """Holds a top model, or an agent of a simulation."""

    model: Model
    prefix: str = ""
    """The prefix of its parts' paths in the trace of a program, such as `top#2` for its second run if that is a simulation."""

    def parts(self) -> Iterator[tuple[str, Any]]:
        """Yields all its parts with their names."""
        for part in subtree(self.model):
            yield self.name(path_of(part)), part

    def name(self, path: str) -> str:
        """Returns the name of the part at a path."""
        return path if not self.prefix else self.prefix if path == "top" else f"{self.prefix}.{path}"

    def named(self, answer: Any) -> Any:
        """Returns an answer in plain values in which the paths of parts are replaced by their names."""
        if not self.prefix:
            return answer
        if isinstance(answer, dict):
            entries: list[tuple[str, Any]] = list(answer.items())  # pyright: ignore[reportUnknownArgumentType,reportUnknownVariableType]
            return {key: self.name(value) if key in PATHS and isinstance(value, str) else self.named(value) for key, value in entries}
        if isinstance(answer, (list, tuple)):
            return [self.named(one) for one in answer]  # pyright: ignore[reportUnknownVariableType]
        return answer


@dataclass(frozen=True, kw_only=True)
class Names:
    """Holds the names of things in a run."""

    productions: frozenset[str] = frozenset()
    buffers: frozenset[str] = frozenset()
    """Paths of the buffers."""
    bodies: frozenset[str] = frozenset()
    modules: frozenset[str] = frozenset()
    """The Python modules from which the models' parts come."""
    fed: frozenset[str] = frozenset()
    """The buffers into which modules of the library put chunks."""
    growing: frozenset[str] = frozenset()
    """Kinds (`production`, `buffer`) of which more may appear later, as in a program that creates models while it runs; for these, a
    name is refused only if it looks misspelt.
    """

    def buffer(self, name: str) -> str:
        """Returns the path of a buffer, given its path or the name that its agent gives it.

        Raises:
            Actr3dError: If there is no such buffer, or several.
        """
        found = [name] if name in self.buffers else sorted(path for path in self.buffers if path.endswith(f".{name}"))
        if len(found) > 1:
            raise Actr3dError(f"there are several buffers '{name}': {', '.join(found[:MAX_NAMES])}; name one of these")
        if not found:
            self.check("buffer", name)
        return found[0] if found else name

    def check(self, what: str, name: str) -> None:
        """Checks that a thing of this name exists, or may exist later.

        Args:
            what: `production`, `buffer` or `body`.
            name: The name; for a production that is compiled from others, the name it has or will have.

        Raises:
            Actr3dError: If there is none.
        """
        short = {path.rpartition(".")[2] for path in self.buffers} if what == "buffer" and "." not in name else set[str]()
        known = {"production": self.productions, "buffer": self.buffers, "body": self.bodies}[what]
        likely = {"production": _learned, "buffer": _numbered}.get(what)
        if name in known or (likely is not None and likely(name, known)):
            return
        near = did_you_mean(name, short) or did_you_mean(name, known)
        if near or what not in self.growing:
            raise Actr3dError(f"no {what} '{name}'{near or there_are(short if len(short) == len(known) else known)}")


def lost_breakpoints(productions: Iterable[str], names: Names) -> Iterator[Notice]:
    """Yields a warning for each breakpoint whose production no longer exists, for example after an edit."""
    for name in sorted(productions):
        try:
            names.check("production", name)
        except Actr3dError as error:
            yield notice("warning", f"the breakpoint on {name} is kept, but there is {error}")


def _learned(name: str, known: frozenset[str]) -> bool:
    """Returns whether a name may belong to a production compiled from known ones; see `actr3d.actr.procedural.compilation`."""
    first, *more = (part for part in name.split("-") if not part.isdecimal())
    return bool(more) and known.issuperset((first, *more))


def _numbered(name: str, known: frozenset[str]) -> bool:
    """Returns whether a name belongs to a buffer in a later model of a known class, such as `goal#2`."""
    return re.sub(r"#\d+", "", name) in known


def there_are(known: Iterable[str]) -> str:
    """Returns the end of an error message about an unknown name: the first of the known ones, and how many more there are."""
    names = sorted(known)
    more = f" and {len(names) - MAX_NAMES} more" if len(names) > MAX_NAMES else ""
    return f"; there are: {', '.join(names[:MAX_NAMES]) or 'none'}{more}"


def names_of(tops: Iterable[Top], bodies: Iterable[str] = ()) -> Names:
    """Returns the names of the things in models."""
    productions: set[str] = set()
    buffers: set[str] = set()
    modules: set[str] = set()
    held: set[int] = set()
    paths: dict[int, str] = {}
    for name, part in (named for top in tops for named in top.parts()):
        modules.add(type(part).__module__)
        if isinstance(part, Buffer):
            buffers.add(name)
            paths[id(part)] = name
            if type(part) is not Buffer:
                held.add(id(part))
        elif isinstance(part, ProductionSystem):
            productions.update(production.name for production in procedural_state_of(part).productions)
        else:
            held.update(id(value) for value in part.__dict__.values() if isinstance(value, Buffer))  # no code of the model
    return Names(
        productions=frozenset(productions),
        buffers=frozenset(buffers),
        bodies=frozenset(bodies),
        modules=frozenset(modules),
        fed=frozenset(path for number, path in paths.items() if number in held),
    )


def names_of_program(tops: Iterable[Top], bodies: Iterable[str], listing: ModelListing, source: str, folder: Path) -> Names:
    """Returns the names of the things in a program, as far as it has run.

    Args:
        tops: The models that have been created.
        bodies: The bodies of the simulation on screen.
        listing: The description read from its text.
        source: Its text.
        folder: The folder of its helper modules.
    """
    made = names_of(tops, bodies)
    productions = made.productions | {name.rpartition(".")[2] for name in listing.productions}
    hidden = not productions or _has_helpers(source, folder)
    return replace(made, productions=productions, growing=frozenset(("production", "buffer") if hidden else ("buffer",)))


def _has_helpers(source: str, folder: Path) -> bool:
    """Returns whether a text imports modules from its folder, which may define models."""
    roots: set[str] = set()
    for node in ast.walk(syntax_tree(source)):
        if isinstance(node, ast.Import):
            roots.update(alias.name.partition(".")[0] for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            roots.add((node.module or "").partition(".")[0])
    return any((folder / f"{root}.py").is_file() or (folder / root).is_dir() for root in roots - {""})

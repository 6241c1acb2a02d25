"""Registries: things by name, which register themselves where they are defined."""

from __future__ import annotations

import pkgutil
import re
from collections.abc import Collection
from importlib import import_module
from typing import Generic, TypeVar

T = TypeVar("T")

MODEL_TEXT = "actr3d_model_"
"""How the name of a module begins that is made from a model's text; a checksum of the text follows, and a number if there are several."""
_OF_TEXT = re.compile(rf"({MODEL_TEXT}[0-9a-f]{{8}})(_\d+)?")


class Registry(dict[str, T], Generic[T]):
    """Things of one kind by name.

    Two different things cannot have one name, but the same definition may be executed again. What a model's text defines is replaced by
    what another text defines under that name: each text means its own.

    Args:
        what: What they are, for errors.
    """

    def __init__(self, what: str) -> None:
        super().__init__()
        self.what = what
        self._origins: dict[str, tuple[str, str]] = {}

    def add(self, name: str, thing: T, module: str | None = None) -> None:
        """Registers a thing under its name.

        Args:
            name: The name.
            thing: The thing.
            module: The name of the module that defines it; None if the thing is a class or function, which knows that, unless it was made
                by `exec` without a `__name__`.

        Raises:
            ValueError: If another thing has this name.
        """
        origin = (lasting_name(module or thing.__module__ or ""), getattr(thing, "__qualname__", name))
        known = self._origins.get(name, origin) if name in self else origin
        if known != origin and not _of_different_texts(known[0], origin[0]):
            raise ValueError(f"{self.what} '{name}' is defined twice: {'.'.join(known)} and {'.'.join(origin)}")
        self[name], self._origins[name] = thing, origin


def import_modules(package: str, path: Collection[str], *, inner: bool = False, named: str | None = None) -> None:
    """Imports all modules of a package, in the order of their names, so that they register what they define.

    Args:
        package: Its `__name__`.
        path: Its `__path__`.
        inner: Whether to import the modules of the packages within it too.
        named: Only modules of this name are imported; None for all but `__main__`.
    """
    for module in (pkgutil.walk_packages if inner else pkgutil.iter_modules)(path, f"{package}."):
        name = module.name.rpartition(".")[2]
        if name == named or (named is None and name != "__main__"):
            import_module(module.name)


def lasting_name(module: str) -> str:
    """Returns the name of a module; that of a model's text without its number, which differs each time the text is loaded."""
    return _OF_TEXT.sub(r"\1", module, count=1)


def _of_different_texts(one: str, other: str) -> bool:
    """Returns whether two modules, given by their lasting names, belong to different texts of models; a helper module is part of a text."""
    first, second = _OF_TEXT.match(one), _OF_TEXT.match(other)
    return first is not None and second is not None and first[1] != second[1]

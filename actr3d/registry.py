"""Registries: things by name, which register themselves where they are defined."""

from __future__ import annotations

import pkgutil
from collections.abc import Collection
from importlib import import_module
from typing import Any, Generic, TypeVar

T = TypeVar("T")


class Registry(dict[str, T], Generic[T]):
    """Things of one kind by name. Two different things cannot have one name; the same definition may be executed again.

    Args:
        what: What they are, for errors.
    """

    def __init__(self, what: str) -> None:
        super().__init__()
        self.what = what

    def add(self, name: str, thing: T) -> None:
        """Registers a thing under its name.

        Raises:
            ValueError: If another thing has this name.
        """
        known = self.get(name)
        if known is not None and known != thing and _origin(known) != _origin(thing):
            raise ValueError(f"{self.what} '{name}' is defined twice: {'.'.join(_origin(known))} and {'.'.join(_origin(thing))}")
        self[name] = thing


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


def _origin(thing: Any) -> tuple[str, str]:
    """Returns the module and the name of a class or function; for other things, their own text."""
    return getattr(thing, "__module__", ""), getattr(thing, "__qualname__", str(thing))

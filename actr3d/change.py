"""Changes: what a user can change by hand in a running simulation or program; the registry of them."""

from __future__ import annotations

import inspect
from collections.abc import Mapping, Sequence
from typing import Any, ClassVar, Literal, Self, TypeVar

from actr3d.configuration import Configuration
from actr3d.errors import ConfigurationError, SimulationError
from actr3d.registry import Registry

Target = Literal["buffer", "memory", "chunk", "production", "object", "aperture", "parameter"]
"""The kinds of things that changes are for; pages offer a change where they show such a thing."""


class Change(Configuration):
    """Base of the changes. Each is a `@dataclass(frozen=True)` with the decorator `change`, in a file of its own.

    It is a command of a user: carried out between two ticks, recorded, and repeated at the same moment when the run goes back and
    forward again. Its fields are the arguments of the command.
    """

    word: ClassVar[str]
    """The name of the command."""
    of: ClassVar[Target]
    """What it changes."""
    title: ClassVar[str]
    """Its name in the menus of pages."""
    text: ClassVar[str]
    """Its text on pages, with fields in braces: `{buffer} {chunk}`."""

    def carry_out(self, on: Any) -> None:
        """Makes the change.

        Args:
            on: The parts of the agents, for an `AgentChange`; otherwise the world. A change of the world changes its state, not
                the compiled model, so that a stored state contains its effect.

        Raises:
            Actr3dError: If it cannot be made; then nothing has changed.
        """
        raise NotImplementedError

    @classmethod
    def present(cls, on: Any, named: Mapping[str, Any]) -> dict[str, Any]:  # noqa: ARG003 - for those that have some
        """Returns the present values of fields of what is to be changed, by name, with which forms begin; by default none.

        A form does not send an optional field that the user has not changed: its default must keep the present value.

        Args:
            on: As for `carry_out`.
            named: The fields that say what is to be changed, such as the name of an object.

        Raises:
            Actr3dError: If there is no such thing.
        """
        return {}

    @classmethod
    def of_arguments(cls, values: Sequence[Any], named: Mapping[str, Any]) -> Self:
        """Returns the change with the arguments of a command.

        Raises:
            SimulationError: If there are too few or too many, or a name is wrong.
            ConfigurationError: If a value has the wrong type or is out of bounds.
        """
        signature = inspect.signature(cls)
        try:
            signature.bind(*values, **named)
        except TypeError as error:
            takes = ", ".join(str(one.replace(annotation=one.empty)) for one in signature.parameters.values())
            raise SimulationError(f"command '{cls.word}': {error}; it takes ({takes})") from error
        try:
            return cls(*values, **named)
        except ConfigurationError as error:  # users know the command, not its class
            raise ConfigurationError(str(error).replace(f"{cls.__name__}.", f"{cls.word}.", 1)) from error


CHANGES: Registry[type[Change]] = Registry("change")
"""All changes by word."""

C = TypeVar("C", bound=type[Change])


def change(of: C) -> C:
    """Registers a change under its word.

    Raises:
        ValueError: If there is another change of this word.
    """
    CHANGES.add(of.word, of)
    return of

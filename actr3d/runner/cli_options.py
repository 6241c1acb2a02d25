"""The command-line options of a model file: `--name value` for each parameter of its `build`, and their help.

Not tyro: the options are known only after the model file is named, they appear beside general options, and their errors must read as
on the page.
"""

from __future__ import annotations

import textwrap
from collections.abc import Iterable, Sequence
from typing import Any

from actr3d.errors import SettingError, alternatives
from actr3d.parameter_schema import Parameter, literal

_INDENT = 22
_WIDTH = 110


def read_options(words: Sequence[str], fields: Sequence[Parameter], others: Iterable[str] = ()) -> dict[str, Any]:
    """Returns the values given by options, by the names of fields.

    Args:
        words: `--name value` or `--name=value` for each; for a field that is True or False also `--name` and `--no-name`.
        fields: The fields that can be set.
        others: Options that are not the model's, used for hints.

    Raises:
        SettingError: If an option does not exist, or its value is missing.
    """
    known = {field.option: field for field in fields}
    settings: dict[str, Any] = {}
    waiting = list(words)
    while waiting:
        word, equals, text = waiting.pop(0).partition("=")
        option = "--" + word.removeprefix("--").replace("_", "-")
        field = known.get(option)
        switch = known.get("--" + option.removeprefix("--no-")) if option.startswith("--no-") else None
        if switch is not None and switch.takes == "switch" and not equals:
            settings[switch.name] = False
        elif field is None or not word.startswith("--"):
            raise SettingError(_unknown(word, known, others))
        elif equals or (waiting and not waiting[0].startswith("--")):
            settings[field.name] = field.value(text if equals else waiting.pop(0))
        elif field.takes == "switch":
            settings[field.name] = True
        else:
            raise SettingError(f"{option} takes a value: {field.domain()}")
    return settings


def read_settings(texts: Sequence[str], fields: Sequence[Parameter], option: str = "--set", *, levels: bool = False) -> dict[str, Any]:
    """Returns parameters from texts `name=value`; an unknown name gets a value too, so that the builder can reject it.

    Args:
        texts: The texts.
        fields: The parameters whose types are known.
        option: The option that gave the texts, for errors.
        levels: Whether a name may have several levels, for errors.

    Raises:
        SettingError: If a text does not have this form, a name has two values, or a list or tuple is not one of Python.
    """
    known = {field.name: field for field in fields}
    settings: dict[str, Any] = {}
    given: dict[str, str] = {}
    for text in texts:
        name, equals, value = text.partition("=")
        if not equals or not name.isidentifier():
            raise SettingError(f"a parameter is set by name=value (got {text!r})")
        if name in given:
            several = f", or several levels with commas between them: {name}={given[name]},{value}" if levels else ""
            raise SettingError(f"{option} {name}: is given twice ({given[name]!r}, {value!r}); give one value{several}")
        given[name] = value
        settings[name] = known[name].value(value) if name in known else literal(value)
        if name not in known and settings[name] == value and value.startswith(("[", "(")):  # one text, where several values were meant
            quoted = f"a shell removes quotes, so quote the whole: {option} \"{name}=['a', 'b']\""
            raise SettingError(f"{option} {name}: must be a list or tuple of Python (got {value!r}); {quoted}")
    return settings


def options_help(fields: Sequence[Parameter]) -> str:
    """Returns the help lines of all options: what each accepts, its meaning, and its default."""
    lines: list[str] = []
    for field in fields:
        default = "must be given" if field.required else f"default {field.default}"
        head = f"  {field.option}"
        lines.append(head.ljust(_INDENT) + f"{field.domain()}; {default}")
        pad = " " * _INDENT
        lines += textwrap.wrap(field.help, _WIDTH, initial_indent=pad, subsequent_indent=pad)
    return "\n".join(lines)


def _unknown(word: str, known: dict[str, Parameter], others: Iterable[str]) -> str:
    if not word.startswith("--"):
        return f"unexpected '{word}': a parameter is given as --name value"
    return f"no option '{word}'{alternatives(word, known, 'the model has:', others)}"

"""Checks the patterns of productions: their types, variables, slots and values."""

from __future__ import annotations

from typing import Any, cast

from actr3d.actr.chunks.pattern import MISSING, Condition, by_variable, not_patterns
from actr3d.actr.kernel.buffer import UNKNOWN, Buffer, plain_value
from actr3d.actr.kernel.source_code import function_node
from actr3d.actr.kernel.tree import TreeNode, top_of
from actr3d.actr.lint.found_kinds import KIND, kinds_in, wrong_names
from actr3d.actr.lint.slot_inference import all_slots, slots_held
from actr3d.actr.lint.slot_names import SURE, vocabulary
from actr3d.actr.procedural.production import Production
from actr3d.errors import did_you_mean, nearest
from actr3d.warnings import warn_at


def check_patterns(production: Production) -> None:
    """Warns about objects that are not patterns, and therefore match anything."""
    for name, pattern in production.pattern_specs.items():
        for part in not_patterns(pattern):
            _warn_likely(production, f"{name}={part!r} is not a pattern and matches anything; write text, such as {name}='{part}'")


def check_variables(production: Production) -> None:
    """Warns about variables that are compared, or name a slot, before they are bound."""
    bound: set[str] = set()
    if production.more_bound:
        return  # a function may bind any
    for condition in production.conditions:
        key = condition.key
        needed = [key[1:]] if by_variable(key) else []
        needed += [condition.value] if condition.op in ("same", "differs") else []
        for name in needed:
            if name not in bound:
                hint = did_you_mean(name, production.variables)
                _warn_never(production, f"nothing binds '?{name}' before {condition.name}'s '{condition}' needs it{hint}")
                return
        if condition.op == "bind":
            bound.add(condition.value)


def check_slots(production: Production) -> None:
    """Warns about slots that are never set, about missing attributes of objects, and about states that never occur."""
    settled = {name: _check_kinds(production, name) for name in production.pattern_specs}
    for condition in production.conditions:
        key = condition.key
        if condition.op in ("empty", "call") or by_variable(key):
            continue
        target = production.context[condition.name or "self"]
        if isinstance(target, Buffer):
            if key not in settled.get(condition.name or "", ()):
                _check_slot(production, key)
        elif isinstance(key, str):
            missing, hint = _missing_attribute(target, key)
            if hint:
                _warn_likely(production, f"'{condition.name}' has no attribute '{missing}'{hint}")
            _check_state(production, condition, target)


def _check_kinds(production: Production, name: str) -> set[str]:
    """Warns, at the line of a pattern, about misspelt features and slots of features, if modules put features into its buffer.

    Returns:
        The slots of these features, and those that the warnings are about.
    """
    target = production.context.get(name)
    kinds = kinds_in(target, top_of(cast("TreeNode", production.system))) if isinstance(target, Buffer) else {}
    if not kinds:
        return set()
    tests = [(one.key, one.op, one.value) for one in production.conditions if one.name == name]
    wrong = wrong_names(tests, kinds, vocabulary(production.original_func).written | slots_held([target]))
    for what in wrong.values():
        warn_at(f"production '{production.name}': {what}", production.original_func, _line_of(production, name))
    return {KIND, *wrong}.union(*kinds.values())


def _line_of(production: Production, name: str) -> int | None:
    """Returns the line of the pattern for a buffer, if the production's source is available."""
    node = function_node(production.original_func)
    named = zip(node.args.args, node.args.defaults, strict=False) if node is not None else ()
    return next((pattern.lineno for parameter, pattern in named if parameter.arg == name), None)


def _check_slot(production: Production, key: int | str) -> None:
    words = vocabulary(production.original_func)
    if isinstance(key, str) and ("." in key or key in words.giving | words.asked):
        return
    hint = did_you_mean(key, words.given | words.asked, SURE) if isinstance(key, str) else ""
    known = None if hint else all_slots(production)
    if (hint or (known is not None and key not in known)) and key not in slots_held(production.context.values()):
        what = f"no chunk is ever given a slot '{key}'"
        if hint:
            _warn_likely(production, f"{what}{hint}")
        else:
            _warn_never(production, what)


def _missing_attribute(target: Any, path: str) -> tuple[str, str]:
    """Returns the first part of a dotted path that does not exist, with a hint; empty texts if the path exists.

    None of the modeller's code is run.
    """
    walked: list[str] = []
    for name in path.split("."):
        walked.append(name)
        found = plain_value(target, name)
        if found is MISSING:
            known = [k for k in (*getattr(target, "__dict__", ()), *dir(cast("object", type(target)))) if k[0] != "_"]
            return ".".join(walked), did_you_mean(name, known, SURE)
        if found is UNKNOWN:
            break
        target = found
    return "", ""


def _check_state(production: Production, condition: Condition, target: object) -> None:
    """Warns if a state that is True or False is compared with a word that is similar to one of these."""
    wanted = condition.value
    if condition.op not in ("is", "not"):
        return
    meant = nearest(str(wanted).capitalize(), ("True", "False"), SURE)
    if meant is None or wanted == meant or wanted in vocabulary(production.original_func).mentioned:
        return
    if isinstance(plain_value(target, condition.key), bool):
        sign = "!" if condition.op == "not" else ""
        what = f"'{condition.name}' has True or False in '{condition.key}', with capital letters, and never '{wanted}'"
        warn = _warn_likely if sign else _warn_never
        warn(production, f"{what}; did you mean '{condition.key}:{sign}{meant}'?")


def _warn_never(production: Production, why: str) -> None:
    warn_at(f"production '{production.name}' can never match: {why}", production.original_func)


def _warn_likely(production: Production, what: str) -> None:
    warn_at(f"production '{production.name}': {what}", production.original_func)

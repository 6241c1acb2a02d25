"""Checks the code of modellers' methods: forgotten calls, and unknown names."""

from __future__ import annotations

import ast
import builtins
import inspect
import re
from collections.abc import Callable, Iterator, Mapping, Sequence
from functools import lru_cache
from typing import Any

from actr3d.actr.chunks.chunk import parse_slots
from actr3d.actr.chunks.pattern import parse
from actr3d.actr.declarative.memory import Memory
from actr3d.actr.declarative.partial_matching import Partial
from actr3d.actr.kernel.buffer import Buffer
from actr3d.actr.kernel.model import MethodWrapper, Model
from actr3d.actr.kernel.source_code import function_node, names_defined_in, productions_inside, source_of, syntax_tree
from actr3d.actr.lint.slot_inference import slots_held
from actr3d.actr.lint.slot_names import GIVERS, READERS, SURE, misspelling_of, slots_in, text_of, vocabulary
from actr3d.actr.modules.imaginal import ImaginalModule
from actr3d.actr.procedural.production import Production
from actr3d.errors import PatternException, did_you_mean
from actr3d.warnings import warn_at

_VARIABLE = re.compile(r"(?<!\w)\?(\w+)")


def check_actions(production: Production, productions: Sequence[Production]) -> None:
    """Warns about likely mistakes in a production's body, or in a method without parameters."""
    node = function_node(production.original_func)
    if node is None:
        return
    func, context = production.original_func, production.context
    where = f"production '{production.name}': "
    _check_brackets(node, func, context)
    for line, message in productions_inside(node, lambda name: isinstance(context.get(name), Model)):
        warn_at(message, func, line)
    known = {*production.variables, *production.assigned}
    if not production.any_bound:
        _check_names(production, known, where)
    for call, owner, method in _calls(node, context):
        _check_slots(call, owner, method, func, where, context)
        if method == "modify":
            _check_values(call, production, productions)
        elif not production.any_bound:
            check = _check_variables if method in GIVERS else _check_wildcards if method in READERS else None
            if check is not None:
                check(call, func, where, known)


def _check_names(production: Production, known: set[str], where: str) -> None:
    """Finds names in a body that nothing defines, neither now nor anywhere in the text."""
    func = production.original_func
    defined = _defined_in(source_of(func))
    if defined is None:
        return
    inside = {*dir(builtins), *func.__globals__, *func.__code__.co_freevars, *production.context, *known, *defined}
    for part in (part for statement in production.node.body for part in ast.walk(statement)):
        if isinstance(part, ast.Name) and part.id not in inside:
            inside.add(part.id)
            warn_at(f"{where}nothing defines '{part.id}'{did_you_mean(part.id, {*known, *production.context})}", func, part.lineno)


@lru_cache(maxsize=16)
def _defined_in(text: str) -> set[str] | None:
    """Returns all names and attributes that a text defines anywhere; None if code may define others."""
    tree = syntax_tree(text)
    names = names_defined_in(tree)
    attributes = {node.attr for node in ast.walk(tree) if isinstance(node, ast.Attribute) and isinstance(node.ctx, ast.Store)}
    return None if names is None else names | attributes


def check_modeller_method(func: Callable[..., Any], part: Model) -> None:
    """Warns about likely mistakes in a part's method that is not a production."""
    node = function_node(func)
    if node is None or not node.args.args or len(node.args.args) == len(node.args.defaults):
        return
    names = {node.args.args[0].arg: part}
    _check_brackets(node, func, names)
    for call, owner, method in _calls(node, names):
        _check_slots(call, owner, method, func, f"{func.__qualname__}: ", names)


def _check_brackets(node: ast.FunctionDef, func: Callable[..., Any], names: Mapping[str, Any]) -> None:
    """Finds statements that name a method without calling it."""
    for part, path in _paths_and_calls(node)[0]:
        if _is_method(path, names):
            text = ast.unparse(path)
            warn_at(f"'{text}' without brackets does nothing; did you mean '{text}()'?", func, part.lineno)


def _is_method(node: ast.Attribute, names: Mapping[str, Any]) -> bool:
    """Returns whether a dotted path leads to a method of a part of the model."""
    owner = _resolve(node.value, names)
    if not isinstance(owner, (Model, Partial)):
        return False
    if node.attr in vars(owner):
        return isinstance(vars(owner)[node.attr], MethodWrapper)
    return inspect.isfunction(inspect.getattr_static(type(owner), node.attr, None))


def _resolve(node: ast.expr, names: Mapping[str, Any]) -> Any:
    """Returns the object that a name or a dotted path of models' attributes refers to; None if it is not known."""
    if isinstance(node, ast.Name):
        return names.get(node.id)
    if isinstance(node, ast.Attribute):
        owner = _resolve(node.value, names)
        return vars(owner).get(node.attr) if isinstance(owner, Model) else None
    return None


def _calls(node: ast.FunctionDef, names: Mapping[str, Any]) -> Iterator[tuple[ast.Call, object, str]]:
    """Yields the calls of methods that make, change or search for chunks, with the owners and names of the methods."""
    for part, func in _paths_and_calls(node)[1]:
        owner = _resolve(func.value, names)
        if isinstance(owner, (Buffer, Memory, ImaginalModule, Partial)):
            yield part, owner, func.attr


@lru_cache(maxsize=1000)
def _paths_and_calls(node: ast.FunctionDef) -> tuple[Sequence[tuple[ast.Expr, ast.Attribute]], Sequence[tuple[ast.Call, ast.Attribute]]]:
    """Returns the statements of a function that are a dotted path only, and its calls of one; once for all files with its text."""
    parts = tuple(ast.walk(node))
    paths = [(part, part.value) for part in parts if isinstance(part, ast.Expr) and isinstance(part.value, ast.Attribute)]
    return paths, [(part, part.func) for part in parts if isinstance(part, ast.Call) and isinstance(part.func, ast.Attribute)]


def _check_slots(call: ast.Call, owner: object, method: str, func: Callable[..., Any], where: str, names: Mapping[str, Any]) -> None:
    """Finds slots that are requested or changed but never set, or set but never read, if there is a similar one."""
    words = vocabulary(func)
    text = (text_of(call.args[0]) or "") if call.args else ""
    if method in READERS and isinstance(owner, (Memory, Partial)):
        slots = [slot for slot in slots_in(text) if slot not in words.giving]
        found = [(slot, f"no chunk is ever given a slot '{slot}'", did_you_mean(slot, words.given, SURE)) for slot in slots]
    elif method == "modify":
        changed = [keyword.arg for keyword in call.keywords if keyword.arg and keyword.arg[0] != "_"]
        slots = [slot for slot in changed if slot not in words.given | words.mentioned | words.matched | words.asked]
        found = [(slot, f"no chunk is ever given a slot '{slot}'", did_you_mean(slot, words.given, SURE)) for slot in slots]
    elif method in GIVERS:
        read = words.matched | words.asked
        slots = [slot for slot in slots_in(text) if slot not in read | words.mentioned | words.modified]
        read &= words.giving  # slots that are read but never set are reported where they are read
        near = [(slot, misspelling_of(slot, (other for other in read if words.apart(slot, other)))) for slot in slots]
        found = [
            (slot, f"no production and no request reads a slot '{slot}'", f"; did you mean '{meant}'?") for slot, meant in near if meant
        ]
    else:
        return
    for slot, what, hint in found:
        if hint and (method in GIVERS or slot not in slots_held(names.values())):
            warn_at(f"{where}{what}{hint}", func, call.lineno)


def _check_variables(call: ast.Call, func: Callable[..., Any], where: str, known: set[str]) -> None:
    """Finds variables in a chunk's text that nothing binds."""
    if call.args and isinstance(call.args[0], ast.Constant) and isinstance(call.args[0].value, str):
        text = call.args[0].value
        for _, value in parse_slots(text):
            if value[:1] == "?" and value[1:] not in known:
                hint = did_you_mean(value[1:], known)
                warn_at(f"{where}nothing binds '{value}' in '{text}'{hint}", func, call.lineno)


def _check_wildcards(call: ast.Call, func: Callable[..., Any], where: str, known: set[str]) -> None:
    """Finds variables in a request that match anything, but whose names are similar to a bound one and occur nowhere else."""
    if not (call.args and isinstance(call.args[0], ast.Constant) and isinstance(call.args[0].value, str)):
        return
    text = call.args[0].value
    try:
        names = {word for _, sign, word in parse(text) if sign in ("?", "!?")} - known
    except PatternException:
        return  # the request itself will raise this
    for name in sorted(names):
        meant = misspelling_of(name, known)
        if meant and _VARIABLE.findall(source_of(func)).count(name) == 1:
            warn_at(f"{where}'?{name}' in '{text}' matches anything; did you mean '?{meant}'?", func, call.lineno)


def _check_values(call: ast.Call, production: Production, productions: Sequence[Production]) -> None:
    """Finds values that contain a variable's name, or a space although patterns compare the slot with a word."""
    for keyword in call.keywords:
        value = keyword.value.value if isinstance(keyword.value, ast.Constant) else None
        if not isinstance(value, str):
            continue
        variables = _VARIABLE.findall(value)
        if variables and value == f"?{variables[0]}":
            hint = f"; the variable's value is {keyword.arg}={variables[0]}"
        elif variables:
            meant = _VARIABLE.sub("{\\1}", value)
            hint = f"; with the variable's value it is {keyword.arg}=f'{meant}'"
        elif len(value.split()) > 1 and _is_compared(keyword.arg, productions):
            hint = "; no pattern can match it, because it contains a space; write one word"
        else:
            continue
        message = f"production '{production.name}': {keyword.arg}={value!r} stores this text literally{hint}"
        warn_at(message, production.original_func, call.lineno)


def _is_compared(slot: str | None, productions: Sequence[Production]) -> bool:
    """Returns whether patterns of the agent compare a slot with a word."""
    conditions = [condition for production in productions for condition in production.conditions]
    return any(c.op in ("is", "not") and c.key == slot for c in conditions)

"""Says what is most likely not meant in a model: it runs once for each agent class, when an agent begins.

A check only warns (`ModelWarning`, at the modeller's own file and line); it never changes what the model does, and
looks at nothing whose reading could.
"""

from __future__ import annotations

import ast
import inspect
import linecache
import sys
import warnings
from collections.abc import Callable, Iterable, Iterator, Mapping
from typing import TYPE_CHECKING, Any, cast
from weakref import WeakSet

from actr3d.actr.buffer import Buffer
from actr3d.actr.chunk import parse_slots
from actr3d.actr.memory import Memory
from actr3d.actr.model import MethodWrapper, Model
from actr3d.actr.modules.imaginal import ImaginalModule
from actr3d.actr.pattern import MISSING, Condition
from actr3d.actr.plain import UNKNOWN, plain_value
from actr3d.actr.sources import function_node, source_of, syntax_tree
from actr3d.actr.vocabulary import slots_given, slots_named
from actr3d.errors import ModelWarning, did_you_mean

if TYPE_CHECKING:
    from actr3d.actr.procedural import ProductionSystem
    from actr3d.actr.production import Production

_CHECKED: WeakSet[type] = WeakSet()
SURE = 0.74
"""How near a name must be to another (0 to 1) to be taken for a slip."""


def check_rules(system: ProductionSystem) -> bool:
    """Checks an agent's class before it acts, unless that has been done; tells whether it has not."""
    if type(system) in _CHECKED:
        return False
    _CHECKED.add(type(system))
    for production in system._productions:
        _check_contradictions(production)
        _check_patterns(production)
    for production in (*system._initializers, *system._productions):
        _check_body(production)
    _check_classes(system)
    return True


def check_names(system: ProductionSystem) -> None:
    """Checks names of slots and parameters, once the methods without parameters have set things up."""
    for production in system._productions:
        _check_slots(production)
    _check_parameters(system)


def say(message: str, func: Callable[..., Any], line: int | None = None) -> None:
    """Warns, at a line of a modeller's function."""
    code = func.__code__
    warnings.warn_explicit(message, ModelWarning, code.co_filename, line or code.co_firstlineno, registry={})


# -- patterns


def _check_contradictions(production: Production) -> None:
    """Finds conditions that cannot hold together."""
    firsts: dict[tuple[str | None, Any], list[Condition]] = {}
    for condition in production.conditions:
        if condition.op != "call":
            firsts.setdefault((condition.name, condition.key), []).append(condition)
    empty = {condition.name for condition in production.conditions if condition.op == "empty"}
    filled = {condition.name for condition in production.conditions if condition.op not in ("empty", "call")}
    for name in sorted(str(n) for n in empty & filled):
        say(f"production '{production.name}' can never match: '{name}' must be empty and hold a chunk at once", production.original_func)
    for (name, key), conditions in firsts.items():
        reason = _contradiction(conditions)
        if reason:
            say(f"production '{production.name}' can never match: {name}'s slot '{key}' {reason}", production.original_func)


def _contradiction(conditions: Iterable[Condition]) -> str:
    """Returns what is asked of one slot that cannot be, or an empty text."""
    wanted: set[str] = set()
    refused: set[str] = set()
    same: set[str] = set()
    different: set[str] = set()
    sets = {"is": wanted, "not": refused, "bind": same, "same": same, "differs": different}
    for condition in conditions:
        sets.get(condition.op, set()).add(condition.value)
    if len(wanted) > 1:
        return f"must be {' and '.join(repr(v) for v in sorted(wanted))} at once"
    if wanted & refused:
        return f"must and must not be {wanted.pop()!r}"
    if same & different:
        return f"must and must not be ?{(same & different).pop()}"
    return ""


def _check_patterns(production: Production) -> None:
    """Finds patterns that ask for nothing at all, because they are no patterns."""
    for name, pattern in production.pattern_specs.items():
        parts = cast("list[Any]", pattern) if isinstance(pattern, (list, tuple)) else (pattern,)
        for part in parts:
            if part is not None and not isinstance(part, (str, Mapping)) and not callable(part):
                say(
                    f"production '{production.name}': {name}={part!r} is no pattern and matches anything; "
                    f"write text, such as {name}='{part}'",
                    production.original_func,
                )


def _check_slots(production: Production) -> None:
    """Finds slots that are never given a value, where a similar one is; and attributes that an object does not have."""
    given: set[str] | None = None
    for condition in production.conditions:
        key = condition.key
        if not isinstance(key, str) or key[:1] == "?" or condition.op in ("empty", "call"):
            continue
        target = production.context[condition.name or "self"]
        if isinstance(target, Buffer):
            if given is None:
                given = slots_given(production.original_func)
            if key in given or "." in key or (target.chunk and key in target.chunk):
                continue
            hint = did_you_mean(key, slots_named(production.original_func), SURE)
            what = f"no chunk is ever given a slot '{key}'"
        else:
            missing, hint = _missing_attribute(target, key)
            what = f"'{condition.name}' has no attribute '{missing}'"
        if hint:
            say(f"production '{production.name}': {what}{hint}", production.original_func)


def _missing_attribute(target: Any, path: str) -> tuple[str, str]:
    """Returns the first part of a dotted path that leads nowhere, with what may be meant; empty texts where it leads on.

    No code of the modeller's is run for that.
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


# -- bodies


def _check_body(production: Production) -> None:
    """Finds calls that were forgotten, and variables that nothing binds."""
    node = function_node(production.original_func)
    if node is None:
        return
    known = {*production.variables, *production.assigned}
    for part in ast.walk(node):
        if isinstance(part, ast.Call) and isinstance(part.func, ast.Attribute):
            _check_call(production, part, part.func, known)
    _check_brackets(node, production.original_func, production.context)


def _check_brackets(node: ast.FunctionDef, func: Callable[..., Any], names: Mapping[str, Any]) -> None:
    """Finds statements that name a method and do not call it."""
    for part in ast.walk(node):
        if not (isinstance(part, ast.Expr) and isinstance(part.value, ast.Attribute)):
            continue
        if isinstance(_resolve(part.value, names), MethodWrapper):
            text = ast.unparse(part.value)
            say(f"'{text}' without brackets does nothing; did you mean '{text}()'?", func, part.lineno)


def _resolve(node: ast.expr, context: Mapping[str, Any]) -> Any:
    """Returns what a name or a dotted path of models' attributes stands for; None where that cannot be told."""
    if isinstance(node, ast.Name):
        return context.get(node.id)
    if isinstance(node, ast.Attribute):
        owner = _resolve(node.value, context)
        return vars(owner).get(node.attr) if isinstance(owner, Model) else None
    return None


def _check_call(production: Production, call: ast.Call, func: ast.Attribute, known: set[str]) -> None:
    owner = _resolve(func.value, production.context)
    if not isinstance(owner, (Buffer, Memory, ImaginalModule)):
        return
    if func.attr in ("set", "add") and call.args and isinstance(call.args[0], ast.Constant) and isinstance(call.args[0].value, str):
        for _, value in parse_slots(call.args[0].value):
            name = value[1:]
            if value[:1] == "?" and name not in known:
                say(
                    f"production '{production.name}': nothing binds '?{name}' in '{call.args[0].value}'{did_you_mean(name, known)}",
                    production.original_func,
                    call.lineno,
                )
    elif func.attr == "modify":
        for keyword in call.keywords:
            value = keyword.value
            if isinstance(value, ast.Constant) and isinstance(value.value, str) and value.value[:1] == "?":
                say(
                    f"production '{production.name}': {keyword.arg}='{value.value}' stores that very text; "
                    f"the variable's value is {keyword.arg}={value.value[1:]}",
                    production.original_func,
                    call.lineno,
                )


# -- classes


def _check_classes(system: ProductionSystem) -> None:
    """Checks the methods of an agent's class and of its modellers' own modules."""
    for part in (system, *system.get_children()):
        for klass in type(part).__mro__:
            functions = [member for member in vars(klass).values() if inspect.isfunction(member)]
            if functions and _is_modellers(klass) and (klass is type(system) or klass not in _CHECKED):
                _CHECKED.add(klass)
                _check_names_of_methods(klass, functions[0])
                for func in functions:
                    node = function_node(func)
                    if node is not None and node.args.args:
                        _check_brackets(node, func, {node.args.args[0].arg: part})


def _check_names_of_methods(klass: type, func: Callable[..., Any]) -> None:
    """Finds methods that a later one of the same name in the same class has replaced."""
    node = _class_node(klass, func)
    seen: dict[str, int] = {}
    for part in node.body if node is not None else ():
        if isinstance(part, ast.FunctionDef):
            if part.name in seen and not part.decorator_list:
                say(
                    f"class {klass.__name__} has two methods '{part.name}', in lines {seen[part.name]} and {part.lineno}; "
                    "only the second counts",
                    func,
                    part.lineno,
                )
            seen[part.name] = part.lineno


def _is_modellers(klass: type) -> bool:
    return klass is not object and not klass.__module__.startswith("actr3d.")


def _class_node(klass: type, func: Callable[..., Any]) -> ast.ClassDef | None:
    """Returns the definition of a class that a function of it stands in."""
    line = func.__code__.co_firstlineno
    found: ast.ClassDef | None = None
    for node in _classes(source_of(func)):
        if node.name == klass.__name__ and node.lineno <= line <= (node.end_lineno or 0):
            found = node
    return found


def _classes(text: str) -> Iterator[ast.ClassDef]:
    return (node for node in ast.walk(syntax_tree(text)) if isinstance(node, ast.ClassDef))


def _check_parameters(system: ProductionSystem) -> None:
    """Finds attributes of an agent or of its modules that are named nearly like a parameter."""
    from actr3d.actr.procedural import ACTR

    known = {name for klass in ACTR.__mro__ for name in vars(klass) if name.startswith("production_")} | {"profile"}
    _check_attributes(system, system, f"class {type(system).__name__}", known)
    for part in system.get_children():
        if not _is_modellers(type(part)):
            parameters = set(inspect.signature(type(part).__init__).parameters) - {"self"}
            _check_attributes(system, part, f"'{part.name}'", parameters)


def _check_attributes(system: ProductionSystem, part: Model, what: str, known: set[str]) -> None:
    for name, value in vars(part).items():
        if name[0] == "_" or name in known or isinstance(value, (MethodWrapper, Model)) or name in vars(Model):
            continue
        hint = did_you_mean(name, known, 0.85)
        if hint:
            filename, line = _place_of_class(type(system))
            warnings.warn_explicit(
                f"{what} has an attribute '{name}', which is no parameter{hint}", ModelWarning, filename, line, registry={}
            )


def _place_of_class(klass: type) -> tuple[str, int]:
    """Returns the file and the line of a class's definition."""
    filename = getattr(sys.modules.get(klass.__module__), "__file__", None) or "<model>"
    lines = [node.lineno for node in _classes("".join(linecache.getlines(filename))) if node.name == klass.__name__]
    return filename, lines[-1] if lines else 1

"""Production compilation: combines a production that makes a request and one that uses the answer into one without a request."""

from __future__ import annotations

import ast
from collections.abc import Sequence
from functools import cached_property
from typing import Any, cast

from actr3d.actr.chunks.pattern import Bindings, conditions
from actr3d.actr.kernel.model import profile_of
from actr3d.actr.kernel.parameters import named_parameters
from actr3d.actr.kernel.tree import path_of
from actr3d.actr.procedural.production import Production
from actr3d.actr.procedural.production_body import Body, Scope
from actr3d.actr.procedural.production_system import add_production
from actr3d.actr.procedural.utility import PMNew, ProceduralSubModule, utility_modules


class CompiledProduction(Production):
    """A production that does what two productions did in sequence, for the values that they had bound.

    Args:
        pre: The production that made the request.
        post: The production that used what was retrieved.
        number: Distinguishes compiled productions of the same parents.
        kept: The statements of `pre` other than the request.
        retrieve: The buffer that it no longer needs to match.
    """

    def __init__(
        self,
        pre: Production,
        post: Production,
        number: int,
        kept: Sequence[ast.stmt],
        retrieve: str,
        pre_bound: Bindings,
        post_bound: Bindings,
    ) -> None:
        self.system = pre.system
        self.name = f"{pre.name}-{post.name}-{number}"
        self.base_utility = 0
        self.parents = (pre.name, post.name)
        self.pre = pre
        self.post = post
        self.pre_bound = dict(pre_bound)
        self.post_bound = dict(post_bound)
        self._kept = kept
        self.bound: Bindings | None = None
        self.original_func = pre.original_func
        more = {name: pattern for name, pattern in post.pattern_specs.items() if name != retrieve and name not in pre.pattern_specs}
        self.pattern_specs = {
            name: _filled(pattern, bound)
            for patterns, bound in ((pre.pattern_specs, pre_bound), (more, post_bound))
            for name, pattern in patterns.items()
        }
        self.keys = list(self.pattern_specs)
        tests = [*conditions(pre.pattern_specs, pre_bound), *conditions(more, post_bound)]
        self.conditions = tuple(sorted(tests, key=lambda test: test.op == "call"))
        self.context = pre.context

    @property
    def place(self) -> str:
        """The places of its parents."""
        return f"compiled from {self.pre.place} and {self.post.place}"

    @property
    def code(self) -> str:
        """The statements of its parents as text."""
        return "\n".join(map(ast.unparse, [*self._kept, *self.post.node.body]))

    @cached_property
    def _kept_body(self) -> Body | None:
        return self.pre.body_of(self._kept) if self._kept else None

    @cached_property
    def _post_body(self) -> Body:
        return self.post.body_of(self.post.node.body)

    def forget_body(self) -> None:
        self.__dict__.pop("_kept_body", None)
        self.__dict__.pop("_post_body", None)

    def _run(self) -> None:
        """Runs the kept statements of the first production, then all of the second."""
        sch = self.system.sch
        bound: dict[str, Any] = {**(self.bound or {}), **self.pre_bound}
        if self._kept_body is not None:
            bound = sch.bound = Scope(bound, self.context, self.pre.original_func)
            self._kept_body(bound)
        bound = sch.bound = Scope({**bound, **self.post_bound}, self.context, self.post.original_func)
        self._post_body(bound)


def _filled(pattern: Any, bound: Bindings) -> Any:
    """Returns a pattern with its variables replaced by their values, for display only: the result need not be a valid pattern."""
    if isinstance(pattern, str):
        # The longest name first: ?a must not match the beginning of ?ab.
        for name in sorted(bound, key=len, reverse=True):
            pattern = pattern.replace(f"?{name}", str(bound[name]))
        return pattern
    if isinstance(pattern, (list, tuple)):
        return [_filled(part, bound) for part in cast("Sequence[Any]", pattern)]
    return pattern


class PMCompile(ProceduralSubModule):
    """Learns new productions: combines one that makes a request and the next one, which uses the answer.

    Args:
        keep: The buffers (or the one buffer) that the productions may match and change.
        request: The beginning of the requesting statement, such as `'memory.request'`.
        retrieve: The buffer in which the answer arrives.
    """

    @named_parameters
    def __init__(self, keep: str | Sequence[str], request: str, retrieve: str) -> None:
        self.keep = tuple(keep) if isinstance(keep, (list, tuple)) else (cast("str", keep),)
        self.request = request
        self.retrieve = retrieve
        self.pre: list[Production] = []
        self.post: list[Production] = []
        self._previous: tuple[Production, Bindings] | None = None
        self.compiled: dict[Any, CompiledProduction] = {}

    @property
    def names_in_productions(self) -> list[tuple[str, str]]:
        given = [("request", self.request), ("retrieve", self.retrieve), *(("keep", name) for name in self.keep)]
        return [(parameter, name.split(".")[0]) for parameter, name in given]

    def create(self, prod: Production, parents: list[Production] | None = None) -> None:
        if self.retrieve in prod.keys and all(name in self.keep or name == self.retrieve for name in prod.keys):
            self.post.append(prod)
        if parents is None and self._kept(prod) is not None:
            self.pre.append(prod)

    def _kept(self, prod: Production) -> list[ast.stmt] | None:
        """Returns a production's statements other than the request; None if it makes none, or cannot be compiled."""
        kept: list[ast.stmt] = []
        requests = False
        for statement in prod.node.body:
            text = ast.unparse(statement)
            if text.startswith(self.request):
                requests = True
            elif any(text.startswith(name) for name in self.keep):
                kept.append(statement)
            elif not (isinstance(statement, ast.Expr) and isinstance(statement.value, ast.Constant)):
                return None
        return kept if requests else None

    def firing(self, prod: Production) -> None:
        if self._previous is not None and prod in self.post:
            self._compile(*self._previous, prod, dict(prod.bound or {}))
        self._previous = (prod, dict(prod.bound or {})) if prod in self.pre else None

    def _compile(self, pre: Production, pre_bound: Bindings, post: Production, post_bound: Bindings) -> None:
        agent: Any = self.parent
        key = (pre, post, tuple(sorted(pre_bound.items())), tuple(sorted(post_bound.items())))
        known = self.compiled.get(key)
        if known is not None:
            if profile_of(self).learn_compiled:  # it moves towards its first parent's utility, as in ACT-R 7
                for adaptor in utility_modules(agent):
                    if isinstance(adaptor, PMNew):
                        adaptor.recreated(known, known.pre)
            return
        made = CompiledProduction(pre, post, len(self.compiled) + 1, self._kept(pre) or [], self.retrieve, pre_bound, post_bound)
        self.compiled[key] = made
        trace = self.sch.trace
        if trace is not None and trace.production:
            trace.emit(self.sch.now_us, path_of(agent), "compile", {"production": made.name, "parents": list(made.parents)})
        for adaptor in utility_modules(agent):
            adaptor.create(made, parents=[pre, post])
        add_production(agent, made)

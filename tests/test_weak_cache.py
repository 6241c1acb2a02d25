"""A cache that does not keep alive what its results are about."""

from __future__ import annotations

import gc
import weakref

from actr3d.weak_cache import weak_cache


def test_a_result_is_stored_as_long_as_its_class_lives() -> None:
    asked: list[type] = []

    @weak_cache
    def name_of(kind: type) -> str:
        asked.append(kind)
        return kind.__name__

    kind = type("Passing", (), {})
    assert [name_of(kind), name_of(kind)] == ["Passing", "Passing"]
    assert asked == [kind]
    asked.clear()
    there = weakref.ref(kind)
    del kind
    gc.collect()
    assert there() is None

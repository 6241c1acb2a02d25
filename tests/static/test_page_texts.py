"""Texts of the page that a reader may trust: keys are those of the registered commands."""

from __future__ import annotations

import re

from workbench.shipped import static

VENDOR = static() / "vendor"
TYPED = re.compile(r"""\((?:(?:Ctrl|Shift|Alt|Cmd|⌘) )*(?:[A-Z]|F\d+|Del|Enter|Space|Esc)\)(?=["`])""")
"""A key at the end of a text, as `buttonTitle` of `keys.js` writes it."""


def test_no_title_has_a_key_typed_into_it() -> None:
    found = {
        str(path.relative_to(static())): keys
        for path in static().rglob("*.js")
        if VENDOR not in path.parents and (keys := TYPED.findall(path.read_text(encoding="utf-8")))
    }
    assert found == {}, "on a Mac it is another key: use `buttonTitle`"

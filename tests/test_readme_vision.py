"""What the README says of vision is so."""

from __future__ import annotations

from pathlib import Path

import pytest

from actr3d.actr.loading import run_text
from actr3d.vision import DETECTORS
from actr3d.vision.feature import slot_names

SECTION = (Path(__file__).parent.parent / "README.md").read_text(encoding="utf-8").split("## Vision\n")[1].split("\n## ")[0]
EXAMPLES = [block.split("```")[0] for block in SECTION.split("```python\n")[1:]]


def test_the_example_prints_what_is_shown(capsys: pytest.CaptureFixture[str]) -> None:
    run_text(EXAMPLES[0], "readme.py")
    assert capsys.readouterr().out == SECTION.split("```\n")[2]


def test_a_detector_of_ones_own_is_known() -> None:
    before = dict(DETECTORS)
    try:
        run_text(EXAMPLES[1], "readme.py")
        assert DETECTORS["pole"].parameters == ("most",)
    finally:
        DETECTORS.clear()
        DETECTORS.update(before)


def test_the_table_has_all_features() -> None:
    expected = [
        f"| `{name}` | {', '.join([*slot_names(one.finds), *(f'{a} (for {b})' for a, b in one.finds.aliases.items())])} | "
        f"{', '.join(one.parameters)} |"
        for name, one in sorted(DETECTORS.items())
        if one.builtin
    ]
    assert [line for line in SECTION.splitlines() if line.startswith("| `")] == expected

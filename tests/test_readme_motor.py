"""What the README says of limbs under command is so."""

from __future__ import annotations

import inspect
import re
from pathlib import Path

import pytest
from moving import moving, until

from actr3d.actr.loading import run_text
from actr3d.motor import Motor

SECTION = (Path(__file__).parent.parent / "README.md").read_text(encoding="utf-8").split("## Limbs under command\n")[1].split("\n## ")[0]
COMMANDS = (
    *(Motor.walk, Motor.turn, Motor.rotate, Motor.rotate_torso, Motor.extend_shoulder, Motor.compress_shoulder, Motor.lower_arms),
    *(Motor.move, Motor.assume, Motor.stop, Motor.feel),
)


def test_the_example_prints_what_is_shown(capsys: pytest.CaptureFixture[str]) -> None:
    run_text(SECTION.split("```python\n")[1].split("```")[0], "example.py")
    assert capsys.readouterr().out == SECTION.split("```\n")[2]


def test_the_table_has_all_commands() -> None:
    rows: list[str] = []
    for command in COMMANDS:
        parameters = list(inspect.signature(command).parameters.values())[1:]
        takes = ", ".join(str(of.replace(annotation=inspect.Parameter.empty)) for of in parameters)
        meaning = re.split(r"(?<=\.)\s", inspect.getdoc(command) or "")[0]
        rows.append(f"| `{command.__name__}({takes})` | {meaning} |")
    shown = [line for line in SECTION.splitlines() if line.startswith("| `") and "(" in line.split("`")[1]]
    assert shown == rows


def test_productions_can_match_all_that_is_told() -> None:
    _, motor = moving()
    named = re.findall(r"`(\w+|<\w+>_\w+)`", SECTION.split("| productions match |")[1].split("\n\n")[0])
    told = {word.replace("<group>", "torso").replace("<joint>", "torso_yaw") for word in named}
    ends = {"done", "stopped", "limit", "blocked", "none"}
    assert {word for word in told if not hasattr(motor, word)} == ends


def test_the_posture_is_as_shown() -> None:
    simulation, motor = moving()
    motor.rotate_torso(60)
    motor.extend_shoulder("right")
    until(simulation, lambda: not motor.busy)
    chunk = motor.parent.posture.chunk
    shown = re.findall(r"`(posture:rotate_torso .*?)`", SECTION)[0].split()
    assert {f"{slot}:{value}" for slot, value in chunk.items()} >= set(shown) - {"..."}

"""Questions about texts: what is known of ACT-R and Python, and that no text runs, blocks or breaks anything."""

from __future__ import annotations

import asyncio
import json
import os
import py_compile
import re
import signal
import sys
from collections.abc import Callable, Iterator
from contextlib import suppress
from importlib import import_module
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st
from jedi import settings

from tests.helpers.asgi_client import COOKIE, GATE, HOST, JSON, ORIGIN, OURS, call
from tests.helpers.paths import MODELS
from tests.helpers.sessions import Desk
from workbench.app import make_app
from workbench.language import language_server
from workbench.language.answers import LanguageError
from workbench.language.explicit_names import ExplicitText
from workbench.language.field_texts import text_at
from workbench.language.language_question import LONGEST_TEXT
from workbench.language.language_server import MAX_WAITING, LanguageServer, TooManyQuestionsError
from workbench.language.language_worker import safe_path
from workbench.language.model_text import ModelText
from workbench.language.python_answers import PythonAnswers
from workbench.language.questions import CodeUnits
from workbench.loader import listing_of

COUNTING = (MODELS / "counting.py").read_text(encoding="utf-8")
FAN = (MODELS / "fan_effect.py").read_text(encoding="utf-8").replace("|", "or")
PAIRED = (MODELS / "paired_associates.py").read_text(encoding="utf-8").replace("|", "or")
APERTURE = (MODELS / "aperture_passage.py").read_text(encoding="utf-8").replace("|", "or")
DOORWAY = (MODELS / "doorway.py").read_text(encoding="utf-8")

SEEING = """from actr3d.actr import *
from actr3d.vision import Vision


class Walker(ACTR):
    goal = Buffer()
    visual = Buffer()
    vision = Vision(visual)

    def look(goal="walk", vision="busy:False"):
        vision.request("feature:obstacle", radius=2, bearing=20)
"""

Ask = Callable[..., Any]


class Asked:
    """Asks a language server about texts in which `|` stands for the position.

    Args:
        desk: Has workers.
        folder: The models folder.
    """

    def __init__(self, desk: Desk, folder: Path) -> None:
        self._desk = desk
        self.server = LanguageServer(desk.workers, folder)

    def __call__(self, ask: str, text: str, name: str = "", path: str = "model.py") -> Any:
        return json.loads(self._desk.do(self.server.ask(question(ask, text, name, path))))

    def labels(self, text: str, **more: Any) -> list[str]:
        """Returns completions, those of the highest rank first."""
        items = self("complete", text, **more)["items"]
        return [item["label"] for item in sorted(items, key=lambda item: -item["boost"])]


def question(ask: str, text: str, name: str = "", path: str = "model.py") -> bytes:
    at = max(0, text.find("|"))
    return json.dumps({"ask": ask, "path": path, "text": text.replace("|", "", 1), "at": at, "name": name}).encode()


@pytest.fixture(scope="module")
def ask(whole_desk: Desk, tmp_path_factory: pytest.TempPathFactory) -> Iterator[Asked]:
    """One process for all tests that do not end it."""
    folder = tmp_path_factory.mktemp("language")
    (folder / "beside.py").write_text("def helps(distance):\n    'Measures.'\n", encoding="utf-8")
    asked = Asked(whole_desk, folder)
    yield asked
    whole_desk.do(asked.server.close())


@pytest.fixture
def alone(desk: Desk, tmp_path: Path) -> Iterator[Asked]:
    """A process that the test may end."""
    asked = Asked(desk, tmp_path)
    yield asked
    desk.do(asked.server.close())


# -- completion


VISION = "from actr3d.vision import Vision\n" + COUNTING.replace("memory = ", "seen = Buffer()\n    vision = Vision(seen)\n    memory = ")


POLE = """from dataclasses import dataclass
from actr3d.vision import Feature, Metres


@dataclass(frozen=True, kw_only=True)
class Pole(Feature):
    girth: Metres


"""


@pytest.mark.daily(3)
@pytest.mark.parametrize(
    ("text", "first"),
    [
        (COUNTING.replace("goal.clear()", "goal.modify(|)"), ["task=", "number=", "last="]),
        (COUNTING.replace("goal.clear()", "goal.modify(task=1)\n        goal.modify(number=abs(2), |)"), ["task=", "last="]),
        (COUNTING.replace("number:?now last", "nu| last"), ["number"]),
        (COUNTING.replace("task:count number:?now last:!?now", "task:|"), ["start", "count"]),
        (COUNTING.replace("number:?now last:!?now", "number:?|"), ["?now", "?next", "?after"]),
        (COUNTING.replace('retrieval="count ?now ?next"', "|"), ["retrieval", "memory"]),
        (COUNTING.replace('retrieval="count ?now ?next"', 'retrieval="|"'), ["count"]),
        (
            COUNTING.replace("    retrieval = ", "    production_ti|\n    retrieval = "),
            ["production_match_delay", "production_threshold", "production_time"],
        ),
        (COUNTING.replace("goal.clear()", "goal.|"), ["clear", "isEmpty", "modify", "set", "chunk"]),
        (COUNTING.replace("goal.clear()", "retr|"), ["retrieval"]),
        (COUNTING.replace("print(now)", "print(no|)"), ["now"]),
        (DOORWAY.replace('eye.request("view")', 'eye.request("|")'), ["accelerometer", "anatomy", "bounding_box"]),
        (DOORWAY.replace('eye.request("view")', 'eye.set("|")'), ["brake", "control", "gaze"]),
        (DOORWAY.replace("pose x:?x", "pose |"), ["x", "y", "z", "heading", "pitch", "roll"]),
        (DOORWAY.replace('eye="busy:False"', 'eye="|"'), ["walk", "view"]),
        (DOORWAY.replace('eye="busy:False"', 'eye="busy:|"'), ["False", "True"]),
        (DOORWAY.replace("Aperture(", "Aperture(clo|, ").replace("import Aperture(clo|,", "import Aperture,"), ["closing="]),
        (DOORWAY + "\nfrom actr3d.world import Mann|", ["Mannequin"]),
        (VISION.replace('memory.request("count ?now ?next")', 'vision.request("feature:|")'), ["obstacle", "opening"]),
        (VISION.replace('memory.request("count ?now ?next")', 'vision.request("|")'), ["feature"]),
        (VISION.replace('memory.request("count ?now ?next")', 'vision.request("feature:opening |")'), ["distance", "direction", "motion"]),
        (POLE + VISION.replace('memory.request("count ?now ?next")', 'vision.request("feature:|")'), ["obstacle", "opening", "pole"]),
        (
            POLE + VISION.replace('memory.request("count ?now ?next")', 'vision.request("feature:pole |")'),
            ["distance", "direction", "motion", "girth"],
        ),
        ("import beside\nbeside.|", ["helps"]),
        (
            DOORWAY.replace("parts=(", "parts=(|"),
            ["Aperture", "Car", "Floor", "Imported", "ImportedBody", "Mannequin", "Mesh", "SimpleObject"],
        ),
        ("x = 'not a chunk |'", []),
    ],
)
def test_what_may_stand_at_a_place(ask: Asked, text: str, first: list[str]) -> None:
    assert ask.labels(text)[: len(first)] == first


def test_a_request_to_vision_begins_with_the_kind_of_feature(ask: Asked) -> None:
    text = VISION.replace('memory.request("count ?now ?next")', 'vision.request("|")')
    assert {one["label"] for one in ask("complete", text)["items"] if one["type"] == "property"} == {"feature"}


@pytest.mark.parametrize(("method", "offered"), [("set", "walk"), ("request", "pose")])
def test_what_a_body_is_given_is_one_word_and_no_chunk(ask: Asked, method: str, offered: str) -> None:
    text = DOORWAY.replace('eye.request("view")', f'eye.{method}("|")')
    items = {one["label"]: one["type"] for one in ask("complete", text)["items"]}
    assert offered in items
    assert set(items.values()) == {"function"}
    assert ("jump" in items) is False
    assert "jump" in ask.labels(text.replace('skin.request("pose")', f'skin.request("pose")\n        eye.{method}("jump")'))
    assert ask.labels(text.replace('("|")', f'("{offered} |")')) == []


def test_only_public_names_of_the_library_are_offered_to_import(ask: Asked) -> None:
    names = set(ask.labels("from actr3d.world import |"))
    assert {"Floor", "Mannequin", "Scene"} <= names
    assert not {"actuated_dofs", "asset_folder"} & names
    assert ask.labels("from actr3d.world import (Floor,\n    Mann|") == ["Mannequin"]
    assert "request" not in ask.labels("from actr3d.world import Floor\nFloor().|")


def test_a_request_to_vision_is_offered_the_conditions_of_its_feature(ask: Asked) -> None:
    items = {one["label"]: one for one in ask("complete", SEEING.replace("radius=2, bearing=20", "|"))["items"]}
    assert {"width=", "distance=", "bearing=", "radius=", "bottom_up="} <= set(items)
    assert "depth=" not in items  # of another feature
    assert "straight ahead" in items["bearing="]["text"]
    assert items["width="]["detail"] == "of obstacle"


def test_only_names_that_exist_are_offered_after_everything_was_imported(ask: Asked) -> None:
    names = set(ask.labels("from actr3d.actr import *\n\nx = |"))
    assert {"Buffer", "DMNoise", "print", "None"} <= names
    assert not {"check_agent", "production_system", "annotations", "AbstractSet", "WindowsError"} & names


def test_a_part_of_a_scene_is_offered_with_the_import_that_it_needs(ask: Asked) -> None:
    items = {one["label"]: one for one in ask("complete", DOORWAY.replace("parts=(", "parts=(Fl|, "))["items"]}
    assert (items["Floor"]["apply"], items["Floor"]["needs"]) == ("Floor(${})", "")
    assert items["Car"]["needs"] == "from actr3d.world import Car"
    assert "Car" not in ask.labels(DOORWAY.replace("Aperture(width", "Aperture(Ca|, width"))


def test_methods_that_only_the_library_calls_are_not_offered(ask: Asked) -> None:
    labels = ask.labels(COUNTING.replace("memory.request", "memory.|; memory.request", 1))
    assert labels[:5] == ["add", "clear", "find_matching_chunks", "get_activation", "request"]
    assert not {"recall", "fail", "add_adaptor", "start"} & set(labels)
    blending = COUNTING.replace("Memory(", "BlendingMemory(").replace("memory.request", "memory.|; memory.request", 1)
    assert not {"recall", "fail"} & set(ask.labels(blending))
    head = "from actr3d.actr import *\nfrom actr3d.sgoms import SGOMS\n\n"
    text = head + "class A(SGOMS):\n    b = Buffer()\n    {}\n    def p(b='x'):\n        {}"
    noise = ask.labels(text.format("noise = PMNoise()", "noise.|"))
    assert "logisticNoise" in noise
    assert not {"create", "firing", "utility"} & set(noise)
    own = ask.labels(text.format("pass", "self.|"))
    assert {"resume_at", "reward", "stop"} <= set(own)
    assert not [label for label in own if label.startswith("sgoms_")]


def test_private_names_are_offered_when_one_begins(ask: Asked) -> None:
    names = ask.labels(COUNTING.replace("goal.clear()", "goal.|"))
    assert "chunk" in names
    assert not any(name.startswith("_") for name in names)
    assert "__class__" in ask.labels(COUNTING.replace("goal.clear()", "goal._|"))


@pytest.mark.daily(2)
@pytest.mark.parametrize("end", ["", "\n\nclass Other(AC", '\n    def more(goal="task:', "\n    def more(goal=", "\n)]}\n", "\nprint(f'{"])
def test_texts_that_are_not_complete_yet(ask: Asked, end: str) -> None:
    assert ask.labels(COUNTING.replace("number:?now last", "nu| last") + end) == ["number"]


@pytest.mark.parametrize(
    ("pattern", "word"),
    [("nu|", "nu"), ("task:co|", "co"), ("number:?n|", "?n"), ("number:!?n|", "?n"), ("number:2!3|", "3"), ("task:|", ""), ("a b|", "b")],
)
def test_a_completion_replaces_the_word_that_was_begun(ask: Asked, pattern: str, word: str) -> None:
    text = COUNTING.replace("task:count number:?now last:!?now", pattern)
    assert text[ask("complete", text)["start"] : text.index("|")] == word


def test_a_completion_says_what_it_is(ask: Asked) -> None:
    (slot,) = (one for one in ask("complete", DOORWAY.replace("pose x:?x", "pose |"))["items"] if one["label"] == "heading")
    assert (slot["detail"], slot["apply"]) == ("slot of pose", "heading:")
    assert "left is positive" in slot["text"]
    said = ask("document item", "from actr3d.actr import *\nDMNoise(None, noi|)", "noise=")
    assert said["text"].startswith("The scale s of the logistic noise")
    said = ask("document item", "from actr3d.world import Ap|", "Aperture")
    assert said["title"].startswith("Aperture(name")
    assert "doorway" in said["text"]


def test_after_a_buffer_its_own_methods_come_first_and_its_chunk_is_documented(ask: Asked) -> None:
    text = COUNTING.replace("memory.request", "goal.|; memory.request", 1)
    assert ask.labels(text)[:4] == ["clear", "isEmpty", "modify", "set"]
    said = ask("document item", text, "chunk")
    assert (said["title"], said["text"]) == ("chunk: Chunk | None", "The chunk that it holds; None if it is empty.")
    busy = ask("document item", COUNTING.replace("memory.request", "memory.|; memory.request", 1), "busy")
    assert busy["title"] == "self.busy = False"  # not how False is made


# -- documentation


@pytest.mark.daily(6)
@pytest.mark.parametrize(
    ("text", "title", "said"),
    [
        ("from actr3d.actr import Mem|ory", "Memory(buffer", "Declarative memory"),
        (COUNTING.replace("memory.request", "mem|ory.request", 1), "memory = Memory(retrieval)", "Declarative memory"),
        (COUNTING.replace("memory.request", "memory.req|uest", 1), "request(pattern", "Requests the most active chunk"),
        (COUNTING.replace("task:count", "ta|sk:count", 1), "slot task", "values: start, count"),
        (COUNTING.replace("task:count", "task:co|unt", 1), "value count", "used in start_counting, count_on"),
        (COUNTING.replace("print(now)", "print(n|ow)", 1), "?now", "retrieval's word 2"),
        (COUNTING.replace("def count_on", "def count|_on"), "production count_on", "goal: task:count number:?now"),
        (COUNTING.replace("    goal = ", "    go|al = "), "goal = Buffer()", "slots: task, number, last"),
        (DOORWAY.replace('"pose"', '"po|se"', 1), "value pose", "Senses position"),
        (DOORWAY.replace("pose x:", "pose x|:"), "slot x", "pose: [m]"),
        (DOORWAY.replace("width=parameters", "wid|th=parameters"), "", "free width"),
        (COUNTING.replace("Memory(retrieval)", "Memory(retrieval, lat|ency=1)"), "latency: ", "F in the retrieval time"),
        (SEEING.replace("bearing=", "bea|ring="), "condition bearing", "obstacle: Greatest angle"),
        (SEEING.replace("radius=", "rad|ius="), "condition radius", "obstacle: distance: Horizontal distance from the eye"),
    ],
)
def test_what_is_known_of_a_name(ask: Asked, text: str, title: str, said: str) -> None:
    found = ask("document", text)
    assert found["title"].startswith(title)
    assert said in found["text"]
    assert found["start"] <= text.index("|") <= found["end"]


READING = """from actr3d.actr import *


class Own(DMSpreading):
    pass


class Reader(ACTR):
    goal = Buffer()
    found = Buffer()
    memory = Memory(found)
    spread = DMSpreading(memory, goal)
    own = Own(memory, goal)
    imaginal = ImaginalModule(goal)

    def init():
        goal.set("task:look")

    def look(goal="task:look"):
        goal.modify(task="say", count=3, place=f"in {1}")

    def say(goal="task:say"):
        goal.modify(task=len("x"))
        goal.modify(task=other)
"""


@pytest.mark.parametrize(
    ("text", "said"),
    [
        (READING.replace("    goal =", "    go|al ="), "filled by imaginal\nslots: task\nmatched in look, say"),
        (READING.replace("    found =", "    fou|nd ="), "filled by memory"),
        (READING.replace("task=", "ta|sk=", 1), "matched in look, say\nset in init, look, say\nvalues: look, say"),
        (READING.replace("count=", "cou|nt="), "set in look\nvalues: 3"),
        (READING.replace("place=", "pla|ce="), "set in look"),
        (READING.replace("task:say", "task:s|ay"), "in slot task, used in look, say"),
    ],
)
def test_what_is_known_of_a_buffer_and_its_slots(ask: Asked, text: str, said: str) -> None:
    assert ask("document", text)["text"].endswith(said)


def test_what_is_known_of_a_field_is_what_its_file_says_now(tmp_path: Path) -> None:
    file = tmp_path / "helper.py"
    file.write_text('width = 1\n"""The width."""\n', encoding="utf-8")
    assert text_at(file, 1) == "The width."
    file.write_text('height = 2\n"""The height."""\nwidth = 1\n"""The width [m]."""\n', encoding="utf-8")
    assert (text_at(file, 1), text_at(file, 3)) == ("The height.", "The width [m].")


def test_nothing_is_known_where_there_is_nothing(ask: Asked) -> None:
    assert ask("document", "x = 1  |  # a comment") is None
    assert ask("define", '"""| a text"""') is None
    assert ask("signature", COUNTING.replace("task:count", "task:|count", 1)) == []


def test_how_a_function_is_called(ask: Asked) -> None:
    (found,) = ask("signature", COUNTING.replace("Memory(retrieval)", "Memory(retrieval, latency=|)"))
    assert (found["name"], found["active"], found["parameters"][0]) == ("Memory", 1, "buffer: Buffer")
    assert found["text"].startswith("F in the retrieval time")
    (field,) = ask("signature", "from actr3d.world import Aperture\nAperture(closing=|)")
    assert field["text"].startswith("How fast")
    turning = DOORWAY.replace('eye.set("walk", self.speed)', 'eye.set("heading", speed=|)')
    (command,) = ask("signature", turning)
    assert (command["name"], command["parameters"], command["active"]) == ("heading", ["angle", "speed=2.0"], 1)
    assert "the whole body" in command["text"]
    (command,) = ask("signature", turning.replace("speed=|", "1|"))
    assert command["active"] == 0


# -- definitions, renaming, formatting


@pytest.mark.parametrize(
    ("text", "found"),
    [
        (COUNTING.replace("goal.clear()", "go|al.clear()"), "goal = Buffer()"),
        (COUNTING.replace("print(now)", "print(n|ow)", 1), "now last:!?now"),
        (COUNTING.replace("last:?now", "la|st:?now"), "last:5"),
        (COUNTING.replace("model.run()", "mo|del.run()"), "model = Counting()"),
        (COUNTING.replace("Counting()", "Count|ing()"), "Counting(ACTR)"),
    ],
)
def test_where_a_name_is_defined(ask: Asked, text: str, found: str) -> None:
    place = ask("define", text)
    assert place["path"] == "model.py"
    assert text.replace("|", "").startswith(found, place["at"])


@pytest.mark.parametrize(
    ("text", "label"),
    [
        ("from ccm import *\nAC|", "ACTR"),
        ("import ccm\nccm.log_every|", "log_everything"),
        ("import ccm.lib.actr\nccm.lib.actr.Mem|", "Memory"),
        ("from python_actr.lib.actr import Mem|", "Memory"),
        (
            "from ccm.lib.actr import *\nclass A(ACTR):\n    memory = Memory(Buffer())\n    def f(memory='x:1'):\n        memory.requ|",
            "request",
        ),
    ],
)
def test_texts_with_the_old_names_of_the_library_are_completed_and_explained(ask: Asked, text: str, label: str) -> None:
    assert ask.labels(text)[0] == label
    begun = text.removesuffix("|")
    whole = begun + label[next(n for n in range(len(label), -1, -1) if begun.endswith(label[:n])) :]
    assert label in ask("document", f"{whole[:-1]}|{whole[-1]}")["title"]


def test_where_names_of_other_files_are_defined(ask: Asked) -> None:
    beside = ask("define", "from beside import helps\nhel|ps(1)")
    assert (beside["path"], beside["line"]) == ("beside.py", 1)
    library = ask("define", "from actr3d.actr import Buf|fer")
    assert (library["path"], library["module"]) == (None, "actr3d.actr.kernel.buffer")


def renamed(asked: Asked, text: str, name: str) -> tuple[str, int]:
    """Returns a text in which a name has been replaced, with `|` in the first place of it, and the number of its places."""
    plain, changes = text.replace("|", ""), asked("rename", text, name)["changes"]
    for start, end in reversed(changes):
        plain = f"{plain[:start]}{'|' if start == changes[0][0] else ''}{name}{plain[end:]}"
    return plain, len(changes)


NAMES = """from random import choice
from actr3d.actr import *

word = "red"
ink = "green"


class Stroop(ACTR):
    goal = Buffer()
    retrieval = Buffer()
    memory = Memory(retrieval)

    def init():
        goal.set(f"task:ink word:{word} ink:{ink}")

    def look(goal="task:ink ink:?i"):
        size = 1
        print(f"{i} {size}")
        memory.request("of:ink")

    def wrong(goal="task:say"):
        print(ink)


def helps():
    other = 1
    return other


def counts():
    count = 2
    return count


model = Stroop()
"""


@pytest.mark.daily(4)
@pytest.mark.parametrize(
    ("text", "name", "changed"),
    [
        (COUNTING.replace("print(now)", "print(n|ow)", 1), "here", 4),
        (COUNTING.replace("goal.clear()", "go|al.clear()"), "aim", 8),
        (COUNTING.replace("number:?now last:!", "num|ber:?now last:!"), "size", 5),
        (COUNTING.replace("model.run()", "mo|del.run()"), "agent_1", 2),
        (NAMES.replace("word = ", "wo|rd = "), "text", 2),
        (NAMES.replace("def look", "def lo|ok"), "see", 1),
        (NAMES.replace("class Stroop", "class Str|oop"), "Reading", 2),
        (NAMES.replace("?i", "?|i", 1), "colour", 2),
        (NAMES.replace("other = 1", "oth|er = 1"), "count", 2),  # a name of another function
        (NAMES.replace("goal = Buffer", "go|al = Buffer"), "aim", 4),
    ],
)
def test_renaming(ask: Asked, text: str, name: str, changed: int) -> None:
    old = ask("rename", text)["name"]
    after, count = renamed(ask, text, name)
    assert (count, after.count(name) - text.replace("|", "").count(name)) == (changed, changed)
    again, count = renamed(ask, after, old)
    assert (count, again.replace("|", "")) == (changed, text.replace("|", ""))


TOTAL = """from actr3d.actr import *

class Stroop(ACTR):
    goal = Buffer()
    def init():
        self.total = 0
    def look(goal="task"):
        self.total += 1
        print(self.total)

class Child(Stroop):
    def look(goal="task"):
        self.total += 2

class Other(ACTR):
    def init():
        self.total = 0

model = Stroop()
print(model.total, [Child()][0].total, Other().total)
"""
BESIDE = """from actr3d.actr import *

class Base(ACTR):
    goal = Buffer()
    def look(goal="x"): pass

class Child(Base):
    aim = Buffer()
    def say(goal="y"): pass
"""
DOTTED = "import actr3d.actr as aa\n\nclass Walk(aa.ACTR):\n    goal = aa.Buffer()\n    def look(goal='x'): pass\n"


@pytest.mark.parametrize(
    "place", ["self.to|tal = 0\n    def look", "self.to|tal += 1", "self.to|tal += 2", "model.to|tal", "(self.to|tal)", "[0].to|tal"]
)
def test_an_attribute_that_a_method_sets_is_renamed_wherever_its_class_has_it(ask: Asked, place: str) -> None:
    text = TOTAL.replace(place.replace("|", ""), place)
    assert text != TOTAL
    after, count = renamed(ask, text, "amount")
    kept = TOTAL.replace("total", "amount").replace(
        "    def init():\n        self.amount = 0\n\nmodel", "    def init():\n        self.total = 0\n\nmodel"
    )
    assert (after.replace("|", ""), count) == (kept.replace("Other().amount", "Other().total"), 6)


def test_a_method_is_renamed_with_those_of_its_subclasses_that_replace_it(ask: Asked) -> None:
    after, count = renamed(ask, TOTAL.replace("def look", "def lo|ok", 1), "see")
    assert (count, after.count("def look"), after.replace("|", "").count("def see")) == (2, 0, 2)


REMAINING = """class Pole:
    # a Pole, and a pole
    pole = 1

POLE = "look at feature:pole"
Pole()
"""


def test_renaming_says_in_which_lines_the_word_stays(ask: Asked) -> None:
    assert ask("rename", REMAINING.replace("class Pole", "class Po|le"), "Rod")["unchanged"] == [2, 3, 5]
    assert ask("rename", REMAINING.replace("class Pole", "class Po|le"), "POLE_")["unchanged"] == [2, 3, 5]
    assert ask("rename", "class Big|Pole: pass\n\nbig_pole = BigPole(), 'big pole'\n", "Rod")["unchanged"] == [3]
    scopes = "def one(size): return size\ndef two(size): return size  # size\n"
    assert ask("rename", scopes.replace("size", "si|ze", 1), "width")["unchanged"] == [2]
    table = 'def re|d(): pass\n\nTABLE = "colour\\nred\\tink"\n'  # a word after an escape
    assert ask("rename", table, "blue")["unchanged"] == [3]
    assert ask("rename", scopes.replace("one", "o|ne", 1), "single")["unchanged"] == []


WHOLE = """from actr3d.actr import *

class Eyes(Model):
    @property
    def first(self):
        return self.parent.seen

class Whole(ACTR):
    goal = Buffer()
    eyes = Eyes()
    def init():
        self.seen = 4
        goal.set("task")
    def look(goal="task", eyes="first:4"):
        print(self.seen)
"""
KEYWORDS = """from actr3d.actr import *

class Walker(ACTR):
    goal = Buffer()
    vision = Vision(goal)
    def look(goal="left:?left"):
        vision.request("feature:opening", width=2, left=">?left")
        goal.modify(other=left)
    def again(goal="left:?left"):
        vision.request("feature:opening", left="?left")
        print("?left")
"""
FIELDS = """from actr3d.actr import *

class Parameters:
    noise: float = 1

class Walker(ACTR):
    goal = Buffer()
    def look(goal="look"):
        print(noise)

def build(parameters: Parameters):
    walker = Walker()
    print(walker.goal)
    walker.noise = parameters.noise
    return walker
"""
CALLED = """def walk(angle=0, pace=1):
    return angle * pace

def other(pace):
    return pace

class Machine:
    def __init__(self, pace):
        self.quick = pace

Machine(pace=3)
walk(3, pace=2)
"""
OVERRIDDEN = """class Walker:
    def go(self, pace=1): pass

class Runner(Walker):
    def go(self, pace=2): pass

def left(speed=1): pass
def right(speed=2): pass

class Machine:
    def __init__(self, walker: Walker, turns):
        walker.go(pace=3)
        self.turn = left if turns else right
        self.turn(speed=3)
"""
PUT = """from actr3d.actr import *

class Board(Model):
    turn = 'ada'

class Player(ACTR):
    goal = Buffer()
    mood = 'calm'
    def go(self='mood:?mood', goal='task:go', board='turn:?mood'):
        goal.set('task:wait')
        print(board.turn)

class Room(Model):
    board = Board()

room = Room()
room.ada = Player()
"""
THINGS = """from actr3d.actr import *

class Fly(Model):
    lives = 2
    salience = 1

class Frog(ACTR):
    visual = Buffer()
    eyes = SOSVision(visual)
    def catch(visual='lives:?lives', fly='lives:2'):
        print(fly)

class Pond(Model):
    def __init__(self):
        self.fly = Fly()
        self.frog = Frog()
"""
REPLACED = """from actr3d.actr import *

class Store(Model):
    busy = False
    size = 2

class Shelf(Model):
    size = 3

class Eyes(Model):
    def seen(store="size:2"): pass

class Person(ACTR):
    goal = Buffer()
    dm = Memory(goal)
    store = Store()
    eyes = Eyes()
    def look(goal="task:x", dm="busy:False", store="size:2"): pass

class Child(Person):
    dm = Store()

class Keeper(Child):
    store = Shelf()
"""
SPLIT = """from actr3d.actr import *

class Person(ACTR):
    goal = Buffer()
    def init():
        goal.set("weight:2 colour:red")
        for slot in "weight colour".split():
            print(goal[slot])
    def look(goal="weight:?w colour:red"):
        print("the weight is", w)
"""
SEEN = """from actr3d.actr import *

class Spot(Model):
    x = 1
    y = 2
    text = "a"
    value = 4

class Person(ACTR):
    goal = Buffer()
    where = Buffer()
    vision = Vision(goal, where)
    def look(goal="text:a"):
        vision.examine("x:1")

class Room(Model):
    def __init__(self):
        self.spot = Spot()
"""
FELT = """from actr3d.actr import *
from actr3d.motor import Motor

class Walker(ACTR):
    goal = Buffer()
    felt = Buffer()
    memory = Memory(felt)
    motor = Motor(felt, memory)
    def plan(goal="task:plan angle:?angle"):
        memory.add("posture:left torso_yaw:?angle")
        goal.set("task:go angle:3")
    def feel(felt="posture:? torso_yaw:>10 hatch:5"): pass
"""
OLD = """import ccm
from ccm.lib.actr import *

class Screen(ccm.Model):
    def start(self):
        self.shown = 1
    def key_pressed(self, key):
        self.shown = key

class Person(ACTR):
    goal = Buffer()
    memory = Memory(goal)
    motor = Motor()
    def look(goal="task:?task", memory="busy:False"):
        motor.press_key(task)
"""
SCOPES = """from math import sqrt

size = 3
twice = [size for size in range(size) if size]

class Box:
    size = size
    sizes = [one for one in range(size)]
    def grown(self, size=size):
        return lambda size=size: size + self.size

def other(number):
    global size
    size = {number: number for number in [number] if number}
    return (number := number + 1)
"""
FETCHED = """from actr3d.actr import *

class Garden(Model):
    apple = Model(owner="none")

class Eater(ACTR):
    goal = Buffer()
    def init():
        goal.set("eat apple")
    def eat(goal="eat ?what"):
        self.take(what)
    def take(self, what):
        getattr(self.parent, what).owner = self
"""
PARTLY = """from actr3d.actr import *
from actr3d.vision import Feature, Vision, detector
from operator import attrgetter
log = log()
CUE = "fact ?word ?"

class Pole(Feature):
    width: float

@detector(Pole)
def poles(view, *, most=0.1):
    return [thing for thing in view if thing.width < most]

class Kitchen(Model):
    def boil(self, seconds=1):
        yield seconds

class Cook(ACTR):
    goal = Buffer()
    visual = Buffer()
    vision = Vision(visual)
    served = 0
    def begin(goal="task:?word"):
        vision.request(CUE)
        self.parent.boil(seconds=0.4)
        self.__class__.served += 1
    def look(goal="task:look ink:?word"):
        vision.request("feature:pole", most=0.3)
        goal.modify(_1=log)

class Trial:
    ink = 1
    price = 2

row = {}
print(row["ink"], attrgetter("price")(Trial))
"""


@pytest.mark.daily(15)
@pytest.mark.parametrize(
    ("text", "name", "lines"),
    [
        ("from actr3d.actr import *\nlo|g = (\n    log()\n)\nprint(log)\n", "trace", [2, 5]),
        ("from actr3d.actr import *\nfor turn in (1, 2):\n    turn > 1 and print(old)\n    o|ld = turn\n", "last", [3, 4]),
        (PARTLY.replace("served = 0", "ser|ved = 0"), "sold", [22, 26]),
        (PARTLY.replace("ink:?word", "ink:?wo|rd"), "seen", [27]),
        (FAN.replace("    answer = reaction", "    ans|wer = reaction"), "reply", [110, 123, 163, 164]),
        (FAN.replace("self.parent.answer", "self.parent.ans|wer"), "reply", [110, 123, 163, 164]),
        (FAN.replace("answer = reaction", "answer = reac|tion"), "delay", [110, 123, 162]),
        (FAN.replace("imaginal = Buffer", "imag|inal = Buffer"), "image", [102, 116, 119, 137, 141, 145, 149, 153]),
        (FAN.replace("self.person, ", "self.per|son, "), "who", [102, 126, 165]),
        (FAN.replace("for person in dict", "for per|son in dict"), "who", [90, 91, 93]),
        (FAN.replace("(person, location)", "(person, loca|tion)", 1), "where", [90, 92, 93]),
        (FAN.replace("(person, location)", "(per|son, location)", 1), "who", [90, 91, 93]),
        (PAIRED.replace("visual = Buffer", "vis|ual = Buffer"), "seen", [115, 129, 147, 166]),
        (PAIRED.replace("screen = Screen", "scr|een = Screen"), "monitor", [114, 123, 136, 143, 161, 176, 177]),
        (PAIRED.replace("showing = ", "show|ing = ", 1), "shows", [91, 99, 101, 105, 115, 143, 161]),
        (PAIRED.replace('"showing:noun', '"show|ing:noun'), "shows", [91, 99, 101, 105, 115, 143, 161]),
        (DOORWAY.replace("    seen = Buffer", "    se|en = Buffer"), "noticed", [49, 51, 64, 68, 69, 70]),
        (APERTURE.replace("def nears", "def nea|rs"), "is_close", None),
        (WHOLE.replace("self.seen =", "self.se|en ="), "known", [6, 12, 15]),
        (WHOLE.replace("def first", "def fi|rst"), "newest", [5, 14]),
        (WHOLE.replace("eyes = Eyes", "ey|es = Eyes"), "vision", [10, 14]),
        (SCOPES.replace("\nsize = 3", "\nsi|ze = 3"), "width", [3, 4, 7, 13, 14]),
        (SCOPES.replace("[size for", "[si|ze for"), "width", [4]),
        (SCOPES.replace("    size = size", "    si|ze = size"), "width", [7, 8, 9, 10]),
        (SCOPES.replace("size + self", "si|ze + self"), "width", [10]),
        (SCOPES.replace("self, size", "self, si|ze"), "width", [9, 10]),
        (SCOPES.replace("{number:", "{num|ber:"), "width", [14]),
        (SCOPES.replace("other(number", "other(num|ber"), "width", [12, 14, 15]),
        (f"{SCOPES}print(sum(number for number in [1]))\n".replace("other(number", "other(num|ber"), "width", [12, 14, 15]),
        (f"{SCOPES}print(sum(number for number in [1]))\n".replace("sum(number", "sum(num|ber"), "width", [16]),
        (KEYWORDS.replace("left:?left", "left:?le|ft", 1), "port", [6, 7, 8]),
        (KEYWORDS.replace('">?left"', '">?le|ft"'), "port", [6, 7, 8]),
        (WHOLE.replace("eyes = Eyes", "ey|es = Eyes").replace("print(", "goal.modify(look='eyes') or print("), "vision", [10, 14]),
        (FIELDS.replace("noise: float", "noi|se: float"), "sigma", [4, 14]),
        (CALLED.replace("pace=1", "pa|ce=1"), "zzz", [1, 2, 12]),
        (CALLED.replace("self, pace", "self, pa|ce"), "zzz", [8, 9, 11]),
        (CALLED.replace("Machine(pace", "Machine(pa|ce"), "zzz", [8, 9, 11]),
        (CALLED.replace("other(pace", "other(pa|ce"), "zzz", [4, 5]),
        (f"{CALLED}class Other(ACTR): pass\nOther(pace=1)\n".replace("other(pace", "other(pa|ce"), "zzz", [4, 5]),
        (f"{CALLED}walk(**{{'pace': 2}})".replace("other(pace", "other(pa|ce"), "zzz", [4, 5]),
        (f"{CALLED}class Other: pass\nsetattr(Other(), 'quick slow' or name, 1)\n".replace("quick =", "qui|ck ="), "zzz", [9]),
        (PUT.replace("self='mood", "self='mo|od"), "feeling", [8, 9]),
        (PUT.replace("mood = ", "mo|od = "), "feeling", [8, 9]),
        (PUT.replace("goal.set('task", "goal.set('ta|sk"), "job", [9, 10]),
        (SPLIT.replace("weight colour", "how much weight?").replace("weight:2", "wei|ght:2"), "mass", [6, 9]),
        (REPLACED.replace("store = Shelf()", "pass").replace("size = 2", "si|ze = 2"), "width", [5, 11, 18]),
        (SEEN.replace("Vision(goal, where)", "SOSVision(goal)").replace("y = 2", "|y = 2"), "north", [5]),
        (SEEN.replace("vision = Vision(goal, where)", "").replace("value =", "val|ue ="), "worth", [7]),
        (FELT.replace("angle:?", "ang|le:?"), "turn", [9, 11]),
        (OLD.replace("self.shown = 1", "self.sho|wn = 1"), "seen", [6, 8]),
        (OLD.replace("goal = B", "go|al = B"), "aim", [11, 12, 14]),
        ("from enum import Enum\nclass Colour(Enum):\n    GR|EEN = 1\n\nprint(Colour['GREEN'])\n", "RED", [3, 5]),
        ('from collections import namedtuple\npoint = namedtuple("point", "east")\nea|st = point(1).east\n', "north", [3]),
    ],
)
def test_a_name_is_renamed_in_all_its_places(ask: Asked, text: str, name: str, lines: list[int] | None) -> None:
    plain = text.replace("|", "")
    changed = sorted({plain.count("\n", 0, start) + 1 for start, _ in ask("rename", text, name)["changes"]})
    assert changed == (lines or [number for number, line in enumerate(plain.splitlines(), 1) if re.search(r"\bnears\b", line)])


POSTURES = """from actr3d.actr import *
import actr3d.motor as am

class Walker(ACTR):
    felt = Buffer()
    motor = am.Motor(felt)
    def feel(felt="posture:? ext|reme:maximum"): pass
"""
REPORTED = """from actr3d.actr import *

class Base(ACTR):
    goal = Buffer()
    def init():
        self.total = 0
        self.things = []
    def look(goal="x"):
        for thing in self.things:
            print(thing.total)

class Plain:
    size = 2

def report(model, **more):
    print(model.size)

def steps(pace=1):
    return pace

report(Base(), size=4)
[steps][0](pace=2)
"""


@pytest.mark.daily(8)
@pytest.mark.parametrize(
    ("text", "why"),
    [
        (FETCHED.replace("apple =", "app|le ="), "whether 'apple' in line 9 is the same is not known"),
        (PARTLY.replace("log()", "lo|g()"), "is defined in actr3d.actr.kernel.log, and keeps its name here"),
        (PARTLY.replace("seconds=1", "sec|onds=1"), "whether 'seconds' in line 25 is the same is not known"),
        (PARTLY.replace("task:?word", "task:?wo|rd"), r"whether '\?word' in line 5 is the same is not known"),
        (PARTLY.replace("_1", "_|1"), "'_1' is the position of a value without a slot, and keeps its name"),
        (PARTLY.replace("class Pole", "class Po|le"), "whether 'feature:pole' in line 28 is the same is not known"),
        (PARTLY.replace("most=0.1", "mo|st=0.1"), "whether 'most' in line 28 is the same is not known"),
        (PARTLY.replace("ink:?", "i|nk:?"), "whether 'ink' in line 36 is the same is not known"),
        (PARTLY.replace("ink = 1", "i|nk = 1"), "whether 'ink' in line 36 is the same is not known"),
        (PARTLY.replace("price = 2", "pr|ice = 2"), "whether 'price' in line 36 is the same is not known"),
        (REPORTED.replace("thing.total", "thing.to|tal"), "'total' cannot be renamed: where it is defined is not known"),
        (REPORTED.replace("self.total", "self.to|tal"), "whether 'total' in line 10 is the same is not known"),
        (FAN.replace("random.choice", "random.cho|ice"), "is defined in|where it is defined is not known"),
        (PAIRED.replace("random.sample", "random.sam|ple"), "is defined in|where it is defined is not known"),
        (FAN.replace("imaginal.set", "imaginal.s|et"), "is defined in"),
        (THINGS.replace("lives = ", "li|ves = "), "whether 'lives:.lives' in line 10 is the same"),
        (THINGS.replace("='lives:?", "='li|ves:?"), "whether '.*lives.*' in line .* is the same"),
        (THINGS.replace("salience =", "sali|ence ="), "'salience' is .*, and keeps its name here"),
        (THINGS.replace("self.fly", "self.fl|y"), "whether 'fly' in line 10 is the same"),
        (PUT.replace("turn = ", "tu|rn = "), "whether 'turn:.mood' in line 9 is the same is not known"),
        (PUT.replace("board='turn", "board='tu|rn"), "where it is defined is not known"),
        (PUT.replace("board = ", "bo|ard = "), "whether 'board' in line 9 is the same is not known"),
        (f"{PUT}print([f'{{one}}:1' for one in ('task', 'job')])\n".replace("goal='task", "goal='ta|sk"), "whether 'task' in line 18"),
        (REPLACED.replace("size = 2", "si|ze = 2"), "whether 'size:2' in line 11 is the same is not known"),
        (REPLACED.replace("size = 3", "si|ze = 3"), "whether 'size:2' in line 11 is the same is not known"),
        (REPLACED.replace('store="si', 'store="s|i', 1), "whether 'size:2' in line 11 is the same is not known"),
        (REPLACED.replace('dm="bus', 'dm="b|us'), "whether 'busy:False' in line 18 is the same is not known"),
        (REPLACED.replace("busy =", "bu|sy ="), "whether 'busy:False' in line 18 is the same is not known"),
        (
            f"{REPLACED}\none = Person()\none.store = Memory(None)\n".replace("size = 2", "si|ze = 2"),
            "whether 'size:2' in line 11 is the same",
        ),
        (
            f"{REPLACED}\none = Person()\none.store = Memory(None)\n".replace('store="si', 'store="s|i', 1),
            "where it is defined is not known",
        ),
        (REPLACED.replace("store = Shelf", "store = Buffer").replace("size = 2", "si|ze = 2"), "whether 'size:2' in line 11 is the same"),
        (
            f"{TOTAL}\ndef shown(one: Stroop | Thing | None):\n    return one.total\n\nclass Thing(Other): pass\n".replace(
                "model.total", "model.to|tal"
            ),
            "'total' in line 23 is the same",
        ),
        *(
            (f"{REPLACED}\n{line}\n".replace("size = 2", "si|ze = 2"), "whether 'size:2' in line 11 is the same is not known")
            for line in (
                "setattr(Person(), 'store', Shelf())",
                "Person(store=list())",
                "Kind = type('Kind', (Person,), {'store': list()})",
                "class Other(Person):\n    store: Model = list()",
                "class Other(Person):\n    store = [Store, list][0]()",
                "class Other(Person):\n    store = Store() if REPLACED else list()",
                "class Beside(ACTR):\n    store = Shelf()\n\nclass Other(Beside, Person): pass",
            )
        ),
        *(
            (
                WHOLE.replace("goal = Buffer", "go|al = Buffer").replace("eyes = Eyes()", f"eyes = Eyes(); {line}"),
                "in line 10 is the same is not known",
            )
            for line in (
                "pm = PMCompile(keep='goal')",
                "names = ['goal']",
                "pm = PMCompile(keep='eyes goal')",
                "pm = PMCompile(request='goal.set')",
            )
        ),
        (
            PUT.replace("board='turn", "board='inner.turn").replace("turn = ", "tu|rn = "),
            "whether 'inner.turn:.mood' in line 9 is the same",
        ),
        (PUT.replace("board='turn", "board='inner.tu|rn"), "where it is defined is not known"),
        ("class Box(Base):\n    def sta|rt(self): pass\n", "what Box inherits in line 1 is not known"),
        (
            "from nothing import Base\n\nclass Box(Base):\n    def start(self):\n        self.tot|al = 0\n",
            "what Box inherits in line 3 is not known",
        ),
        (SPLIT.replace("weight:2", "wei|ght:2"), "whether 'weight' in line 7 is the same is not known"),
        (SPLIT.replace("weight colour", "colour/weight").replace("weight:2", "wei|ght:2"), "whether 'colour/weight' in line 7 is the same"),
        (SPLIT.replace('"weight colour".split()', "('weight', 'colour')").replace("weight:2", "wei|ght:2"), "whether 'weight' in line 7"),
        (
            f"{CALLED}for name in 'slow,quick'.split(','): setattr(Machine(1), name, 1)\n".replace("quick =", "qui|ck ="),
            "whether .* in line 13 is the same",
        ),
        *(
            (SEEN.replace(f"{name} = ", f"{name[0]}|{name[1:]} = ", 1), f"'{name}' is read by Vision, and keeps its name")
            for name in ("x", "y")
        ),
        (SEEN.replace('goal="text:a', 'goal="|x:1 text:a'), "'x' is read by Vision, and keeps its name here"),
        (SEEN.replace("Vision(goal, where)", "SOSVision(goal)").replace("value =", "val|ue ="), "'value' is read by SOSVision"),
        *(
            (
                SEEN.replace("Vision(goal, where)", "SOSVision(goal)")
                .replace("text:a", "x:1")
                .replace("text = ", "te|xt = ")
                .replace('x:1")', more),
                why,
            )
            for more, why in (
                ('x:1")\n        for one in ("text:a", "x:1"): vision.request(one)', "whether 'text:a' in line 14 is the same"),
                ('x:1")\n        print([goal[one] for one in "text value".split()])', "whether 'text' in line 14 is the same"),
            )
        ),
        (SEEN.replace("text = ", "te|xt = "), "whether 'text:a' in line 13 is the same"),
        ("from actr3d.vision import Feature, Metres\n\nclass Pole(Feature):\n    wi|dth: Metres\n", "'width' is an attribute of Feature"),
        (FELT.replace("left torso", "left tor|so"), "'torso_yaw' may be a joint in the chunks of Motor, and keeps its name here"),
        (FELT.replace("hatch", "hat|ch"), "'hatch' may be a joint in the chunks of Motor, and keeps its name here"),
        (OLD.replace("import ccm", "import c|cm"), "'ccm' is defined in ccm, and keeps its name here"),
        (OLD.replace("from ccm", "from c|cm"), "'ccm' .*keeps its name here"),
        (OLD.replace("def start", "def st|art"), "'start' is defined in .*, and keeps its name here"),
        (OLD.replace("def key", "def k|ey"), "'key_pressed' is read by Motor, and keeps its name here"),
        (OLD.replace("busy:", "bu|sy:"), "'busy' is defined in .*, and keeps its name here"),
        (
            OLD.replace("import ccm", "import python_actr").replace("ccm", "python_actr").replace("def key", "def k|ey"),
            "'key_pressed' is read by Motor, and keeps its name here",
        ),
        (
            OLD.replace("import ccm", "from python_actr import *")
            .replace("ccm.Model", "Model")
            .replace("ccm.lib", "python_actr.lib")
            .replace("def start", "def st|art"),
            "'start' is defined in .*, and keeps its name here",
        ),
        (
            PUT.replace("turn = 'ada'", "def key_pre|ssed(self, key): pass").replace("    goal = ", "    motor = Motor()\n    goal = ", 1),
            "'key_pressed' is read by Motor, and keeps its name here",
        ),
        (DOORWAY.replace("view.as_array", "view.as_|array", 1), "where it is defined is not known"),
        (DOORWAY.replace("SIDEWAYS, speed", "SIDEWAYS, spe|ed"), "is defined in|where it is defined is not known"),
        (DOORWAY.replace('seen=None, eye="busy', 'seen=None, eye="bu|sy'), "'busy' is defined in .*, and keeps its name here"),
        (DOORWAY.replace("speed: Ann", "spe|ed: Ann"), "whether 'walker.speed' in line 43 is the same is not known"),
        (DOORWAY.replace("pose x:", "pose |x:"), "'x' is a slot of 'pose', and keeps its name here"),
        (DOORWAY.replace("def build", "def bu|ild"), "'build' is called to make the simulation"),
        (
            APERTURE.replace('b_context="way:open"', 'b_con|text="way:open"'),
            "'b_context' is an attribute of SGOMS, and keeps its name here",
        ),
        (APERTURE.replace('motor="busy:', 'motor="bu|sy:', 1), "'busy' is defined in .*, and keeps its name here"),
        (APERTURE.replace('    answer = "', '    ans|wer = "', 1), "whether 'answer' in line 303 is the same is not known"),
        (APERTURE.replace("    squeeze =", "    squ|eeze ="), "whether 'planning_unit:squeeze' in line 302 is the same is not known"),
        (APERTURE.replace("    pass_doorway =", "    pass_|doorway ="), "whether 'pass_doorway' in line 441 is the same is not known"),
        (APERTURE.replace("self.judged", "self.jud|ged", 1), "whether 'judged' in line 649 is the same is not known"),
        (APERTURE.replace("state:start", "sta|te:start", 1), "'state' is a slot of SGOMS, and keeps its name here"),
        (APERTURE.replace("b_DM.clear()", "b_D|M.clear()", 1), "'b_DM' is .*, and keeps its name here"),
        (KEYWORDS.replace("other=left", "other='?left'").replace("?left", "?le|ft", 1), "whether '.left' in line 8 is the same"),
        *(
            (f"{CALLED}{line}\n".replace("pace=1", "pa|ce=1"), f"'{shown}' in line 13 is the same")
            for line, shown in (
                ("partial(walk, pace=3)", "pace"),
                ("walk(2, **{'pace': 5})", "pace"),
                ("options['pace'] = 2; walk(2, **options)", "pace"),
                ("for act in (walk, other): act(pace=2)", "pace"),
                ("run(walk, pace=2)", "pace"),
                ("{'go': walk}['go'](pace=2)", "pace"),
                ("type(Machine())(pace=2)", "pace"),
                ("dict(pace=2)", "pace"),
            )
        ),
        (OVERRIDDEN.replace("pace=1", "pa|ce=1"), "'pace' in line 12 is the same"),
        (OVERRIDDEN.replace("pace=2", "pa|ce=2"), "'pace' in line 12 is the same"),
        (OVERRIDDEN.replace("speed=1", "sp|eed=1"), "'speed' in line 14 is the same"),
        (f"{CALLED}for act in (walk, other): act(pa|ce=2)\n", "where it is defined is not known"),
        (f"{CALLED}setattr(Machine(1), name, 1)\nnames = ['quick']\n".replace("quick =", "qui|ck ="), "'quick' in line 14"),
        (f"{CALLED}setattr(one, name, 1)\nnames = ['quick']\n".replace("quick =", "qui|ck ="), "'quick' in line 14"),
        (CALLED.replace("self.quick = pace", "self.quick = type(self)(pa|ce=2)"), "where it is defined is not known"),
        (POSTURES, "'extreme' is a slot of Motor, and keeps its name here"),
        (APERTURE.replace("when:now", "wh|en:now", 1), "'when' is a slot of SGOMS, and keeps its name here"),
        (APERTURE.replace("planning_unit:squeeze", "plan|ning_unit:squeeze", 1), "'planning_unit' is a slot of SGOMS, and keeps its name"),
        (APERTURE.replace('state="recalling"', 'sta|te="recalling"'), "'state' is a slot of SGOMS, and keeps its name here"),
        (APERTURE.replace("b_unit_task=", "b_unit|_task=", 1), "'b_unit_task' is defined in actr3d.sgoms.agent, and keeps its name here"),
        (FAN.replace("    profile =", "    pro|file ="), "'profile' is defined in actr3d.actr.kernel.model, and keeps its name here"),
        ("class Box:\n    def __en|ter__(self): pass\n", "'__enter__' has a meaning in Python, and keeps its name"),
        (FAN.replace("None", "No|ne", 1), "there is no name here"),
        (WHOLE.replace("print(self.seen)", "print(getattr(self, 'seen'))").replace("self.seen =", "self.se|en ="), "'seen' in line 15"),
        (PAIRED.replace("def start", "def sta|rt"), "'start' is defined in .*, and keeps its name"),
    ],
)
def test_a_name_is_not_renamed_if_it_is_not_known_which_places_are_the_same(ask: Asked, text: str, why: str) -> None:
    assert "|" in text
    with pytest.raises(LanguageError, match=why):
        ask("rename", text, "zzz")


INHERITED = ("traced", "now", "stop", "explain")
DERIVED = "class Derived(Base):\n    def lo|ok(self): pass\n"


@pytest.mark.daily(12)
@pytest.mark.parametrize(
    ("text", "name", "why"),
    [
        (COUNTING.replace("goal.clear()", "go|al.clear()"), "memory", "there is a part 'memory' already"),
        (COUNTING.replace("task:count", "ta|sk:count", 1), "last", "there is a slot 'last' already"),
        (COUNTING.replace("print(now)", "print(n|ow)", 1), "next", "there is a variable 'next' already"),
        (COUNTING.replace("print(now)", "print(n|ow)", 1), "for", "'for' is not a name"),
        (COUNTING.replace("model.run()", "mo|del.run()"), "My Agent", "'My Agent' is not a name$"),
        (COUNTING.replace("Memory(ret", "Mem|ory(ret"), "Store", "is defined in actr3d.actr.declarative.memory"),
        (COUNTING.replace("task:count", "task:co|unt", 1), "x", "there is no name here"),
        ("|", "x", "there is no name here"),
        (NAMES.replace("?i", "?|i", 1), "self", "there is a variable 'self' already"),
        (NAMES.replace("print(ink)", "print(se|lf.now())"), "agent", "'self' is the agent in every production"),
        (NAMES.replace("word = ", "wo|rd = "), "ink", "'ink' already has a meaning in line 5"),
        (NAMES.replace("word = ", "wo|rd = "), "memory", "'memory' already has a meaning in line 14"),
        (NAMES.replace("ink = ", "in|k = "), "Stroop", "'Stroop' already has a meaning in line 8"),
        (NAMES.replace("def look", "def lo|ok"), "wrong", "'wrong' already has a meaning in line 21"),
        (NAMES.replace("def look", "def lo|ok"), "retrieval", "'retrieval' already has a meaning in line 10"),
        (NAMES.replace("class Stroop", "class Str|oop"), "ACTR", "'ACTR' is imported from actr3d.actr.* already"),
        (NAMES.replace("class Stroop", "class Str|oop"), "choice", "'choice' is imported from random already"),
        (NAMES.replace("?i", "?|i", 1), "print", "'print' is a name of Python itself"),
        (NAMES.replace("?i", "?|i", 1), "size", "'size' already has a meaning in line 17"),
        (NAMES.replace("retrieval = Buffer", "retr|ieval = Buffer"), "print", "'print' is a name of Python itself"),
        (NAMES.replace("retrieval = Buffer", "retr|ieval = Buffer"), "Memory", "'Memory' is imported from actr3d.actr.* already"),
        (NAMES.replace("retrieval = Buffer", "retr|ieval = Buffer"), "look", "'look' already has a meaning in line 16"),
        (NAMES.replace("goal = Buffer", "go|al = Buffer"), "ink", "'ink' already has a meaning in line"),
        *((NAMES.replace("def look", "def lo|ok"), name, f"^'{name}' is a method of ACTR already$") for name in INHERITED),
        *((NAMES.replace("goal.set", "go|al.set"), name, f"^'{name}' is a method of ACTR already$") for name in INHERITED),
        (NAMES.replace("def look", "def lo|ok"), "parent", "^'parent' is an attribute of .* already$"),
        (f"class Base:\n    def read(self): pass\n\n{DERIVED}", "read", "^'read' is a method of Base already$"),
        *(
            (TOTAL.replace("self.total +=", "self.to|tal +=", 1), name, f"^'{name}' is a")
            for name in ("random", "parent", "traced", "explain")
        ),
        (TOTAL.replace("self.total +=", "self.to|tal +=", 1), "goal", "'goal' already has a meaning in line 4"),
        (
            f"{TOTAL}\ndef shown(one):\n    return one.total\n".replace("model.total", "model.to|tal"),
            "amount",
            "'total' in line 23 is the same",
        ),
        *((DOTTED.replace("def look", "def lo|ok"), name, f"^'{name}' is a method of aa.ACTR already$") for name in INHERITED),
        *((DOTTED.replace("goal =", "go|al ="), name, f"^'{name}' is a method of aa.ACTR already$") for name in INHERITED),
        (
            DOTTED.replace("aa", "actr3d.actr")
            .replace("import actr3d.actr as actr3d.actr", "import actr3d.actr")
            .replace("def look", "def lo|ok"),
            "traced",
            "is a method of actr3d.actr.ACTR already",
        ),
        (BESIDE.replace("def look", "def lo|ok"), "say", "^'say' is a method of Child already$"),
        (BESIDE.replace("goal = Buffer", "go|al = Buffer"), "aim", "'aim'"),
        (
            f"from actr3d.actr import *\n\n{BESIDE}".replace("goal = Buffer", "go|al = Buffer"),
            "say",
            "^'say' is a method of Child already$",
        ),
        (NAMES.replace("def look", "def lo|ok"), "_children", "^'_children' may be a private name of ACTR$"),
    ],
)
def test_what_cannot_be_renamed(ask: Asked, text: str, name: str, why: str) -> None:
    with pytest.raises(LanguageError, match=why):
        ask("rename", text, name)


def test_formatting(ask: Asked) -> None:
    assert ask("format", "x  =  {'a':1}\n") == {"text": 'x = {"a": 1}\n'}
    with pytest.raises(LanguageError, match=r"line 2: .*xpected"):
        ask("format", "x = 1\ny = = 2\n")


def test_positions_count_as_in_the_page(ask: Asked) -> None:
    text = "smile = '😀'\nsmile = sm|ile\n"
    units = text.index("|") + 1  # the page counts the smile twice
    found = ask.server
    body = {"ask": "rename", "path": "model.py", "text": text.replace("|", ""), "at": units, "name": "grin"}
    answer = json.loads(ask._desk.do(found.ask(json.dumps(body).encode())))
    plain = text.replace("|", "").encode("utf-16-le")
    assert [plain[2 * start : 2 * end].decode("utf-16-le") for start, end in answer["changes"]] == ["smile"] * 3


# -- reading any text


@pytest.mark.daily(8)
@pytest.mark.parametrize("path", sorted(MODELS.rglob("*.py")), ids=lambda path: path.stem)
def test_the_productions_of_every_model_are_found(path: Path) -> None:
    text = path.read_text(encoding="utf-8")
    model = ModelText(text)
    methods = [method for agent in model.agents.values() for method in agent.methods.values()]
    assert sorted(method.path for method in methods if method.parameters and method.sees_parts) == sorted(listing_of(text).productions)
    assert all(text[one.start : one.end] == one.text for one in (*model.names, *model.texts))


PIECES = (
    "class A(ACTR):\n",
    "    def f(goal='a b:?c",
    "', x=None):\n",
    "        goal.set(f'{d} e:1')\n",
    "\n",
    "'''",
    '"',
    "(",
    ")",
    "\\",
    "\r",
    "😀",
    "é",
)


@given(st.lists(st.sampled_from(PIECES)).map("".join) | st.text())
def test_any_text_is_read(text: str) -> None:
    model = ModelText(text)
    assert all(text[one.start : one.end] == one.text for one in (*model.names, *model.texts))
    assert all(text[one.start : one.end] == one.text for part in model.texts for one in (*part.slots, *part.pieces))
    explicit = ExplicitText(model)
    for at in range(len(text) + 1):
        assert explicit.position(*explicit.place(at)) == at
    units = CodeUnits(text)
    for at in range(len(text) + 1):
        assert units.unit(at) == len(text[:at].encode("utf-16-le", "surrogatepass")) // 2
        assert units.position(units.unit(at)) == at


def test_names_are_written_out_for_tools_that_know_no_actr() -> None:
    explicit = ExplicitText(ModelText(COUNTING))
    added = [line.strip() for line in explicit.text.split("\n") if line not in COUNTING.split("\n")]
    assert len(added) == 4
    assert added[1].startswith("self = Counting(); goal = Counting.goal; retrieval = Counting.retrieval; memory = Counting.memory; ")
    compile(explicit.text, "model.py", "exec")


# -- safety


def test_nothing_is_executed(alone: Asked, tmp_path: Path) -> None:
    marks = [tmp_path / name for name in ("text", "source", "compiled", "typed")]
    writes = "from pathlib import Path\nPath({!r}).touch()\n"
    for name, mark in zip(("helper", "compiled", "jedi", "typing", "sitecustomize"), (*marks[1:], marks[3], marks[3]), strict=True):
        (tmp_path / f"{name}.py").write_text(writes.format(str(mark)) + "def f(): ...\n", encoding="utf-8")
    py_compile.compile(str(tmp_path / "compiled.py"), str(tmp_path / "compiled.pyc"))  # jedi would have to import it
    (tmp_path / "compiled.py").unlink()
    top = writes.format(str(marks[0])) + "import helper, compiled, jedi\n"
    assert alone.labels(f"{top}helper.|") == ["Path", "f"] or "f" in alone.labels(f"{top}helper.|")
    alone("complete", f"{top}compiled.|")
    alone("document", f"{top}comp|iled.f")
    alone("define", f"{top}compiled.f|")
    alone("signature", f"{top}compiled.f(|)")
    alone("rename", f"{top}he|lper = 1", "other")
    alone("format", top)
    assert [mark for mark in marks if mark.exists()] == []


def _cut(path: Path) -> None:
    path.write_bytes(path.read_bytes()[:20])


def _no_file(path: Path) -> None:
    path.unlink()
    path.mkdir()


@pytest.mark.parametrize("damage", [_cut, _no_file])
def test_damaged_files_of_parsed_texts_are_parsed_again(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, damage: Callable[[Path], None]
) -> None:
    monkeypatch.setattr(settings, "cache_directory", str(tmp_path / "cache"))
    (tmp_path / "beside.py").write_text("def helps(distance):\n    'Measures.'\n", encoding="utf-8")
    explicit = ExplicitText(ModelText("import beside\nbeside."))

    def completed() -> list[str]:
        import_module("parso.cache").parser_cache.clear()
        return [one.label for one in PythonAnswers(tmp_path).complete(explicit, "model.py", len(explicit.text))]

    assert completed() == ["helps"]
    files = list((tmp_path / "cache").rglob("*.pkl"))
    assert files
    for path in files:
        damage(path)
    assert completed() == ["helps"]


def test_no_compiled_module_is_imported_even_if_it_could_be_found(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    mark = tmp_path / "executed"
    (tmp_path / "compiled.py").write_text(f"from pathlib import Path\nPath({str(mark)!r}).touch()\n", encoding="utf-8")
    py_compile.compile(str(tmp_path / "compiled.py"), str(tmp_path / "compiled.pyc"))
    (tmp_path / "compiled.py").unlink()
    monkeypatch.setattr(sys, "path", [str(tmp_path), *sys.path])
    explicit = ExplicitText(ModelText("import compiled\ncompiled."))
    assert PythonAnswers(tmp_path).complete(explicit, "model.py", len(explicit.text)) == []
    assert not mark.exists()


def test_modules_are_not_found_in_the_working_directory_or_the_models_folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    here, models = tmp_path / "here", tmp_path / "models"
    for folder in (here, models / "sub"):
        folder.mkdir(parents=True)
        monkeypatch.setattr(sys, "path", [str(folder), *sys.path])
    monkeypatch.chdir(here)
    paths = safe_path(models)
    assert {str(here), str(models / "sub"), ""}.isdisjoint(paths)
    assert paths[-1] == str(MODELS.parent)  # the library itself comes last


def test_a_text_that_takes_too_long_is_given_up_and_the_next_is_answered(alone: Asked, monkeypatch: pytest.MonkeyPatch) -> None:
    assert "import" in alone.labels("impo|")
    monkeypatch.setattr(language_server, "ANSWER_TIME", 0.3)
    with pytest.raises(LanguageError, match=r"takes longer than 0\.3 s"):
        alone("complete", f"{'(' * 150_000}|")
    monkeypatch.undo()
    assert "import" in alone.labels("impo|")


@pytest.mark.slow
def test_a_process_that_has_ended_is_replaced(alone: Asked, desk: Desk) -> None:
    alone("complete", "impo|")

    async def killed() -> None:
        worker = alone.server._worker
        assert worker is not None
        asking = asyncio.create_task(alone.server.ask(question("complete", f"{'(' * 150_000}|")))
        await asyncio.sleep(0)
        os.kill(worker.pid, signal.SIGKILL)
        with pytest.raises(LanguageError, match="was ended by SIGKILL"):
            await asking

    desk.do(killed())
    assert "import" in alone.labels("impo|")


def test_questions_at_once_are_answered_in_turn_and_too_many_refused(alone: Asked, desk: Desk) -> None:
    async def asked() -> list[Any]:
        questions = (alone.server.ask(question("complete", f"name_{number} = 1\nname_{number}|")) for number in range(MAX_WAITING + 5))
        return await asyncio.gather(*questions, return_exceptions=True)

    answers = desk.do(asked())
    assert [json.loads(answer)["items"][0]["label"] for answer in answers[:MAX_WAITING]] == [f"name_{n}" for n in range(MAX_WAITING)]
    assert [type(answer) for answer in answers[MAX_WAITING:]] == [TooManyQuestionsError] * 5


@pytest.mark.daily(4)
@pytest.mark.parametrize(
    "text",
    [
        "\0|",
        "\ud800|",
        "(" * 3_000 + "|",
        "\n" * 100_000 + "|",
        "class A:\n    x: A.x = A.x|",
        "é😀 = 1\né😀|",
        "def f(): return f()\nf().|",
        "\r\r\n|\f",
    ],
)
def test_odd_texts_are_answered_or_refused(ask: Asked, text: str) -> None:
    for what in ("complete", "document", "signature", "define", "rename", "format"):
        with suppress(LanguageError):
            ask(what, text, "new")
    assert "import" in ask.labels("impo|")


def test_the_route_says_why_there_is_no_answer_and_refuses_what_is_no_question(
    desk: Desk, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    app = make_app(tmp_path, GATE)
    app.state.language = LanguageServer(desk.workers, tmp_path)

    def posted(**more: Any) -> tuple[int, Any]:
        body = json.dumps({"ask": "format", "path": "model.py", "text": "x=1", **more}).encode()
        answer = desk.do(call(app, "/api/language", HOST, COOKIE, JSON, OURS, ORIGIN, method="POST", body=body))
        return answer.status, json.loads(answer.body)

    assert posted() == (200, {"text": "x = 1\n"})
    assert posted(text="x =") == (200, {"unanswered": "the text was not formatted: line 1: Expected an expression", "line": 1})
    with monkeypatch.context() as now:
        now.setattr(language_server, "ANSWER_TIME", 0.3)
        slow = posted(ask="complete", text="(" * 150_000, at=150_000)
    assert slow == (200, {"unanswered": "reading this text takes longer than 0.3 s", "line": None})
    for status, more in (
        (422, {"text": "x" * (LONGEST_TEXT + 1)}),
        (422, {"ask": "execute"}),
        (422, {"at": -1}),
        (400, {"path": "../model.py"}),
    ):
        found, said = posted(**more)
        assert (found, list(said)) == (status, ["error"])
    desk.do(app.state.language.close())

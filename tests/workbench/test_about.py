"""What a model's docstring says is sent as a tree of elements, in which whatever a docstring has is text."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest

from tests.helpers.sessions import Desk
from tests.helpers.workbench_server import MODELS
from workbench.about import LONGEST, about_of
from workbench.loader import listing_of

TEXTS = {"p", "h2", "h3", "h4", "ul", "ol", "li", "blockquote", "em", "strong", "code", "pre", "br", "hr", "a"}
SHOWN = {*TEXTS, "table", "thead", "tbody", "tr", "th", "td"}
ALL_MODELS = sorted(path.relative_to(MODELS).as_posix() for path in MODELS.rglob("*.py"))


def texts(nodes: list[Any]) -> str:
    """Returns all texts of a tree."""
    return "".join(node if isinstance(node, str) else texts(node["children"]) for node in nodes)


def elements(nodes: list[Any]) -> list[dict[str, Any]]:
    """Returns all elements of a tree."""
    return [one for node in nodes if not isinstance(node, str) for one in (node, *elements(node["children"]))]


def about(docstring: str, code: str = "") -> dict[str, Any]:
    return about_of(f"{docstring!r}\n{code}", "model.py")


def test_a_docstring_is_shown_with_its_headings_lists_and_values_to_try() -> None:
    told = about(
        "A *title*.\n\nText.\n\nWhat to try\n-----------\n- `width = 0.5, speed=2`: narrow\n- `other = 1`\n", "width = 0.8\nspeed = 1\n"
    )
    assert texts(told["title"]) == "A title."
    assert [one["tag"] for one in elements(told["nodes"])] == ["p", "h3", "ul", "li", "code", "li", "code"]
    assert [one.get("settings") for one in elements(told["nodes"]) if one["tag"] == "code"] == [{"width": 0.5, "speed": 2}, None]


def test_a_value_to_try_of_a_variable_after_other_code_says_why_it_is_no_button() -> None:
    text = "T\n\nTry `word = 'green'`, `width = 2` and `other = 1`.\n"
    nodes = about(text, "width = 1\nimport math\nword = 'red'\n")["nodes"]
    assert [one.get("settings") for one in elements(nodes) if one["tag"] == "code"] == [None, {"width": 2}, None]
    why = " (word is not a parameter, because other code, such as an import, comes before it)"
    assert texts(nodes) == f"Try word = 'green'{why}, width = 2 and other = 1."
    first = about(text, "word = 'red'\nwidth = 1\nimport math\n")["nodes"]
    assert [one.get("settings") for one in elements(first) if one["tag"] == "code"] == [{"word": "green"}, {"width": 2}, None]


def test_a_table_is_a_table() -> None:
    told = about("Title.\n\n| a | b |\n|---|--:|\n| 1 | `2` |\n")
    assert [one["tag"] for one in elements(told["nodes"])] == ["table", "thead", "tr", "th", "th", "tbody", "tr", "td", "td", "code"]


@pytest.mark.parametrize(
    "code", ["width", "width == 1", "f(width=1)", "1, width=2", "**{}", "width=open('x')", "width=[1]", "width=1); (", "width=" + "(" * 500]
)
def test_code_that_gives_no_plain_values_to_parameters_is_nothing_to_try(code: str) -> None:
    assert all("settings" not in one for one in elements(about(f"T\n\n`{code}`", "width = 0.8\n")["nodes"]))


@pytest.mark.parametrize(
    "hostile",
    [
        "<script>alert(1)</script>",
        "<img src=x onerror=alert(1)>",
        "[x](javascript:alert(1))",
        "[x](java&#115;cript:alert(1)) [y](data:text/html,<script>) [z](JAVASCRIPT:1) [w](vbscript:1) [v](//evil.example)",
        "![x](https://evil.example/x.png)",
        "<https://evil.example>",
        "[x]: javascript:alert(1)\n\n[x]",
        '[x](https://ok.example "onclick=alert(1)")',
        "&lt;b&gt;",
        "\ud800 half a character",
        "\x00\x1b[31m",
    ],
)
def test_a_hostile_docstring_is_text(hostile: str) -> None:
    told = about(f"T\n\n{hostile}")
    json.dumps(told).encode()
    assert {one["tag"] for one in elements(told["nodes"])} <= {"p", "a"}
    for one in elements(told["nodes"]):
        assert set(one) <= {"tag", "children", "href"}
        assert one.get("href", "https://").startswith("https://ok.") or "href" not in one


@pytest.mark.parametrize("part", ["[", "![[", "*", "**a", "_a", "`", "> ", "- ", "1. ", "[](", "[a](<", "<", "&", "\\", "\t", "# "])
def test_a_docstring_of_any_length_is_shown_in_part(part: str) -> None:
    told = about("T\n\n" + part * (4 * LONGEST // len(part)))
    assert told["cut"]
    assert {one["tag"] for one in elements(told["nodes"])} <= SHOWN
    assert len(json.dumps(told)) < 20 * LONGEST


def test_a_model_without_a_description_and_a_text_that_is_no_python_say_so() -> None:
    told = about_of("x = 1\n", "model.py")
    assert [parameter["name"] for parameter in told.pop("parameters")] == ["x"]
    assert told == {"model": "model.py", "title": [], "nodes": [], "cut": False, "agents": [], "readable": True}
    assert not about_of("x = = 1\n", "model.py")["readable"]


@pytest.mark.parametrize("name", ALL_MODELS)
def test_a_shipped_model_says_what_to_expect_and_what_to_try(name: str) -> None:
    source = (MODELS / name).read_text(encoding="utf-8")
    told = about_of(source, name)
    headings = [texts(one["children"]) for one in elements(told["nodes"]) if one["tag"] == "h3"]
    assert "What to expect" in headings
    assert "What to try" in headings
    assert listing_of(source, name).title.endswith((".", "?"))
    if listing_of(source, name).parameters:
        assert any("settings" in one for one in elements(told["nodes"])), "there is something to try with one click"


def test_a_session_describes_the_text_from_which_its_run_was_built(desk: Desk, tmp_path: Path) -> None:
    talk = desk.begin(tmp_path, '"""Before."""\nx = 1\n')
    (tmp_path / "model.py").write_text('"""After."""\nx = 1\n', encoding="utf-8")
    assert talk.session.source is not None
    assert about_of(talk.session.source, "model.py")["title"] == ["Before."]


BODY = """
from actr3d.simulation import Simulation
from actr3d.world import Floor, Mannequin, Scene

def build() -> Simulation:
    return Simulation(Scene(parts=(Floor(), Mannequin(name='walker'))), seed=1)
"""


def test_a_model_with_a_body_begins_at_real_time_where_that_is_wished_until_a_speed_is_chosen(desk: Desk, tmp_path: Path) -> None:
    talk = desk.begin(tmp_path, BODY, real_time=True)
    assert talk.state["wanted"] == 1.0
    talk.say("restart")
    talk.wait(lambda: talk.session.run == 2)
    assert talk.state["wanted"] == 1.0
    talk.say("speed", factor=None)
    assert talk.state["wanted"] is None
    talk.say("restart")
    talk.wait(lambda: talk.session.run == 3)
    assert talk.state["wanted"] is None
    assert desk.begin(tmp_path, "print('a mind')\n", name="mind.py", real_time=True).state["wanted"] is None
    assert desk.begin(tmp_path, BODY, name="body.py").state["wanted"] is None


def test_notices_of_a_run_have_the_number_of_events_before_them(desk: Desk, tmp_path: Path) -> None:
    source = "import warnings\nprint('one')\nprint('two')\nwarnings.warn('beware')\nprint('  three  ')\nraise ValueError('no')\n"
    talk = desk.begin(tmp_path, source, run=True, wait="failed")
    printed = [event[3]["text"] for event in talk.events if event[2] == "output"]
    assert printed == ["one", "two", "  three  "]
    assert {notice["text"]: notice["events"] for notice in talk.notices} == {"beware": 2, "ValueError: no": 3}


WARNS = """import warnings
from actr3d.actr import *

class Talker(ACTR):
    goal = Buffer()
    def init():
        goal.set("count 0")
    def count(goal="count ?n!9"):
        if int(n) == 3:
            for _ in range(2):
                warnings.warn(f"{n} is odd")
        if int(n) == 5:
            raise ValueError("no")
        goal.modify(_1=int(n) + 1)

Talker().run()
"""


def test_a_notice_is_given_once_however_often_the_run_goes_there_again(desk: Desk, tmp_path: Path) -> None:
    talk = desk.begin(tmp_path, WARNS, run=True, wait="failed")
    texts = ["3 is odd", "ValueError: no"]

    def given() -> list[str]:
        return [notice["text"].partition("\n")[0] for notice in talk.notices]

    for time in (0.1, 0.25, 0.0, talk.state["furthest"]):
        talk.say("seek", time=time)
    talk.wait(lambda: talk.state["status"] == "failed")
    assert given() == texts
    talk.say("seek", time=0.1)
    talk.say("command", word="set_buffer", named={"buffer": "goal", "chunk": "count 2"}, drop=True)
    talk.say("run")
    talk.wait(lambda: talk.state["status"] == "failed")
    talk.wait(lambda: len(talk.notices) == 4)
    assert given() == texts * 2  # another way, on which it happens at other moments


def test_the_largest_seed_is_shown_without_loss(desk: Desk, tmp_path: Path) -> None:
    talk = desk.begin(tmp_path, "print(1)\n", seed=2**63 - 1)
    assert talk.facts["seed"] == str(2**63 - 1)
    talk.say("restart", seed=str(2**63 - 2))
    talk.wait(lambda: talk.session.run == 2)
    assert talk.facts["seed"] == str(2**63 - 2)
    talk.say("restart")
    talk.wait(lambda: talk.session.run == 3)
    assert talk.facts["seed"] == str(2**63 - 2)
    talk.say("restart", seed=7)
    talk.wait(lambda: talk.session.run == 4)
    assert talk.facts["seed"] == 7


def test_earlier_prints_can_be_asked_for_with_the_numbers_of_their_events(desk: Desk, tmp_path: Path) -> None:
    talk = desk.begin(tmp_path, "for n in range(5):\n    print(n)\n", run=True, wait="ended")
    told = talk.say("events", first=1, most=3, kinds=["output"])
    assert (told["numbers"], [event[3]["text"] for event in told["events"]]) == ([1, 2, 3], ["1", "2", "3"])

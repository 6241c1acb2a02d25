"""The tutorial models show what their texts say: every number is compared with its equation, repeated here.

Shares are measured in more trials than the models run by themselves, and may differ by four standard errors.
"""

from __future__ import annotations

import math
import re
from typing import Any

import pytest
from golden.make import MODELS

from actr3d.actr.kernel.run_limits import RunLimits
from actr3d.actr.loading import run_text
from actr3d.actr.loading.sweep import with_values

approx: Any = getattr(pytest, "approx")  # noqa: B009 - its type is not known


def run(name: str, seed: int = 1, until: float | None = None, change: tuple[str, str] | None = None, **values: Any) -> Any:
    """Runs a tutorial model with other values for its parameters, and another text in one place; returns its module."""
    source = (MODELS / "tutorial" / f"{name}.py").read_text(encoding="utf-8")
    if change is not None:
        assert source.count(change[0]) == 1
        source = source.replace(*change)
    return run_text(with_values(source, values), f"{name}.py", limits=RunLimits(seed=seed, until=until))


def times(text: str) -> list[float]:
    """Returns the times that a text names [s]."""
    return [float(found) for found in re.findall(r"(\d+\.\d{3}) s", text)]


def larger_by(d: float, s: float) -> float:
    """Returns the probability that one of two logistic noises of scale s exceeds the other by d, by numerical integration."""
    step = s / 200
    points = [i * step for i in range(-8000, 8001)]

    def density(x: float) -> float:
        return 1 / (4 * s * math.cosh(x / (2 * s)) ** 2)

    return math.fsum(density(x) / (1 + math.exp((x + d) / s)) for x in points) * step


def near(share: float, expected: float, trials: int) -> bool:
    """Returns whether a share of n trials lies within four standard errors of the expected one."""
    return abs(share - expected) < 4 * math.sqrt(expected * (1 - expected) / trials)


@pytest.mark.parametrize(("first", "last"), [(2, 6), (0, 12), (4, 5)])
def test_counting_takes_a_tenth_of_a_second_for_each_number(first: int, last: int, capsys: pytest.CaptureFixture[str]) -> None:
    run("counting", first=first, last=last)
    printed = capsys.readouterr().out.splitlines()
    assert [int(re.findall(r"s: (\d+)", line)[0]) for line in printed] == list(range(first, last + 1))
    assert times("\n".join(printed)) == approx([0.15 + 0.1 * n for n in range(last - first)] + [0.1 + 0.1 * (last - first)])


@pytest.mark.parametrize(("a", "b"), [(5, 3), (3, 5), (7, 0), (2, 2)])
def test_addition_takes_longer_for_a_larger_second_number(a: int, b: int, capsys: pytest.CaptureFixture[str]) -> None:
    run("addition", a=a, b=b)
    printed = capsys.readouterr().out
    assert printed.startswith(f"{a} + {b} = {a + b} ")
    assert times(printed) == approx([0.1 + 0.25 * b])


@pytest.mark.parametrize("threshold", [0, -1])
def test_each_link_of_the_network_takes_the_same(threshold: int, capsys: pytest.CaptureFixture[str]) -> None:
    run("semantic_network", threshold=threshold)
    printed = capsys.readouterr().out
    failure = 0.05 * math.exp(-threshold)
    assert times(printed) == approx([0.05 + 0.15 * n for n in (0, 1, 2, 3, 1)] + [0.45 + 0.1 + failure], abs=0.0006)
    assert [line.split()[2] for line in printed.splitlines()] == ["yes"] * 5 + ["no"]


@pytest.mark.parametrize(("strength", "attention"), [(1.6, 1.0), (2.0, 1.0), (1.6, 0.5), (1.6, 0)])
def test_facts_with_a_larger_fan_take_longer(strength: float, attention: float) -> None:
    fans = {
        "sailor cellar": (1, 1), "baker meadow": (1, 3), "tailor church": (2, 2), "tailor meadow": (2, 3),
        "miller harbour": (3, 1), "miller church": (3, 2), "miller meadow": (3, 3),
    }  # fmt: skip
    expected = {
        fact: 0.63 * math.exp(-attention / 2 * (strength - math.log(person + 1) + strength - math.log(place + 1)))
        for fact, (person, place) in fans.items()
    }
    assert run("fan_effect", strength=strength, attention=attention).agent.times == approx(expected, abs=2e-6)


@pytest.mark.daily(2)
@pytest.mark.parametrize(("noise", "penalty"), [(0.3, 10.0), (0.6, 10.0), (0.3, 20.0)])
def test_similar_letters_are_confused_as_often_as_the_equation_says(noise: float, penalty: float) -> None:
    trials = 500
    module = run("partial_matching", noise=noise, penalty=penalty, trials=trials)
    shares: list[float] = []
    for one, other, similarity in (("b", "d", -0.03), ("m", "n", -0.06), ("c", "g", -0.12)):
        expected = larger_by(-penalty * similarity, noise)
        assert module.predicted(similarity)[0] == approx(expected, abs=1e-6)
        printed = [(cue, word) for cue in (one, other) for word in module.agent.answers[cue]]
        assert len(printed) == 2 * trials
        shares.append(sum(word[0] != cue for cue, word in printed) / (2 * trials))
        assert near(shares[-1], expected, 2 * trials)
    assert shares == sorted(shares, reverse=True)


@pytest.mark.parametrize("noise", [0.2, 0.4, 0.8])
def test_the_faster_way_is_learned_and_chosen_as_often_as_the_equation_says(noise: float) -> None:
    module = run("utility_learning", noise=noise, mornings=3000)
    expected = 1 - larger_by(1, noise)
    assert module.predicted() == approx(expected, abs=1e-6)
    later = module.agent.choices[500:]
    assert near(later.count("bus") / len(later), expected, len(later))
    learned = [module.agent.get_activation(name) for name in ("by_bus", "on_foot")]
    assert learned == approx([2 - 2.1, 2 - 3.1], abs=0.01)


@pytest.mark.slow
def test_both_ways_are_tried_equally_often_at_first() -> None:
    firsts = [run("utility_learning", seed=seed, mornings=1).agent.choices[0] for seed in range(100)]
    assert near(firsts.count("bus") / 100, 0.5, 100)


@pytest.mark.parametrize(("utility", "later"), [(-1, 0.05), (1, 0.15)])
def test_a_compiled_production_needs_no_retrieval(utility: int, later: float) -> None:
    answers = run("compilation", utility_of_asking=utility).agent.times
    assert [(word, german) for word, german, _ in answers] == [("house", "Haus"), ("river", "Fluss"), ("bread", "Brot")] * 4
    assert [time for _, _, time in answers] == approx([0.15] * 3 + [later] * 9)


def test_a_compiled_production_of_equal_utility_is_used_half_the_time() -> None:
    later = [time for _, _, time in run("compilation", utility_of_asking=0, rounds=200).agent.times[3:]]
    assert near(sum(time < 0.1 for time in later) / len(later), 0.5, len(later))


@pytest.mark.parametrize("last", [1, 6, 9])
def test_two_agents_take_turns(last: int, capsys: pytest.CaptureFixture[str]) -> None:
    room = run("two_agents", last=last).room
    printed = capsys.readouterr().out.splitlines()
    assert [line.split()[2:] for line in printed] == [[("ben", "ada")[n % 2], "writes", str(n)] for n in range(1, last + 1)]
    assert times("\n".join(printed)) == approx([0.15 * n for n in range(1, last + 1)])
    assert (room.board.turn, room.ada.goal["task"], room.ben.goal["task"]) == ("nobody", "watch", "watch")


@pytest.mark.parametrize("smoke_time", [0.02, 0.29, 0.305, 0.33])
def test_the_agent_reacts_to_an_alarm_in_its_next_cycle(smoke_time: float, capsys: pytest.CaptureFixture[str]) -> None:
    run("parallel_system", smoke_time=smoke_time)
    printed = capsys.readouterr().out
    when = {what: times(next(line for line in printed.splitlines() if what in line))[0] for what in ("alarm", "off")}
    assert when["alarm"] == approx(smoke_time + 0.01)
    assert 0.05 <= round(when["off"] - when["alarm"], 6) <= 0.1
    assert printed.count("stirs") == round(when["off"] / 0.05) - 1


def test_a_stir_with_a_higher_utility_fires_before_the_alarm(capsys: pytest.CaptureFixture[str]) -> None:
    run("parallel_system", until=2, change=('def stir(goal="task:stir")', 'def stir(goal="task:stir", utility=2)'))
    printed = capsys.readouterr().out
    assert printed.count("stirs") == 40
    assert "turns the stove off" not in printed


@pytest.mark.parametrize(("red", "green"), [(0.9, 0.4), (0.5, 0.5), (1.0, 0.2)])
def test_things_are_seen_as_often_as_their_saliences_say(red: float, green: float) -> None:
    counts = run("sos_vision", red_salience=red, green_salience=green, glances=2000).crossing.observer.counts
    assert sum(counts.values()) == 2000
    assert near(counts["red"] / 2000, red * (1 - green) + red * green / 2, 2000)
    assert near(counts["green"] / 2000, green * (1 - red) + red * green / 2, 2000)
    if red < 1:
        assert near(counts["nothing"] / 2000, (1 - red) * (1 - green), 2000)
    else:
        assert counts["nothing"] == 0


@pytest.mark.parametrize("decay", [0.5, 1.0, 0.0])
def test_a_blend_weights_experiences_by_their_age(decay: float) -> None:
    ages = {7: 7 * 86400, 9: 2 * 86400, 8: 86400, 20: 60}
    estimates = run("blending", decay=decay).agent.estimates
    assert len(estimates) == 5
    for asked, minutes in estimates:
        weights = [(asked + age) ** -decay for age in ages.values()]
        mean = math.fsum(w * m for w, m in zip(weights, ages, strict=True)) / math.fsum(weights)
        assert minutes == approx(mean, abs=0.001)  # patterns read numbers with six digits
    values = [minutes for _, minutes in estimates]
    assert values == sorted(values, reverse=True)
    assert values[-1] >= 11
    assert decay > 0 or values == [11] * 5


@pytest.mark.parametrize(("decay", "threshold", "gap"), [(0.5, -4.0, 5.0), (0.3, -4.0, 5.0), (0.5, -5.0, 60.0)])
def test_words_are_forgotten_as_the_equation_says(decay: float, threshold: float, gap: float) -> None:
    answers = run("base_level", decay=decay, threshold=threshold, gap=gap).agent.answers
    assert len(answers) == 20
    for word, asked, time in answers:
        looks = {"anchor": 1, "button": 2, "candle": 4, "dragon": 8}[word]
        level = math.log(math.fsum((asked + gap * n) ** -decay for n in range(looks)))
        if level < threshold:
            assert time is None
        else:
            assert time == approx(0.05 * math.exp(-level), abs=2e-6)
    forgotten = sum(time is None for _, _, time in answers)
    assert forgotten == {(0.5, -4.0): 4, (0.3, -4.0): 0, (0.5, -5.0): 1}[decay, threshold]


@pytest.mark.parametrize("delay", [0.2, 0.4])
def test_each_change_of_the_image_takes_its_delay(delay: float, capsys: pytest.CaptureFixture[str]) -> None:
    run("imaginal", imaginal_delay=delay)
    printed = capsys.readouterr().out
    assert times(printed) == approx([0.1 + delay + (0.15 + delay) * n for n in range(3)])
    assert [int(total) for total in re.findall(r"s: (\d+)", printed)] == [3, 7, 9]


def test_a_request_to_a_busy_imaginal_module_is_lost(capsys: pytest.CaptureFixture[str]) -> None:
    run("imaginal", change=('?total", imagine="busy:False"', '?total"'))
    assert "7, and that is all" in capsys.readouterr().out


def test_sgoms_the_longer_the_interruption_the_longer_it_takes_to_find_back(capsys: pytest.CaptureFixture[str]) -> None:
    for call, interrupted in ((4.0, 2.06), (0.5, 2.06), (10.0, 2.06)):
        run("sgoms", call_time=call)
        lines = [line.split(" s: ") for line in capsys.readouterr().out.splitlines()]
        printed = {what: moment for moment, what in lines}  # the last of each
        # From the interruption: begin, choose, start and end of two unit tasks that take 1 s and the call; look, end; ask.
        away = 0.05 + 0.05 + (0.05 + 1.0 + 0.05) + 0.1 + (0.05 + call + 0.05) + 0.1 + 0.05
        back = interrupted + away + 0.05 * math.sqrt(away) + 0.05
        assert float(printed["steep"]) == approx(back + 0.05, abs=0.001)
        # Steeping ends after 1.05 s; 0.15 s to the next unit task, and as much to the end; 0.05 s to notice it.
        assert float(printed["that is all"]) == approx(back + 0.05 + 1.05 + 0.15 + 0.05 + 1.05 + 0.15 + 0.05, abs=0.001)


@pytest.mark.parametrize(
    ("ring", "when", "order"),
    [
        (2.0, "now", ["boil", "steep", "pick_up", "talk", "steep", "pour"]),
        (2.0, "end", ["boil", "steep", "pick_up", "talk", "pour"]),
        (1.27, "now", ["boil", "pick_up", "talk", "steep", "pour"]),
    ],
)
def test_sgoms_the_tea_continues_where_it_was_left(ring: float, when: str, order: list[str], capsys: pytest.CaptureFixture[str]) -> None:
    run("sgoms", ring_at=ring, when=when)
    printed = [line.split(" s: ")[1] for line in capsys.readouterr().out.splitlines()]
    assert [what for what in printed if what not in ("the telephone rings", "that is all")] == order


@pytest.mark.parametrize(("call", "forgotten"), [(18.0, False), (18.8, True)])
def test_sgoms_a_place_is_forgotten_below_the_threshold(call: float, forgotten: bool, capsys: pytest.CaptureFixture[str]) -> None:
    run("sgoms", call_time=call)
    assert abs(1.55 + call - math.exp(2 * 1.5)) < 0.6
    assert ("where was I?" in capsys.readouterr().out) == forgotten

"""The command `actr3d run`, as a person at a terminal meets it."""

import json
import os
import re
import shutil
import subprocess
import sys
from contextlib import suppress
from importlib.metadata import version
from pathlib import Path

import pytest

import actr3d
from actr3d.benchmark import Measurement, report
from actr3d.cli import main
from actr3d.recording import Recorded
from tests.helpers.commands import run_command, run_without_reader
from tests.helpers.paths import MODELS

COMMAND = [sys.executable, "-c", "import sys; from actr3d.cli import main; sys.exit(main(sys.argv[1:]))"]

NOISY = """
from python_actr import *

class Noisy(ACTR):
    goal = Buffer()
    noise = PMNoise(noise=1)
    def init():
        goal.set('go 0')
    def left(goal='go ?n!5'):
        print('left', n)
        goal.set({0: 'go', 1: int(n) + 1})
    def right(goal='go ?n!5'):
        print('right', n)
        goal.set({0: 'go', 1: int(n) + 1})

Noisy().run()
"""

ENDLESS = """
from python_actr import *

class Endless(ACTR):
    goal = Buffer()
    def init():
        goal.set('go')
    def on(goal='go'):
        print('on')

model = Endless()
"""

BROKEN = """from python_actr import *

class Broken(ACTR):
    goal = Buffer()
    def init():
        goal.set('go')
    def boom(goal='go'):
        print('before the crash \u2211')
        x = goall.chunk

Broken().run()
"""


def run(folder: Path, source: str, *words: str) -> subprocess.CompletedProcess[str]:
    """Runs a model's text."""
    (folder / "model.py").write_text(source, encoding="utf-8")
    return run_command("run", "model.py", *words, folder=folder)


def test_a_seed_gives_the_same_bytes(tmp_path: Path) -> None:
    first, second = (run(tmp_path, NOISY, "--seed", "7", "--json") for _ in range(2))
    assert first.returncode == 0
    assert first.stderr == ""
    assert first.stdout == second.stdout
    others = {run(tmp_path, NOISY, "--seed", str(seed)).stdout for seed in range(4)}
    assert len(others) > 1


def test_every_line_of_json_is_an_event(tmp_path: Path) -> None:
    done = run(tmp_path, NOISY + "print('no end of line', end='')\nprint(' \\ud800 \\x00')", "--seed", "1", "--json")
    assert done.returncode == 0

    def refuse(word: str) -> float:
        raise ValueError(word)

    events = [json.loads(line, parse_constant=refuse) for line in done.stdout.splitlines()]
    assert all(list(event) == ["time", "source", "kind", "data"] for event in events)
    assert events[0]["kind"] == "start"
    assert events[0]["data"]["seed"] == 1
    printed = [event["data"]["text"] for event in events if event["kind"] == "output"]
    assert printed[-1] == "end..."
    assert printed[-2] == "no end of line \ud800 \x00"
    assert [event["time"] for event in events] == sorted(event["time"] for event in events)


def test_numbers_that_json_does_not_have_become_text(tmp_path: Path) -> None:
    source = "import ccm\nm = ccm.Model()\nm.run(limit=0)\nm.x = float('inf')\nm.y = [float('nan')]\n"
    done = run(tmp_path, source, "--json")
    data = [json.loads(line)["data"] for line in done.stdout.splitlines()]
    assert {"x": "inf"} in data
    assert {"y": ["nan"]} in data


@pytest.mark.parametrize(
    "ending",
    [
        "model.run()",
        "while True: model.run(1)",
        "while True: Endless().run()",
        "while True:\n    try: model.run()\n    except Exception: pass",
        "while True:\n    try: Endless().run()\n    except: pass",
        "while True:\n    try:\n        while True:\n            try: model.run(0.1)\n            except: pass\n    finally: continue",
        "import threading\nthreading.Thread(target=model.run).start()",
        "import threading\ndef go():\n    while True: Endless().run()\nthreading.Thread(target=go).start()",
    ],
)
def test_until_ends_every_model(tmp_path: Path, ending: str) -> None:
    done = run(tmp_path, ENDLESS + ending, "--until", "0.5")
    assert (done.returncode, done.stderr) == (0, "")
    assert done.stdout == "on\n" * 10 + "end...\n"


@pytest.mark.parametrize(("level", "kinds"), [("none", set[str]()), ("production", {"start", "select", "fire"})])
def test_levels_of_trace(tmp_path: Path, level: str, kinds: set[str]) -> None:
    done = run(tmp_path, ENDLESS + "model.run()", "--until", "0.2", "--trace", level)
    lines = [line.split() for line in done.stdout.splitlines() if line.startswith("  ")]
    assert {words[2] for words in lines} == kinds
    assert done.stdout.count("on\n") >= 4


def test_an_error_names_file_line_and_production_after_all_output(tmp_path: Path) -> None:
    done = run(tmp_path, BROKEN)
    assert done.returncode == 1
    assert done.stdout == "before the crash \u2211\nend...\n"
    assert 'File "model.py", line 9, in boom' in done.stderr
    assert "    x = goall.chunk" in done.stderr
    assert "in production 'boom' (model.py:7) at 0.05 s; did you mean 'goal'?" in done.stderr
    assert "actr3d/" not in done.stderr


def test_an_error_shows_what_caused_it(tmp_path: Path) -> None:
    source = "def inner():\n    raise KeyError('deep')\n"
    source += "try:\n    inner()\nexcept KeyError as error:\n    raise ValueError('shallow') from error\n"
    done = run(tmp_path, source)
    assert "line 2, in inner" in done.stderr
    assert "KeyError: 'deep'" in done.stderr
    assert done.stderr.endswith("ValueError: shallow\n")


def test_an_error_of_the_library_shows_the_modellers_line(tmp_path: Path) -> None:
    done = run(tmp_path, ENDLESS + "model.run(limit=0)\nmodel.goal.clear()\nmodel.goal.modify(a=1)\n")
    assert done.returncode == 1
    assert 'File "model.py", line 14' in done.stderr
    assert "error: buffer 'goal' is empty" in done.stderr
    assert "actr3d/" not in done.stderr


def test_an_error_while_matching_names_the_modellers_lines_and_the_production(tmp_path: Path) -> None:
    source = (
        "from python_actr import *\nclass Lamp(Model):\n    @property\n    def on(self):\n        return 1 / 0\n"
        "class Agent(ACTR):\n    lamp = Lamp()\n    def p(lamp='on:1'):\n        pass\nAgent().run()\n"
    )
    done = run(tmp_path, source)
    assert re.findall(r'File "(.*)", line (\d+)', done.stderr) == [("model.py", "10"), ("model.py", "5")]
    assert done.stderr.endswith("ZeroDivisionError: division by zero\nin production 'p' (model.py:8) at 0 s\n")


@pytest.mark.daily(1)
@pytest.mark.parametrize("folder", ["actr3d-models", "actr3d/models"])
def test_a_model_beside_the_library_or_installed_with_it_is_no_part_of_it(tmp_path: Path, folder: str) -> None:
    shutil.copytree(Path(actr3d.__file__).parent, tmp_path / "actr3d", ignore=shutil.ignore_patterns("__pycache__"))
    model = tmp_path / folder / "model.py"
    model.parent.mkdir()
    model.write_text(ENDLESS.replace("print('on')", "1 / 0") + "display(model)\nmodel.run()\n")
    done = subprocess.run(
        [*COMMAND, "run", str(model)], cwd=tmp_path, capture_output=True, text=True, env={**os.environ, "PYTHONPATH": str(tmp_path)}
    )
    assert f"{model}:12: warning: display() opens no window here" in done.stderr
    assert f'File "{model}", line 9, in on\n' in done.stderr
    assert f'File "{tmp_path / "actr3d" / "actr"}' not in done.stderr


def test_time_that_stands_still_is_an_error(tmp_path: Path) -> None:
    done = run(
        tmp_path, ENDLESS.replace("goal = Buffer()", "goal = Buffer(); production_time = 0").replace("print('on')", "pass") + "model.run()"
    )
    assert done.returncode == 1
    assert "error: endless loop at 0 s" in done.stderr
    assert "'on' (model.py:8)" in done.stderr
    assert "of 'top'" in done.stderr


@pytest.mark.parametrize(("call", "code", "message"), [("3", 3, ""), ("", 0, ""), ("'sorry'", 1, "sorry\n")])
def test_a_model_may_exit(tmp_path: Path, call: str, code: int, message: str) -> None:
    done = run(tmp_path, f"import sys\nprint('before')\nsys.exit({call})\n", "--json")
    assert (done.returncode, done.stderr) == (code, message)
    assert json.loads(done.stdout)["data"] == {"text": "before"}


def test_a_closed_pipe_is_no_error(tmp_path: Path) -> None:
    (tmp_path / "model.py").write_text(ENDLESS + "model.run()", encoding="utf-8")
    command = [*COMMAND, "run", "model.py", "--until", "5000", "--json"]
    with subprocess.Popen(command, cwd=tmp_path, stdout=subprocess.PIPE, stderr=subprocess.PIPE) as process:
        assert process.stdout is not None
        assert process.stderr is not None
        assert b"start" in process.stdout.readline()
        process.stdout.close()
        assert process.stderr.read() == b""
        assert process.wait(timeout=60) == 1


@pytest.mark.parametrize("words", [[], ["--trace", "all"], ["--json"]])
def test_a_run_is_recorded_whole_though_nobody_reads_its_output(tmp_path: Path, words: list[str]) -> None:
    (tmp_path / "model.py").write_text((MODELS / "counting.py").read_text(encoding="utf-8"), encoding="utf-8")
    command = [*COMMAND, "run", "model.py", "--record", "run", *words]
    done = run_without_reader(command, tmp_path, timeout=60)
    assert (done.returncode, done.stderr) == (1, "")
    with Recorded(tmp_path / "run") as recorded:
        assert recorded.finished
        assert [event.data["text"] for event in recorded.events() if event.kind == "output"] == ["2", "3", "4", "5"]


def test_what_the_terminal_cannot_show_does_not_end_a_run(tmp_path: Path) -> None:
    (tmp_path / "model.py").write_text("print('\u2211')", encoding="utf-8")
    command, env = [*COMMAND, "run", "model.py"], {**os.environ, "PYTHONIOENCODING": "ascii"}
    done = subprocess.run(command, cwd=tmp_path, env=env, capture_output=True, timeout=60, check=True)
    assert done.stdout == b"\\u2211\n"
    done = subprocess.run([*command, "--json"], cwd=tmp_path, env=env, capture_output=True, timeout=60, check=True)
    assert json.loads(done.stdout)["data"] == {"text": "\u2211"}


@pytest.mark.daily(4)
@pytest.mark.parametrize(
    ("words", "message"),
    [
        (["run", "model.py", "--until", "-1"], "--until: must be a number of seconds > 0 and < 1e9 (got -1)"),
        (["run", "model.py", "--until", "nan"], "> 0 and < 1e9 (got nan)"),
        (["run", "model.py", "--until", "soon"], "> 0 and < 1e9 (got soon)"),
        (["run", "model.py", "--seed", "x"], "--seed: must be a whole number >= 0 (got x)"),
        (["run", "model.py", "--seed", "-1"], "--seed: must be a whole number >= 0 (got -1)"),
        (["run", "model.py", "--trace", "much"], "--trace: invalid choice: 'much'"),
        (["run", "--fast", "model.py"], "--fast is not an option of every run; those of the model file come after its name"),
        (["bench", "core", "--fast"], "unrecognized arguments: --fast"),
        (["bench", "coer"], "no benchmark 'coer'; did you mean 'core'? There are: "),
        (["run"], "the following arguments are required: FILE"),
        (["run", ""], "argument FILE: must be the name of a file (got '')"),
        (["run", "model.py", "--record", ""], "argument --record: must be the name of a file (got '')"),
        (["replay", ""], "argument RECORDING: must be the name of a file (got '')"),
        (["report", ""], "argument FOLDER: must be the name of a folder (got '')"),
        (["fit", "fan_effect", "--target", ""], "argument --target: must be the name of a file (got '')"),
        (["experiment", "fan_effect", "--scheduler", ""], "argument --scheduler: must be the name of a scheduler (got '')"),
        (["experiment", "fan_effect", "--trial", "0", "--record", ""], "argument --record: must be the name of a file (got '')"),
        ([], "the following arguments are required: COMMAND"),
    ],
)
def test_bad_options_are_refused(tmp_path: Path, words: list[str], message: str) -> None:
    done = run_command(*words, folder=tmp_path)
    assert (done.returncode, done.stdout) == (2, "")
    assert message in done.stderr


def test_a_stray_word_after_the_file_is_said_to_be_one_also_if_an_option_has_the_same_value(tmp_path: Path) -> None:
    (tmp_path / "model.py").touch()
    done = run_command("run", "--seed", "5", "model.py", "5", folder=tmp_path)
    assert (done.returncode, done.stderr) == (2, "error: unexpected '5': a parameter is given as --name value\n")


def test_a_missing_file_is_one_line(tmp_path: Path) -> None:
    (tmp_path / "counting.py").touch()
    done = run_command("run", "countng.py", folder=tmp_path)
    assert (done.returncode, done.stdout) == (1, "")
    assert done.stderr == "error: no model file 'countng.py'; did you mean 'counting.py'?\n"


def test_the_order_of_sets_does_not_differ_between_runs(tmp_path: Path) -> None:
    (tmp_path / "model.py").write_text("print({'a', 'b', 'c', 'd', 'e', 'f', 'g'})", encoding="utf-8")
    (tmp_path / "random.py").write_text("raise SystemExit('a file of the model stands in for the library')", encoding="utf-8")
    env = {key: value for key, value in os.environ.items() if key != "PYTHONHASHSEED"}
    command = [str(Path(sys.executable).parent / "actr3d"), "run", "model.py", "--seed", "1"]
    runs: list[bytes] = []
    for seed in ({}, {"PYTHONHASHSEED": "random"}, {"PYTHONHASHSEED": "123"}):
        done = subprocess.run(command, cwd=tmp_path, env={**env, **seed}, capture_output=True, timeout=60, check=True)
        runs.append(done.stdout)
    assert len(set(runs)) == 1


@pytest.mark.parametrize("line", ["for i in xrange(3): pass", "import Tkinter", "{}.has_key(1)", "print(raw_input())"])
def test_a_name_of_python_2_is_called_that(line: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    file = tmp_path / "old.py"
    file.write_text(f"import ccm\n{line}\n", encoding="utf-8")
    assert main(["run", str(file)]) == 1
    said = capsys.readouterr().err
    assert "old.py" in said
    assert "line 2" in said
    assert "this file is written for Python 2" in said


WRITES = """
import os, sys, subprocess, io
print('one', end=' ')
sys.__stdout__.write('two\\n')
os.system('echo child')
subprocess.run([sys.executable, '-c', 'print("grandchild")'], check=True)
os.write(1, b'raw\\n')
sys.stdout.buffer.write(b'bytes \\xff\\n')
sys.stdout.reconfigure(encoding='latin-1')
wrapper = io.TextIOWrapper(sys.stdout.buffer, encoding='utf-8')
wrapper.write('wrapped \\u2211\\n')
del wrapper
os.fstat(sys.stdout.fileno())
print(sys.stdout.encoding, sys.stdout.isatty())
sys.stdout.writelines(['a\\n', 'b\\n'])
sys.stdout.close()
"""


def test_nothing_comes_between_the_lines_of_json(tmp_path: Path) -> None:
    done = run(tmp_path, WRITES + NOISY, "--seed", "1", "--json")
    assert done.returncode == 0
    printed = [event["data"]["text"] for event in map(json.loads, done.stdout.splitlines()) if event["kind"] == "output"]
    assert printed[:6] == ["one two", "bytes \\xff", "wrapped \u2211", "utf-8 False", "a", "b"]
    assert sorted(done.stderr.split()) == ["child", "grandchild", "raw"]


@pytest.mark.daily(2)
@pytest.mark.parametrize("words", [[], ["--trace", "all"], ["--json"]])
@pytest.mark.parametrize(
    ("source", "message"),
    [
        ("print('x' * 100000)\nprint('y')", ""),
        ("try:\n    for i in range(9999): print(i)\nexcept OSError: pass", ""),
        ("import ccm, sys\nprint('x')\nsys.exit(3)", ""),
        ("print('x')\n1 / 0", "ZeroDivisionError: division by zero\n"),
        ("try: print('x' * 100000)\nexcept OSError: pass\nopen('no')", "FileNotFoundError: [Errno 2] No such file or directory: 'no'\n"),
    ],
)
@pytest.mark.skipif(not Path("/dev/full").exists(), reason="there is no /dev/full")
def test_a_full_disk_is_one_clear_error(tmp_path: Path, words: list[str], source: str, message: str) -> None:
    (tmp_path / "model.py").write_text(source, encoding="utf-8")
    with Path("/dev/full").open("w") as full:
        env = {key: value for key, value in os.environ.items() if key != "PYTHONUNBUFFERED"}
        command = [*COMMAND, "run", "model.py", *words]
        done = subprocess.run(
            command, cwd=tmp_path, env=env, stdout=full, stderr=subprocess.PIPE, encoding="utf-8", timeout=60, check=False
        )
    assert done.returncode == 1
    assert done.stderr.endswith(message + "error: cannot write the output: No space left on device\n")
    assert done.stderr.count("Traceback") == bool(message)


@pytest.mark.parametrize("unbuffered", ["", "1"])
@pytest.mark.parametrize(
    ("words", "code"), [(["replay", "run"], 2), (["bench"], 2), (["--version"], 1), (["--help"], 1), (["run", "model.py", "--help"], 1)]
)
@pytest.mark.skipif(not Path("/dev/full").exists(), reason="there is no /dev/full")
def test_the_output_of_every_command_is_written_or_the_exit_code_says_that_it_is_not(
    tmp_path: Path, words: list[str], code: int, unbuffered: str
) -> None:
    assert run(tmp_path, "print('x')", "--record", "run").returncode == 0
    command, environment = [*COMMAND, *words], {**os.environ, "PYTHONUNBUFFERED": unbuffered}
    with Path("/dev/full").open("w") as full:
        done = subprocess.run(command, cwd=tmp_path, env=environment, stdout=full, stderr=subprocess.PIPE, text=True, check=False)
    assert (done.returncode, done.stderr) == (code, "error: cannot write the output: No space left on device\n")
    done = run_without_reader(command, tmp_path, unbuffered=unbuffered)
    assert (done.returncode, done.stderr) == (code, "")


@pytest.mark.parametrize("words", [[], ["--trace", "all"], ["--json"]])
def test_a_model_may_close_its_output(tmp_path: Path, words: list[str]) -> None:
    done = run(tmp_path, "import ccm, sys\nprint('said')\nsys.stdout.close()\nccm.Model().run(1)", *words)
    assert (done.returncode, done.stderr) == (0, "")
    assert "said" in done.stdout


def test_a_helper_of_python_2_is_one_line(tmp_path: Path) -> None:
    (tmp_path / "old.py").write_text("x = 1\nprint x\n", encoding="utf-8")
    done = run(tmp_path, "import old")
    assert (done.returncode, done.stdout) == (1, "")
    assert done.stderr == f"error: {tmp_path}/old.py:2: this file is written for Python 2 (a print statement); convert it to Python 3\n"


def test_the_command_prints_its_version(capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit) as ended:
        main(["--version"])
    assert ended.value.code == 0
    assert capsys.readouterr().out == f"actr3d {version('actr3d')}\n"


@pytest.mark.parametrize("name", ["run", "replay", "bench", "experiment", "fit", "report"])
def test_the_help_of_each_command_lists_its_exit_codes(name: str, capsys: pytest.CaptureFixture[str]) -> None:
    with suppress(SystemExit):
        main([name, "--help"])
    assert "Exit codes: 0 " in capsys.readouterr().out


def test_a_replay_of_what_is_no_recording_says_so_in_plain_words(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    file = tmp_path / "model.py"
    file.write_text("x = 1\n", encoding="utf-8")
    assert main(["replay", str(file)]) == 2
    assert capsys.readouterr().err == f"error: '{file}' is not a recording: it is a file of another kind, or damaged\n"


def test_the_package_is_the_command(tmp_path: Path) -> None:
    file = tmp_path / "said.py"
    file.write_text("import random\nprint('said', {'a', 'b', 'c', 'd', 'e'}, random.random())\n", encoding="utf-8")
    said = {
        subprocess.run([sys.executable, *program, "run", str(file), "--seed", "1"], check=True, capture_output=True, timeout=60).stdout
        for program in (["-m", "actr3d"], [str(Path(sys.executable).with_name("actr3d"))])
    }
    assert len(said) == 1
    assert said.pop().startswith(b"said {")


def test_an_interruption_while_the_command_is_loaded_is_no_traceback(tmp_path: Path) -> None:
    (tmp_path / "argparse.py").write_text("raise KeyboardInterrupt\n", encoding="utf-8")
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join([str(tmp_path), str(Path(actr3d.__file__).parents[1])])}
    command = [sys.executable, "-m", "actr3d", "bench"]
    done = subprocess.run(command, env=environment, capture_output=True, text=True, timeout=60, check=False)
    assert (done.returncode, done.stdout, done.stderr) == (130, "", "stopped\n")


def test_benchmarks_are_listed_as_json_too() -> None:
    done = run_command("bench", "--json")
    assert done.returncode == 0
    assert json.loads(done.stdout)["core"] == "Compares the cognitive core with python_actr, in one run on one machine."


@pytest.mark.parametrize(
    ("name", "package", "install"), [("core", "python_actr", "python_actr"), ("experiment", "dask", "'actr3d[experiment]'")]
)
def test_a_benchmark_without_its_package_says_what_to_install(tmp_path: Path, name: str, package: str, install: str) -> None:
    program = f"import sys; sys.modules['{package}'] = None; from actr3d.cli import main; sys.exit(main(['bench', '{name}']))"
    command = [sys.executable, "-c", program]
    done = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, timeout=60, check=False)
    assert (done.returncode, done.stdout) == (2, "")
    assert done.stderr.endswith(f"; install: pip install {install}\n")


def test_what_a_benchmark_prints_says_what_each_figure_means(capsys: pytest.CaptureFixture[str]) -> None:
    figure = Measurement(name="copy", value=3.5, sense="at most", limit=3, what="a list's copy by a tuple's")
    assert report([figure], json_output=False) == 1
    assert capsys.readouterr().out == "MISSED  copy        3.50  (at most 3)  a list's copy by a tuple's\n"
    assert report([figure], json_output=True) == 1
    found = {"value": 3.5, "limit": "at most 3", "met": False, "what": "a list's copy by a tuple's"}
    assert json.loads(capsys.readouterr().out) == {"copy": found}

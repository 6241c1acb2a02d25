"""The code blocks of Markdown pages: the input of a reader, and the output that the page shows.

The blocks of a page follow one another, as a reader would copy them:

- A `python` block continues the program of the block before; one with `title="name.py"` begins a new file.
- An `output` block holds what the block before it printed. A line `...` matches any lines.
- A `console` block holds commands, each after `$ `, and what they print. They run in a folder with the page's files and `models`.
- Blocks of other languages are not run: `sh` for commands of the system, `text` for what is only shown.
"""

from __future__ import annotations

import contextlib
import io
import re
import shlex
import textwrap
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path

from actr3d.actr.kernel.run_limits import RunLimits
from actr3d.actr.loading import run_text
from actr3d.cli import main
from tests.helpers.paths import ROOT

PAGES = (*sorted(ROOT.glob("*.md")), ROOT / "models" / "README.md", *sorted((ROOT / "docs").rglob("*.md")))
FENCE = re.compile(r"^( *)```(\w+)?([^\n]*)\n(.*?)^\1```$", re.MULTILINE | re.DOTALL)
END_OF_BLOCK = "\N{SYMBOL FOR RECORD SEPARATOR}"


@dataclass
class Program:
    """One file of a page: its blocks, each with its output if the page shows it."""

    name: str
    blocks: list[str] = field(default_factory=list[str])
    printed: list[str | None] = field(default_factory=list[str | None])

    @property
    def text(self) -> str:
        """The program."""
        return "".join(self.blocks)

    def run(self) -> Iterator[tuple[str | None, str]]:
        """Runs the program in the current folder; yields the expected and the printed output of each block."""
        marked = f"\nprint({END_OF_BLOCK!r}, end='')\n".join([*self.blocks, ""])
        out = io.StringIO()
        with contextlib.redirect_stdout(out):
            run_text(marked, self.name, limits=RunLimits(seed=1))
        yield from zip(self.printed, out.getvalue().split(END_OF_BLOCK), strict=False)


def has_code(page: Path) -> bool:
    """Returns whether a page has blocks that are run."""
    return any(language in ("python", "console") for _, language, _, _ in FENCE.findall(page.read_text(encoding="utf-8")))


def check(page: Path, folder: Path) -> None:
    """Runs the code of a page in a folder, and compares its output with that of the page.

    Raises:
        AssertionError: If they differ.
    """
    (folder / "models").symlink_to(ROOT / "models")
    programs: list[Program] = []
    run_by_commands: set[str] = set()
    with contextlib.chdir(folder):
        for indent, language, options, body in FENCE.findall(page.read_text(encoding="utf-8")):
            text = textwrap.dedent(body) if indent else body
            if language == "python":
                title = re.search(r'title="([^"]+)"', options)
                if title or not programs:
                    programs.append(Program(title[1] if title else f"{page.stem}.py"))
                programs[-1].blocks.append(text)
                programs[-1].printed.append(None)
                if title:
                    Path(title[1]).write_text(programs[-1].text, encoding="utf-8")
            elif language == "output":
                programs[-1].printed[-1] = text
            elif language == "console":
                for command, printed in _commands(text):
                    run_by_commands.update(command.split())
                    compare(printed, _carried_out(command))
        for program in programs:
            if program.name in run_by_commands and not any(program.printed):
                continue
            for expected, found in program.run():
                if expected is not None:
                    compare(expected, found)


def compare(expected: str, found: str) -> None:
    """Compares the output that a page shows with the printed output; a line `...` of the page matches any lines.

    Raises:
        AssertionError: If they differ.
    """
    found = found.rstrip("\n") + "\n" if found else ""
    parts = re.split(r"^ *\.\.\.\n", expected, flags=re.MULTILINE)
    pattern = "(?:.*\n)*?".join(map(re.escape, parts))
    assert re.fullmatch(pattern, found), f"the page shows\n{expected}\nbut this is printed:\n{found}"


def _commands(text: str) -> Iterator[tuple[str, str]]:
    """Yields the commands of a block, each with its output."""
    for part in re.split(r"^\$ ", text, flags=re.MULTILINE)[1:]:
        command, _, printed = part.partition("\n")
        yield command, printed


def _carried_out(command: str) -> str:
    """Runs `actr3d ...`; returns its output, errors included."""
    name, *arguments = shlex.split(command)
    assert name == "actr3d", f"only `actr3d` can be run here (got {command!r})"
    out = io.StringIO()
    with contextlib.redirect_stdout(out), contextlib.redirect_stderr(out), contextlib.suppress(SystemExit):
        main(arguments)
    return out.getvalue()

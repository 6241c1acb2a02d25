"""The command `actr3d report`: writes the report of an experiment into its folder, or another one."""

from __future__ import annotations

import errno
import itertools
import re
import tempfile
from collections.abc import Callable, Sequence
from contextlib import suppress
from dataclasses import replace
from pathlib import Path

from actr3d.errors import ExperimentError, reason_of
from actr3d.experiment.report.figures import png, svg
from actr3d.experiment.report.general import analysis_sections, comparison_section, human_section, measure_sections, what_was_run
from actr3d.experiment.report.page import MADE_BY, distinct, page
from actr3d.experiment.report.parts import Plot, Section, Table
from actr3d.experiment.report.reference_means import ReferenceMeans, human_data_of, means_of_experiment, means_of_people
from actr3d.experiment.report.results import Results, by_number, read_results

REPORT, PAGE = "report", "index.html"
"""The folder of a report in that of the experiment, and the name of its page."""
OWN = re.compile(r"index\.html|figures(/[^/]+\.(svg|png))?|tables(/[^/]+\.csv)?")
"""What a report consists of: its files and folders."""
DIGITS = "%.8g"
"""The format of numbers in tables: more digits would depend on the processor."""


def write_report(
    folder: Path | str, *, human: Path | str | None = None, compare: Path | str | None = None, out: Path | str | None = None
) -> Path:
    """Writes the report of an experiment, and returns its page.

    The folder of the report has the page `index.html`, `figures/NAME.svg` and `.png`, and `tables/NAME.csv`; an earlier report there
    is replaced.

    Args:
        folder: The folder of the experiment.
        human: A file of human data; None for those that the design names. See `actr3d.experiment.human_data`.
        compare: The folder of another experiment to show beside this one.
        out: The folder of the report; None for `report` in that of the experiment, which must be writable then.

    Raises:
        ExperimentError: If a folder holds no experiment or no trials, the human data are not valid, or the report cannot be written.
            An error in a measure or an analysis ends only its own sections: it is named there, and raised when the report is written.
    """
    named = Path(folder) / REPORT if out is None else Path(out)
    final = named.resolve()  # a link leads to the same folder afterwards
    results = read_results(folder)
    _check_place(final)
    parts = by_number(results)
    data, why = human_data_of(results.design, parts, human)
    people = None if data is None else means_of_people(data, parts)
    other = None if compare is None else read_results(compare)
    reference = None if other is None else means_of_experiment(by_number(other), parts)
    others: list[ReferenceMeans] = [one for one in (people, reference) if one is not None]
    analyses = analysis_sections(results, others)
    sections = [what_was_run(results), *analyses, human_section(parts, data, why, people)]
    if other is not None:
        sections.append(comparison_section(results, other, parts, reference))
    sections += measure_sections(parts, others, secondary=not all(section.failed for section in analyses))
    _write(final, results, sections, hint="; name another folder with --out" if out is None else "")
    if failed := [section.failed for section in sections if section.failed]:
        raise ExperimentError(f"'{named / PAGE}' is written, but some of its sections are not complete: {'; '.join(failed)}")
    return named / PAGE


def _check_place(final: Path) -> None:
    """Checks that the folder of a report is new, or empty, or holds nothing but an earlier report.

    Raises:
        ExperimentError: If it holds something else, or cannot be read.
    """
    try:
        if not final.is_dir():
            if final.exists():
                raise ExperimentError(f"'{final}' is a file; name a folder for the report")
            return
        files = [path.relative_to(final).as_posix() for path in sorted(final.rglob("*"))]
        others = [file for file in files if not OWN.fullmatch(file)]
        first = final / PAGE
        if files and (others or not first.is_file() or MADE_BY not in first.read_text(encoding="utf-8", errors="replace")):
            what = f"holds '{others[0]}'" if others else "is not a report"
            raise ExperimentError(f"'{final}' {what}, which a new report would replace; move it away")
        if Path.cwd().is_relative_to(final):
            raise ExperimentError(f"'{final}': a new report would replace the folder in which you are; leave it, or name another --out")
    except OSError as error:
        raise ExperimentError(f"'{final}': cannot be read ({reason_of(error)})") from None


def _write(final: Path, results: Results, sections: Sequence[Section], *, hint: str) -> None:
    """Writes all files into a new folder, which then replaces the earlier report; the hint follows the error if it cannot be written."""
    sections = _with_distinct_names(sections)
    try:
        final.parent.mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryDirectory(prefix=f".{REPORT} ", dir=final.parent, ignore_cleanup_errors=True) as place:
            part = Path(place) / "new"
            for inner in ("figures", "tables"):
                (part / inner).mkdir(parents=True)
            drawings: dict[str, str] = {}
            for item in (item for section in sections for item in section.parts):
                match item:
                    case Plot():
                        drawings[item.name] = svg(item.figure)
                        (part / "figures" / f"{item.name}.svg").write_text(drawings[item.name], encoding="utf-8")
                        (part / "figures" / f"{item.name}.png").write_bytes(png(item.figure))
                    case Table():
                        item.frame.to_csv(part / "tables" / f"{item.name}.csv", index=False, float_format=DIGITS, lineterminator="\n")
                    case _:
                        pass
            (part / PAGE).write_text(_page(results, sections, drawings), encoding="utf-8")
            _replace(final, part, Path(place))
    except OSError as error:
        raise ExperimentError(f"'{final}': cannot write the report ({reason_of(error)}){hint}") from None


def _with_distinct_names(sections: Sequence[Section]) -> list[Section]:
    """Returns sections whose figures and tables have names that make different files, also on disks that ignore capital letters."""
    found = list(sections)
    for kind in (Plot, Table):
        names = iter(distinct([part.name for section in sections for part in section.parts if isinstance(part, kind)]))
        for place, section in enumerate(found):
            parts = [replace(part, name=next(names)) if isinstance(part, kind) else part for part in section.parts]
            found[place] = replace(section, parts=parts)
    return found


def _replace(final: Path, part: Path, place: Path) -> None:
    """Puts a folder in the place of another, which is moved away; another process may do the same."""
    for number in itertools.count():
        with suppress(FileNotFoundError):
            final.replace(place / f"earlier {number}")
        try:
            part.replace(final)
        except OSError as error:
            if error.errno not in (errno.ENOTEMPTY, errno.EEXIST):
                raise
        else:
            return


def _page(results: Results, sections: Sequence[Section], drawings: dict[str, str]) -> str:
    count: Callable[[int], str] = "{:,}".format
    people = sum(group.participants for group in results.design.groups.values())
    facts = {
        "participants": count(people),
        "trials": count(len(results.rows) + len(results.failures)),
        "failed": count(len(results.failures)),
        "cells of each participant": count(len(results.design.cells)),
    }
    first = " ".join(results.description.partition("\n\n")[0].split())
    return page(results.specification.name, first, facts, sections, drawings)

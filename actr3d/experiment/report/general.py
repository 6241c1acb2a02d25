"""The sections that every report has: what was run, failures, human data, and each measure with its figure, means and tests."""

from __future__ import annotations

import itertools
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from traceback import extract_tb
from typing import Any

import numpy as np

from actr3d.experiment.design import factor_name
from actr3d.experiment.human_data import HumanData
from actr3d.experiment.plain_values import plain_text
from actr3d.experiment.report.analyses import find_analyses
from actr3d.experiment.report.figures import Curve, Look, Pane, curves_figure
from actr3d.experiment.report.libraries import pandas, versions
from actr3d.experiment.report.parts import Caution, Part, Plot, Section, Table
from actr3d.experiment.report.reference_means import (
    ReferenceMeans,
    cells_left_out,
    factors_of,
    fit_to,
    matched,
    missing,
    ran_at,
    same_unit,
    varied_once,
)
from actr3d.experiment.report.results import Results, words
from actr3d.experiment.report.statistics import (
    MIN_FOR_BOOTSTRAP,
    MIN_FOR_TESTS,
    RESAMPLES,
    SEED,
    Tests,
    cell_means,
    in_order,
    participant_means,
    run_tests,
)
from actr3d.experiment.trial_measures import NOTHING_LEFT, ended_early
from actr3d.runner.traceback_report import PYTHON, failure
from actr3d.warnings import is_library

MAX_PANES = 6
"""A factor with more levels than this makes no panes of a figure."""
MAX_TICKS = 12
"""An axis has a tick for each level if all are whole numbers and there are at most this many."""
MAX_KINDS = 20
"""A measure with more different texts than this is not counted."""
MAX_CELLS = 6
"""The maximum number of cells with failed trials, or of cells that are not compared, that are named."""
TAIL = 700
"""The characters of a failure's message that the page shows: its end."""


def what_was_run(results: Results) -> Section:
    """Returns the section on design, model, participants and trials."""
    design, specification, pd = results.design, results.specification, pandas()
    rows = [("design", specification.name), ("model", specification.model.file)]
    rows += [(f"factor {name}", ", ".join(map(plain_text, levels)) + _unit(results, name)) for name, levels in design.factors.items()]
    for name, group in design.groups.items():
        drawn = "; ".join(f"{key} = {value!r}" for key, value in group.parameters.items())
        people = "1 participant" if group.participants == 1 else f"{group.participants} participants"
        rows.append((f"group {name}", f"{people}{': ' + drawn if drawn else ''}"))
    rows += [(f"setting {name}", repr(value)) for name, value in design.settings.items()]
    rows += [(f"changed {name}", repr(value)) for name, value in results.changes.items()]
    rows += [("trials of each cell", f"{design.trials:,} by each participant"), ("order", design.order), ("seed", str(design.seed))]
    rows += [("versions", text) for text in results.versions]
    rows.append(("analysed with", versions()))
    table = Table(name="design", title="Design", frame=pd.DataFrame(rows, columns=["what", "value"]))
    parts: list[Part] = [*results.description.split("\n\n")[1:]]
    if results.changes:
        parts.append(f"The description is that of the design as it was written. Changed in this experiment: {', '.join(results.changes)}.")
    parts += [*cautions(results), table]
    if len(results.failures):
        parts.append(failures(results))
    return Section(title="What was run", parts=parts)


def cautions(results: Results) -> list[Caution]:
    """Returns what a reader must not overlook: trials that are missing, few participants, versions that changed."""
    total, done = len(results.design), len(results.rows) + len(results.failures)
    found: list[str] = []
    if done < total:
        found.append(f"Only {done:,} of {total:,} trials have finished; all numbers are preliminary.")
    if len(results.failures):
        found.append(f"{len(results.failures):,} of {done:,} trials failed. They are left out of all means.{_failed_cells(results)}")
    if cut := sum(results.rows["end"] == "limits") if len(results.rows) else 0:
        found.append(
            f"{cut:,} of {done:,} trials were stopped at their limit of {results.design.until:g} simulated seconds, `until` in the design. "
            "Their measures are those of that moment."
        )
    if len(results.rows) and ended_early(results.rows["end"]):
        found.append(f"All trials {NOTHING_LEFT}")
    there = results.rows.groupby("group")["participant"].nunique()
    people = {name: (int(there.get(name, 0)), group.participants) for name, group in results.design.groups.items()}
    least, planned = min(people.values())
    many = {0: "no participants", 1: "one participant"}.get(least, f"{least} participants")
    many += f" with results, of {planned} in the design" if least < planned else ""
    if least < MIN_FOR_TESTS:
        narrow = ", and intervals over two participants are no more than their range" if least == 2 else ""
        found.append(
            f"A group has {many}. With fewer than {MIN_FOR_TESTS} nothing can be said about other participants: nothing is tested{narrow}."
        )
    elif least < MIN_FOR_BOOTSTRAP:
        found.append(f"A group has {many}. With fewer than {MIN_FOR_BOOTSTRAP}, bootstrap intervals are too narrow.")
    if len(results.versions) > 1:
        found.append(f"The trials were run with {len(results.versions)} different sets of versions.")
    return [Caution(text) for text in found]


def _failed_cells(results: Results) -> str:
    """Returns sentences that name the cells in which trials failed, and say what that means for their means."""
    by = [*results.by_group, *(name for name in results.factors if name in results.failures)]
    means = " What is left may be the easier ones: read its means and tests with care. "
    means += "They are not compared with other means."
    if not by:
        return means
    return f" Cells with failed trials: {_listed(results.failures[by].drop_duplicates().to_dict('records'))}.{means}"


def _listed(cells: Sequence[Mapping[str, Any]]) -> str:
    """Returns the conditions of cells as text: of the first `MAX_CELLS`, and how many more there are."""
    named = [", ".join(f"{words(name)} {plain_text(level)}" for name, level in cell.items()) or "all" for cell in cells[:MAX_CELLS]]
    more = [f"and {len(cells) - MAX_CELLS:,} more"] if len(cells) > MAX_CELLS else []
    return "; ".join([*named, *more])


def failures(results: Results) -> Table:
    """Returns the table of failures: how many trials ended with each message, and one of them."""
    frame = results.failures.copy()
    frame["message"] = [text.strip() if len(text.strip()) <= TAIL else f"… {text.strip()[-TAIL:]}" for text in frame["error"]]
    groups = frame.groupby(["end", "message"], sort=False)
    found = [
        {"trials": len(of), "end": end, "first_trial": int(of["trial"].min()), "participants": of["participant"].nunique(), "message": text}
        for (end, text), of in groups
    ]
    table = pandas().DataFrame(found).sort_values(["trials", "first_trial"], ascending=[False, True])
    note = "Run one of them again: actr3d experiment FOLDER --trial ID --record FILE"
    return Table(name="failures", title="Failures", frame=table, note=note)


def analysis_sections(results: Results, others: Sequence[ReferenceMeans]) -> list[Section]:
    """Returns the sections of the analyses that can be made of an experiment; an error ends those of its own analysis, and no other."""
    found = list[Section]()
    for make in find_analyses(results.rows.columns):
        try:
            found += make(results, others)
        except Exception as error:  # noqa: BLE001 - as in `_add`
            name, parts = make.__name__, list[Part]()
            failed = _failed(f"analysis '{name}'", error, parts)
            found.append(Section(title=name.replace("_", " ").capitalize(), parts=parts, failed=failed))
    return found


def _add(parts: list[Part], what: str, made: Iterator[Part]) -> str:
    """Adds parts to a section as they are made: those before an error stay. Returns the error, see `_failed`; "" if there is none."""
    try:
        for part in made:
            parts.append(part)  # noqa: PERF402 - one at a time
    except Exception as error:  # noqa: BLE001 - it is shown here, and `write_report` raises it when the other sections are written
        return _failed(what, error, parts)
    return ""


def _failed(what: str, error: Exception, parts: list[Part]) -> str:
    """Adds to a section that not all of it could be made, and returns why: the error, and the line of the library or of the design."""
    frames = extract_tb(error.__traceback__)
    place = [frame for frame in frames if is_library(frame.filename) or not frame.filename.startswith(PYTHON)][-1]
    why = f"{what}: {failure(error)} ({Path(place.filename).name}, line {place.lineno})"
    parts.append(Caution(f"Not all of this section could be made: {why}."))
    return why


def human_section(parts: Sequence[Results], data: HumanData | None, why: str, reference: ReferenceMeans | None) -> Section:
    """Returns the section on human data: what there is, where it is from, and how well the model agrees with it."""
    if data is None or reference is None:
        return Section(title="Human data", parts=[why, "Figures show the model only."])
    people = len({(row["group"], row["participant"]) for row in data.rows}) if not data.published else 0
    kind = "published means" if data.published else f"trials of {people} {'person' if people == 1 else 'people'}"
    count = "1 row" if len(data.rows) == 1 else f"{len(data.rows):,} rows"
    found: list[Part] = [f"{data.name}: {count} of {kind}.", *(f"{note}" for note in data.notes)]
    if data.published:
        found += [f"Source: {source}" for source in data.sources]
        found.append("Intervals of published means follow from their SD and n (t distribution); means without these have none.")
    fit = fit_to(parts, reference)
    without = [name for part in parts for name in part.measures if name not in data.measures]
    if len(fit):
        note = "Agreement of the means of all cells that both have. A model must be compared with a baseline, too."
        found.append(Table(name="fit_to_people", title="Agreement with people", frame=fit, note=note, hidden=["beside"]))
        found += _sentences_on_left_out(parts, reference)
        found.append(_matched_table(parts, reference, "means_beside_people", "Means beside those of people"))
    if without:
        found.append(f"No human data for: {', '.join(without)}.")
    return Section(title="Human data", parts=found)


def comparison_section(results: Results, other: Results, parts: Sequence[Results], reference: ReferenceMeans | None) -> Section:
    """Returns the section that compares two experiments."""
    title = f"Compared with {other.label}"
    if not any(name in other.measures and same_unit(results, other, name) for name in results.measures):
        return Section(title=title, parts=[Caution(f"{other.label} has no measure in common with {results.label}.")])
    different = [*results.specification.differences_from(other.specification), *results.design.differences_from(other.design)]
    what = f"{other.label} (“there”: {other.specification.name}, {len(other.rows):,} trials)"
    text = f"{what} differs from this experiment (“now”) in: {'; '.join(different) or 'nothing that was set'}."
    found: list[Part] = [text, *levels_compared(results, other)]
    if units := [name for name in results.measures if name in other.measures and not same_unit(results, other, name)]:
        found.append(Caution(f"Not compared, because {other.label} has them in another unit: {', '.join(units)}."))
    if reference is not None and len(fit := fit_to(parts, reference)):
        found.append(Table(name="fit_to_other", title="Agreement of the means of all common cells", frame=fit, hidden=["beside"]))
        found += _sentences_on_left_out(parts, reference)
        found.append(_matched_table(parts, reference, "means_beside_other", f"Means beside those of {other.label}"))
    else:
        found.append(Caution("The two experiments have no cell in common without failed trials: their means are not compared."))
    return Section(title=title, parts=found)


def levels_compared(results: Results, other: Results) -> list[str | Caution]:
    """Returns sentences about the factors that only one of two experiments varies: at which levels the two are compared."""
    found: list[str | Caution] = []
    for name, (varying, levels) in varied_once(results, other).items():
        which, fixed = ("this experiment", other) if varying is results else (other.label, results)
        of_groups, what = ran_at(fixed, name, levels), words(name)
        elsewhere = other.label if fixed is other else "this experiment"
        ran = ", ".join(f"{plain_text(level)}{_unit(varying, name)}" for level in dict.fromkeys(of_groups.values()))
        if not of_groups:
            drawn = not {name, name.removesuffix("_")}.isdisjoint(fixed.rows)
            why = "drew it for each participant or trial" if drawn else "has no such parameter with a known default"
            found.append(Caution(f"Only {which} varies {what}, and {elsewhere} {why}. The means are not compared."))
        elif set(levels).isdisjoint(of_groups.values()):
            found.append(Caution(f"Only {which} varies {what}, and {elsewhere} ran at another level, {ran}. The means are not compared."))
        else:
            found.append(f"Only {which} varies {what}. The means are compared at the level at which {elsewhere} ran: {ran}.")
            if left := [group for group in fixed.groups if group not in of_groups]:
                found.append(Caution(f"Groups of {elsewhere} without one level of {what} are not compared: {', '.join(left)}."))
    return found


def _sentences_on_left_out(parts: Sequence[Results], reference: ReferenceMeans) -> list[str]:
    """Returns sentences that name the conditions of the means beside that are not compared, of measures of which some are."""
    measures: dict[str, list[str]] = {}
    for results, measure in ((part, measure) for part in parts for measure in part.measures):
        cells = matched(results, reference, measure)
        if len(cells) and (others := cells_left_out(results, reference, measure, cells)):
            several = len({*results.groups, *(cell["group"] for cell in others if "group" in cell)}) > 1
            shown = [{name: level for name, level in cell.items() if several or name != "group"} for cell in others]
            measures.setdefault(_listed(shown), []).append(measure)
    return [f"Left out of the means of {reference.label} for {', '.join(of)}: {conditions}." for conditions, of in measures.items()]


def _matched_table(parts: Sequence[Results], reference: ReferenceMeans, name: str, title: str) -> Table:
    pieces = [matched(part, reference, measure).assign(measure=measure) for part in parts for measure in part.measures]
    frame = pandas().concat([piece for piece in pieces if len(piece)], ignore_index=True)
    first = ["measure", "group", *factors_of(parts)]
    frame = frame[[*first, *(column for column in frame if column not in first)]]
    return Table(name=name, title=title, frame=frame, heads={"beside": reference.label}, folded=True)


def measure_sections(parts: Sequence[Results], others: Sequence[ReferenceMeans], *, secondary: bool = False) -> list[Section]:
    """Returns a section for each measure, and one that explains what all measures show.

    Args:
        parts: The experiment, from `by_number`.
        others: Means beside its own.
        secondary: Whether other sections show results, too: then those of measures that neither the design names nor people have are
            folded.
    """
    note = (
        "Means are of participants: first the trials of a participant in a cell are averaged, then the participants. Intervals are 95 % "
        f"percentile bootstrap intervals over participants ({RESAMPLES:,} samples, seed {SEED}). The tests describe the simulated sample: "
        "with more simulated participants, any difference becomes significant, so read the effect sizes. They are not corrected for the "
        "number of measures."
    )
    texts: list[Part] = [note]
    with_values = {name for part in parts for name in (*part.measures, *part.outcomes)}
    if empty := [measure.name for measure in parts[0].design.kept if measure.name not in with_values]:
        texts.append(Caution(f"No trial has a value of: {', '.join(empty)}."))
    failed = [why for name in parts[0].outcomes if (why := _add(texts, f"measure '{name}'", _outcomes(parts[0], name)))]
    found = [Section(title="All measures", parts=texts, failed="; ".join(failed))]
    return found + [_measure_section(part, name, others, secondary=secondary) for part in parts for name in part.measures]


def _outcomes(results: Results, measure: str) -> Iterator[Part]:
    """Yields how many trials had each text of a measure, and the shares of the texts by the factor on the x axis of figures."""
    by = results.by_group
    column = factor_name(measure)
    rows = results.rows[[*by, measure]].fillna({measure: "none"}).rename(columns={measure: column})
    if rows[column].nunique() <= MAX_KINDS:
        counts = in_order(rows.groupby([*by, column], observed=True).size().rename("trials").reset_index(), by, rows)
        yield Table(name=f"counts_{measure}", title=f"Trials by {words(measure)}", frame=counts)
        yield from _shares(results, measure)


def _shares(results: Results, measure: str) -> Iterator[Table | Plot]:
    """Yields a figure and a table of the shares of each text of a measure; nothing for a single text, or without factors."""
    layout, rows = layout_of(results), results.rows.fillna({measure: "none"})
    texts = sorted(rows[measure].unique())
    if layout is None or layout.x == "group" or len(texts) < 2:
        return
    x, column, title = layout.x, factor_name(measure), f"Shares of each {words(measure)} by {words(layout.x)}"
    by = [*results.by_group, x]
    of = {text: cell_means(rows.assign(**{measure: (rows[measure] == text) * 1.0}), measure, by) for text in texts}
    frame = in_order(pandas().concat([means.assign(**{column: text}) for text, means in of.items()]), by, rows)
    over = [name for name in results.factors if name != x]
    layout = replace(layout, curves=column, panes=results.by_group, averaged=over, levels={**layout.levels, column: texts})
    figure = _figure(results, layout, [("model", "model", frame)], "share of trials", from_zero=True)
    note = "Shares of the trials of a participant, averaged over participants, with 95 % bootstrap intervals."
    yield Plot(name=f"shares_{measure}", title=title, figure=figure, note=note + layout.note)
    frame = frame[[*by, column, "mean", "sd", "low", "high", "n", "trials"]]
    yield Table(name=f"shares_{measure}", title=title, frame=frame, heads={"mean": "share"}, folded=True)


def _measure_section(results: Results, measure: str, others: Sequence[ReferenceMeans], *, secondary: bool) -> Section:
    """Returns the section of a measure, see `measure_sections`; an error ends this section, and no other."""
    parts: list[Part] = []
    failed = _add(parts, f"measure '{measure}'", _measure_parts(results, measure, others))
    human = any(one.look == "human" and len(one.of(measure)) for one in others)
    folded = secondary and not (results.design.kept or human or failed)  # a design that names measures has no others
    return Section(title=results.name_with_unit(measure), parts=parts, folded=folded, failed=failed)


def _measure_parts(results: Results, measure: str, others: Sequence[ReferenceMeans]) -> Iterator[Part]:
    unit, meaning = results.unit(measure), results.columns[measure].meaning if measure in results.columns else ""
    by = [*results.by_group, *results.factors]
    means = cell_means(results.rows, measure, by)
    means = means.assign(measure=measure, unit=unit)[[*by, "measure", "unit", "mean", "sd", "low", "high", "n", "trials"]]
    lost = int(results.rows[measure].isna().sum())
    if meaning:
        yield meaning
    if lost:
        yield f"{lost:,} of {len(results.rows):,} trials have no value."
    figure, note = figure_of(results, measure, others)
    if figure is not None:
        yield Plot(name=f"measure_{measure}", title=f"{results.name_with_unit(measure)} by cell", figure=figure, note=note)
    units = dict.fromkeys(("mean", "sd", "low", "high"), unit) | {name: results.unit(name) for name in by}
    note = "sd: between participants; low, high: 95 % interval; n: participants."
    yield Table(
        name=f"means_{measure}", title="Means", frame=means, units=units, hidden=("measure", "unit"), note=note, folded=len(means) > 12
    )
    over_cells = participant_means(results.rows, measure, []).rename(columns={"value": "mean"})
    yield Table(name=f"participants_{measure}", title="Participants", frame=over_cells, units={"mean": unit}, folded=True)
    yield from test_parts(run_tests(results, measure), measure)


def test_parts(tests: Tests, measure: str) -> list[Part]:
    """Returns tests as parts of a section."""
    parts: list[Part] = []
    if tests.anova is not None:
        note = (
            "One factor within participants at a time, averaged over others; p corrected: Greenhouse-Geisser. Differences: an effect on "
            "the difference between two levels is an interaction with them."
        )
        parts.append(Table(name=f"anova_{measure}", title="Analysis of variance", frame=tests.anova, note=note))
    if tests.mixed_model is not None:
        note = "Linear mixed model of the means of participants, all effects crossed, with the random effects named below; Wald tests."
        parts.append(Table(name=f"mixed_model_{measure}", title="Mixed model", frame=tests.mixed_model, note=note))
    if tests.assumptions is not None and len(tests.assumptions):
        parts.append(Table(name=f"assumptions_{measure}", title="Assumptions", frame=tests.assumptions))
    return [*parts, *tests.notes]


# -- the figure of a measure

Source = tuple[str, Look, Any]
"""Means of a figure: whose they are, their look, and a `DataFrame` of them."""


@dataclass(frozen=True, kw_only=True)
class Layout:
    """What the axes, colours and panes of a figure show."""

    x: str
    curves: str | None
    panes: Sequence[str]
    averaged: Sequence[str]
    """Factors that the figure averages over."""
    levels: Mapping[str, Sequence[Any]]
    """The levels of factors, groups and curves."""

    @property
    def note(self) -> str:
        """What the note of a figure says of them."""
        return f" Averaged over: {', '.join(map(words, self.averaged))}." if self.averaged else ""


def layout_of(results: Results) -> Layout | None:
    """Returns the layout of the figures of an experiment: x is what values are numbered by, or else the factor with the most levels,
    numbers before texts; the groups, or the next factor, are curves; other factors are panes, as long as there are few. Returns None if
    there is nothing to lay out."""
    factors, levels = results.factors, {**results.all_factors, "group": results.groups}
    order = sorted(factors, key=lambda name: (name not in results.numbers, isinstance(factors[name][0], str), -len(factors[name])))
    left = [*order[1:]] if order else []
    if not order:
        return Layout(x="group", curves=None, panes=(), averaged=(), levels=levels) if results.by_group else None
    curves = "group" if results.by_group else left.pop(0) if left else None
    panes: list[str] = []
    while left and np.prod([len(factors[name]) for name in [*panes, left[0]]]) <= MAX_PANES:
        panes.append(left.pop(0))
    return Layout(x=order[0], curves=curves, panes=panes, averaged=left, levels=levels)


def figure_of(results: Results, measure: str, others: Sequence[ReferenceMeans]) -> tuple[Any, str]:
    """Returns the figure of a measure, and a note; `(None, "")` if there is only one cell."""
    layout = layout_of(results)
    if layout is None:
        return None, ""
    by = [name for name in (*layout.panes, layout.curves, layout.x) if name is not None]
    sources: list[Source] = [("model", "model", cell_means(results.rows, measure, by))]
    for one in others:
        sources.append((one.label, one.look, _averaged(one, measure, by, results)))  # noqa: PERF401 - pyright infers other types
    figure = _figure(results, layout, sources, results.name_with_unit(measure))
    return figure, f"Means of participants with 95 % bootstrap intervals.{layout.note}"


def _figure(results: Results, layout: Layout, sources: Sequence[Source], y_label: str, *, from_zero: bool = False) -> Any:
    """Returns a figure of means; `from_zero` is whether y begins at 0."""
    places, ticks = _axis(layout.levels[layout.x])
    panes: list[Pane] = []
    for cell in itertools.product(*(layout.levels[name] for name in layout.panes)):
        here = dict(zip(layout.panes, cell, strict=True))
        curves = [curve for source in sources for curve in _curves(source, here, layout, places)]
        title = ", ".join(f"{_named(name, level)}{_unit(results, name)}" for name, level in here.items())
        panes.append(Pane(title=title, curves=curves))
    return curves_figure(panes, results.name_with_unit(layout.x), y_label, ticks=ticks, from_zero=from_zero)


def _named(name: str, level: Any) -> str:
    """Returns a level with the name of its column; a group alone."""
    return str(level) if name == "group" else f"{words(name)} {plain_text(level)}"


def _axis(levels: Sequence[Any]) -> tuple[dict[Any, float], list[tuple[float, str]]]:
    """Returns the places of levels that are texts on an axis, and its ticks; none to choose them."""
    places: dict[Any, float] = {level: float(n) for n, level in enumerate(levels) if isinstance(level, str)}
    if all(isinstance(level, float) and level.is_integer() for level in levels) and len(levels) <= MAX_TICKS:
        return places, [(float(level), f"{level:g}") for level in levels]
    return places, [(place, str(level)) for level, place in places.items()]


def _curves(source: Source, here: Mapping[str, Any], layout: Layout, places: Mapping[Any, float]) -> list[Curve]:
    """Returns the curves of one source in one pane: one for each level, and one of the means over all levels."""
    label, look, frame = source
    name, found = layout.curves, list[Curve]()
    rows = [row for row in frame.to_dict("records") if all(missing(row[key]) or row[key] == level for key, level in here.items())]
    rows = [row for row in rows if not missing(row[layout.x])]
    for level in [None] if name is None else [*layout.levels[name], None]:
        of = [row for row in rows if name is None or (missing(row[name]) if level is None else row[name] == level)]
        points = sorted((float(places.get(row[layout.x], row[layout.x])), row["mean"], row["low"], row["high"]) for row in of)
        if points:
            x, y, low, high = (list(values) for values in zip(*points, strict=True))
            text = "" if name is None or level is None else _named(name, level)
            found.append(Curve(label=text, source=label, look=look, x=x, y=y, low=low, high=high))
    return found


def _averaged(reference: ReferenceMeans, measure: str, by: Sequence[str], results: Results) -> Any:
    """Returns the means of another source for a figure: those of cells that the figure averages over are averaged, without intervals."""
    rows = reference.of(measure)
    over = [name for name in ("group", *results.all_factors) if name not in by and rows[name].notna().any()]
    if not any(rows[name].nunique() > 1 for name in over):
        return rows
    means = rows.groupby(list(by), dropna=False, observed=True)["mean"].mean().reset_index()
    return means.assign(low=float("nan"), high=float("nan"))


def _unit(results: Results, name: str) -> str:
    unit = results.unit(name)
    return f" {unit}" if unit else ""

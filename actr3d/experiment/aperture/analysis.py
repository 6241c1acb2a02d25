"""The sections of a report on passing apertures: rotation, critical ratio, margins, bars, judgements, and the nine constraints.

The means of the original ACT-R 3D and the baseline, one line of geometry, are always shown beside the model.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from actr3d.experiment.aperture.constraints import CRITICAL, MARGIN, PASSABLE, SAME, Constraint, Findings
from actr3d.experiment.aperture.critical_ratio import CriticalRatio, bend, critical_ratio
from actr3d.experiment.aperture.original import original_bar_means, original_means
from actr3d.experiment.aperture.passing import TURNED, Passing, baseline_angle
from actr3d.experiment.report.analyses import analysis
from actr3d.experiment.report.figures import Curve, Look, Pane, curves_figure
from actr3d.experiment.report.libraries import pandas
from actr3d.experiment.report.parts import Caution, Part, Plot, Section, Table
from actr3d.experiment.report.reference_means import ReferenceMeans, matched_means, missing, without_failures
from actr3d.experiment.report.results import Results
from actr3d.experiment.report.statistics import bootstrap_interval, cell_means, in_order, rmse_and_r

Parts = list[Part]
ORIGINAL, GEOMETRY = "original ACT-R 3D", "geometry (baseline)"
BASELINE = (
    "Baseline: one line of geometry, which any model must beat: the angle at which an ellipse, as wide as the shoulders S and 0.563 S "
    "deep, leaves 0.30 S free in total."
)
ANGLE = "shoulder angle at the wall [degrees]"
OF_RATIO = "aperture / shoulder width (A/S)"
ASKED_TO_TURN = f"asked of a model: {CRITICAL[0]:g} to {CRITICAL[1]:g} (people: 1.28 to 1.31)"
ASKED_TO_PASS = f"asked of a model: {PASSABLE[0]:g} to {PASSABLE[1]:g} (people: about 1.16)"
OF_WALKS = ("aperture", "shoulder_width", "wall_angle_deg", "clearance_left_m", "clearance_right_m", "contacts", "outcome")
"""The columns that every experiment with walks through apertures has."""
NEEDED = ("participant", "group", *OF_WALKS, "condition", "peak_angle_deg", "bar", "start_aside", "start_heading")
"""The columns that a `Passing` is made of."""
BEYOND = "beyond: the value is most likely outside the ratios of the trials; it is then only a bound, and left out of all means."
SIDES_DIFFER = 0.001
"""Sides that differ by less than this in every trial are equal [m]."""


def passings_of(results: Results) -> list[Passing]:
    """Returns the trials of an experiment with apertures."""
    found: list[Passing] = []
    for given in results.rows[[name for name in NEEDED if name in results.rows]].to_dict("records"):
        row: dict[str, Any] = {name: None if missing(value) else value for name, value in given.items()}
        if row["shoulder_width"] is None:
            continue
        found.append(
            Passing(
                participant=row["participant"],
                group=row["group"],
                condition=row.get("condition") or "",
                aperture=row["aperture"],
                shoulders=row["shoulder_width"],
                angle=row["wall_angle_deg"] if row["wall_angle_deg"] is not None else row.get("peak_angle_deg"),
                left=row["clearance_left_m"],
                right=row["clearance_right_m"],
                contacts=int(row["contacts"] or 0),
                passed=row["outcome"] == "passed",
                bar=row.get("bar"),
                straight=not row.get("start_aside") and not row.get("start_heading"),
            )
        )
    return found


def frame_of(results: Results, findings: Findings) -> Any:
    """Returns a `DataFrame` of the trials without a wide bar that begin in line with the doorway; lengths are in cm."""
    plain = set(map(id, findings.plain))
    kept = [n for n, one in enumerate(findings.passings) if id(one) in plain]
    rows = results.rows[results.rows["shoulder_width"].notna()].iloc[kept]
    frame = rows[["participant", "group", "outcome", "contacts"]].reset_index(drop=True)
    frame["condition"] = [one.condition for one in findings.plain]
    frame["level"] = [findings.level(one) for one in findings.plain]
    frame["ratio"] = [one.ratio for one in findings.plain]
    frame["angle"] = np.array([one.angle for one in findings.plain], dtype=float)
    frame["turned"] = [one.turned for one in findings.plain]
    for name, column, scale in (
        ("logged", "logged_angle_deg", 1),
        ("left", "clearance_left_m", 100),
        ("right", "clearance_right_m", 100),
        ("onset", "onset_distance_m", 1),
        ("onset_time", "onset_time_s", 1),
        ("force", "max_force_n", 1),
    ):
        frame[name] = rows[column].to_numpy() * scale if column in rows else math.nan
    frame["narrower"] = frame[["left", "right"]].min(axis=1, skipna=False)
    return frame


@analysis(*OF_WALKS, people=("shoulder_width", "ratio"))
def passing_apertures(results: Results, others: Sequence[ReferenceMeans]) -> list[Section]:
    """Returns the sections on walking through apertures."""
    by = "aperture" if "aperture" in results.factors else "ratio"
    findings = Findings(passings_of(results), by)
    sections = [Section(title="Constraints on a model of people", parts=[_constraints(findings.all())])]
    frame = frame_of(results, findings)
    if len(findings.levels) > 1:
        rotation = Rotation(results, findings, frame, others)
        sections.append(Section(title="Rotation of the shoulders", parts=rotation.parts()))
        sections.append(Section(title="Critical ratio", parts=_critical_ratios(findings)))
        sections.append(Section(title="Margins, contacts and onset", parts=_margins(findings, frame)))
    if not all(one.straight for one in findings.passings):
        sections.append(Section(title="Starts beside the doorway or at an angle", parts=_starts(results)))
    if bars := findings.bar_angles():
        sections.append(Section(title="Bars in the hands", parts=_bars(bars)))
    if (left := len(findings.passings) - len(findings.plain)) and len(findings.levels) > 1:
        text = (
            f"{left:,} trials with a wide bar, or with a start beside the doorway or at an angle, are left out of the figures of rotation "
            "and margins."
        )
        sections[1] = Section(title=sections[1].title, parts=[Caution(text), *sections[1].parts])
    return sections


@analysis("judged", "passable", "ratio", "shoulder_width")
def judging_apertures(results: Results, others: Sequence[ReferenceMeans]) -> list[Section]:
    """Returns the sections on judging whether one could pass without turning."""
    pd, rows = pandas(), results.rows
    judged: list[list[tuple[float, bool]]] = []
    found: list[dict[str, Any]] = []
    for (group, participant), of in rows.groupby(["group", "participant"], sort=False, observed=True):
        answered = of[of["passable"].notna()]
        judged.append(list(zip(answered["ratio"].tolist(), (answered["passable"] < 0.5).tolist(), strict=True)))
        found.append({"group": group, "participant": participant, **_columns("boundary", critical_ratio(judged[-1]))})
    people = pd.DataFrame(found)
    constraints = Findings([]).all(judged=[answers for answers in judged if answers])
    means = cell_means(rows, "passable", ["group", "ratio"])
    curves: list[Curve] = []
    for group in results.groups:
        of = means[means["group"] == group]
        curves.append(_model_curve(group, of["ratio"].tolist(), of))
        curves += _curves_beside(others, "passable", {"group": group}, group, "ratio", 1.0)
    pane = Pane(title="", curves=curves, band=(*PASSABLE, ASKED_TO_PASS))
    figure = curves_figure([pane], OF_RATIO, "judged passable without turning [proportion]")
    parts: Parts = [
        Plot(name="judgements", title="Judged passable", figure=figure, note="Means of participants with 95 % bootstrap intervals."),
        Table(
            name="boundaries",
            title="Boundary of each participant",
            frame=people,
            note="boundary: the ratio at which half of the judgements are «can pass», by a logistic fit; low, high: 95 % interval of the "
            "profile likelihood, infinite where it goes beyond the ratios of the trials. " + BEYOND,
            digits={"boundary": 3, "low": 3, "high": 3},
        ),
    ]
    within: list[float] = people[people["beyond"] == "no"]["boundary"].dropna().tolist()
    if within:
        low, high = bootstrap_interval(within)
        parts.append(f"Mean boundary {float(np.mean(within)):.3f} (95 % interval over participants {low:.3f} to {high:.3f}).")
    parts += _left_out(people, "boundary")
    parts.append(
        "The boundary of the descriptive and of the replication variant is a parameter of the model (1.16, 1.139): only its spread follows "
        "from the noise of vision. The boundary of the predictive variant follows from its experience: it predicts the outcome of its most "
        "active memory."
    )
    return [
        Section(title="Constraints on a model of people", parts=[_constraints(constraints)]),
        Section(title="Judged passability", parts=parts),
    ]


def _constraints(constraints: Sequence[Constraint]) -> Table:
    words = {True: "met", False: "not met", None: "not decided"}
    rows = [{"number": str(one.number), "constraint": one.says, "result": words[one.met], "found": one.found} for one in constraints]
    note = (
        "As in the manual, «Human data and sources». Participants are the unit; the ratios of the fourth and the ninth are fitted to all "
        "trials, with intervals at least as wide as the spread between participants."
    )
    return Table(name="constraints", title="The nine constraints", frame=pandas().DataFrame(rows), note=note)


class Rotation:
    """The rotation of the shoulders: figures, means beside those of the original and of the baseline, and how well they agree.

    `findings` are the trials of the experiment, and `frame` is what `frame_of` returns for them.
    """

    def __init__(self, results: Results, findings: Findings, frame: Any, others: Sequence[ReferenceMeans]) -> None:
        self._results = results
        self._findings, self._others = findings, [with_greatest_angles(one, findings.by) for one in others]
        self._by_aperture = findings.by == "aperture"
        self._at_ratios = [at_own_ratios(one) for one in others] if self._by_aperture else []
        self._x_label = "aperture [cm]" if self._by_aperture else OF_RATIO
        self._frame = frame
        self._means = cell_means(frame, "angle", ["group", "condition", "level"])
        self._shoulders = {
            group: float(np.mean([one.shoulders for one in findings.plain if one.group == group])) for group in findings.groups
        }
        self._original = original_means() if self._by_aperture else {}

    def parts(self) -> Parts:
        """Returns the parts of the section."""
        findings, several = self._findings, len(self._findings.conditions) > 1
        note = "Means of participants with 95 % bootstrap intervals."
        panes = [self._pane(condition, [(group, group, condition) for group in findings.groups]) for condition in findings.conditions]
        parts: Parts = [BASELINE]
        figure = curves_figure(panes, self._x_label, ANGLE, from_zero=True)
        parts.append(
            Plot(
                name="rotation_by_aperture",
                title="Rotation by aperture" if self._by_aperture else "Rotation by A/S",
                figure=figure,
                note=note,
            )
        )
        if several:
            panes = [self._pane(group, [(name, group, name) for name in findings.conditions]) for group in findings.groups]
            figure = curves_figure(panes, self._x_label, ANGLE, from_zero=True)
            parts.append(Plot(name="rotation_by_speed", title="Rotation by speed", figure=figure, note=note))
        if self._by_aperture:
            panes = [self._ratio_pane(condition) for condition in findings.conditions]
            figure = curves_figure(panes, OF_RATIO, ANGLE, from_zero=True)
            without = any(one.look == "human" and not len(one.frame) for one in self._at_ratios) and self._people is not None
            left_out = " People are left out: their data have neither `shoulder_width` nor `ratio`." if without else ""
            parts.append(Plot(name="rotation_by_ratio", title="Rotation by A/S", figure=figure, note=note + left_out))
        parts += [self._cells(), self._fit(), *self._equivalence(), *self._aic()]
        if self._people is None:
            parts.append(
                "Human mean angles for each aperture were not found as numbers, so none are drawn; give data of your own with --human."
            )
        return parts

    @property
    def _people(self) -> Any:
        """The mean angles of people; None if there are none."""
        return next((means for one in self._others if one.look == "human" and len(means := one.of("wall_angle_deg"))), None)

    def _pane(self, title: str, cells: Sequence[tuple[str, str, str]]) -> Pane:
        """Returns a pane with curves, each given by its label, group and condition."""
        scale = 100.0 if self._by_aperture else 1.0
        curves: list[Curve] = []
        for label, group, condition in cells:
            of = self._means[(self._means["group"] == group) & (self._means["condition"] == condition)]
            x = (of["level"] * scale).tolist()
            curves.append(_model_curve(label, x, of))
            curves += self._original_curve(label, group, condition, 1.0)
            grid = np.linspace(self._findings.levels[0], self._findings.levels[-1], 200)
            ratio = grid / self._shoulders[group] if self._by_aperture else grid
            drawn = any(curve.look == "baseline" and curve.y == baseline_angle(ratio).tolist() for curve in curves)
            if not drawn:  # it is the same at all speeds
                shared = not self._by_aperture or len({g for _, g, _ in cells}) == 1
                y = baseline_angle(ratio).tolist()
                curves.append(Curve(label="" if shared else label, source=GEOMETRY, look="baseline", x=(grid * scale).tolist(), y=y))
            cell = {"group": group, "condition": condition}
            curves += _curves_beside(self._others, "wall_angle_deg", cell, label, self._findings.by, scale)
        return Pane(title=title, curves=curves)

    def _ratio_pane(self, condition: str) -> Pane:
        curves: list[Curve] = []
        for group in self._findings.groups:
            of = self._means[(self._means["group"] == group) & (self._means["condition"] == condition)]
            shoulders = self._shoulders[group]
            curves.append(_model_curve(group, (of["level"] / shoulders).tolist(), of))
            curves += self._original_curve(group, group, condition, 0.01 / shoulders)
            cell = {"group": group, "condition": condition}
            curves += _curves_beside(self._at_ratios, "wall_angle_deg", cell, group, "ratio", 1.0)
        ratios = [x for curve in curves for x in curve.x]
        grid = np.linspace(min(ratios), max(ratios), 200)
        curves.append(Curve(label="", source=GEOMETRY, look="baseline", x=grid.tolist(), y=baseline_angle(grid).tolist()))
        return Pane(title=condition, curves=curves, band=(*CRITICAL, ASKED_TO_TURN))

    def _original_curve(self, label: str, group: str, condition: str, scale: float) -> list[Curve]:
        cells = sorted((aperture, angle) for (g, c, aperture), angle in self._original.items() if (g, c) == (group, condition))
        x, y = [100 * aperture * scale for aperture, _ in cells], [angle for _, angle in cells]
        return [Curve(label=label, source=ORIGINAL, look="other", x=x, y=y)] if cells else []

    def _cells(self) -> Table:
        frame = self._means.copy()
        frame["original"], frame["baseline"] = self._original_of(frame), self._baseline(frame)
        frame = frame.rename(columns={"level": self._findings.by})
        if self._by_aperture:
            frame["ratio"] = frame["aperture"] / frame["group"].map(self._shoulders)
        if not self._original:
            frame = frame.drop(columns="original")
        units: dict[str, str] = dict.fromkeys(("mean", "sd", "low", "high", "original", "baseline"), "degrees")
        units["aperture"] = "m"
        note = "Angles at the wall; of trials that did not reach it, the greatest angle until then. "
        note += "sd: between participants; low, high: 95 % interval; n: participants; original: the original ACT-R 3D. "
        note += "ratio: the aperture divided by the group's mean shoulder width." if self._by_aperture else ""
        digits = dict.fromkeys(units, 1) | {"aperture": 2, "ratio": 2}
        return Table(name="rotation", title="Rotation of each cell", frame=frame, units=units, digits=digits, note=note, folded=True)

    def _original_of(self, cells: Any) -> list[float]:
        """Returns the original's mean angle of each cell [degrees]; NaN where there is none."""
        return [self._original.get((row["group"], row["condition"], row["level"]), math.nan) for row in cells.to_dict("records")]

    def _baseline(self, cells: Any) -> list[float]:
        """Returns the baseline's mean angle of each cell [degrees], from the shoulder widths of the participants."""
        ratios = self._frame.groupby(["group", "participant", "level"], observed=True)["ratio"].first().reset_index()
        ratios["angle"] = baseline_angle(ratios["ratio"].to_numpy())
        angles = ratios.groupby(["group", "level"], observed=True)["angle"].mean()
        return [float(angles[row["group"], row["level"]]) for row in cells.to_dict("records")]

    def _fit(self) -> Table:
        """Returns the agreement of model, original and baseline."""
        measure = "logged" if self._frame["logged"].notna().any() else "angle"
        logged = cell_means(self._frame, measure, ["group", "condition", "level"])
        logged["original"], logged["baseline"] = self._original_of(logged), self._baseline(logged)
        angles = self._means.assign(baseline=self._baseline(self._means))
        logged, angles = (self._whole(cells.rename(columns={"level": self._findings.by})) for cells in (logged, angles))
        note = "RMSE and correlation of the means of cells."
        if len(logged) < len(self._means):
            note += " Cells in which a trial failed are left out: what is left of them may be the easier trials."
        if logged["original"].notna().any():
            note += " The original's angle is the one it logged: torso plus clavicle."
        return _agreement("agreement", logged, angles, note, self._beside_people())

    def _whole(self, cells: Any) -> Any:
        """Returns the cells in which no trial failed."""
        return without_failures(cells, ["group", "condition", self._findings.by], [self._results])

    def _beside_people(self) -> Any:
        """Returns the mean angles of the cells that people have, too: `mean` of the model, `baseline` and `people` [degrees]."""
        if self._people is None:
            return None
        by = self._findings.by
        means = self._people[self._people[by].notna()]
        keys = [name for name in ("group", "condition", by) if name in means]
        trials = self._frame.rename(columns={"level": by}) if by != "ratio" else self._frame.assign(ratio=self._frame["level"])
        trials = trials.assign(baseline=baseline_angle(self._frame["ratio"].to_numpy()))
        trials = trials[trials["angle"].notna()]
        of_model, of_baseline = (matched_means(trials, measure, keys, means) for measure in ("angle", "baseline"))
        cells = of_model.assign(baseline=of_baseline["model"]).rename(columns={"model": "mean", "beside": "people"})
        return without_failures(cells, keys, [self._results])

    def _equivalence(self) -> Parts:
        test, pair = self._findings.ratio_test, self._findings.pair
        if test is None or pair is None:
            return []
        row = {"groups": f"{pair[1]} − {pair[0]}", "difference": test.difference, "bound": SAME, "df": test.df, "p": test.p}
        row["result"] = "equivalent" if test.p < 0.05 else "not shown to be equivalent"
        note = (
            "Two one-sided Welch t tests on the mean angle of each participant at the common ratios from 1.0 to 1.4. A small p says that "
            "the groups differ by less than the bound."
        )
        table = Table(
            name="equivalence",
            title="Do the groups coincide on A/S?",
            frame=pandas().DataFrame([row]),
            units={"difference": "degrees", "bound": "degrees"},
            digits={"difference": 2},
            note=note,
        )
        return [table, *test.notes]

    def _aic(self) -> Parts:
        if not self._by_aperture or self._findings.pair is None:
            return []
        means = self._frame.groupby(["group", "participant", "level"], observed=True)[["angle", "ratio"]].mean().reset_index().dropna()
        if means["level"].nunique() < 4:  # a parabola goes through the means of three
            return []
        rows: list[dict[str, Any]] = []
        for name, column in (("A/S", "ratio"), ("A", "level")):
            x, y = means[column].to_numpy(dtype=float), means["angle"].to_numpy(dtype=float)
            found: Any = np.polynomial.Polynomial.fit(x, y, 2)
            error = float(np.sum((y - found(x)) ** 2))
            if error <= 0:
                return []
            rows.append({"angle_depends_on": name, "aic": len(y) * math.log(error / len(y)) + 2 * 4})
        note = "Akaike's criterion of a quadratic regression of participants' mean angles on A/S, or on the aperture A; smaller is better."
        return [Table(name="aic", title="Ratio or width?", frame=pandas().DataFrame(rows), note=note, digits={"aic": 1})]


def with_greatest_angles(one: ReferenceMeans, by: str) -> ReferenceMeans:
    """Returns means to show beside those of the model, with angles of another experiment that are computed as the model's.

    These are the angles at the wall; for a walker that did not reach the wall, its greatest angle. Means of people are returned unchanged.
    """
    if one.results is None or not {by, *OF_WALKS} <= set(one.results.rows):
        return one
    findings = Findings(passings_of(one.results), by)
    means = cell_means(frame_of(one.results, findings), "angle", ["group", "condition", "level"])
    return replace(one, frame=means.rename(columns={"level": by}).assign(measure="wall_angle_deg"))


def at_own_ratios(one: ReferenceMeans) -> ReferenceMeans:
    """Returns mean angles at the wall to show by A/S: each at the mean ratio of the participants of its cell.

    The ratios are those of the trials; of people, `ratio`, or else the aperture divided by their `shoulder_width`. Without these, the
    frame is empty.
    """
    place = "aperture"
    if one.results is not None and set(OF_WALKS) <= set(one.results.rows):
        rows = frame_of(one.results, Findings(passings_of(one.results))).rename(columns={"level": "aperture"})
    elif one.trials is not None and "wall_angle_deg" in one.trials and not {"ratio", "shoulder_width"}.isdisjoint(one.trials):
        trials = one.trials
        own = trials["aperture"].astype("float64") / trials["shoulder_width"] if "shoulder_width" in trials else math.nan
        rows = trials.assign(angle=trials["wall_angle_deg"], ratio=trials["ratio"].fillna(own) if "ratio" in trials else own)
        place = place if rows["aperture"].notna().any() else "ratio"
    else:
        return replace(one, frame=one.frame.iloc[:0].assign(ratio=math.nan))
    rows = rows[rows["angle"].notna() & rows["ratio"].notna()]
    keys = [name for name in ("group", "condition", place) if name in rows and rows[name].notna().any()]
    ratios = cell_means(rows, "ratio", keys)["mean"]
    return replace(one, frame=cell_means(rows, "angle", keys).assign(ratio=ratios, measure="wall_angle_deg"))


def _curves_beside(others: Sequence[ReferenceMeans], measure: str, cell: dict[str, str], label: str, x: str, scale: float) -> list[Curve]:
    """Returns the means of people and of other experiments in a cell; those of all groups or conditions count for each of them."""
    found: list[Curve] = []
    for one in others:
        rows = one.of(measure)
        if x not in rows:
            continue
        for name, level in cell.items():
            rows = rows[(rows[name] == level) | rows[name].isna()] if name in rows else rows
        rows = rows[rows[x].notna()].sort_values(x)
        if len(rows):
            look: Look = "human" if one.look == "human" else "points"
            places, y = (rows[x].astype(float) * scale).tolist(), rows["mean"].tolist()
            low, high = rows["low"].tolist(), rows["high"].tolist()
            found.append(Curve(label=label, source=one.label, look=look, x=places, y=y, low=low, high=high))
    return found


def _agreement(name: str, cells: Any, own: Any, note: str = "", people: Any = None) -> Table:
    """Returns how well the mean angles of the model, of the original, of people and of the baseline agree.

    Args:
        name: The name of the table.
        cells: For each cell, `mean` of the model, `original`, and `baseline` [degrees].
        own: The cells in which the baseline is compared with the model.
        note: The note below the table.
        people: For each cell that people have, `mean` of the model, `baseline` and `people` [degrees]; None without people.
    """
    rows: list[dict[str, Any]] = []
    for what, other, frame, one, two in (
        ("this model", ORIGINAL, cells, "mean", "original"),
        (GEOMETRY, ORIGINAL, cells, "baseline", "original"),
        (GEOMETRY, "this model", own, "baseline", "mean"),
        ("this model", "people", people, "mean", "people"),
        (GEOMETRY, "people", people, "baseline", "people"),
    ):
        if frame is None:
            continue
        both = frame[frame[two].notna()]
        if len(both):
            rmse, r = rmse_and_r(both[one], both[two])
            rows.append({"means_of": what, "compared_with": other, "cells": len(both), "rmse": rmse, "r": r, "r2": r * r})
    frame, digits = pandas().DataFrame(rows), {"rmse": 2, "r": 3, "r2": 3}
    return Table(name=name, title="Agreement", frame=frame, units={"rmse": "degrees"}, digits=digits, note=note)


def _model_curve(label: str, x: Sequence[float], of: Any) -> Curve:
    low, high = of["low"].tolist(), of["high"].tolist()
    return Curve(label=label, source="this model", look="model", x=x, y=of["mean"].tolist(), low=low, high=high)


# -- critical ratio


def _critical_ratios(findings: Findings) -> Parts:
    rows: list[dict[str, Any]] = []
    for group in findings.groups:
        for condition in findings.conditions:
            for one in findings.participants(group):
                fits = _fits(findings.trials(group, condition, one), findings.curve(group, condition, one))
                rows.append({"group": group, "condition": condition, "participant": one, **fits})
    frame = pandas().DataFrame(rows)
    digits = {"critical_ratio": 3, "low": 3, "high": 3, "bend": 3}
    note = (
        f"Logistic: half of the trials are turned by more than {TURNED:g} degrees. low, high: 95 % interval of the profile likelihood, "
        f"infinite where it goes beyond the ratios of the trials; if the change is abrupt, the interval is one step between two apertures. "
        f"{BEYOND} Bend: piecewise-linear fit; it is too large for a rotation that falls more steeply near its end."
    )
    title = "Critical ratio of each participant"
    parts: Parts = []
    if (known := frame[frame["critical_ratio"].notna()]).size:
        panes = [_ratios_pane(known[known["condition"] == condition], condition, findings) for condition in findings.conditions]
        names = _places(findings)
        ticks = [(float(n), one.rpartition(" ")[2]) for one, n in names.items()] if len(names) <= 30 else [(0.0, "")]
        figure = curves_figure(panes, "participant", "critical ratio A/S", ticks=ticks)
        note_of_bars = "Bars: 95 % intervals of the profile likelihood; an interval without an end is not drawn."
        parts.append(Plot(name="critical_ratio", title=title, figure=figure, note=note_of_bars))
    parts.append(_critical_ratios_of_groups(frame))
    parts.append(Table(name="critical_ratios", title=title, frame=frame, note=note, digits=digits, folded=True))
    if len(known) < len(frame):
        parts.append(
            Caution(
                f"{len(frame) - len(known)} of {len(frame)} curves have no critical ratio: all of their trials are turned, or none is, or "
                "there are too few to say where turning begins."
            )
        )
    return [*parts, *_left_out(frame, "critical_ratio")]


def _critical_ratios_of_groups(frame: Any) -> Table:
    """Returns the means over the participants of each group and condition."""
    rows: list[dict[str, Any]] = []
    for (group, condition), of in frame.groupby(["group", "condition"], sort=False):
        values: list[float] = of[of["beyond"] == "no"]["critical_ratio"].dropna().tolist()
        low, high = bootstrap_interval(values)
        bends: list[float] = of["bend"].dropna().tolist()
        row = {"group": group, "condition": condition, "mean": float(np.mean(values)) if values else math.nan, "low": low, "high": high}
        rows.append({**row, "n": len(values), "mean_bend": float(np.mean(bends)) if bends else math.nan})
    note = "Means of participants with 95 % bootstrap intervals. People: 1.30 (1.28 to 1.31; Warren & Whang 1987)."
    digits: dict[str, int] = dict.fromkeys(("mean", "low", "high", "mean_bend"), 3)
    return Table(name="critical_ratios_of_groups", title="Critical ratio", frame=pandas().DataFrame(rows), note=note, digits=digits)


def _left_out(frame: Any, column: str) -> list[Caution]:
    """Returns a caution if some of the values of participants are only bounds."""
    beyond = frame[frame["beyond"] == "yes"]
    if not len(beyond):
        return []
    known = int(frame[column].notna().sum())
    text = (
        f"{len(beyond)} of {known} values are most likely beyond the ratios of the trials. They are left out of the means of participants, "
        "which are therefore not the means of all participants; wider or narrower apertures would show these values."
    )
    return [Caution(text)]


def _fits(of: Sequence[Passing], curve: tuple[list[float], list[float]]) -> dict[str, Any]:
    """Returns both fits of one participant at one speed."""
    logistic = critical_ratio((one.ratio, one.turned) for one in of)
    if logistic is not None and math.isinf(logistic.low) and math.isinf(logistic.high):
        logistic = None  # it may be anywhere
    line = bend(*curve)
    return {**_columns("critical_ratio", logistic), "bend": math.nan if line is None else line}


def _columns(name: str, ratio: CriticalRatio | None) -> dict[str, Any]:
    """Returns the columns of a critical ratio in a table; those of numbers are NaN without one."""
    if ratio is None:
        return {name: math.nan, "low": math.nan, "high": math.nan, "beyond": "no"}
    return {name: ratio.value, "low": ratio.low, "high": ratio.high, "beyond": "yes" if ratio.beyond else "no"}


def _places(findings: Findings) -> dict[str, int]:
    """Returns the place of each participant on the axis, also of those without a critical ratio."""
    return {one: n for n, one in enumerate(one for group in findings.groups for one in findings.participants(group))}


def _ratios_pane(rows: Any, condition: str, findings: Findings) -> Pane:
    places = _places(findings)
    curves: list[Curve] = []
    for group in findings.groups:
        of = rows[rows["group"] == group]
        x = [float(places[one]) for one in of["participant"]]
        low, high = of["low"].tolist(), of["high"].tolist()
        curves.append(Curve(label=group, source="this model", look="points", x=x, y=of["critical_ratio"].tolist(), low=low, high=high))
    return Pane(title=condition, curves=curves, level=(*CRITICAL, ASKED_TO_TURN))


# -- margins, contacts, onset


SIDES = {"left": "left", "right": "right", "narrower": "narrower side"}
"""The margins of a trial, and what figures call them; a walker that sways is nearer to the wall on one side, left or right by chance."""


def _margins(findings: Findings, frame: Any) -> Parts:
    pd, by, scale = pandas(), findings.by, 100.0 if findings.by == "aperture" else 1.0
    x_label = "aperture [cm]" if by == "aperture" else OF_RATIO
    parts, panes, of_people = list[Part](), list[Pane](), list[Any]()
    for group in findings.groups:
        for condition in findings.conditions:
            of = frame[(frame["group"] == group) & (frame["condition"] == condition)]
            curves: list[Curve] = []
            for side, label in SIDES.items():
                means = cell_means(of, side, ["level"])
                of_people.append(means.rename(columns={"level": by}).assign(group=group, condition=condition, side=label))
                curves.append(_model_curve(label, (means["level"] * scale).tolist(), means))
            band = (100 * MARGIN[0], 100 * MARGIN[1], "people keep 6 to 8 cm")
            panes.append(Pane(title=", ".join(filter(None, (group, condition))), curves=curves, level=band))
    figure = curves_figure(panes, x_label, "smallest distance to the wall [cm]", from_zero=True)
    note = "Means of participants with 95 % bootstrap intervals; the narrower side is that of each trial. "
    note += "At wide apertures, the distances depend on the aperture only."
    parts.append(Plot(name="margins", title="Margins on the left, on the right, and on the narrower side", figure=figure, note=note))
    people = pd.concat(of_people)[["group", "condition", "side", by, "mean", "sd", "low", "high", "n"]]
    units: dict[str, str] = {**dict.fromkeys(("mean", "sd", "low", "high"), "cm"), "aperture": "m"}
    digits = dict.fromkeys(units, 2) | {"ratio": 2}
    note = "The means of the figure. sd: between participants; low, high: 95 % interval; n: participants."
    title = "Margins of participants"
    parts.append(Table(name="margins_of_participants", title=title, frame=people, units=units, digits=digits, note=note, folded=True))
    there = frame[frame["left"].notna() & frame["right"].notna()]
    if len(there) and float((there["left"] - there["right"]).abs().max()) < 100 * SIDES_DIFFER:
        parts.append(Caution("Left and right are equal in every trial: this walker neither sways nor steers, which people do."))
    rows: list[dict[str, Any]] = []
    for (group, condition, level), of in there.groupby(["group", "condition", "level"], sort=False, observed=True):
        row: dict[str, Any] = {"group": group, "condition": condition, by: level, "trials": len(of)}
        for side in SIDES:
            sd = float(of[side].std(ddof=1)) if len(of) > 1 else math.nan
            row |= {f"{side}_mean": float(of[side].mean()), f"{side}_least": float(of[side].min()), f"{side}_sd": sd}
        rows.append({**row, "largest_difference": float((of["left"] - of["right"]).abs().max())})
    table = in_order(pd.DataFrame(rows), ["group", "condition", by], frame)
    of_sides = [name for name in table if name.startswith((*SIDES, "largest"))]
    units = {**dict.fromkeys(of_sides, "cm"), "aperture": "m"}
    digits = {**dict.fromkeys(of_sides, 1), "aperture": 2, "ratio": 2}
    note = "Means, least values and sd are of trials, not of participants; largest difference: between the sides of one trial."
    parts.append(Table(name="margins", title="Margins of each cell", frame=table, units=units, digits=digits, note=note, folded=True))
    return [*parts, _contacts(frame), *_onset(findings, frame, x_label, scale)]


def _contacts(frame: Any) -> Table:
    is_so = {**{name: frame["outcome"] == name for name in ("passed", "stopped", "declined")}, "touched": frame["contacts"] > 0}
    cells = frame.assign(**is_so).groupby(["group", "condition"], sort=False, observed=True)
    table = cells.agg(trials=("outcome", "size"), **{name: (name, "sum") for name in is_so}, max_force=("force", "max")).reset_index()
    note = "touched: trials with at least one contact; the force is the greatest of all."
    return Table(name="contacts", title="Contacts", frame=table, units={"max_force": "N"}, digits={"max_force": 1}, note=note)


def _onset(findings: Findings, frame: Any, x_label: str, scale: float) -> Parts:
    turned = frame[frame["onset"].notna() & frame["turned"]]
    if not len(turned):
        return ["No walker turned, so there is no onset."]
    means = cell_means(turned, "onset", ["group", "condition", "level"])
    panes: list[Pane] = []
    for condition in findings.conditions:
        curves: list[Curve] = []
        for group in findings.groups:
            of = means[(means["group"] == group) & (means["condition"] == condition)]
            if len(of):
                curves.append(_model_curve(group, (of["level"] * scale).tolist(), of))
        panes.append(Pane(title=condition, curves=curves))
    figure = curves_figure(panes, x_label, "distance from the wall at the onset [m]", from_zero=True)
    note = f"Of trials that turned by more than {TURNED:g} degrees. Means of participants with 95 % bootstrap intervals."
    table = means.rename(columns={"level": findings.by})
    units: dict[str, str] = dict.fromkeys(("mean", "sd", "low", "high", "aperture"), "m")
    digits = dict.fromkeys(units, 2)
    return [
        Plot(name="onset", title="Onset of the turn", figure=figure, note=note),
        Table(name="onset", title="Onset of each cell", frame=table, units=units, digits=digits, folded=True),
    ]


# -- starts


def _starts(results: Results) -> Parts:
    """Returns the figure and the table of walks that begin beside the doorway or at an angle."""
    rows = results.rows.copy()
    for name in ("start_aside", "start_heading"):
        rows[name] = rows[name].fillna(0.0) if name in rows else 0.0
    rows["passed"], rows["free"] = rows["outcome"] == "passed", (rows["outcome"] == "passed") & (rows["contacts"] == 0)
    by, wide = ["start_aside", "start_heading"], "aperture" in results.factors
    of_all = [("", rows)] if not wide else [(f"aperture {100 * width:g} cm", of) for width, of in rows.groupby("aperture")]
    panes: list[Pane] = []
    for title, of in of_all:
        means = cell_means(of, "passed", by)
        curves: list[Curve] = []
        for heading, cell in means.groupby("start_heading"):
            curves.append(_model_curve(f"{heading:g} degrees off", (100 * cell["start_aside"]).tolist(), cell))
        panes.append(Pane(title=title, curves=curves))
    figure = curves_figure(panes, "start beside the middle of the doorway [cm]", "passed [proportion]", from_zero=True)
    keys = ["aperture", *by] if wide else by
    table = cell_means(rows, "passed", keys)[[*keys, "mean", "n", "trials"]].rename(columns={"mean": "passed"})
    table["untouched"] = cell_means(rows, "free", keys)["mean"]
    for side in ("left", "right"):
        rows[side] = 100 * rows[f"clearance_{side}_m"]
        margins = cell_means(rows, side, keys).rename(columns={"mean": side})
        table = table.merge(margins[[*keys, side]], on=keys, how="left")
    units = {"start_aside": "m", "start_heading": "degrees", "left": "cm", "right": "cm", "aperture": "m"}
    digits = {"start_aside": 2, "start_heading": 0, "passed": 2, "untouched": 2, "left": 1, "right": 1, "aperture": 2}
    note = (
        "untouched: passed without a contact; left, right: mean of the smallest distances to the wall, of those that were in the doorway."
    )
    title = "Passing from starts beside the doorway or at an angle"
    return [
        Plot(name="starts", title=title, figure=figure, note="Means of participants with 95 % intervals."),
        Table(name="starts", title=title, frame=table, units=units, digits=digits, note=note),
    ]


# -- bars


def _bars(bars: dict[float, dict[float, dict[str, float]]]) -> Parts:
    """Returns the figure and the table of rotation with bars."""
    original = original_bar_means()
    curves, rows = list[Curve](), list[dict[str, Any]]()
    for ratio, lengths in bars.items():
        label = f"A / total width {ratio:g}"
        x, y, low, high = list(lengths), list[float](), list[float](), list[float]()
        for length, of in lengths.items():
            values = list(of.values())
            interval = bootstrap_interval(values)
            y.append(float(np.mean(values)) if values else math.nan)
            low.append(interval[0])
            high.append(interval[1])
            baseline = float(baseline_angle([ratio * length], length)[0])
            row = {"ratio": ratio, "bar": length, "mean": y[-1], "low": low[-1], "high": high[-1], "n": len(values)}
            rows.append({**row, "original": original.get((ratio, length), math.nan), "baseline": baseline})
        curves.append(Curve(label=label, source="this model", look="model", x=x, y=y, low=low, high=high))
        there = [(length, original[ratio, length]) for length in x if (ratio, length) in original]
        if there:
            curves.append(Curve(label=label, source=ORIGINAL, look="other", x=[a for a, _ in there], y=[b for _, b in there]))
        of_baseline = [row["baseline"] for row in rows if row["ratio"] == ratio]
        curves.append(Curve(label=label, source=GEOMETRY, look="baseline", x=x, y=of_baseline))
    figure = curves_figure([Pane(title="", curves=curves)], "bar [body widths; 1: not wider than the body]", ANGLE, from_zero=True)
    note = (
        "People turn less with a longer bar at the same ratio (Higuchi, Seya & Imanaka 2012); their mean angles are not at hand. Baseline: "
        "body and a thin bar turn together, and leave 0.30 S free in total."
    )
    frame = pandas().DataFrame(rows)
    parts: Parts = [Plot(name="bars", title="Rotation with a bar", figure=figure, note=note)]
    both = frame[frame["original"].notna() & frame["mean"].notna()]
    if frame["mean"].isna().any():
        parts.append(Caution("In some cells no walker set out, so there is no angle; see the outcomes below."))
    units = dict.fromkeys(("mean", "low", "high", "original", "baseline"), "degrees") | {"bar": "body widths"}
    digits: dict[str, int] = dict.fromkeys(("mean", "low", "high", "original", "baseline"), 1)
    parts.append(Table(name="bars", title="Rotation with a bar", frame=frame, units=units, digits=digits))
    if len(both) > 2:
        parts.append(_agreement("bar_agreement", both, both))
    return parts

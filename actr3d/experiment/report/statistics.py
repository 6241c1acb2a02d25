"""Statistics of experiments with participants as the unit: means, bootstrap intervals, analyses of variance, mixed models."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache
from itertools import combinations
from typing import Any

import numpy as np

from actr3d.experiment.report.libraries import mixedlm, noting_warnings, pandas, pingouin
from actr3d.experiment.report.results import Results

RESAMPLES = 4_000
"""The number of bootstrap samples."""
AT_ONCE = 1_000_000
"""The number of values of bootstrap samples that are drawn at a time: memory does not grow with the number of participants."""
SEED = 1987
"""The seed of the bootstrap; the same for every report."""
MIN_FOR_TESTS = 3
"""With fewer participants in a group, nothing is tested."""
MIN_FOR_BOOTSTRAP = 10
"""With fewer participants, bootstrap intervals are known to be too narrow."""
LEVEL = 0.05
"""The level of significance of the checks of assumptions."""
MAX_SHAPIRO = 5_000
"""The maximum number of participants that the test of Shapiro and Wilk takes; of more, some from all groups are taken."""
ROUNDING_ERROR = 1e-12
"""A standard deviation below this, relative to the values, is rounding."""
TOO_SMALL = f"the means differ by less than {ROUNDING_ERROR:g}, which counts as rounding; measure in a smaller unit"
"""Why a measure of which only the unit is too large is not tested."""
NO_SPREAD = 1e-6
"""Participants differ in an effect if the standard deviation of their differences is above this, relative to that of all means.
Analyses of variance subtract sums of squares, which have 15 to 16 digits: of smaller differences, nothing but rounding is left."""

CHECKS = ("assumption", "test", "statistic", "p", "holds")
"""The columns of the table of checks of assumptions."""
Check = tuple[str, str, float, float, str]
"""A row of it."""


def bootstrap_interval(values: Sequence[float]) -> tuple[float, float]:
    """Returns the 95 % percentile interval of the mean over bootstrap samples of participants; NaN for fewer than two."""
    given = np.asarray(values, dtype=float)
    given = given[np.isfinite(given)]
    return _bootstrapped(given.tobytes()) if len(given) > 1 else (float("nan"), float("nan"))


@lru_cache(maxsize=10_000)  # a report needs the interval of the same mean for its figure, its table, and each comparison
def _bootstrapped(values: bytes) -> tuple[float, float]:
    given = np.frombuffer(values)
    draw, n = np.random.default_rng([SEED, len(given)]), len(given)
    rows = max(1, AT_ONCE // n)
    counts = [min(rows, RESAMPLES - begin) for begin in range(0, RESAMPLES, rows)]
    means = np.concatenate([given[draw.integers(0, n, (count, n))].mean(axis=1) for count in counts])
    low, high = np.quantile(means, (0.025, 0.975))
    return float(low), float(high)


def participant_means(rows: Any, measure: str, by: Sequence[str]) -> Any:
    """Returns a `DataFrame` with the mean of each participant in each cell, `value`, and its number of trials, `trials`.

    Args:
        rows: The trials; those without a value are left out.
        measure: The column with the values.
        by: The columns whose values make a cell.
    """
    there = rows[rows[measure].notna()]
    keys = ["participant", *(["group"] if "group" in rows else []), *(name for name in by if name != "group")]
    return there.groupby(keys, sort=False, observed=True)[measure].agg(value="mean", trials="count").reset_index()


def cell_means(rows: Any, measure: str, by: Sequence[str]) -> Any:
    """Returns a `DataFrame` with a row for each cell: the mean of participants' means, with `sd`, `low`, `high`, `n` and `trials`.

    Args:
        rows: The trials.
        measure: The column with the values.
        by: The columns whose values make a cell; empty for one cell.
    """
    means = participant_means(rows, measure, by)
    cells = means.groupby(list(by), sort=False, observed=True) if by else [((), means)]
    found: list[dict[str, Any]] = []
    for key, cell in cells:
        values = cell["value"].to_numpy()
        low, high = bootstrap_interval(values)
        mean = float(values.mean()) if len(values) else float("nan")
        sd = float(np.std(values, ddof=1)) if len(values) > 1 else float("nan")
        row = {"mean": mean, "sd": sd, "low": low, "high": high, "n": len(values), "trials": int(cell["trials"].sum())}
        found.append({**dict(zip(by, key, strict=True)), **row})
    return in_order(pandas().DataFrame(found, columns=[*by, "mean", "sd", "low", "high", "n", "trials"]), by, rows)


def in_order(cells: Any, by: Sequence[str], rows: Any) -> Any:
    """Returns cells sorted by columns: numbers by size, texts in the order in which the rows have them, which is that of the design."""
    if not by or not len(cells):
        return cells

    def rank(column: Any) -> Any:
        if str(column.dtype).startswith(("float", "int")):
            return column
        return column.map({value: number for number, value in enumerate(dict.fromkeys(rows[column.name]))})

    return cells.sort_values(list(by), key=rank, kind="stable", ignore_index=True)


def rmse_and_r(found: Sequence[float], target: Sequence[float]) -> tuple[float, float]:
    """Returns the root mean square difference of two lists of means, and their correlation.

    Its sign must be shown, too: a model that falls where people rise has an r² of 1. The correlation is NaN for fewer than three means,
    and if those of one list are equal but for rounding.
    """
    one, other = np.asarray(found, dtype=float), np.asarray(target, dtype=float)
    rmse = float(np.sqrt(np.mean((one - other) ** 2)))
    if len(one) < 3 or any(np.ptp(means) <= ROUNDING_ERROR * np.abs(means).max() for means in (one, other)):
        return rmse, float("nan")
    return rmse, float(np.corrcoef(one, other)[0, 1])


@dataclass(frozen=True, kw_only=True)
class Tests:
    """The statistical tests of one measure; a table is None where the design does not allow it."""

    anova: Any
    mixed_model: Any
    assumptions: Any
    notes: Sequence[str]
    """What was not tested, and why; what a library warned of."""


def run_tests(results: Results, measure: str) -> Tests:
    """Runs the tests that the design allows on the means of participants."""
    pd, notes = pandas(), list[str]()
    factors = list(results.factors)
    grouped = len(results.groups) > 1
    means = participant_means(results.rows, measure, factors)
    cells = int(np.prod([len(levels) for levels in results.factors.values()]))
    whole = means[means.groupby("participant", observed=True)["value"].transform("size") == cells]
    lost = means["participant"].nunique() - whole["participant"].nunique()
    sizes = whole.drop_duplicates("participant")["group"].value_counts() if len(whole) else pd.Series(dtype=int)
    reason = ""
    if not grouped and not factors:
        reason = "the design has one group and no factor"
    elif len(means) > 1 and (spread := np.std(means["value"])) <= _rounding(means):
        reason = "all means are the same" if spread <= ROUNDING_ERROR * np.abs(means["value"]).max() else TOO_SMALL
    elif len(sizes) < len(results.groups) or sizes.min() < MIN_FOR_TESTS:
        reason = f"a group has fewer than {MIN_FOR_TESTS} participants with a value in every cell"
    if reason:
        return Tests(anova=None, mixed_model=None, assumptions=None, notes=[f"Not tested: {reason}."])
    if lost:
        who = "1 participant" if lost == 1 else f"{lost} participants"
        notes.append(f"Not part of the analysis of variance: {who} without a value in some cell.")
    if grouped and factors and sizes.nunique() > 1:
        counts = ", ".join(f"{name} {sizes[name]}" for name in results.groups)
        notes.append(
            f"The groups are of unequal size ({counts}). The analysis of variance has sums of squares of type II: "
            "in the effect of a factor, a group counts by its participants. The tests of the mixed model are of type III, "
            "as those of SPSS, jamovi and JASP: there all groups count the same. "
            "Both may differ where the groups differ in the effect of a factor."
        )
    anova: list[dict[str, Any]] = []
    checks: list[Check] = []
    mixed = None
    with noting_warnings() as warned:
        _analyse_variance(whole, results, anova, checks, notes)
        _check_assumptions(whole, factors, grouped, checks)
        if len(factors) + grouped > 1:
            if _spread(whole, factors) > _least_spread(whole):
                mixed = _mixed_model(means, factors, grouped, notes)
            else:
                notes.append("Not tested: the mixed model, because it leaves no residual beyond rounding.")
    if mixed is not None and sizes.min() < MIN_FOR_BOOTSTRAP:
        notes.append(
            f"With fewer than {MIN_FOR_BOOTSTRAP} participants in a group, the p values of the mixed model's Wald tests are "
            "too small, above all for the effect of group. Where the analysis of variance tests the same effect, prefer it."
        )
    # Of its attempts to fit, only the end matters: `_mixed_model` says if it is not known.
    notes += [f"Note of a library: {text}" for text in warned if "optimization" not in text]
    return Tests(
        anova=pd.DataFrame(anova) if anova else None, mixed_model=mixed, assumptions=pd.DataFrame(checks, columns=CHECKS), notes=notes
    )


def _analyse_variance(whole: Any, results: Results, anova: list[dict[str, Any]], checks: list[Check], notes: list[str]) -> None:
    """Adds the rows of all analyses of variance: one factor within participants at a time, and pairs of them.

    An effect in which participants do not differ is not tested: its F would be a number divided by rounding.
    """
    pg, factors, grouped = pingouin(), list(results.factors), len(results.groups) > 1
    least = _least_spread(whole)

    def differ(data: Any, within: Sequence[str], effects: Sequence[str]) -> bool:
        different = _spread(data, within) > least
        if not different:
            whose = "the participants of a group" if grouped else "participants"
            what = f"the effect of {' × '.join(within)}" if within else "their means"
            notes.append(f"Not tested: {', '.join(effects)}, because {whose} do not differ in {what} beyond rounding.")
        return different

    between = grouped and differ(_over(whole, []), [], ["group"])
    if not factors and between:
        found = pg.anova(data=_over(whole, []), dv="value", between="group")
        _add(anova, "between participants", found, {})
    for factor in factors:
        data, name = _over(whole, [factor]), f"group × {factor}"
        within = differ(data, [factor], [factor, name] if grouped else [factor])
        if not within and not between:
            continue
        if grouped:
            found = pg.mixed_anova(data=data, dv="value", within=factor, subject="participant", between="group", correction=True)
            found = found[[between if source == "group" else within for source in found["Source"]]]
            _add(anova, name, found, {"Interaction": name})
        else:
            found = pg.rm_anova(data=data, dv="value", within=factor, subject="participant", correction=True)
            _add(anova, factor, found, {})
        if within and (levels := len(results.factors[factor])) > 2:
            testable = data["participant"].nunique() - max(1, data["group"].nunique()) >= levels - 1
            _add_sphericity(checks, factor, found, testable=testable)
    for pair in combinations(factors, 2):
        data, both, (one, other) = _over(whole, pair), " × ".join(pair), pair
        if not grouped:
            if not differ(data, pair, [both]):
                continue
            found = pg.rm_anova(data=data, dv="value", within=[one, other], subject="participant", correction=True)
            found = found[found["Source"] == f"{one} * {other}"]  # the others are those of the single factors
            _add(anova, both, found, {f"{one} * {other}": both})
            continue
        if len(results.factors[one]) != 2:
            one, other = other, one
        levels = results.factors[one]
        if len(levels) != 2:
            notes.append(f"The interactions of {one} and {other} are in the mixed model only.")
            continue
        names = {other: both, "Interaction": f"group × {both}"}
        if not differ(data, pair, list(names.values())):
            continue
        # An interaction with a factor of two levels is an effect on the difference between them.
        wide = data.pivot(index=["participant", "group", other], columns=one, values="value")
        data = (wide[levels[1]] - wide[levels[0]]).rename("value").reset_index()
        found = pg.mixed_anova(data=data, dv="value", within=other, subject="participant", between="group", correction=True)
        found = found[found["Source"] != "group"]  # the analysis of this factor has the same test
        _add(anova, f"differences {_text(levels[1])} − {_text(levels[0])}", found, names)


def _rounding(means: Any) -> float:
    """Returns the standard deviation that is rounding of values."""
    return ROUNDING_ERROR * max(1.0, float(np.abs(means["value"]).max()))


def _least_spread(whole: Any) -> float:
    """Returns the standard deviation above which participants differ."""
    return max(_rounding(whole), NO_SPREAD * float(np.std(whole["value"])))


def _spread(data: Any, within: Sequence[str]) -> float:
    """Returns the standard deviation of the differences between participants by which an effect is tested.

    Args:
        data: A value of each participant in each cell of the factors.
        within: The factors of the effect; empty for that of group.
    """
    left = data["value"] - data.groupby(["group", *within], observed=True)["value"].transform("mean")
    for factor in within:
        cells = [data[name] for name in ("participant", *within) if name != factor]
        left = left - left.groupby(cells, observed=True).transform("mean")
    return float(np.std(left))


def _over(whole: Any, factors: Sequence[str]) -> Any:
    """Returns each participant's means over all factors but some."""
    return whole.groupby(["participant", "group", *factors], sort=True, observed=True)["value"].mean().reset_index()


def _add(anova: list[dict[str, Any]], of: str, found: Any, names: dict[str, str]) -> None:
    """Adds the rows of one analysis of variance under common names of columns."""
    for row in found.to_dict("records"):
        if row["Source"] == "Residual" or not np.isfinite(row.get("F", np.nan)):
            continue
        corrected = row.get("p_GG_corr")
        df1, df2 = row.get("DF1", row.get("ddof1")), row.get("DF2", row.get("ddof2"))
        anova.append(
            {
                "analysis": of,
                "effect": names.get(row["Source"], row["Source"]),
                "df1": df1,
                "df2": df2,
                "F": row["F"],
                "p": row["p_unc"],
                "p_corrected": corrected if corrected is not None else np.nan,
                "partial_eta_squared": row["F"] * df1 / (row["F"] * df1 + df2),
            }
        )


def _add_sphericity(checks: list[Check], factor: str, found: Any, *, testable: bool) -> None:
    """Adds the check of the sphericity of a factor.

    Args:
        checks: All checks.
        factor: The factor.
        found: The analysis of variance.
        testable: Whether the participants, without one for each group, are at least as many as the differences of levels. With fewer,
            the statistic is 0 but for rounding, and pingouin gives any p for it, also 1 or more; epsilon is still right.
    """
    row: dict[str, Any] = next((one for one in found.to_dict("records") if one["Source"] == factor), dict[str, Any]())
    p = row.get("p_spher", np.nan) if testable else np.nan
    holds = "yes" if p >= LEVEL else "no: use the corrected p (Greenhouse-Geisser)"
    if not np.isfinite(p):
        holds = f"cannot be tested with so few participants: use the corrected p (ε = {row.get('eps', np.nan):.2f})"
    checks.append((f"sphericity of {factor}", "Mauchly", row.get("W_spher", np.nan) if testable else np.nan, p, holds))


def _check_assumptions(whole: Any, factors: Sequence[str], grouped: bool, checks: list[Check]) -> None:
    """Adds the checks of normality, of participants' means and of their effects of each factor, and of equal variances of the groups."""
    pg, least = pingouin(), _least_spread(whole)
    scores = {"participants' means": _over(whole, [])}
    for factor in factors:
        effects = _over(whole, [factor])
        places = {level: number for number, level in enumerate(dict.fromkeys(whole[factor]))}
        # Rising along the levels, in their order; of two levels, it is half of their difference.
        effects["value"] *= effects[factor].map(places).astype(float) - (len(places) - 1) / 2
        scores[f"participants' trends over {factor}"] = _over(effects, [])
    for name, of in scores.items():
        residuals = (of["value"] - of.groupby("group", observed=True)["value"].transform("mean")).to_numpy()
        sample = residuals[:: -(-len(residuals) // MAX_SHAPIRO)]
        if len(sample) <= MIN_FOR_TESTS or np.std(sample) <= least:  # the test needs four
            continue
        found = pg.normality(sample).iloc[0]
        says = "yes" if found["pval"] >= LEVEL else "no: prefer the bootstrap intervals"
        checks.append((f"normality of {name}", "Shapiro-Wilk", found["W"], found["pval"], says))
    if grouped and _spread(_over(whole, []), []) > least:
        found = pg.homoscedasticity(_over(whole, []), dv="value", group="group").iloc[0]
        says = "yes" if found["pval"] >= LEVEL else "no: the groups differ in their spread"
        checks.append(("equal variances of groups", "Levene", found["W"], found["pval"], says))


def _mixed_model(means: Any, factors: Sequence[str], grouped: bool, notes: list[str]) -> Any:
    """Returns the Wald tests of a linear mixed model; None if it cannot be fitted.

    Participants differ at random in their mean, and in their effects of each factor, and of each interaction but that of all factors,
    which is the residual: as in an analysis of variance, an effect is tested by how much it varies between participants.
    """
    names = [*(["group"] if grouped else []), *factors]
    short = {name: f"f{number}" for number, name in enumerate(names)}
    data = means[["participant", "value", *names]].rename(columns=short)
    terms = " * ".join(f"C({name}, Sum)" for name in short.values())
    varied = [of for size in range(1, len(factors)) for of in combinations(factors, size)]
    effects = {f"participant × {' × '.join(of)}": "0 + " + ":".join(f"C({short[name]})" for name in of) for of in varied}
    try:
        fitted = mixedlm()(f"value ~ {terms}", data, groups=data["participant"], re_formula="1", vc_formula=effects or None).fit(reml=True)
        tests = fitted.wald_test_terms(scalar=True).table
    except (np.linalg.LinAlgError, ValueError) as error:
        notes.append(f"The mixed model cannot be fitted: {error}.")
        return None
    found: list[dict[str, Any]] = []
    for term, row in tests.iterrows():
        if term == "Intercept":
            continue
        used = re.findall(r"C\((f\d+), Sum\)", str(term))
        back = {code: name for name, code in short.items()}
        found.append(
            {"effect": " × ".join(back[code] for code in used), "chi2": row["statistic"], "df": row["df_constraint"], "p": row["pvalue"]}
        )
    variances = dict(zip(fitted.model.exog_vc.names if effects else (), fitted.vcomp, strict=True))
    deviating = {"participants": float(np.asarray(fitted.cov_re).ravel()[0]), **variances, "residual": float(fitted.scale)}
    deviations = ", ".join(f"{name} {float(np.sqrt(max(0.0, variance))):.3g}" for name, variance in deviating.items())
    notes.append(
        f"Mixed model: standard deviations of random effects: {deviations}. It assumes that effects vary between participants by the same "
        "amount at all levels of a factor (sphericity): where that does not hold, prefer the corrected p of the analysis of variance."
        + ("" if fitted.converged else " The fit did not converge: where the analysis of variance tests the same effect, prefer it.")
    )
    return pandas().DataFrame(found)


def _text(level: float | str) -> str:
    return level if isinstance(level, str) else f"{level:g}"

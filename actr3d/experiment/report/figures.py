"""Figures of reports: curves with intervals in panels, and their SVG and PNG files.

Figures are made without pyplot, so that nothing is kept between two of them. The same data give the same files. Colours are those of
Okabe & Ito (2008), which colour-blind readers can distinguish; each also has its own marker.
"""

from __future__ import annotations

import io
import math
import re
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import Any, Literal

from actr3d.experiment.report.libraries import matplotlib

INK, MUTED, GRID, PAPER = "#1b2430", "#5b6675", "#dde2e8", "#fffffe"
COLOURS = ("#0072b2", "#c44e00", "#007a5e", "#a3528f", "#8a6d00", "#3f7fbf")
MARKERS = ("o", "s", "^", "D", "v", "P")
VARIABLES = {INK: "--ink", MUTED: "--muted", GRID: "--line", PAPER: "--paper"} | {c: f"--c{n}" for n, c in enumerate(COLOURS)}
"""Colours that the page replaces by variables of its style, which differ between light and dark."""
STYLE: dict[str, Any] = {
    "font.family": "DejaVu Sans",
    "font.size": 10,
    "text.color": INK,
    "text.parse_math": False,  # a dollar sign in a name is one
    "axes.edgecolor": MUTED,
    "axes.labelcolor": INK,
    "axes.titlesize": 10.5,
    "axes.titleweight": "bold",
    "axes.titlelocation": "left",
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.grid": True,
    "axes.axisbelow": True,
    "grid.color": GRID,
    "grid.linewidth": 0.8,
    "xtick.color": MUTED,
    "ytick.color": MUTED,
    "xtick.labelcolor": INK,
    "ytick.labelcolor": INK,
    "figure.facecolor": PAPER,
    "axes.facecolor": PAPER,
    "savefig.facecolor": PAPER,
    "legend.frameon": False,
    "legend.fontsize": 9.5,
    "svg.fonttype": "none",
    "svg.hashsalt": "actr3d",
}
SCALE = 1.53
"""The size of figures on the page [CSS pixels per point]: texts in them are then nearly as large as those of tables."""
Look = Literal["model", "points", "human", "other", "baseline"]
"""`model`: the experiment of the report; `points`: the same without a line; `human`: people;
`other`: another experiment or model; `baseline`: what any model must beat."""
LONGEST_TEXT = 60
"""The maximum length of a title, tick or label of a figure [characters]; of a longer one, beginning and end are shown."""
END = 20
"""The characters of that end."""
CHARACTERS, ROOM_OF_HANDLE = 13, 6
"""How many characters of a legend fit into an inch, and how many take the room of a line with its marker."""
ROOM_OF_MARKER = 0.025
"""The room that a marker needs above the highest value, relative to the height of the axes."""
NEAREST = 0.8
"""Intervals beside each other take at most this part of the distance between two levels, so that none is nearer to another level."""
ROUNDING = 1e-9
"""Values that differ by less than this, relative to the greatest, are drawn as equal."""
LOOKS: dict[str, dict[str, Any]] = {
    "model": {"linestyle": "-", "linewidth": 1.8, "markersize": 5.5},
    "points": {"linestyle": "none", "markersize": 6},
    "human": {"linestyle": "none", "markersize": 8.5, "markeredgewidth": 1.6, "hollow": True},
    "other": {"linestyle": "--", "linewidth": 1.2, "markersize": 5.5, "markeredgewidth": 1.2, "hollow": True},
    "baseline": {"linestyle": ":", "linewidth": 1.6, "marker": ""},
}


@dataclass(frozen=True, kw_only=True)
class Curve:
    """Values over x, with intervals."""

    label: str
    """What its colour means, such as a group; empty for all groups together."""
    source: str
    """Whose values they are, such as `model` or `original ACT-R 3D`."""
    look: Look
    x: Sequence[float]
    y: Sequence[float]
    low: Sequence[float] | None = None
    high: Sequence[float] | None = None


@dataclass(frozen=True, kw_only=True)
class Pane:
    """One pair of axes."""

    title: str
    curves: Sequence[Curve]
    band: tuple[float, float, str] | None = None
    """A band of x that is shaded, and what it is."""
    level: tuple[float, float, str] | None = None
    """A band of y that is shaded, and what it is."""


def curves_figure(
    panes: Sequence[Pane], x_label: str, y_label: str, *, ticks: Sequence[tuple[float, str]] = (), from_zero: bool = False
) -> Any:
    """Returns a figure with a row of panes that share their axes.

    Args:
        panes: The panes.
        x_label: The name of x, with its unit.
        y_label: The name of y, with its unit.
        ticks: Places on x with their texts; empty to choose them, or for the only place that there is.
        from_zero: Whether y begins at 0.
    """
    places = {x for pane in panes for curve in pane.curves for x in curve.x}
    if not ticks and len(places) == 1:
        ticks = [(x, f"{x:g}") for x in places]
    labels = list(dict.fromkeys(curve.label for pane in panes for curve in pane.curves if curve.label))
    columns = min(len(panes), 2)
    rows = math.ceil(len(panes) / columns)
    figure = new_figure(8.6 if columns > 1 else 6.4, 0.7 + 3.1 * rows)
    with matplotlib().rc_context(STYLE):
        axes = figure.subplots(rows, columns, sharex=True, sharey=True, squeeze=False)
        for place, ax in enumerate(axes.flat):
            if place >= len(panes):
                ax.remove()
                continue
            pane = panes[place]
            ax.set_title(_short(pane.title))
            _shade(ax, pane)
            for curve in pane.curves:
                _draw(ax, curve, labels.index(curve.label) if curve.label else None, len(labels))
            if ticks:
                ax.set_xticks([at for at, _ in ticks], [_short(text) for _, text in ticks])
            if place + columns >= len(panes):
                ax.set_xlabel(x_label)
                ax.tick_params(labelbottom=True)
            if place % columns == 0:
                ax.set_ylabel(y_label)
        _limit_y(axes.flat[0], panes, from_zero=from_zero)
        _legend(figure, panes, labels)
    return figure


def _limit_y(ax: Any, panes: Sequence[Pane], *, from_zero: bool) -> None:
    """Sets the limits of y, which all panes share: differences that are rounding stay invisible, and no marker is cut."""
    curves = [curve for pane in panes for curve in pane.curves]
    drawn = [float(y) for curve in curves for some in (curve.y, curve.low or (), curve.high or ()) for y in some if math.isfinite(y)]
    low, high = ax.get_ylim()
    if drawn and 0 < max(drawn) - min(drawn) < ROUNDING * max(map(abs, drawn)) and not any(pane.level for pane in panes):
        middle = max(drawn)
        low, high = middle - 0.05 * abs(middle), middle + 0.05 * abs(middle)
    if from_zero:
        low = min(0.0, low)
        if drawn:
            high = max(high, max(drawn) + ROOM_OF_MARKER * (max(drawn) - low))
    ax.set_ylim(low, high)


def new_figure(width: float, height: float) -> Any:
    """Returns an empty figure in the style of reports; its size is in inches."""
    with matplotlib().rc_context(STYLE):
        return matplotlib("figure").Figure(figsize=(width, height), layout="constrained")


def _shade(ax: Any, pane: Pane) -> None:
    for shade, band in ((ax.axvspan, pane.band), (ax.axhspan, pane.level)):
        if band is not None:
            shade(*band[:2], color=MUTED, alpha=0.16, linewidth=0)


def _marker(number: int) -> str:
    """Returns the marker of a label: where colours begin again, other markers go with them."""
    return MARKERS[(number + number // len(COLOURS)) % len(MARKERS)]


def _style(look: str, colour: str, marker: str) -> dict[str, Any]:
    """Returns the style of a line of matplotlib."""
    style = dict(LOOKS[look])
    face = PAPER if style.pop("hollow", False) else colour
    return {"color": colour, "marker": marker, "markerfacecolor": face, "markeredgecolor": colour, **style}


def _draw(ax: Any, curve: Curve, number: int | None, of: int) -> None:
    colour = INK if number is None else COLOURS[number % len(COLOURS)]
    style = _style(curve.look, colour, "D" if number is None else _marker(number))
    x = list(curve.x)
    if curve.look == "model" and number is not None and of > 1 and len(x) > 1:  # intervals of two curves must not cover each other
        gap = min((after - before for before, after in pairwise(sorted(set(x)))), default=0)
        step = min(0.012 * (max(x) - min(x)), NEAREST * gap / (of - 1))
        x = [value + step * (number - (of - 1) / 2) for value in x]
    ax.plot(x, curve.y, zorder=2 if curve.look in ("baseline", "other") else 3, **style)
    if curve.low is not None and curve.high is not None:
        solid = [n for n in range(len(x)) if math.isfinite(curve.low[n]) and math.isfinite(curve.high[n])]
        lower, upper = [curve.low[n] for n in solid], [curve.high[n] for n in solid]
        ax.vlines([x[n] for n in solid], lower, upper, color=colour, linewidth=1.3, zorder=2.5)


def _legend(figure: Any, panes: Sequence[Pane], labels: Sequence[str]) -> None:
    """Adds the legend above the panes: a colour for each label, a style for each source."""
    line = matplotlib("lines").Line2D
    patch = matplotlib("patches").Patch
    handles: list[Any] = []
    for number, label in enumerate(labels):
        style = _style("model", COLOURS[number % len(COLOURS)], _marker(number))
        handles.append(line([], [], label=_short(label), **style))
    curves = [curve for pane in panes for curve in pane.curves]
    sources = {(one.source, one.look): bool(one.label) for one in sorted(curves, key=lambda one: bool(one.label))}
    if len(sources) > 1:
        for source, name in dict.fromkeys((one.source, one.look) for one in curves):
            style = _style(name, INK, "o" if sources[source, name] else "D")
            handles.append(line([], [], label=_short(source), **style))
    bands = dict.fromkeys(band[2] for pane in panes for band in (pane.band, pane.level) if band is not None)
    handles += [patch(facecolor=MUTED, alpha=0.25, linewidth=0, label=text) for text in bands]
    if handles:
        columns = legend_columns([len(str(handle.get_label())) for handle in handles], figure.get_figwidth())
        figure.legend(handles=handles, loc="outside upper left", ncols=columns, borderaxespad=0.2, columnspacing=1.6, handlelength=2.2)


def legend_columns(lengths: Sequence[int], width: float) -> int:
    """Returns the greatest number of columns of a legend that fits into a figure.

    Args:
        lengths: The lengths of its labels [characters]; a column is filled before the next one.
        width: The width of the figure [inches].
    """
    for columns in range(len(lengths), 1, -1):
        rows = math.ceil(len(lengths) / columns)
        widest = [max(lengths[first : first + rows]) + ROOM_OF_HANDLE for first in range(0, len(lengths), rows)]
        if sum(widest) <= CHARACTERS * width:
            return len(widest)
    return 1


def _save(figure: Any, out: Any, **options: Any) -> None:
    with matplotlib().rc_context(STYLE):
        layout = figure.get_layout_engine()
        if layout is not None:  # laid out once for all formats
            layout.execute(figure)
            figure.set_layout_engine(None)
        figure.savefig(out, **options)


def png(figure: Any) -> bytes:
    """Returns a figure as a PNG file."""
    out = io.BytesIO()
    _save(figure, out, format="png", dpi=160, metadata={"Software": None})
    return out.getvalue()


def svg(figure: Any) -> str:
    """Returns a figure as an SVG file, whose texts are texts."""
    out = io.StringIO()
    _save(figure, out, format="svg", metadata={"Date": None, "Creator": None})
    return out.getvalue()


def inline_svg(text: str, name: str, title: str) -> str:
    """Returns an SVG file as an element of a page: with the colours of the page, and ids of its own.

    Args:
        text: The file.
        name: A name that no other figure of the page has.
        title: Its name for readers who do not see it.
    """
    body = text[text.index("<svg") :]
    for colour, variable in VARIABLES.items():
        body = body.replace(colour, f"var({variable})")
    body = re.sub(r"<metadata>.*?</metadata>\s*|<defs>\s*<style.*?</defs>\s*", "", body, flags=re.DOTALL)
    body = re.sub(r"\bid=\"", f'id="{name}-', body)
    body = re.sub(r"url\(#", f"url(#{name}-", body)
    body = re.sub(r"href=\"#", f'href="#{name}-', body)
    body = re.sub(r"font: ((?:bold |\d+ )*)([\d.]+)px [^;\"]*", r"font-size: \2px; font-weight: \1", body)
    body = re.sub(r"; font-weight: (?=[;\"])|font-family: [^;\"]*;? ?", "", body)
    label = title.replace("&", "&amp;").replace("<", "&lt;").replace('"', "&quot;")
    box = re.search(r"<svg [^>]*?viewBox=\"(\S+ \S+ (\S+) \S+)\"[^>]*>", body)
    if box is None:
        return body
    wide = round(float(box[2]) * SCALE)
    return f'<svg viewBox="{box[1]}" style="max-width: {wide}px" role="img" aria-label="{label}">{body[box.end() :]}'


def _short(text: str) -> str:
    """Returns a text, or the beginning and the end of a long one: names often differ at one of them."""
    return text if len(text) <= LONGEST_TEXT else f"{text[: LONGEST_TEXT - END]}...{text[-END:]}"

"""The page of a report: one HTML file without scripts, whose figures are part of it."""

from __future__ import annotations

import html
import itertools
import math
import re
from collections.abc import Mapping, Sequence
from typing import Any
from urllib.parse import quote

from actr3d.experiment.report.figures import inline_svg
from actr3d.experiment.report.parts import Caution, Part, Plot, Section, Table
from actr3d.experiment.report.results import name_with_unit

MADE_BY = '<meta name="generator" content="actr3d report">'
"""The line by which a page is known to be a report."""
FOLDED = 40
"""A table with more rows is folded."""
CSS = """
:root { color-scheme: light dark; --paper: light-dark(#ffffff, #14181f); --ink: light-dark(#1b2430, #e6eaf0);
  --muted: light-dark(#5b6675, #9aa6b5); --line: light-dark(#dde2e8, #2d3541); --soft: light-dark(#f4f6f9, #1b212a);
  --link: light-dark(#1f5fc4, #8fbcff); --caution: light-dark(#8a4b00, #ffc266); --caution-paper: light-dark(#fff6e5, #2c2415);
  --good: light-dark(#007a5e, #2fd0a5); --bad: light-dark(#b3261e, #ff8a80);
  --c0: light-dark(#0072b2, #56b4e9); --c1: light-dark(#c44e00, #ff8c42); --c2: light-dark(#007a5e, #2fd0a5);
  --c3: light-dark(#a3528f, #e29fd6); --c4: light-dark(#8a6d00, #e0c04c); --c5: light-dark(#3f7fbf, #9cc7f5); }
* { box-sizing: border-box; }
body { margin: 0; background: var(--paper); color: var(--ink);
  font: 16px/1.55 system-ui, -apple-system, "Segoe UI", "DejaVu Sans", sans-serif; }
main { max-width: 62rem; margin: 0 auto; padding: 2.5rem 1.5rem 5rem; }
h1 { font-size: 1.9rem; line-height: 1.2; margin: 0 0 .3rem; overflow-wrap: anywhere; }
h2 { font-size: 1.35rem; margin: 3rem 0 .8rem; padding-top: 1rem; border-top: 1px solid var(--line); }
h3 { font-size: 1rem; margin: 1.8rem 0 .4rem; }
p { margin: .5rem 0; max-width: 48rem; }
a { color: var(--link); }
.lead { color: var(--muted); }
.facts { display: grid; grid-template-columns: repeat(auto-fit, minmax(9rem, 1fr)); gap: .8rem; margin: 1.5rem 0; }
.facts div { background: var(--soft); border-radius: 8px; padding: .7rem 1rem; }
.facts dt { color: var(--muted); font-size: .85rem; }
.facts dd { margin: 0; font-size: 1.3rem; font-weight: 600; font-variant-numeric: tabular-nums; }
nav { margin: 1rem 0; } nav ul { list-style: none; padding: 0; display: flex; flex-wrap: wrap; gap: .2rem 1.2rem; margin: 0; }
.caution { background: var(--caution-paper);
  border-left: 3px solid var(--caution); padding: .5rem 1rem; margin: .8rem 0; border-radius: 0 6px 6px 0; }
.caution::before { content: "Note "; font-weight: 600; color: var(--caution); }
figure { margin: .4rem 0 1.8rem; } .files { font-size: .85rem; margin: .2rem 0; }
.files a { margin-right: .4rem; } figcaption, .note { color: var(--muted); font-size: .9rem; max-width: 48rem; }
.plot { overflow-x: auto; } .plot svg { display: block; width: 100%; min-width: 34rem; height: auto; }
.plot text { font-family: system-ui, -apple-system, "Segoe UI", "DejaVu Sans", sans-serif; }
.plot * { stroke-linejoin: round; stroke-linecap: butt; }
.scroll { overflow-x: auto; margin: .4rem 0; }
table { border-collapse: collapse; font-size: .88rem; font-variant-numeric: tabular-nums; }
th, td { padding: .28rem .8rem .28rem 0; text-align: left; vertical-align: top; border-bottom: 1px solid var(--line); }
th { font-weight: 600; color: var(--muted); vertical-align: bottom; } td.number, th.number { text-align: right; white-space: nowrap; }
td.good { color: var(--good); font-weight: 600; } td.bad { color: var(--bad); font-weight: 600; }
td.short { white-space: nowrap; } td.text { max-width: 34rem; overflow-wrap: break-word; }
details { margin: .6rem 0; } summary { cursor: pointer; padding: .25rem 0; color: var(--link); }
details.section { border-top: 1px solid var(--line); margin: 0; padding: .35rem 0; }
details.section > summary { font-weight: 600; color: var(--ink); }
details.section[open] { padding-bottom: 1.2rem; }
code { font-size: .9em; } pre { background: var(--soft); padding: .8rem 1rem; overflow-x: auto; border-radius: 6px; font-size: .82rem; }
@media print { :root { color-scheme: light !important; } nav { display: none; } }
"""
ROUNDING = 1e-12
"""Smaller numbers are shown as 0."""
MET = {"met": "good", "not met": "bad"}
"""Texts of cells that are coloured."""


SHORT = 16
"""Texts of cells up to this length are not broken into lines."""


def page(title: str, lead: str, facts: Mapping[str, str], sections: Sequence[Section], drawings: Mapping[str, str]) -> str:
    """Returns the page.

    Args:
        title: Its title.
        lead: The paragraph below it.
        facts: Numbers at the top, by what they count.
        sections: Its sections.
        drawings: The SVG files of the figures by name.
    """
    ids = distinct([_id(section.title) for section in sections])
    opened = [(section, name) for section, name in zip(sections, ids, strict=True) if not section.folded]
    links = "".join(f'<li><a href="#{name}">{_text(section.title)}</a></li>' for section, name in opened)
    tiles = "".join(f"<div><dt>{_text(name)}</dt><dd>{_text(value)}</dd></div>" for name, value in facts.items())
    body = "\n".join(_section(section, name, drawings) for section, name in zip(sections, ids, strict=True))
    return (
        f'<!doctype html>\n<html lang="en">\n<head>\n<meta charset="utf-8">\n<meta name="viewport" content="width=device-width">\n'
        f"{MADE_BY}\n<title>{_text(title)}</title>\n<style>{CSS}</style>\n</head>\n<body>\n<main>\n"
        f'<h1>{_text(title)}</h1>\n<p class="lead">{_text(lead)}</p>\n<dl class="facts">{tiles}</dl>\n'
        f'<nav aria-label="Contents"><ul>{links}</ul></nav>\n{body}\n</main>\n</body>\n</html>\n'
    )


def distinct(names: Sequence[str]) -> list[str]:
    """Returns names in which each that differs from an earlier one in capital letters at most has a number added."""
    used: set[str] = set()
    found: list[str] = []
    for name in names:
        different = (f"{name}_{number}" for number in itertools.count(2))
        new = next(one for one in itertools.chain([name], different) if one.casefold() not in used)
        used.add(new.casefold())
        found.append(new)
    return found


def _section(section: Section, name: str, drawings: Mapping[str, str]) -> str:
    parts = "\n".join(_part(part, drawings) for part in section.parts)
    if section.folded:
        return f'<details class="section" id="{name}"><summary>{_text(section.title)}</summary>\n{parts}\n</details>'
    return f'<section id="{name}">\n<h2>{_text(section.title)}</h2>\n{parts}\n</section>'


def _part(part: Part, drawings: Mapping[str, str]) -> str:
    match part:
        case str():
            return f"<p>{_with_code(part)}</p>"
        case Caution():
            return f'<div class="caution">{_with_code(part.text)}</div>'
        case Plot():
            drawing = inline_svg(drawings[part.name], quote(part.name).replace("%", "-"), part.title)
            links = f'<a href="figures/{quote(part.name)}.svg">SVG</a> <a href="figures/{quote(part.name)}.png">PNG</a>'
            return (
                f'<h3>{_text(part.title)}</h3>\n<figure>\n<div class="plot">{drawing}</div>\n'
                f'<figcaption>{_text(part.note)} <span class="files">{links}</span></figcaption>\n</figure>'
            )
        case Table():
            return _table(part)


def _table(table: Table) -> str:
    frame, shown = table.frame, [name for name in table.frame.columns if name not in table.hidden]
    kinds = {name: str(frame[name].dtype) for name in shown}
    numeric = {name for name, kind in kinds.items() if kind.startswith(("int", "float"))}
    heads = "".join(f'<th scope="col"{" class=number" if name in numeric else ""}>{_text(_head(name, table))}</th>' for name in shown)
    rows = "\n".join(
        "<tr>" + "".join(_cell(name, value, numeric, table) for name, value in row.items()) + "</tr>"
        for row in frame[shown].to_dict("records")
    )
    link = f'<p class="files"><a href="tables/{quote(table.name)}.csv">CSV</a></p>'
    note = f'<p class="note">{_text(table.note)}</p>' if table.note else ""
    body = f'{note}<div class="scroll"><table>\n<thead><tr>{heads}</tr></thead>\n<tbody>\n{rows}\n</tbody>\n</table></div>\n'
    if table.folded or len(frame) > FOLDED:
        rows_text = "1 row" if len(frame) == 1 else f"{len(frame)} rows"
        return f"<details><summary>{_text(table.title)} ({rows_text})</summary>\n{body}{link}</details>"
    return f"<h3>{_text(table.title)}</h3>\n{body}{link}"


def _head(name: str, table: Table) -> str:
    """Returns the name of a column with its unit; degrees are short there, because many columns have them.

    A factor with the name of another column (`n_`, see `factor_name`) is called a factor.
    """
    shown = table.heads.get(name, f"factor {name[:-1]}" if name.endswith("_") else name)
    return name_with_unit(shown, table.units.get(name, "")).replace("[degrees]", "[°]")


def _cell(name: str, value: Any, numeric: set[str], table: Table) -> str:
    if name in numeric:
        return f'<td class="number">{_text(number(value, table.digits.get(name), p=name.partition("_")[0] == "p"))}</td>'
    text = "" if value is None or (isinstance(value, float) and math.isnan(value)) else str(value)
    kind = MET.get(text, "short" if len(text) <= SHORT else "text")
    return f'<td class="{kind}">{_text(text)}</td>'


def number(value: float, digits: int | None = None, *, p: bool = False) -> str:
    """Returns a number as text: with a number of decimals, or three significant digits; a dash if there is none.

    Args:
        value: The number.
        digits: The number of decimals; None for three significant digits.
        p: Whether it is a probability of a test.
    """
    value = 0.0 if abs(value) < ROUNDING else value
    if not math.isfinite(value):
        return "–" if math.isnan(value) else "∞" if value > 0 else "−∞"
    if p:
        return "< 0.001" if value < 0.001 else f"{value:.3f}"
    if digits is not None:
        text = f"{value:,.{digits}f}"
    elif value == int(value) and abs(value) < 1e15:
        text = f"{value:,.0f}"
    else:
        text = f"{value:.3g}" if abs(value) < 1000 else f"{value:,.0f}"
    return text.replace("-", "−") if float(text.replace(",", "")) != 0 else text.replace("-", "")


def _with_code(text: str) -> str:
    """Returns a text in which what is between backticks is shown as code."""
    return re.sub(r"`([^`]+)`", r"<code>\1</code>", _text(text))


def _text(text: str) -> str:
    return html.escape(text, quote=True)


def _id(title: str) -> str:
    return "".join(letter if letter.isalnum() else "-" for letter in title.lower())

"""The HTML log: a table with a row for each moment and a column for each thing that was logged."""

from __future__ import annotations

import html
from pathlib import Path
from typing import Any
from zlib import crc32

STYLE = """
:root { color-scheme: light dark; }
body { font: 14px/1.4 system-ui, sans-serif; margin: 1.5rem; }
table { border-collapse: collapse; margin-bottom: 1.5rem; }
th { position: sticky; top: 0; background: #222; color: #fff; padding: .3rem .6rem; text-align: left; }
td { border: 1px solid #8886; padding: .2rem .6rem; vertical-align: top; }
td.time { background: #333; color: #fff; text-align: right; font-variant-numeric: tabular-nums; }
td.yes { background: #bfe8bf; color: #063; } td.no { background: #f6cccc; color: #800; }
td.value { background: hsl(var(--hue) 70% 86%); color: #111; }
"""


def _cell(value: Any, rows: int) -> str:
    """Returns a table cell; equal texts have equal colours."""
    span = f' rowspan="{rows}"' if rows > 1 else ""
    text = "" if value is None or value == "None" else str(value)
    words = [f"<i>{html.escape(w.split(':', 1)[0])}:</i>{html.escape(w.split(':', 1)[1])}" if ":" in w else html.escape(w) for w in text.split(" ")]
    shown = " ".join(words)
    if text in ("True", "False"):
        return f'<td class="{"yes" if text == "True" else "no"}"{span}>{shown}</td>'
    if not text or isinstance(value, (int, float)):
        return f"<td{span}>{shown}</td>"
    return f'<td class="value" style="--hue:{crc32(text.encode()) % 360}"{span}>{shown}</td>'


def html_page(rows: list[tuple[float, str, Any]], title: str) -> str:
    """Returns the page for log lines (time [s], key, value); what never changes stands in a table of its own below."""
    columns: dict[str, list[tuple[int, Any]]] = {}
    for index, (_, key, value) in enumerate(rows):
        columns.setdefault(key, []).append((index, value))
    changing = sorted(key for key, values in columns.items() if len(values) > 1)
    fixed = sorted(key for key, values in columns.items() if len(values) == 1)
    # One row for each moment, and a further one wherever a column changes again within that moment.
    moments: list[tuple[float, dict[str, Any]]] = []
    for time, key, value in rows:
        if key not in changing:
            continue
        if not moments or moments[-1][0] != time or key in moments[-1][1]:
            moments.append((time, {}))
        moments[-1][1][key] = value
    cells: list[list[str]] = [[] for _ in moments]
    for key in (None, *changing) if moments else ():
        starts = [i for i, (t, now) in enumerate(moments) if i == 0 or (key in now if key else t != moments[i - 1][0])]
        for start, end in zip(starts, [*starts[1:], len(moments)], strict=True):
            if key is None:
                span = f' rowspan="{end - start}"' if end - start > 1 else ""
                cells[start].append(f'<td class="time"{span}>{moments[start][0]:1.3f}</td>')
            else:
                cells[start].append(_cell(moments[start][1].get(key), end - start))
    head = "".join(f"<th>{html.escape(key)}</th>" for key in ("time", *changing))
    body = "\n".join(f"<tr>{''.join(row)}</tr>" for row in cells)
    below = "\n".join(f"<tr><td>{html.escape(key)}</td>{_cell(columns[key][0][1], 1)}</tr>" for key in fixed)
    return (
        f'<!doctype html>\n<html lang="en"><head><meta charset="utf-8"><title>{html.escape(title)}</title><style>{STYLE}</style></head>'
        f"<body>\n<table><tr>{head}</tr>\n{body}\n</table>\n<table>{below}</table>\n</body></html>\n"
    )


def write_html(path: Path, rows: list[tuple[float, str, Any]]) -> None:
    """Writes the page to a file."""
    path.write_text(html_page(rows, path.name), encoding="utf-8")

"""Log files of Python ACT-R: last values as text, and an HTML table with a row for each moment and a column for each key."""

from __future__ import annotations

import html
from pathlib import Path
from typing import Any
from zlib import crc32

from actr3d.actr.kernel.log import LOG

STYLE = """
:root { color-scheme: light dark; --paper: #fff; --ink: #1b1b1b; --line: #d5d5d5; --head: #24303c; --time: #eef1f4;
  --yes: #d3efd3; --yes-ink: #064a1e; --no: #f8dada; --no-ink: #7a0d0d; --light: 90%; }
@media (prefers-color-scheme: dark) {
  :root { --paper: #16191d; --ink: #e4e6e8; --line: #363c43; --head: #2c3a48; --time: #20262c;
    --yes: #163d22; --yes-ink: #a9e5b8; --no: #4a1c1c; --no-ink: #f3b8b8; --light: 22%; } }
body { font: 14px/1.45 system-ui, sans-serif; margin: 1.25rem; background: var(--paper); color: var(--ink); }
h1 { font-size: 1.05rem; margin: 0 0 .75rem; overflow-wrap: anywhere; }
.scroll { overflow: auto; max-height: 85vh; max-width: 100%; width: fit-content; border: 1px solid var(--line); margin-bottom: 1.5rem; }
table { border-collapse: separate; border-spacing: 0; }
th, td { border: solid var(--line); border-width: 0 1px 1px 0; padding: .2rem .6rem; text-align: left; vertical-align: top; }
th { background: var(--head); color: #fff; white-space: nowrap; }
thead th { position: sticky; top: 0; z-index: 2; }
thead th:first-child, td.time { position: sticky; left: 0; }
thead th:first-child { z-index: 3; }
td { max-width: 40ch; overflow-wrap: break-word; }
td.time { z-index: 1; white-space: nowrap; background: var(--time); text-align: right; font-variant-numeric: tabular-nums; }
td.yes { background: var(--yes); color: var(--yes-ink); }
td.no { background: var(--no); color: var(--no-ink); }
td.value { background: hsl(var(--hue) 45% var(--light)); }
td i { opacity: .75; }
"""


def _word(word: str) -> str:
    """Returns a word as HTML, with the slot's name of `slot:value` in italics."""
    slot, colon, value = word.partition(":")
    return f"<i>{html.escape(slot)}:</i>{html.escape(value)}" if colon else html.escape(word)


def _cell(value: Any, rows: int) -> str:
    """Returns a table cell; equal texts have equal colours."""
    span = f' rowspan="{rows}"' if rows > 1 else ""
    text = "" if value is None or value == "None" else str(value)
    shown = " ".join(_word(word) for word in text.split(" "))
    if text in ("True", "False"):
        return f'<td class="{"yes" if text == "True" else "no"}"{span}>{shown}</td>'
    if not text or isinstance(value, (int, float)):
        return f"<td{span}>{shown}</td>"
    return f'<td class="value" style="--hue:{crc32(text.encode(errors="backslashreplace")) % 360}"{span}>{shown}</td>'


def html_page(rows: list[tuple[float, str, Any]], title: str) -> str:
    """Returns the page for log lines (time [s], key, value), with a separate table below for values that never change."""
    columns: dict[str, list[tuple[int, Any]]] = {}
    for index, (_, key, value) in enumerate(rows):
        columns.setdefault(key, []).append((index, value))
    changing = sorted(key for key, values in columns.items() if len(values) > 1)
    fixed = sorted(key for key, values in columns.items() if len(values) == 1)
    # One row for each moment, and another whenever a column changes again within that moment.
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
    below = "\n".join(f"<tr><th>{html.escape(key)}</th>{_cell(columns[key][0][1], 1)}</tr>" for key in fixed)
    tables = [f"<thead><tr>{head}</tr></thead>\n<tbody>\n{body}\n</tbody>"] if changing else []
    tables += [f"<tbody>\n{below}\n</tbody>"] if fixed else []
    return (
        '<!doctype html>\n<html lang="en"><head><meta charset="utf-8"><meta name="viewport" content="width=device-width, initial-scale=1">'
        f"<title>{html.escape(title)}</title><style>{STYLE}</style></head>\n<body>\n<h1>{html.escape(title)}</h1>\n"
        + "".join(f'<div class="scroll" tabindex="0"><table>\n{table}\n</table></div>\n' for table in tables)
        + "</body></html>\n"
    )


def write_html(path: Path, rows: list[tuple[float, str, Any]]) -> None:
    """Writes the page to a file."""
    path.write_text(html_page(rows, path.name), encoding="utf-8", errors="backslashreplace")


def finished(flush: bool = True) -> None:  # noqa: ARG001 - as models call it
    """Writes the files that the log's settings request, and starts a new log."""
    if LOG:
        if LOG.do_summary:
            LOG.display_all()
        if LOG.do_data:
            data = {**LOG.data, "time": LOG.time} if LOG.time > 0 else LOG.data
            lines = [f"{key}={data[key]}\n" for key in sorted(data)]
            LOG.file(".data").write_text("".join(lines), encoding="utf-8", errors="backslashreplace")
        if LOG.do_html:
            write_html(LOG.file(".html"), LOG.rows)
    LOG.reset()
    if LOG.announce:
        print("end...")  # noqa: T201 - the log's own output

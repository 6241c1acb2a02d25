"""Tells whether a file that does not compile is written for Python 2, and by what one sees it."""

from __future__ import annotations

import re

_SIGNS: tuple[tuple[re.Pattern[str], str], ...] = (
    (re.compile(r"^\s*print\s+[^(=\s]|^\s*print\s+\(.*\)\s*[%,]|[:;]\s*print\s+[\"'\w]|^\s*print\s*>>"), "a print statement"),
    (re.compile(r"^\s*except\s+[\w.()\s,]+,\s*\w+\s*:"), "'except Error, name'"),
    (re.compile(r"^\s*raise\s+[\w.]+\s*,"), "'raise Error, text'"),
    (re.compile(r"^\s*raise\s+[\"'].*,"), "'raise text'"),
    (re.compile(r"^\s*exec\s+[^(=\s]"), "an exec statement"),
    (re.compile(r"<>"), "the operator <>"),
    (re.compile(r"`[^`]+`"), "backquotes"),
    (re.compile(r"\b0[0-7]+\b(?![.\w])"), "an octal number without 0o"),
    (re.compile(r"\b\d+[lL]\b"), "a long number"),
    (re.compile(r"\b[uU][rR][\"']"), "a ur'' text"),
    (re.compile(r"^\s*def\s+\w+\([^)]*\([^)]*\)[^)]*\)\s*:|lambda\s*\("), "a tuple parameter"),
)


def python_2_reason(source: str, error: SyntaxError) -> tuple[int, str] | None:
    """Returns the line at which a file is seen to be Python 2, and the sign; None where nothing tells.

    Args:
        source: The file's text.
        error: What Python 3 says of it.
    """
    lines = source.splitlines()
    number = error.lineno or 0
    # The line Python 3 stopped at, or the one before, where a statement's end was missed.
    for line in (number, number - 1):
        if 0 < line <= len(lines):
            text = _without_comment(lines[line - 1])
            for sign, reason in _SIGNS:
                if sign.search(text):
                    return line, reason
    if isinstance(error, TabError):
        return number, "tabs and spaces mixed in its indentation"
    return None


def _without_comment(line: str) -> str:
    """Cuts a line's comment off, where it has no text that could contain a '#'."""
    return line if '"' in line or "'" in line else line.split("#", 1)[0]

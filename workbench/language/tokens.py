"""Splits Python code, which may be incomplete, into tokens."""

from __future__ import annotations

import re
import sys
from collections.abc import Iterator
from dataclasses import dataclass

from parso.python.tokenize import tokenize
from parso.utils import parse_version_string

_VERSION = parse_version_string(f"{sys.version_info[0]}.{sys.version_info[1]}")
_QUOTE = re.compile(r"(\w*)('''|\"\"\"|'|\")")
_STATEMENTS = ("class", "def", "import", "@")
"""Tokens that begin a statement at the start of a line, whatever is still open before them."""


@dataclass(frozen=True, slots=True)
class CodeToken:
    """A name, a text, a sign, or anything else in code."""

    kind: str
    """`name`, `text` (the inside of a string, or a part of an f-string), `sign`, `end` of a statement, or `other`."""
    text: str
    start: int
    line: int
    column: int
    first: bool
    """Whether it is the first on its line."""

    @property
    def end(self) -> int:
        """Where it ends."""
        return self.start + len(self.text)

    @property
    def begins_statement(self) -> bool:
        """Whether a statement begins here even if a bracket is still open."""
        return self.first and self.text in _STATEMENTS


def tokens_of(code: str) -> Iterator[CodeToken]:
    """Yields the tokens of some code."""
    at = skipped = seen = 0
    for token in tokenize(code, version_info=_VERSION):
        at += len(token.prefix)
        start, at = at, at + len(token.string)
        if start < skipped or not token.string:
            continue
        (line, column), kind = token.start_pos, token.type.name
        first, seen = line != seen, line
        if kind == "ERRORTOKEN" and token.string[-1] in "'\"":  # a string without its end: the rest of the line is its text
            skipped = code.find("\n", start)
            skipped = len(code) if skipped < 0 else skipped
            yield CodeToken("text", code[at:skipped], at, line, column, first)
        elif kind == "STRING":
            quote = _QUOTE.match(token.string)
            assert quote is not None
            inside = token.string[quote.end() : -len(quote[2])]
            yield CodeToken("other" if "b" in quote[1].lower() else "text", inside, start + quote.end(), line, column, first)
        else:
            names = {"NAME": "name", "FSTRING_STRING": "text", "OP": "sign", "NEWLINE": "end"}
            yield CodeToken(names.get(kind, "other"), token.string, start, line, column, first)


def line_of(text: str, at: int) -> int:
    """Returns the line of a position in a text, counted from 1."""
    return text.count("\n", 0, at) + 1

"""Recognizes Python 2 in a file that does not compile, and names the sign of it."""

from __future__ import annotations

import ast
import re

PYTHON_2_NAMES = frozenset(
    {
        "xrange",
        "raw_input",
        "unicode",
        "unichr",
        "long",
        "basestring",
        "cmp",
        "execfile",
        "reduce",
        "file",
        "iteritems",
        "itervalues",
        "iterkeys",
        "has_key",
        "izip",
        "imap",
        "ifilter",
        "cPickle",
        "cStringIO",
        "StringIO",
        "Tkinter",
        "tkMessageBox",
        "Queue",
        "ConfigParser",
        "urllib2",
        "sets",
        "commands",
    }
)
"""Names of Python 2 that do not exist in Python 3; a file that compiles may still use them."""

_SIGNS: tuple[tuple[re.Pattern[str], str], ...] = (
    (re.compile(r"^\s*print\s+[^(=\s]|^\s*print\s+\(.*\)\s*[%,]|[:;]\s*print\s+[\"'\w]|^\s*print\s*>>"), "a print statement"),
    (re.compile(r"^\s*except\s+[\w.()\s,]+,\s*\w+\s*:"), "'except Error, name'"),
    (re.compile(r"^\s*raise\s+[\w.]+\s*,"), "'raise Error, text'"),
    (re.compile(r"^\s*raise\s+[\"'].*,"), "'raise text'"),
    (re.compile(r"^\s*exec\s+[^(=\s]"), "an exec statement"),
    (re.compile(r"<>"), "the operator <>"),
    (re.compile(r"`[^`]+`"), "backquotes"),
    (re.compile(r"\b0[0-7]+\b(?![.\w])"), "an octal number without 0o"),
    (re.compile(r"\b(\d+|0[xX][0-9a-fA-F]+)[lL]\b"), "a long number"),
    (re.compile(r"\b[uU][rR][\"']"), "a ur'' text"),
    (re.compile(r"^\s*def\s+\w+\([^)]*\([^)]*\)[^)]*\)\s*:|lambda\s*\("), "a tuple parameter"),
)


LONGEST = 1000
"""The maximum length of a line that is searched [characters]: no sign needs more, and nested brackets make the search slow."""


def python_2_reason(source: str, error: SyntaxError) -> tuple[int, str] | None:
    """Returns the first line that shows a file to be Python 2, and the sign; None if there is no sign.

    Args:
        source: The file's text.
        error: The error of Python 3.
    """
    lines = [line[:LONGEST] for line in _without_texts(source).split("\n")]
    number = error.lineno or 0
    # The line of the error, or the one before, if the end of a statement is missing.
    for line in (number, number - 1):
        if 0 < line <= len(lines):
            for sign, reason in _SIGNS:
                if sign.search(lines[line - 1]):
                    return line, reason
    statement = re.match(r"Missing parentheses in call to '(print|exec)'", error.msg)
    if statement is not None:
        return number, f"{'an' if statement[1] == 'exec' else 'a'} {statement[1]} statement"
    if isinstance(error, TabError):
        return number, "tabs and spaces mixed in its indentation"
    return None


def print_to(tree: ast.Module) -> int | None:
    """Returns the line of the first `print >> file, ...`, which Python 3 compiles but cannot run; None if there is none.

    Ignores code under a test of Python's version, and files that define their own `print`.
    """
    found: list[int] = []
    waiting: list[ast.AST] = [tree]
    while waiting:
        node = waiting.pop()
        if _gives_name(node, "print"):
            return None
        if isinstance(node, ast.If) and "version" in ast.unparse(node.test).lower():
            continue
        if isinstance(node, ast.Expr):
            first = node.value.elts[0] if isinstance(node.value, ast.Tuple) and node.value.elts else node.value
            if (
                isinstance(first, ast.BinOp)
                and isinstance(first.op, ast.RShift)
                and isinstance(first.left, ast.Name)
                and first.left.id == "print"
            ):
                found.append(node.lineno)
        waiting.extend(ast.iter_child_nodes(node))
    return min(found, default=None)


def _gives_name(node: ast.AST, name: str) -> bool:
    """Returns whether a node binds a name."""
    if isinstance(node, ast.Name):
        return node.id == name and not isinstance(node.ctx, ast.Load)
    own = (getattr(node, "name", None), getattr(node, "arg", None), getattr(node, "asname", None))
    return name in own


_QUIET = re.compile(r"#[^\n]*|(\"\"\"|\'\'\')[\s\S]*?\1|([\"\'])(?:\\.|(?!\2)[^\n\\])*\2")


def _without_texts(source: str) -> str:
    """Removes the contents of comments and strings, which may contain anything, and keeps the line breaks."""

    def emptied(found: re.Match[str]) -> str:
        quote = found[1] or found[2] or ""
        return f"{quote}{chr(10) * found[0].count(chr(10))}{quote}"

    return _QUIET.sub(emptied, source)

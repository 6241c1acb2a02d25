"""No rule of one panel's styles reaches into another panel: what several share stands in style.css, all else below a class of its own."""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path

import pytest

from workbench import page_files
from workbench.shipped import static

VENDOR = static() / "vendor"
SHARED = static() / "style.css"
FRAME = static() / "scene" / "view.css"
"""The styles of the 3D view, which is a page of its own in a frame: no panel is there."""
SCOPED = sorted(path for path in static().rglob("*.css") if VENDOR not in path.parents and path not in (SHARED, FRAME))
MODULES = sorted(path for path in static().rglob("*.js") if VENDOR not in path.parents)
ROOT = re.compile(r"[a-z]*\.([A-Za-z][\w-]*)")
"""What a rule outside all others may select: one class, perhaps of one kind of element."""


def rules(text: str) -> Iterator[tuple[str, str]]:
    """Yields the rules of a style sheet that lie in no other one: what is before the brace, and what is between the braces."""
    text = re.sub(r"/\*.*?\*/", "", text, flags=re.DOTALL)
    depth, start, head = 0, 0, ""
    for found in re.finditer(r"""[{};]|"[^"]*"|'[^']*'""", text):
        sign = found[0]
        if sign == "{":
            if depth == 0:
                head, start = text[start : found.start()].strip(), found.end()
            depth += 1
        elif sign == "}":
            depth -= 1
            assert depth >= 0, f"there is a brace too many after «{head}»"
            if depth == 0:
                yield head, text[start : found.start()]
                start = found.end()
        elif sign == ";" and depth == 0:
            if text[start : found.start()].strip():
                yield text[start : found.start()].strip(), ""
            start = found.end()
    assert depth == 0, f"a brace is missing after «{head}»"
    assert not text[start:].strip(), text[start:]


def leaks(text: str) -> list[str]:
    """Returns what a style sheet has that could reach beyond its roots."""
    found = [f"«{head}» is below no class" for head, _ in rules(text) if not all(ROOT.fullmatch(part.strip()) for part in head.split(","))]
    inside = [head for _, body in rules(text) for head in nested(body)]
    found += [f"«{head}» is known everywhere" for head in inside if re.match(r"@(?!container|media|supports)", head)]
    # `& .x` is below the root; `.x &` begins outside of it.
    return found + [f"«{head}» begins outside its root" for head in inside for part in head.split(",") if "&" in part.strip()[1:]]


def nested(body: str) -> Iterator[str]:
    """Yields what is before each brace inside a rule, at any depth."""
    for match in re.finditer(r"([^{};]*)\{", re.sub(r"""/\*.*?\*/|"[^"]*"|'[^']*'""", "", body, flags=re.DOTALL)):
        yield match[1].strip()


def roots(path: Path) -> set[str]:
    """Returns the classes below which the rules of a file lie."""
    heads = (part.strip() for head, _ in rules(path.read_text(encoding="utf-8")) for part in head.split(","))
    return {found[1] for head in heads if (found := ROOT.fullmatch(head)) is not None}


def classes(text: str) -> set[str]:
    """Returns the classes that a module of the page gives to elements."""
    given = re.findall(r'class=(?:"([^"]*)"|(\$\{[^}]*\}))', text)
    return {word for parts in given for part in parts for word in re.findall(r"(?<![\w-])[A-Za-z][\w-]*", part)}


@pytest.mark.parametrize("path", SCOPED, ids=lambda path: path.name)
def test_all_rules_of_a_panel_lie_below_a_class_of_its_own(path: Path) -> None:
    assert leaks(path.read_text(encoding="utf-8")) == []
    own = roots(path)
    assert own
    for other in {*SCOPED, SHARED} - {path}:
        assert own.isdisjoint(roots(other)), f"{other.name} has rules for the same class"
    for root in own:
        givers = [module.name for module in MODULES if root in classes(module.read_text(encoding="utf-8"))]
        assert len(givers) == 1, f".{root} is to be given in one module, and is given in {givers}"


@pytest.mark.parametrize(
    "text",
    [
        ".mine .dot { color: blue; }",
        "h2 { margin: 0; }",
        ".mine, p { margin: 0; }",
        ".mine { .dark & { color: white; } }",
        ".mine { a, body & { color: white; } }",
        "@media (width < 600px) { .other { margin: 0; } }",
        ".mine { @keyframes appear { from { opacity: 0; } } }",
        ":root { --page: red; }",
    ],
)
def test_a_rule_that_would_leak_is_found(text: str) -> None:
    assert leaks(text)


def test_every_style_sheet_is_loaded_once() -> None:
    text = SHARED.read_text(encoding="utf-8") + page_files.panel_styles()
    loaded = set(re.findall(r'@import url\("([^"]+)"\);', text)) - {"panels.css"}
    assert sorted(loaded) == sorted(path.relative_to(static()).as_posix() for path in SCOPED)

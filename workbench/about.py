"""Converts a model's docstring to a tree of elements for the page: a small subset of Markdown; nothing is interpreted as HTML."""

from __future__ import annotations

import ast
from collections.abc import Iterator, Mapping
from dataclasses import asdict
from typing import Any

from markdown_it import MarkdownIt
from markdown_it.tree import SyntaxTreeNode

from actr3d.actr.kernel.source_code import parse
from actr3d.errors import ConfigurationError
from workbench.loader import ModelListing, listing_of

LONGEST = 20_000
"""How much of a docstring is shown [characters]: about ten pages of a book."""
_ELEMENTS = {
    "paragraph": "p",
    "bullet_list": "ul",
    "ordered_list": "ol",
    "list_item": "li",
    "blockquote": "blockquote",
    "em": "em",
    "strong": "strong",
    **{name: name for name in ("table", "thead", "tbody", "tr", "th", "td")},
}
_HEADINGS = {"h1": "h2", "h2": "h3", "h3": "h4"}
"""The page has its own heading above these; all smaller headings become `h4`."""

Node = str | dict[str, Any]
"""A text, or an element with `tag`, `children` and optional `href` (of a link) or `settings` (values to try)."""


def about_of(source: str, filename: str) -> dict[str, Any]:
    """Returns a model's description of itself, from its docstring.

    Args:
        source: The model's text; it is not executed.
        filename: The name of the model's file.

    Returns:
        `title`, the first line as elements; `nodes`, the rest; `cut`, whether the text was too long and is cut; `readable`, whether the
        text could be parsed as Python; `agents`, with their productions and parts, as far as the text says what they have; `parameters`,
        as in a listing.
    """
    listing = listing_of(source, filename)
    text = listing.text[:LONGEST]
    title, _, rest = text.partition("\n")
    return {
        "model": filename,
        "title": list(_inside(_tree(title), listing)),
        "nodes": list(_nodes(_tree(rest), listing)),
        "cut": len(listing.text) > LONGEST,
        "agents": [asdict(agent) for agent in listing.agents],
        "parameters": [asdict(parameter) for parameter in listing.parameters],
        "readable": bool(listing.text) or not any(problem.level == "error" for problem in listing.problems),
    }


def _tree(text: str) -> SyntaxTreeNode:
    markdown = MarkdownIt("commonmark", {"html": False, "maxNesting": 12}).enable("table").disable(["reference", "autolink", "entity"])
    return SyntaxTreeNode(markdown.parse(text))


def _inside(node: SyntaxTreeNode, listing: ModelListing) -> Iterator[Node]:
    """Yields the contents of a text's paragraphs without the paragraphs themselves."""
    for child in node.children:
        if child.type in ("paragraph", "inline", "heading"):
            yield from _inside(child, listing)
        else:
            yield from _node(child, listing)


def _nodes(node: SyntaxTreeNode, listing: ModelListing) -> Iterator[Node]:
    for child in node.children:
        yield from _node(child, listing)


def _node(node: SyntaxTreeNode, listing: ModelListing) -> Iterator[Node]:
    """Yields what the page shows for a node; for an unknown node, only its texts."""
    match node.type:
        case "text" | "text_special" | "html_inline" | "html_block":
            yield node.content
        case "softbreak":
            yield " "
        case "hardbreak":
            yield {"tag": "br", "children": []}
        case "hr":
            yield {"tag": "hr", "children": []}
        case "code_inline":
            given = _given_in(node.content)
            settings = _settings_in(given, listing)
            yield {"tag": "code", "children": [node.content], **({"settings": settings} if settings else {})}
            later = [name for name in given if name in listing.later]
            if later:
                yield f" ({later[0]} is not a parameter, because other code, such as an import, comes before it)"
        case "code_block" | "fence":
            yield {"tag": "pre", "children": [node.content]}
        case "image":
            yield node.content  # the alternative text: the page loads nothing from other servers
        case "link":
            address = str(node.attrs.get("href", ""))
            inside = list(_nodes(node, listing))
            if address.lower().startswith(("https://", "http://")):
                yield {"tag": "a", "href": address, "children": inside}
            else:
                yield from inside
        case "heading":
            yield {"tag": _HEADINGS.get(node.tag, "h4"), "children": list(_nodes(node, listing))}
        case "list_item" if _is_tight(node):
            yield {"tag": "li", "children": list(_inside(node, listing))}
        case kind if kind in _ELEMENTS:
            yield {"tag": _ELEMENTS[kind], "children": list(_nodes(node, listing))}
        case _:
            yield from _nodes(node, listing)


def _is_tight(item: SyntaxTreeNode) -> bool:
    """Returns whether a list item is a single paragraph without space around it."""
    return len(item.children) == 1 and item.children[0].type == "paragraph" and bool(item.children[0].hidden)


def _given_in(code: str) -> dict[str, Any]:
    """Returns the values in code such as `width = 0.5, speed = 2`, by name; nothing if the code is anything else."""
    try:
        call = parse(f"_({code})", mode="eval").body
        if not isinstance(call, ast.Call) or call.args or not isinstance(call.func, ast.Name):
            return {}
        given = {keyword.arg or "": ast.literal_eval(keyword.value) for keyword in call.keywords}
    except (ValueError, TypeError, SyntaxError, MemoryError, RecursionError):
        return {}
    return given if all(value is None or type(value) in (bool, int, float, str) for value in given.values()) else {}


def _settings_in(given: Mapping[str, Any], listing: ModelListing) -> Mapping[str, Any]:
    """Returns values that can be given to parameters; nothing if one cannot."""
    try:
        for name, value in given.items():
            listing.parameter(name).check(value)
    except ConfigurationError:
        return {}
    return given

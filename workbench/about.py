"""What a model's docstring says, as a tree of elements for the page: a small part of Markdown, in which nothing is ever HTML."""

from __future__ import annotations

import ast
from collections.abc import Iterator
from typing import Any

from markdown_it import MarkdownIt
from markdown_it.tree import SyntaxTreeNode

from actr3d.errors import ConfigurationError
from workbench.loader import Listing, listing_of

LONGEST = 20_000
"""So much of a docstring is shown [characters]: that of a book's page ten times over."""
_ELEMENTS = {
    "paragraph": "p",
    "bullet_list": "ul",
    "ordered_list": "ol",
    "list_item": "li",
    "blockquote": "blockquote",
    "em": "em",
    "strong": "strong",
}
_HEADINGS = {"h1": "h2", "h2": "h3", "h3": "h4"}
"""The page itself has the heading above these; smaller ones are all alike."""

Node = str | dict[str, Any]
"""A text, or an element: `tag`, `children`, and what else it has: `href` of a link, `settings` of values to try."""


def about_of(source: str, filename: str) -> dict[str, Any]:
    """Returns what a model says of itself.

    Args:
        source: The model's text; nothing of it is run.
        filename: What it is called.

    Returns:
        `title`, its first line as elements; `nodes`, all else; `cut`, whether there is more than is shown; `readable`, whether the text
        could be read as Python at all.
    """
    listing = listing_of(source, filename)
    text = listing.text[:LONGEST]
    title, _, rest = text.partition("\n")
    return {
        "model": filename,
        "title": list(_inside(_tree(title), listing)),
        "nodes": list(_nodes(_tree(rest), listing)),
        "cut": len(listing.text) > LONGEST,
        "readable": bool(listing.text) or not any(problem.level == "error" for problem in listing.problems),
    }


def _tree(text: str) -> SyntaxTreeNode:
    markdown = MarkdownIt("commonmark", {"html": False, "maxNesting": 12}).disable(["reference", "autolink", "entity"])
    return SyntaxTreeNode(markdown.parse(text))


def _inside(node: SyntaxTreeNode, listing: Listing) -> Iterator[Node]:
    """Yields what is in a text's paragraphs, without these."""
    for child in node.children:
        if child.type in ("paragraph", "inline", "heading"):
            yield from _inside(child, listing)
        else:
            yield from _node(child, listing)


def _nodes(node: SyntaxTreeNode, listing: Listing) -> Iterator[Node]:
    for child in node.children:
        yield from _node(child, listing)


def _node(node: SyntaxTreeNode, listing: Listing) -> Iterator[Node]:
    """Yields what the page is to show of a node; of what is not known its texts."""
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
            settings = _settings_in(node.content, listing)
            yield {"tag": "code", "children": [node.content], **({"settings": settings} if settings else {})}
        case "code_block" | "fence":
            yield {"tag": "pre", "children": [node.content]}
        case "image":
            yield node.content  # what stands in its place: the page loads nothing from elsewhere
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
    """Tells whether a list's item is one paragraph that is to have no room around it."""
    return len(item.children) == 1 and item.children[0].type == "paragraph" and bool(item.children[0].hidden)


def _settings_in(code: str, listing: Listing) -> dict[str, Any] | None:
    """Returns the values that code such as `width = 0.5, speed = 2` gives to the model's parameters; None where it is anything else."""
    try:
        call = ast.parse(f"_({code})", mode="eval").body
    except (SyntaxError, ValueError, MemoryError, RecursionError):
        return None
    if not isinstance(call, ast.Call) or not call.keywords or call.args or not isinstance(call.func, ast.Name):
        return None
    settings: dict[str, Any] = {}
    for keyword in call.keywords:
        try:
            parameter = listing.parameter(keyword.arg or "")
            value = ast.literal_eval(keyword.value)
            parameter.check(value)
        except (ConfigurationError, ValueError, TypeError, SyntaxError, MemoryError, RecursionError):
            return None
        if value is not None and type(value) not in (bool, int, float, str):
            return None
        settings[parameter.name] = value
    return settings

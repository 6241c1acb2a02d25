"""Reads XML files and the files that they include into plain elements with file and line."""

from __future__ import annotations

import posixpath
from collections.abc import Iterator
from dataclasses import dataclass, field
from xml.parsers import expat

from actr3d.errors import WorldError
from actr3d.world.asset_folder import AssetFolder

MAX_ELEMENTS = 100_000
"""Greatest number of elements of a document and the files that it includes; the largest public robots have some thousands."""

MAX_DEPTH = 200
"""Greatest nesting depth of elements. MuJoCo's own reader stops at 500."""

ESCAPES = str.maketrans({"&": "&amp;", "<": "&lt;", ">": "&gt;", '"': "&quot;", "\n": "&#10;", "\r": "&#13;", "\t": "&#9;"})


@dataclass
class Element:
    """One XML element. Text between elements is dropped: neither MJCF nor URDF has any."""

    tag: str
    attributes: dict[str, str]
    where: str
    """File and line, for messages: `robot.xml, line 3`."""

    children: list[Element] = field(default_factory=list["Element"])

    def walk(self) -> Iterator[Element]:
        """Yields it and all elements inside it, in the order of the document."""
        yield self
        for child in self.children:
            yield from child.walk()


def read_document(folder: AssetFolder, name: str) -> Element:
    """Reads an XML file, replaces each `<include file="…"/>` with the content of that file, and returns the root.

    An included name is relative to the folder of the first file, or else to that of the file that includes it.

    Raises:
        WorldError: If XML is not well formed, has a document type (entities), is too large or deep, includes itself, or
            a file cannot be read; with file and line.
    """
    root = _XmlReader(name).read(folder.read(name))
    _expand(root, folder, (name,), [0])
    return root


def written(root: Element) -> tuple[str, list[str]]:
    """Returns a document as text, and the origin of each line: MuJoCo's messages name lines."""
    lines: list[str] = []
    origins: list[str] = []
    _write(root, lines, origins)
    return "\n".join(lines), origins


class _XmlReader:
    """Builds elements from expat's events."""

    def __init__(self, name: str) -> None:
        self._name = name
        self.open: list[Element] = []
        self.root: Element | None = None
        self._count = 0
        self._parser = expat.ParserCreate()
        self._parser.StartElementHandler = self._start
        self._parser.EndElementHandler = lambda _: self.open.pop()
        self._parser.StartDoctypeDeclHandler = self._doctype

    def read(self, content: bytes) -> Element:
        try:
            self._parser.Parse(content, True)
        except expat.ExpatError as error:
            still = f"; <{self.open[-1].tag}> of {self.open[-1].where} is still open" if self.open else ""
            raise WorldError(f"{self._name}, line {error.lineno}: {expat.ErrorString(error.code)}{still}") from error
        except (LookupError, ValueError) as error:  # of an encoding that Python does not know, or expat cannot use
            raise WorldError(f"{self._name}, line 1: {error}; write it in UTF-8") from error
        assert self.root is not None  # expat has found a document
        return self.root

    def _start(self, tag: str, attributes: dict[str, str]) -> None:
        element = Element(tag=tag, attributes=attributes, where=f"{self._name}, line {self._parser.CurrentLineNumber}")
        self._count += 1
        if self._count > MAX_ELEMENTS or len(self.open) >= MAX_DEPTH:
            limit = f"more than {MAX_ELEMENTS:,} elements" if self._count > MAX_ELEMENTS else f"elements nested more than {MAX_DEPTH} deep"
            raise WorldError(f"{element.where}: {limit}")
        if self.open:
            self.open[-1].children.append(element)
        else:
            self.root = element
        self.open.append(element)

    def _doctype(self, *_: object) -> None:
        line = self._parser.CurrentLineNumber
        raise WorldError(f"{self._name}, line {line}: <!DOCTYPE> is refused: entities can grow without bounds, and MuJoCo has none")


def _expand(element: Element, folder: AssetFolder, inside: tuple[str, ...], count: list[int]) -> None:
    """Replaces the includes below an element; `inside` are the including files, `count` the number of elements up to now."""
    children: list[Element] = []
    for child in element.children:
        count[0] += 1
        if count[0] > MAX_ELEMENTS:
            raise WorldError(f"{child.where}: more than {MAX_ELEMENTS:,} elements with all that is included")
        if child.tag == "include":
            included = _included(child, folder, inside, count)
            children.extend(included.children)
        else:
            _expand(child, folder, inside, count)
            children.append(child)
    element.children = children


def _included(element: Element, folder: AssetFolder, inside: tuple[str, ...], count: list[int]) -> Element:
    file = element.attributes.get("file")
    if not file:
        raise WorldError(f'{element.where}: <include> has no file="…"')
    places = [posixpath.normpath(posixpath.join(posixpath.dirname(parent), file)) for parent in (inside[0], inside[-1])]
    name = next((place for place in places if folder.has(place)), places[0])
    if name in inside:
        raise WorldError(f"{element.where}: {' includes '.join((*inside[inside.index(name) :], name))}, without end")
    root = _XmlReader(name).read(folder.read(name, element.where))
    _expand(root, folder, (*inside, name), count)
    return root


def _quoted(value: str) -> str:
    """Returns the value of an attribute in quotation marks. The function for it in `xml.sax.saxutils` would load all of `http`."""
    return f'"{value.translate(ESCAPES)}"'


def _write(element: Element, lines: list[str], origins: list[str]) -> None:
    attributes = "".join(f" {name}={_quoted(value)}" for name, value in element.attributes.items())
    lines.append(f"<{element.tag}{attributes}{'' if element.children else '/'}>")
    origins.append(element.where)
    for child in element.children:
        _write(child, lines, origins)
    if element.children:
        lines.append(f"</{element.tag}>")
        origins.append(element.where)

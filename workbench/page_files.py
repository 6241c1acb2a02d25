"""Serves the files of the page. Their addresses contain their version, so a browser loads each file once and keeps it."""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping
from hashlib import blake2b
from types import MappingProxyType

from starlette.responses import Response
from starlette.staticfiles import StaticFiles
from starlette.types import Scope

from actr3d.actr.declarative.activation_parts import ACTIVATION_PARTS
from actr3d.trace_kinds import GROUPS, KINDS
from workbench.shipped import static

ROUTE = "/static/{version}"
KEEP = "private, max-age=31536000, immutable"
"""The `cache-control` of the files of the current version: a browser may keep them for a year without asking again."""


def panels() -> str:
    """Returns a module with the panels of the page: one for each file of the folder `panels` that exports a `panel`."""
    files = sorted(path.name for path in (static() / "panels").glob("*.js"))
    imports = "".join(f'import * as panel{n} from "./panels/{file}";\n' for n, file in enumerate(files))
    modules = ", ".join(f"panel{n}" for n in range(len(files)))
    sorting = "flatMap(({ panel }) => panel ?? []).sort((one, other) => one.order - other.order)"
    return f"{imports}\nexport const PANELS = [{modules}].{sorting};\n"


def panel_styles() -> str:
    """Returns a style sheet that imports those of the folder `panels`."""
    names = [path.name for path in sorted((static() / "panels").glob("*.css"))]
    return "".join(f'@import url("panels/{name}");\n' for name in names)


def trace_kinds() -> str:
    """Returns a module with the groups of trace events, by which pages filter them, and the texts of their kinds."""
    groups = [
        {"id": name, "text": title, "first": shown, "kinds": [kind for kind, of in KINDS.items() if of.group == name]}
        for name, (title, shown) in GROUPS.items()
    ]
    texts = {name: [kind.title, kind.text] for name, kind in KINDS.items()}
    return f"export const GROUPS = {json.dumps(groups)};\nexport const TEXTS = {json.dumps(texts)};\n"


def part_names() -> str:
    """Returns a module with the names that users see for what adds to an activation."""
    return f"export const NAMES = {json.dumps(ACTIVATION_PARTS)};\n"


GENERATED: Mapping[str, tuple[Callable[[], str], str]] = MappingProxyType(
    {
        "panels.js": (panels, "text/javascript"),
        "panels.css": (panel_styles, "text/css"),
        "trace_kinds.js": (trace_kinds, "text/javascript"),
        "activation_parts.js": (part_names, "text/javascript"),
    }
)
"""The files that are made on request, by name: what makes the text, and its type."""


class PageFiles(StaticFiles):
    """Serves the files of the folder `static` and the generated ones. To be mounted at `ROUTE`."""

    def __init__(self) -> None:
        super().__init__(directory=static())
        self._version = ""

    def address(self) -> str:
        """Returns the address of the present version of the files. Call it for each page, because it changes when a file is edited."""
        version = blake2b(digest_size=8)
        for path in sorted(path for path in static().rglob("*") if path.is_file()):
            known = path.stat()
            version.update(f"{path}\0{known.st_size}\0{known.st_mtime_ns}\0".encode("utf-8", "surrogateescape"))
        for make, _ in GENERATED.values():
            version.update(make().encode())
        self._version = version.hexdigest()
        return ROUTE.format(version=self._version)

    def with_versions(self, page: str) -> str:
        """Returns the text of a page whose addresses `/static/...` lead to the files of this moment."""
        return page.replace("/static/", f"{self.address()}/")

    async def get_response(self, path: str, scope: Scope) -> Response:
        """Returns one file. One that is asked for under an older version is the file of today, which the browser does not keep."""
        make, kind = GENERATED.get(path, (None, None))
        response = await super().get_response(path, scope) if make is None else Response(make(), media_type=kind)
        if scope["path_params"]["version"] == self._version:
            response.headers["cache-control"] = KEEP
        return response

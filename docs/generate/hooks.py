"""Hooks of mkdocs: add the generated pages and tables, check docstrings, and move inline scripts into files.

The workbench serves the built site under its own Content-Security-Policy, which forbids inline scripts.
"""

from __future__ import annotations

import hashlib
import logging
import re
from pathlib import Path
from typing import Any

import docstrings
import model_pages
import packages
import tables
import workbench_pages
from mkdocs.config.defaults import MkDocsConfig
from mkdocs.structure.files import File, Files
from mkdocs.structure.pages import Page

ROOT = Path(__file__).parents[2]
LOG = logging.getLogger("mkdocs.hooks.manual")
INLINE_SCRIPT = re.compile(r"<script>(.*?)</script>", re.DOTALL)
GENERATED = re.compile(r"^<!-- (table|help|diagram): ([\w -]+) -->$", re.MULTILINE)


def on_config(config: Any) -> None:
    """Adds the pages of models and of panels to the navigation, and checks the docstrings of everything public."""
    section = next(entry["Models"] for entry in config.nav if "Models" in entry)
    section[1:] = [page.address for page in model_pages.pages()]
    section = next(entry["Workbench"] for entry in config.nav if "Workbench" in entry)
    section[1:] = workbench_pages.pages()
    config.extra["inline_scripts"] = {}
    for problem in docstrings.missing():
        LOG.warning(problem)


def on_files(files: Files, config: MkDocsConfig) -> None:
    """Adds the generated pages."""
    for page in model_pages.pages():
        files.append(File.generated(config, page.address, content=page.markdown()))
    files.append(File.generated(config, "models/index.md", content=model_pages.index()))
    files.append(File.generated(config, "changelog.md", content=(ROOT / "CHANGELOG.md").read_text(encoding="utf-8")))


def on_page_markdown(markdown: str, page: Page, **_: Any) -> str:
    """Replaces `<!-- table: name -->`, `<!-- help: command -->` and `<!-- diagram: name -->` by what they name."""

    def generated(found: re.Match[str]) -> str:
        kind, name = found.groups()
        try:
            return {"table": tables.table, "help": tables.command_help, "diagram": _diagram}[kind](name)
        except (KeyError, FileNotFoundError):
            LOG.warning("%s: there is no %s named %r", page.file.src_uri, kind, name)
            return ""

    return GENERATED.sub(generated, markdown)


def _diagram(name: str) -> str:
    """Returns a drawing of `docs/images`, or the diagram of the packages, as part of the page: it follows the theme."""
    if name == "packages":
        return packages.diagram()
    return f"<figure>{(ROOT / 'docs' / 'images' / f'{name}.svg').read_text(encoding='utf-8').strip()}</figure>"


def on_post_page(output: str, page: Page, config: Any) -> str:
    """Moves each inline script of a page into a file, named after what it holds."""

    def moved(found: re.Match[str]) -> str:
        text = found[1]
        name = f"assets/inline/{hashlib.sha256(text.encode()).hexdigest()[:16]}.js"
        config.extra["inline_scripts"][name] = text
        up = "../" * page.url.count("/")
        return f'<script src="{up}{name}"></script>'

    return INLINE_SCRIPT.sub(moved, output)


def on_post_build(config: Any) -> None:
    """Writes the scripts, and drops the page of errors and the site map, which need to know the address of the site."""
    site = Path(config.site_dir)
    for name, text in config.extra["inline_scripts"].items():
        path = site / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text, encoding="utf-8")
    for name in ("404.html", "sitemap.xml", "sitemap.xml.gz"):
        (site / name).unlink(missing_ok=True)

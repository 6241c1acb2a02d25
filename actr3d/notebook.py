"""Finds who shows simulations and recordings in notebooks: the workbench, which the library does not import."""

from __future__ import annotations

from typing import Any

from actr3d.errors import NotebookError

GROUP = "actr3d.notebook"
"""The entry point group of an installed package that has a function `show`."""
EXTRA = ("anywidget", "traitlets")
"""The packages that the extra `notebook` installs."""


def show_in_notebook(what: Any, **options: Any) -> Any:
    """Returns a widget that shows a simulation or a recording.

    Args:
        what: The `Simulation`, or the `Recorded`.
        options: See their methods `show`.

    Raises:
        NotebookError: If the packages for notebooks are not installed, or this is not a notebook.
    """
    from importlib.metadata import entry_points  # 20 ms, which only notebooks need

    found = list(entry_points(group=GROUP, name="show"))
    if not found:
        raise NotebookError("show(): no installed package shows notebooks; install this one again")
    try:
        show = found[0].load()
    except ModuleNotFoundError as error:
        if error.name not in EXTRA:
            raise
        raise NotebookError(f"show() needs the package '{error.name}': pip install 'actr3d[notebook]'") from None
    return show(what, **options)

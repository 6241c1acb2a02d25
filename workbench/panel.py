"""Viser's own panel: run, pause, step and back, the apertures, the overlays; so that the 3D view can be used alone."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import Any

from workbench import protocol as say
from workbench.look import TITLES, Look
from workbench.worker.messages import State

WORDS: dict[str, Callable[[], Any]] = {"run": say.Run, "pause": say.Pause, "step": say.Step, "back": say.Back}
MOST_SLIDERS = 8


class Panel:
    """The controls in viser's panel. What a model calls its things is shown as text only.

    Args:
        gui: Viser's side of it.
        apertures: By the name of each aperture the least and the greatest width that it can be set to [cm].
        look: How the scene is looked at.
        said: Takes what users do.
    """

    def __init__(self, gui: Any, apertures: dict[str, tuple[int, int]], look: Look, said: Callable[[Any], None]) -> None:
        self._said = said
        self.apertures = apertures
        """What it was made for."""
        gui.reset()
        gui.set_panel_label("ACT-R 3D")
        self._time = gui.add_markdown("")
        buttons = gui.add_button_group("run", tuple(WORDS))

        @buttons.on_click
        def _(_: Any) -> None:
            said(WORDS[buttons.value]())

        self._sliders: dict[str, Any] = {}
        for name, (least, most) in list(apertures.items())[:MOST_SLIDERS]:
            slider = gui.add_slider(f"{name} [cm]", min=least, max=most, step=1, initial_value=least)
            slider.on_update(partial(self._slid, name, slider))
            self._sliders[name] = slider
        self._boxes: dict[str, Any] = {}
        with gui.add_folder("overlays"):
            for name, title in TITLES.items():
                box = gui.add_checkbox(title, initial_value=name in look.shown)
                box.on_update(partial(self._switched, name, box))
                self._boxes[name] = box

    def show(self, state: State) -> None:
        """Shows how the run is."""
        pace = "" if state.measured is None else f" · {state.measured:.1f}x"
        text = f"**t = {state.time:.2f} s** · {state.status}{pace}"
        if self._time.content != text:
            self._time.content = text
        for name, width in state.apertures.items():
            slider = self._sliders.get(name)
            shown = 0 if slider is None else max(slider.min, min(slider.max, round(100 * width)))
            if slider is not None and round(slider.value) != shown:
                slider.value = shown

    def choose(self, look: Look) -> None:
        """Shows how the scene is looked at."""
        for name, box in self._boxes.items():
            if box.value != (name in look.shown):
                box.value = name in look.shown

    def _slid(self, name: str, slider: Any, event: Any) -> None:
        if event.client_id is not None:  # else the panel is only being set to what is so
            self._said(say.Aperture(width=slider.value / 100, name=name))

    def _switched(self, name: say.OverlayName, box: Any, event: Any) -> None:
        if event.client_id is not None:
            self._said(say.Overlay(name=name, shown=box.value))

"""Defines viser's own panel with run, pause, step, back, apertures and overlays, so that the 3D view can be used alone."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import Any

from workbench.overlays import OVERLAYS, ViewSettings
from workbench.page_commands.changes import SimulationCommand
from workbench.page_commands.running import Back, Pause, Run, Step
from workbench.page_commands.session import ShowOverlay
from workbench.time_text import time_text
from workbench.worker.messages import State

WORDS: dict[str, Callable[[], Any]] = {"run": Run, "pause": Pause, "step": Step, "back": Back}
MAX_SLIDERS = 8


class Panel:
    """Shows the controls in viser's panel. Names from a model are shown as plain text.

    Args:
        gui: Viser's GUI interface.
        apertures: The minimum and maximum width of each aperture [cm], by name.
        look: Which overlays are shown.
        said: Called with each command of a user.
    """

    def __init__(self, gui: Any, apertures: dict[str, tuple[int, int]], look: ViewSettings, said: Callable[[Any], None]) -> None:
        self._said = said
        self.apertures = apertures
        """The apertures that the panel was made for."""
        gui.reset()
        gui.set_panel_label("ACT-R 3D")
        self._time = gui.add_markdown("")
        buttons = gui.add_button_group("run", tuple(WORDS))

        @buttons.on_click
        def _(_: Any) -> None:
            said(WORDS[buttons.value]())

        self._sliders: dict[str, Any] = {}
        for name, (least, most) in list(apertures.items())[:MAX_SLIDERS]:
            slider = gui.add_slider(f"{name} [cm]", min=least, max=most, step=1, initial_value=least)
            slider.on_update(partial(self._slid, name, slider))
            self._sliders[name] = slider
        self._boxes: dict[str, Any] = {}
        with gui.add_folder("overlays"):
            for name, overlay in OVERLAYS.items():
                box = gui.add_checkbox(overlay.title, initial_value=name in look.shown)
                box.on_update(partial(self._switched, name, box))
                self._boxes[name] = box

    def show(self, state: State) -> None:
        """Shows the state of the run."""
        pace = "" if state.measured is None else f" · {state.measured:.1f}x"
        text = f"**t = {time_text(state.time, 2)}** · {state.status}{pace}"
        if self._time.content != text:
            self._time.content = text
        for name, width in state.apertures.items():
            slider = self._sliders.get(name)
            shown = 0 if slider is None else max(slider.min, min(slider.max, round(100 * width)))
            if slider is not None and round(slider.value) != shown:
                slider.value = shown

    def choose(self, look: ViewSettings) -> None:
        """Shows which overlays are on."""
        for name, box in self._boxes.items():
            if box.value != (name in look.shown):
                box.value = name in look.shown

    def _slid(self, name: str, slider: Any, event: Any) -> None:
        if event.client_id is not None:  # otherwise the panel itself was updated to the current state
            self._said(SimulationCommand(word="aperture", values=(slider.value / 100,), named={"name": name}))

    def _switched(self, name: str, box: Any, event: Any) -> None:
        if event.client_id is not None:
            self._said(ShowOverlay(name=name, shown=box.value))

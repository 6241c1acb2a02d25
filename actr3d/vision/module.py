"""The vision module: features from the body's eye for an agent."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Annotated, Any

from annotated_types import Ge, Le

from actr3d.actr.explain.module_reasons import outcome_of
from actr3d.actr.kernel.noise import duration
from actr3d.actr.kernel.parameters import WithParameters, named_parameters
from actr3d.actr.kernel.tree import lineage
from actr3d.actr.modules.answers import plain_answer
from actr3d.actr.modules.port import RAW_VISION, Request, Searching, note_request
from actr3d.camera import CameraParameters, View
from actr3d.clock import MICROSECONDS
from actr3d.errors import ParameterError, VisionError
from actr3d.values import BASIC
from actr3d.vision.detectors import DETECTORS
from actr3d.vision.encoding import PROGRAMMING, Emma
from actr3d.vision.feature import off_sight, slot_names
from actr3d.vision.feature_cache import FeatureCache
from actr3d.vision.noise import blurred
from actr3d.vision.request_parser import Query, read_request
from actr3d.vision.salience import Rule
from actr3d.vision.search import Search
from actr3d.vision.validation import CAMERA, FromZero, check_camera, encoding_of, saliences_of
from actr3d.world.actuators.motion import saccade_time
from actr3d.world.command_registry import checked_number
from actr3d.world.frames import wrapped

BITS = 64
"""Bits of the seed of a view's noise."""

STATE = ("busy", "error", "watching")
"""The attributes of the module that productions match."""


class Vision(WithParameters, Searching):
    """Searches for features with a body's eye, and puts one of those that it notices into a buffer, as a chunk.

    It is for agents with a body in a physical world. `from actr3d.vision import Vision` after `from actr3d.actr import *` replaces the
    `Vision` of Python ACT-R, which sees the objects of an environment that have `x` and `y`.

    The view is private to this module: an agent receives features only, with opaque labels and no names. A request is answered from the
    view at the end of the tick in which it is made; the chunk arrives `delay` after the request, or at the end of that tick, if later, and
    describes that view, even if the scene has changed since. If nothing is found, the buffer is cleared and `error` is set. Another
    top-down request before the chunk arrives replaces this one.

    Bottom-up requests (`bottom_up=True`) wait until a top-down one is done. A top-down one never waits: a bottom-up search in
    progress is cancelled, and begins again with a new view when the top-down one is done. Bottom-up searches that find nothing leave
    buffer and `error` unchanged, and others do not replace a chunk that a top-down one has set within the last `hold`.
    `busy` and `error` concern top-down requests; `watching` is true while a bottom-up one is in progress or waits.

    Args:
        buffer: Receives the chunks.
        delay: Time from a request to its chunk [s].
        delay_sd: The standard deviation of `delay` and of `bottom_up_delay` [s]; None for no noise.
        bottom_up_delay: Time from a bottom-up request to its chunk [s].
        hold: Time for which the chunk of a top-down request is protected from bottom-up ones, while it stays in the buffer [s].
        salience: Measure of salience: `size`, `nearness`, `motion`, `equal`, a function of a feature, or one of these by
            the feature's name; None: openings by size, obstacles by nearness.
        rule: Choice among several: `share` with probability s_i / sum(s); `sos` as SOS Vision does: each is noticed with
            probability s_i (above 1 counts as 1), one of those is drawn, and described at the end of the delay, if it is still visible
            and passes all tests; otherwise nothing is found. Top-down requests while it is busy do nothing.
        error_rate: The probability that a search notices nothing.
        edge_noise: The standard deviation of the directions of edges [rad].
        distance_noise: The standard deviation of one common factor for all distances of a view, as a fraction. Each search has its own
            noise. With noise, a feature that does not move also seems to move, because `motion` and `time_to_contact` are changes since the
            previous view.
        encoding: Additional time to encode the feature of a top-down request: a time [s], such as 0.085 for a shift of
            attention; or `emma`, or an `Emma`, whose time grows with the angle from the line of sight.
        saccades: Whether the eye turns to the feature of a top-down request, within its limits; the chunk then waits until it is there,
            except with EMMA, where encoding may end earlier. Without it, EMMA's times are as if the eye turned there and back.
        private_view: Whether other ports of the agent are refused the raw view (`body.request("view")`), and the pictures `image`
            and `depth`. With False they receive them: the agent then bypasses vision, and the trace shows this.
        camera: The fields of `CameraParameters`: `rows=50`, `horizontal_fov=2.0`.

    Raises:
        ParameterError: If there is no such parameter, or a value is invalid.
        ConfigurationError: If a camera parameter is invalid.
        VisionError: If a salience is invalid.

    Source: 50 ms for a request and 20 ms for a search for obstacles, the original ACT-R 3D (docs/human-data.md); the `sos` rule, SOS Vision
    (West & Emond 2002). The `hold` of 0.1 s was chosen: the time of two productions of 50 ms, the one in progress and the one that reads
    the chunk.
    """

    @named_parameters
    def __init__(
        self,
        buffer: Any,
        delay: FromZero = 0.05,
        delay_sd: FromZero | None = None,
        bottom_up_delay: FromZero = 0.02,
        hold: FromZero = 0.1,
        salience: Any = None,
        rule: Rule = "share",
        error_rate: Annotated[float, Ge(0), Le(1)] = 0.0,
        edge_noise: FromZero = 0.0,
        distance_noise: FromZero = 0.0,
        encoding: Any = 0.0,
        saccades: bool = False,
        private_view: bool = True,
        **camera: Any,
    ) -> None:
        self._buffer = buffer
        self.busy = False
        self.error = False
        self.watching = False
        self.salience = salience
        self.encoding = encoding
        self.delay = delay
        self.delay_sd = delay_sd
        self.bottom_up_delay = bottom_up_delay
        self.hold = hold
        self.rule: Rule = rule
        self.error_rate = error_rate
        self.edge_noise = edge_noise
        self.distance_noise = distance_noise
        self.saccades = saccades
        self.private_view = private_view
        check_camera(camera, sorted(self._settable() - {"camera", *STATE}))
        self._detectors = dict(DETECTORS)
        self._has_learnt = False
        self._saliences = saliences_of(salience, self._detectors)
        self._encoding = encoding_of(encoding)
        self._camera = camera
        self._cache = FeatureCache()
        self._top_down: Search | None = None
        self._bottom_up: Search | None = None
        self._waiting: Search | None = None
        self._delivered: tuple[Any, int] = (None, 0)
        self._aim: tuple[int, float, float] = (0, 0.0, 0.0)
        self._asked: tuple[str, Query | None] = ("", None)
        self._last: dict[bool, Search] = {}

    def __setattr__(self, name: str, value: Any) -> None:
        if "_last" in vars(self):  # it has been made
            if name == "salience":
                self._saliences = saliences_of(value, self._detectors)
            elif name == "encoding":
                self._encoding = encoding_of(value)
            elif name in CAMERA:
                raise ParameterError(f"Vision.{name}: a camera cannot be changed; set it in Vision({name}=...)")
        super().__setattr__(name, value)

    # -- for observers

    @property
    def eyesight(self) -> CameraParameters:
        """The parameters of the eye."""
        return CameraParameters.from_mapping(self._camera)

    @property
    def searches(self) -> tuple[Search, ...]:
        """The last top-down and the last bottom-up search with a view, if any."""
        return tuple(search for _, search in sorted(self._last.items()))

    # -- requests

    def request(self, pattern: str, *, bottom_up: bool = False, **slots: Any) -> Search | None:
        """Searches for a feature: `request('feature:opening', width='>?w', height='>1.5')`.

        A slot takes comparisons (`'>0.5'`, `'<2'`, `'>=?w <3'`), labels take `'?l'` or `'!?l'`. A number without a sign is the minimum of a
        size, and the maximum of a distance or a time. Angles are in degrees. A feature must pass all tests.

        Args:
            pattern: The feature, and optionally slots: `'feature:opening height:1.5'`.
            bottom_up: Whether it is a request of bottom-up vision, which waits for top-down requests.
            slots: Its required slots, and parameters of its detector.

        Returns:
            The search, to wait for in a generator; None if the request does nothing (rule `sos`, while busy).

        Raises:
            VisionError: If there is no such feature or slot, or a value is invalid.
            ChunkError: If a variable is not bound.
            SimulationError: If the agent has no body, or has not started.
        """
        self._joined("view")
        if not isinstance(bottom_up, bool):  # pyright: ignore[reportUnnecessaryIsInstance] # a model's file
            raise VisionError(f"vision '{self._path}': bottom_up: must be True or False (got {bottom_up!r})")
        self._learn_detectors()
        query = self._read(pattern, slots)
        waits = {"waits": self._top_down is not None} if bottom_up else {}
        self._trace_request("request", pattern=pattern, asked=query.asked, bottom_up=bottom_up, **waits)
        if bottom_up:
            return self._ask_bottom_up(query)
        if self._top_down is not None:
            if self.rule == "sos":
                return None
            self.sch.finish(self._top_down)
        if self._bottom_up is not None:
            self._waiting, self._bottom_up = self._bottom_up, None
        self._top_down = search = self._begin(Search(query, bottom_up=False, site=self._call_site()), self.delay)
        if self.error:
            self.error = False
        if not self.busy:
            self.busy = True
        return search

    def _read(self, pattern: str, slots: dict[str, Any]) -> Query:
        """Reads a request, unless it is the same as the last one: eyes that scan ask for the same thing again and again."""
        text = repr((pattern, slots))
        last, query = self._asked
        # The value of a variable may have changed, and other objects may differ and have the same text.
        if query is None or text != last or "?" in text or not BASIC.issuperset(map(type, (pattern, *slots.values()))):
            query = read_request(pattern, slots, self._detectors, self.sch.bound, f"vision '{self._path}'")
            self._asked = text, query
        return query

    def gaze(self, left: float, up: float = 0.0) -> None:
        """Turns the eye to a direction relative to the head, or to its limits, in the time of a human saccade.

        Args:
            left: To the left of straight ahead [degrees].
            up: Above it [degrees].

        Raises:
            WorldError: If one of them is not a number.
            SimulationError: If the agent has no body.
        """
        angles = (checked_number(value, f"vision '{self._path}': gaze: {name}", -360, 360) for name, value in (("left", left), ("up", up)))
        self._send_command("gaze", *map(math.radians, angles))

    def _ask_bottom_up(self, query: Query) -> Search:
        """Begins a bottom-up search, or delays it until the end of a top-down one. It replaces an earlier bottom-up search."""
        for earlier in (self._bottom_up, self._waiting):
            if earlier is not None:
                self.sch.finish(earlier)
        self._bottom_up = self._waiting = None
        search = Search(query, bottom_up=True, site=self._call_site())
        if self._top_down is not None:
            self._waiting = search
        else:
            self._bottom_up = self._begin(search, self.bottom_up_delay)
        if not self.watching:
            self.watching = True
        return search

    def _begin(self, search: Search, delay: float) -> Search:
        """Begins a search, with a request to the body for a view at the end of the present tick."""
        search.clear()
        search.begun = self.sch.now_us
        search.due = self.sch.after(duration(self, delay, self.delay_sd))
        self._ask_for_view(search)
        return search

    def _kept_private(self, sensor: str) -> str | None:
        return "Vision(private_view=False)" if sensor in RAW_VISION and self.private_view else None

    def _ask_for_view(self, search: Search) -> None:
        embodiment = self._joined("view")
        embodiment.outbox.append(Request(embodiment.body, "view", (), self._camera, search.site, self, search))

    # -- views

    def _take(self, request: Request, answer: View) -> None:
        try:
            self._process(request, answer)
        except Exception as error:
            note_request(error, self, request.site)
            raise

    def _process(self, request: Request, answer: View) -> None:
        """Searches a view, and schedules the end of the search."""
        search = request.reading
        sch = self.sch
        if search is None or (search is not self._top_down and search is not self._bottom_up):
            return  # cancelled meanwhile
        assert isinstance(search, Search)
        trace = sch.trace
        if trace is not None and trace.all:
            trace.emit(sch.now_us, self._path, "answer", {"word": request.word, "value": plain_answer(answer)})
        perceived = self._perceived(search, answer)
        self._cache.add(perceived, sch.now_us)
        if search.again:
            self._look_again(search)
            return
        if self.error_rate > 0 and self.random.random() < self.error_rate:
            search.why = "nothing was noticed (error_rate)"
        else:
            search.divide(self._cache.features(search.query), self._saliences[search.query.detector.name])
            search.choose(self.rule, self.random)
        search.seen, search.view, search.perceived = sch.now_us, answer, perceived
        self._last[search.bottom_up] = search
        if trace is not None and trace.all:
            trace.emit(sch.now_us, self._path, "search", search.to_data())
        if search.feature is not None and not search.bottom_up:
            self._attend(search, answer)
        if search.due <= sch.now_us:
            self._end(search, search.begun)
            return
        sch.call_at(search.due, self._end, (search, search.begun))
        if self.rule == "sos" and search.feature is not None:
            tick = self._joined("view").tick
            if search.due >= sch.now_us + tick:
                sch.call_at(search.due - tick + 1, self._ask_again, (search, search.begun))

    def _ask_again(self, search: Search, begun: int) -> None:
        """Requests a second view, at the end of the last tick before a search is over."""
        if search.begun == begun and (search is self._top_down or search is self._bottom_up):
            search.again = True
            self._ask_for_view(search)

    def _look_again(self, search: Search) -> None:
        """Checks whether the chosen feature is still there and passes all tests."""
        search.again = False
        search.update_chosen(self._cache.features(search.query))
        trace = self.sch.trace
        if trace is not None and trace.all:
            trace.emit(self.sch.now_us, self._path, "search", search.to_data())
        if search.due <= self.sch.now_us:
            self._end(search, search.begun)

    def _perceived(self, search: Search, view: View) -> View:
        """Returns a view with noise; the same noise for both views of one search."""
        if self.edge_noise <= 0 and self.distance_noise <= 0:
            return view
        if search.noise is None:
            search.noise = self.random.getrandbits(BITS)
        return blurred(view, self.edge_noise, self.distance_noise, search.noise)

    def _attend(self, search: Search, view: View) -> None:
        """Schedules the shift of attention to the chosen feature at the end of the search: encoding, and the turn of the eye."""
        sch = self.sch
        feature = search.feature
        assert feature is not None
        left, up, eccentricity = off_sight(view.axes, feature)
        landing, direction, elevation = self._aim
        if sch.now_us < landing:  # the eye will look there before it turns again
            left, up = wrapped(feature.direction - direction), feature.elevation - elevation
        begin = max(search.due, sch.now_us)
        encoding = self._encoding
        time, start = encoding.course(eccentricity) if isinstance(encoding, Emma) else (encoding, 0.0)
        if self.saccades and start is not None:
            start = begin + round(start * MICROSECONDS)
            landing = start + round(saccade_time(eccentricity) * MICROSECONDS)
            prepared = max(begin, start - round(PROGRAMMING * MICROSECONDS))
            sch.call_at(prepared, self._program_eye, (search, search.begun, start, landing, left, up))
            if not isinstance(encoding, Emma):
                time = max(time, saccade_time(eccentricity))
        search.due = begin + round(time * MICROSECONDS)

    def _program_eye(self, search: Search, begun: int, start: int, landing: int, left: float, up: float) -> None:
        """Schedules the eye movement to the feature of a search; does nothing if another search has replaced this one.

        `start` and `landing` are times [us], `left` and `up` angles [rad].
        """
        if search is self._top_down and search.begun == begun and search.feature is not None:
            self._aim = (landing, search.feature.direction, search.feature.elevation)
            self.sch.call_at(start, self._send_command, ("saccade", left, up))

    # -- results

    def _end(self, search: Search, begun: int) -> None:
        """Ends a search: sets the buffer, and continues bottom-up vision; not if the search began again or waits for a view."""
        if search.begun != begun or search.again:
            return
        if search is self._top_down:
            self._top_down = None
            self._deliver(search)
            self.busy = False
            if self._waiting is not None:
                self._bottom_up, self._waiting = self._begin(self._waiting, self.bottom_up_delay), None
        elif search is self._bottom_up:
            self._bottom_up = None
            self._deliver(search)
            self.watching = False
        else:
            return
        self.sch.finish(search)

    def _deliver(self, search: Search) -> None:
        """Puts the feature into the buffer, unless that is protected."""
        feature = search.feature
        slots = None if feature is None else feature.slots()
        held = search.bottom_up and slots is not None and self._is_held()
        if not search.bottom_up:
            if slots is None:
                self._buffer.clear()
                self.error = True
            else:
                self._buffer.set(slots)
            self._delivered = (self._buffer.chunk, self.sch.now_us)
        elif slots is not None and not held:
            self._buffer.set(slots)
        data = {"bottom_up": search.bottom_up, "failed": slots is None, **({"held": True} if held else {})}
        search.outcome = outcome_of(data)
        self.emit("sight", **data, **({} if slots is None else {"chunk": slots}))

    def _learn_detectors(self) -> None:
        """Adds the detectors that were registered after the module was made, such as those below the agent in its file.

        Before its first request, those of the file also replace what other files, or earlier texts of this one, have defined.
        """
        if self._has_learnt and DETECTORS.keys() <= self._detectors.keys():
            return
        own = set[str]() if self._has_learnt else {type(part).__module__ for part in lineage(self)}
        self._has_learnt = True
        newer = {name: one for name, one in DETECTORS.items() if name not in self._detectors or one.detect.__module__ in own}
        if newer:
            self._detectors = {**self._detectors, **newer}
            self._saliences = saliences_of(self.salience, self._detectors)
            self._asked = "", None

    def _kinds(self) -> dict[str, tuple[str, ...]]:
        self._learn_detectors()
        return {name: slot_names(one.finds) for name, one in self._detectors.items()}

    def _latest_searches(self) -> list[tuple[int, Mapping[str, Any], str]]:
        return [(search.seen, search.to_data(), search.outcome) for search in self.searches]

    def _is_held(self) -> bool:
        """Returns whether the buffer holds the protected chunk of a top-down request."""
        chunk, time = self._delivered
        return (
            self.hold > 0
            and chunk is not None
            and self._buffer.chunk is chunk
            and self.sch.now_us <= time + round(self.hold * MICROSECONDS)
        )

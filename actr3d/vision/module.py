"""The vision module: what a mind gets of what its body's eye sees."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

from actr3d.actr.answers import plain_answer
from actr3d.actr.modules.port import Request, place_of_caller
from actr3d.actr.parameters import WithParameters, named_parameters
from actr3d.actr.searches import Searching, outcome_of
from actr3d.camera import CameraParameters, View
from actr3d.clock import MICROSECONDS
from actr3d.errors import ParameterError, VisionError
from actr3d.vision.detectors import DETECTORS
from actr3d.vision.encoding import Emma, saccade_time
from actr3d.vision.feature import off_sight
from actr3d.vision.feature_cache import Looks
from actr3d.vision.noise import blurred
from actr3d.vision.request_parser import Query, read_request
from actr3d.vision.search import Search
from actr3d.vision.validation import CAMERA, check_camera, check_numbers, encoding_of, saliences_of
from actr3d.world.command_registry import number

TICK = 10_000
"""After which a body answers [us]; see `actr3d.simulation`."""
BITS = 64
"""Of the seed of a look's noise."""


class Vision(WithParameters, Searching):
    """Looks for features with a body's eye, and brings one of those it notices to a buffer, as a chunk.

    The view is private to this module: an agent gets features only, with opaque labels and no names. A request is answered from
    what is visible at the end of the tick in which it is made; the chunk comes `delay` after the request, or when that tick ends, if
    later, and tells what was seen then, also where that has changed meanwhile. Where nothing is found, the buffer is cleared and
    `error` set. A further request before that takes the place of this one.

    Bottom-up requests (`bottom_up=True`) wait until a top-down one is done. A top-down one never waits: a bottom-up search that is
    under way is given up, and begins anew with a new look when the top-down one is done. Bottom-up searches that find nothing leave
    buffer and `error` as they are, and those that find something do not replace what a top-down one brought within the last `hold`.
    `busy` and `error` are of top-down requests, `watching` says whether a bottom-up one is under way or waits.

    Args:
        buffer: Where chunks go.
        delay: From a request to its chunk [s].
        delay_sd: The standard deviation of that, also of bottom-up requests [s]; None for no noise.
        bottom_up_delay: The same for a bottom-up request [s].
        hold: How long what a top-down request brought is safe from bottom-up ones, while it stays in the buffer [s].
        salience: What makes a feature salient: `size`, `nearness`, `motion`, `equal`, a function of a feature, or one of these by
            the feature's name; None: openings by size, obstacles by nearness.
        rule: How one of several is chosen: `share` with probability s_i / sum(s); `sos` as SOS Vision does: each is noticed with
            probability s_i (above 1 counts as 1), one of those is drawn, and comes as it is when the delay is over, if it is still to
            be seen and as was asked for; else nothing is found. Requests while it is busy do nothing.
        error_rate: The probability that a search notices nothing.
        edge_noise: The standard deviation of the directions in which edges are seen [rad].
        distance_noise: That of how far away all is seen at one look, as a part of the distances.
        encoding: How much longer it takes to encode what a top-down request has found: a time [s], such as 0.085 for a shift of
            attention; or `emma`, or an `Emma`, by which it takes the longer the farther off the line of sight it is.
        saccades: Whether the eye turns to what a top-down request has found, as far as it can; the chunk then does not come before.
            Without it, EMMA's times are as if the eye turned there and back.
        private_view: Whether other ports of the agent are refused the raw view (`body.request("view")`). With False they get it:
            the agent then steps outside what vision gives, and the trace says so.
        camera: The fields of `CameraParameters`: `rows=50`, `horizontal_fov=2.0`.

    Raises:
        ParameterError: If a parameter has no such name, or is not what it should be.
        ConfigurationError: If one of the camera's is not.
        VisionError: If a salience is none.

    Source: 50 ms for a request and 20 ms for a search for obstacles, the original ACT-R 3D (human-data); the `sos` rule, SOS Vision
    (West & Emond 2002). A `hold` of 0.1 s is ours: so long it takes at most until a production of 50 ms has fired that was under
    way, and one that reads the chunk.
    """

    @named_parameters
    def __init__(
        self,
        buffer: Any,
        delay: float = 0.05,
        delay_sd: float | None = None,
        bottom_up_delay: float = 0.02,
        hold: float = 0.1,
        salience: Any = None,
        rule: str = "share",
        error_rate: float = 0.0,
        edge_noise: float = 0.0,
        distance_noise: float = 0.0,
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
        self.rule = rule
        self.error_rate = error_rate
        self.edge_noise = edge_noise
        self.distance_noise = distance_noise
        self.saccades = saccades
        self.private_view = private_view
        check_numbers(vars(self))
        check_camera(camera, sorted(self._settable() - {"camera", "busy", "error", "watching"}))
        self._detectors = dict(DETECTORS)
        self._saliences = saliences_of(salience, self._detectors)
        self._encoding = encoding_of(encoding)
        self._camera = camera
        self._looks = Looks()
        self._top_down: Search | None = None
        self._bottom_up: Search | None = None
        self._waiting: Search | None = None
        self._brought: tuple[Any, int] = (None, 0)
        self._last: dict[bool, Search] = {}

    def __setattr__(self, name: str, value: Any) -> None:
        if "_last" in self.__dict__:  # it has been made
            if name == "salience":
                self._saliences = saliences_of(value, self._detectors)
            elif name == "encoding":
                self._encoding = encoding_of(value)
            elif name in CAMERA:
                raise ParameterError(f"Vision.{name}: a camera cannot be changed; give it to Vision({name}=...) when that is made")
        super().__setattr__(name, value)

    # -- for who looks on

    @property
    def eyesight(self) -> CameraParameters:
        """How the eye sees."""
        return CameraParameters.from_mapping(self._camera)

    @property
    def searches(self) -> tuple[Search, ...]:
        """The last top-down and the last bottom-up search that have looked, as far as there have been such."""
        return tuple(search for _, search in sorted(self._last.items()))

    # -- what it is asked

    def request(self, pattern: str, *, bottom_up: bool = False, **slots: Any) -> Search | None:
        """Looks for a feature: `request('feature:opening', width='>?w', height='>1.5')`.

        A slot takes comparisons (`'>0.5'`, `'<2'`, `'>=?w <3'`), labels take `'?l'` or `'!?l'`. A bare number is the least of a
        size, and the most of a distance or time. Angles are in degrees. All that is asked must hold.

        Args:
            pattern: The feature, and slots if one likes: `'feature:opening height:1.5'`.
            bottom_up: Whether it is asked by bottom-up vision, and gives way to what is asked otherwise.
            slots: What it must be like, and what its detector takes.

        Returns:
            What can be waited for in a generator; None where it does nothing (rule `sos`, while busy).

        Raises:
            VisionError: If there is no such feature or slot, or a value is not what it takes.
            ChunkError: If a variable is not bound.
            ParameterError: If a parameter was changed to what it cannot be.
            SimulationError: If the agent has no body, or does not live yet.
        """
        self._joined("view")
        check_numbers(vars(self))
        if not isinstance(bottom_up, bool):  # pyright: ignore[reportUnnecessaryIsInstance] # a model's file
            raise VisionError(f"vision '{self._path}': bottom_up: must be True or False (got {bottom_up!r})")
        query = read_request(pattern, slots, self._detectors, self.sch.bound, f"vision '{self._path}'")
        trace = self.sch.trace
        if trace is not None and trace.all:
            waits = {"waits": self._top_down is not None} if bottom_up else {}
            self._trace_request("request", pattern=pattern, asked=query.asked, bottom_up=bottom_up, **waits)
        if bottom_up:
            return self._ask_bottom_up(query)
        if self._top_down is not None:
            if self.rule == "sos":
                return None
            self._give_up(self._top_down)
        if self._bottom_up is not None:
            self._waiting, self._bottom_up = self._bottom_up, None
        self._top_down = search = self._begin(Search(query, bottom_up=False, begun=0, due=0), self.delay)
        if self.error:
            self.error = False
        if not self.busy:
            self.busy = True
        return search

    def gaze(self, left: float, up: float = 0.0) -> None:
        """Turns the eye to a direction against the head, or to its limits, as fast as people do.

        Args:
            left: To the left of straight ahead [degrees].
            up: Above it [degrees].

        Raises:
            WorldError: If one of them is no number.
            SimulationError: If the agent has no body.
        """
        angles = (number(value, f"vision '{self._path}': gaze: {name}") for name, value in (("left", left), ("up", up)))
        self._tell("gaze", *map(math.radians, angles))

    def _ask_bottom_up(self, query: Query) -> Search:
        """Begins a bottom-up search, or lets it wait; it takes the place of an earlier one."""
        for earlier in (self._bottom_up, self._waiting):
            if earlier is not None:
                self._give_up(earlier)
        self._bottom_up = self._waiting = None
        search = Search(query, bottom_up=True, begun=0, due=0)
        if self._top_down is not None:
            self._waiting = search
        else:
            self._bottom_up = self._begin(search, self.bottom_up_delay)
        if not self.watching:
            self.watching = True
        return search

    def _begin(self, search: Search, delay: float) -> Search:
        """Asks the body for a view, which it answers at the end of the present tick."""
        if self.delay_sd is not None:
            delay = max(0.0, self.random.gauss(delay, self.delay_sd))
        search.clear()
        search.begun = self.sch.now_us
        search.due = self.sch.after(delay)
        self._ask_for_view(search)
        return search

    def _kept_private(self, word: str) -> str | None:
        return "Vision(private_view=False)" if word == "view" and self.private_view else None

    def _ask_for_view(self, search: Search) -> None:
        embodiment = self._joined("view")
        embodiment.outbox.append(Request(embodiment.body, "view", (), self._camera, place_of_caller(), self, search))

    def _give_up(self, search: Search) -> None:
        """Lets those go on who wait for a search that will not end."""
        self.sch.finish(search)

    # -- what it sees

    def _take(self, request: Request, answer: View) -> None:
        """Takes a view in: finds what was asked for, and lets it come when it is due."""
        search = request.reading
        sch = self.sch
        if search is None or (search is not self._top_down and search is not self._bottom_up):
            return  # given up meanwhile
        assert isinstance(search, Search)
        trace = sch.trace
        if trace is not None and trace.all:
            trace.emit(sch.now_us, self._path, "answer", {"word": request.word, "value": plain_answer(answer)})
        perceived = self._perceived(search, answer)
        self._looks.take(perceived, sch.now_us)
        if search.again:
            self._look_again(search)
            return
        if self.error_rate > 0 and self.random.random() < self.error_rate:
            search.why = "nothing was noticed, by error"
        else:
            search.sift(self._looks.features(search.query), self._saliences[search.query.detector.name])
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
        if self.rule == "sos" and search.feature is not None and search.due >= sch.now_us + TICK:
            sch.call_at(search.due - TICK + 1, self._ask_again, (search, search.begun))

    def _ask_again(self, search: Search, begun: int) -> None:
        """Asks for a second view, of the end of the last tick before a search is over."""
        if search.begun == begun and (search is self._top_down or search is self._bottom_up):
            search.again = True
            self._ask_for_view(search)

    def _look_again(self, search: Search) -> None:
        """Looks whether what was chosen is still there and as was asked for."""
        search.again = False
        search.check(self._looks.features(search.query))
        trace = self.sch.trace
        if trace is not None and trace.all:
            trace.emit(self.sch.now_us, self._path, "search", search.to_data())
        if search.due <= self.sch.now_us:
            self._end(search, search.begun)

    def _perceived(self, search: Search, view: View) -> View:
        """Returns a view as it is misjudged; both views of one search alike."""
        if self.edge_noise <= 0 and self.distance_noise <= 0:
            return view
        if search.noise is None:
            search.noise = self.random.getrandbits(BITS)
        return blurred(view, self.edge_noise, self.distance_noise, search.noise)

    def _attend(self, search: Search, view: View) -> None:
        """Lets attention shift to the chosen feature when the search is over: it is encoded, and the eye turns to it."""
        sch = self.sch
        feature = search.feature
        assert feature is not None
        left, up, eccentricity = off_sight(view.axes, feature)
        begin = max(search.due, sch.now_us)
        encoding = self._encoding
        time, start = encoding.course(eccentricity) if isinstance(encoding, Emma) else (encoding, 0.0)
        if self.saccades and start is not None:
            sch.call_at(begin + round(start * MICROSECONDS), self._turn_eye, (search, search.begun, left, up))
            if not isinstance(encoding, Emma):
                time = max(time, saccade_time(eccentricity))
        search.due = begin + round(time * MICROSECONDS)

    def _turn_eye(self, search: Search, begun: int, left: float, up: float) -> None:
        """Turns the eye to what a search has found, unless another one has taken its place."""
        if search is self._top_down and search.begun == begun:
            self._tell("saccade", left, up)

    # -- what comes of it

    def _end(self, search: Search, begun: int) -> None:
        """Brings what was found, and lets bottom-up vision go on; not if the search has begun anew since [us], or looks again."""
        if search.begun != begun or search.again:
            return
        if search is self._top_down:
            self._top_down = None
            self._bring(search)
            self.busy = False
            if self._waiting is not None:
                self._bottom_up, self._waiting = self._begin(self._waiting, self.bottom_up_delay), None
        elif search is self._bottom_up:
            self._bottom_up = None
            self._bring(search)
            self.watching = False
        else:
            return
        self.sch.finish(search)

    def _bring(self, search: Search) -> None:
        """Puts what was found into the buffer, if that is free for it."""
        feature = search.feature
        slots = None if feature is None else feature.slots()
        held = search.bottom_up and slots is not None and self._is_held()
        if not search.bottom_up:
            if slots is None:
                self._buffer.clear()
                self.error = True
            else:
                self._buffer.set(slots)
            self._brought = (self._buffer.chunk, self.sch.now_us)
        elif slots is not None and not held:
            self._buffer.set(slots)
        data = {"bottom_up": search.bottom_up, "failed": slots is None, **({"held": True} if held else {})}
        search.outcome = outcome_of(data)
        trace = self.sch.trace
        if trace is not None and trace.all:
            trace.emit(self.sch.now_us, self._path, "sight", data if slots is None else {**data, "chunk": slots})

    def _latest_searches(self) -> list[tuple[int, Mapping[str, Any], str]]:
        return [(search.seen, search.to_data(), search.outcome) for search in self.searches]

    def _is_held(self) -> bool:
        """Tells whether the buffer has what a top-down request has just brought."""
        chunk, time = self._brought
        return (
            self.hold > 0
            and chunk is not None
            and self._buffer.chunk is chunk
            and self.sch.now_us <= time + round(self.hold * MICROSECONDS)
        )

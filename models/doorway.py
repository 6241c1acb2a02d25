"""Walks through a doorway, and turns the shoulders if the doorway is too narrow.

The agent walks its body towards a doorway 7 m away. Every 100 ms it looks: the view has the edges of what is visible, without
names. This raw view bypasses vision; aperture_passage.py uses a vision module instead.
It finds the nearest edges to the left and to the right of the middle of the screen, and computes the width of the gap
from their distances and angles. At 1.5 m it decides: a gap narrower than 1.3 times its shoulders is passed sideways (Warren
and Whang, 1987: people turn their shoulders below that ratio). Behind the doorway it stops, and the run ends as it begins to turn back.

What to expect
--------------
With a doorway of 0.5 m it turns its shoulders, and touches nothing. With 0.8 m it walks straight on. The walk takes about 7 s.

What to try
-----------
- `width = 0.5`: turns its shoulders; `width = 0.8`: walks straight on.
- `width = 0.5, speed = 2`: has less time to turn, and still passes.
- `width = 0.2`: too narrow even for a body turned sideways: it walks on against the wall, until you stop it.
- Move the slider of the aperture while it walks: a decision is not changed.
"""

from dataclasses import dataclass
from math import radians, sin
from typing import Annotated

from annotated_types import Gt, Le

from actr3d.actr import *
from actr3d.configuration import Configuration, Live
from actr3d.simulation import BodyPort, Simulation
from actr3d.world import Aperture, Floor, Mannequin, Scene

SHOULDERS = 0.45
SIDEWAYS = {"pelvis_yaw": 0.6, "torso_yaw": 0.75}


@dataclass(frozen=True, kw_only=True)
class Parameters(Configuration):
    """The parameters of the model."""

    width: Annotated[float, Gt(0), Le(3), Live("aperture")] = 0.5
    """The free width of the doorway [m]."""

    speed: Annotated[float, Gt(0), Le(3), Live("parameter", "walker.speed")] = 1.2
    """How fast it walks [m/s]."""


class Walker(ACTR):
    goal = Buffer()
    seen = Buffer()
    felt = Buffer()
    eye = BodyPort(seen)
    skin = BodyPort(felt)

    def init():
        goal.set("approach")
        self.keep_pace()

    def keep_pace(self):
        """Walks at the speed that is wanted, which a user may change on the way."""
        if self.walks_at != self.speed:
            self.walks_at = self.speed
            self.eye.set("walk", self.speed)

    def look(goal="approach", seen=None, eye="busy:False"):
        self.keep_pace()
        eye.request("view")

    def judge(goal="approach", seen="view"):
        gap = self.gap(seen["seen"])
        seen.clear()
        if gap is not None:
            width, distance = gap
            if distance < 1.5:
                goal.set("turn" if width < 1.3 * SHOULDERS else "pass")
                print(f"{self.now():.2f} s: a gap of {width:.2f} m")

    def gap(self, view):
        """Returns the width and the distance of the gap ahead [m], from the middle row of the view; None if there is no gap."""
        middle = view.as_array()[view.as_array()["row"] == view.rows // 2]
        left, right = middle[middle["x2"] < 0.5], middle[middle["x1"] > 0.5]
        if len(left) == 0 or len(right) == 0:
            return None
        _, distance, angle = max((x, d, a) for x, d, a in zip(left["x2"], left["d2"], left["a2"]))
        _, further, wider = min((x, d, a) for x, d, a in zip(right["x1"], right["d1"], right["a1"]))
        return distance * sin(radians(angle)) + further * sin(radians(wider)), min(distance, further)

    def turn(goal="turn"):
        print(f"{self.now():.2f} s: turns")
        eye.set("posture", SIDEWAYS, speed=3.0)
        goal.set("pass")

    def feel(goal="pass", felt=None, skin="busy:False"):
        self.keep_pace()
        skin.request("pose")

    def walk_on(goal="pass", felt="pose x:?x"):
        felt.clear()
        if float(x) > 8:
            goal.set("behind")

    def stop_behind(goal="behind"):
        eye.set("posture", {joint: 0.0 for joint in SIDEWAYS}, speed=3.0)
        eye.set("stop")
        print(f"{self.now():.2f} s: is through")
        goal.set("done")
        self.stop()


def build(parameters: Parameters) -> Simulation:
    """Puts a walker in front of a doorway."""

    def agent():
        walker = Walker()
        walker.speed, walker.walks_at = parameters.speed, 0.0
        return walker

    scene = Scene(parts=(Floor(), Aperture(width=parameters.width), Mannequin(name="walker", shoulder_width=SHOULDERS)))
    return Simulation(scene, {"walker": agent})

"""A person walks to a doorway, and turns the shoulders if it is too narrow.

People turn their shoulders to pass an aperture that is narrower than 1.30 times their shoulder width. From a distance, they judge
that they can pass without turning if it is wider than 1.16 times that width (Warren & Whang 1987, JEP:HPP 13). What counts is the
ratio of the aperture to the body. The walker does not know the size of its own body at first: it learns it. In the experiments with
people it knows it (`body = "known"`), as adults do.

The work is two planning units (SGOMS). `pass_doorway` has the unit tasks *learn*, *judge*, *approach* and *leave*; `squeeze`, with the
unit task *turn*, interrupts it before a narrow doorway:

1. *Learn*: the walker turns its shoulders to each side several times. Its width in each posture is stored in declarative memory. A
   walker that knows its body recalls its least width instead.
2. *Judge*: is there an opening that is wide enough to pass without turning? If not, the walker remembers how narrow it can make
   itself, and looks for an opening of that size. If there is none, it declines.
3. *Approach*: it walks. Its eyes, a parallel system with productions of 10 ms, look for obstacles ahead.
4. *Turn*: an obstacle interrupts the walk. The walker turns its shoulders at a constant speed until vision finds an opening that
   is wider than its felt width by a margin. Then it walks on.
5. *Leave*: behind the doorway it turns back, and stands.

The three variants
------------------
The `predictive` variant is described in predictive_walker.py: no margin and no ratio is a rule of it, and one number is fitted to a ratio
of people.

The `descriptive` variant (the default) looks before it turns. It turns only if the opening is narrower than 1.30 times its width. The turn
starts 1.6 s before the wall; hips and legs turn with the shoulders, until the room at the sides is 0.30 of the shoulder width, that
of a person who just passes without turning. The faster it walks, the faster it turns. The size of its body is proportional to its
shoulder width.

The `replication` variant follows the original ACT-R 3D (facts about its code and its trials: docs/human-data.md). An object within 3 times its
width starts a turn at 240 degrees/s, of which the torso alone contributes 120, whatever the size of the opening. The turn stops at
each answer of vision, and continues if no opening was found. So it turns by 17.5, 35, 46, 55, 64 … degrees, in pieces of 73 ms, one
every 175 ms. The original's means are at these angles, and a fast walker turns less because it has time for fewer pieces. It turns by
about 18 degrees before any doorway. Two things are inferred from these means: the turn in pieces, and the depth of the trunk.

These two keep looking until the edges of the doorway are beside them. If the doorway becomes narrower they turn again, or stop;
the `descriptive` variant stands still while it turns if it is near. A change less than 0.3 s before they arrive is noticed too late.

What to expect
--------------
- With an aperture of 0.45 m the body turns by 40 to 47 degrees and touches nothing; about 6 or 7 cm are left on each side.
- An aperture of 0.6 m is passed without a turn, but with a turn by the `large` group.
- An aperture of 0.25 m is declined.

The run begins with some seconds of learning, unless the walker knows its body. At its end the tab *Buffers* shows the measures of the
passage, computed from the simulated world.

What to try
-----------
- `aperture = 0.45`: passes with its shoulders turned.
- `aperture = 0.6`: walks straight through; `aperture = 0.6, group = "large"`: turns.
- `aperture = 0.25`: declines.
- `condition = "fast"`: walks and turns faster.
- `variant = "replication", aperture = 0.7`: the original model turns even here.
- `margin = 0, noise = 0.05`: a careless walker with poor eyes.
- `bar = 0.6, aperture = 0.7`: a walker with a bar in both hands, which it turns too; at 0.6 it declines, although people pass.
- `body = "known", aperture = 0.45`: sets out at once.
- `start_aside = 0.3`: a start that is not in line with the doorway. This walker cannot steer: it walks into the wall. The
  `predictive` one can.
- Or move the slider of the aperture while the walker is on its way.

Variations of the `predictive` variant:

- `variant = "predictive", gait = False`: no steps and no sway, now and in its memories.
- `variant = "predictive", perceptual_noise = 0.0`: exact eyes, and an exactly felt width.
- `variant = "predictive", impact = "any"`: each contact costs the same, whatever its energy.
- `variant = "predictive", memories = 0`: no experience.
- `variant = "predictive", units = "metres"`: it remembers how much room a passage had in metres, not in shoulder widths.
"""

from dataclasses import dataclass
from math import radians
from typing import Annotated, Literal

from annotated_types import Ge, Gt, Le

from actr3d.actr import *
from actr3d.configuration import Configuration, Live
from actr3d.experiment.aperture import Passage
from actr3d.motor import Motor
from actr3d.sgoms import SGOMS, Ordered, Situated
from actr3d.simulation import Simulation
from actr3d.vision import Vision
from actr3d.world import Aperture, Floor, Load, Mannequin, Scene

WIDTHS = {"small": 0.404, "large": 0.484}
SPEEDS = {("small", "normal"): 1.29, ("small", "fast"): 1.61, ("large", "normal"): 1.28, ("large", "fast"): 1.77}
SHOULDERS, CHEST = 0.259, 0.563
"""Shoulder width as a fraction of the height (Drillis & Contini 1966), and depth of the chest as a fraction of the shoulder width:
0.25 m (ANSUR II, 2012) at 0.444 m. All sizes of a body are proportional to its shoulder width."""

TORSO, CLAVICLE, SIDEWAYS = 60, 20, 80
"""The greatest turn of the replication's torso, of the shoulders relative to it, and of a person [degrees].
Source: the original's limits of 20 and 80 (docs/human-data.md)."""
NECK = 60
"""The greatest turn of the head against a turned body [degrees]; the eye does the rest. Source: the mannequin's limit."""
BEARING = 19.6
"""Objects further from the walking direction are not obstacles [degrees]. Source: the original's 100 - acos(0.5 / 3) (docs/human-data.md)."""
TIGHT = 1.03
"""The least ratio of an opening to the felt width at which the walker passes when it cannot turn further. Source: chosen for this model."""
BESIDE = 57.3
"""Objects further from the walking direction are beside the walker, not ahead [degrees]. Source: chosen for this model."""
FIELD = 2.6
"""The width of the field of view [rad]. Source: chosen for this model, to see the edges of a doorway until it is reached; that of
people is wider."""
BEHIND = 0.8
"""How far the walker continues behind the middle of an opening [m]: more than the depth of a body turned sideways. Source: chosen
for this model."""
DOOR = "feature:opening height:>1.5 depth:>0.5"
"""Openings that one can walk through [m]. Source: the original's requests."""


@dataclass(frozen=True, kw_only=True)
class Parameters(Configuration):
    """The parameters of the model."""

    variant: Literal["predictive", "descriptive", "replication"] = "descriptive"
    """The walker: one whose behaviour follows from gait, perception and experience; one that is given people's behaviour; or a replication
    of the original ACT-R 3D's model."""

    aperture: Annotated[float, Gt(0), Le(3), Live("aperture")] = 0.5
    """The free width of the doorway [m]. Source: Warren & Whang (1987) used 0.35 to 0.70."""

    group: Literal["small", "large"] = "small"
    """The group that determines shoulder width (0.404 or 0.484 m) and speed. Source: Warren & Whang (1987)."""

    shoulder_width: Annotated[float, Ge(0.3), Le(0.7)] | None = None
    """The shoulder width [m]; None: the mean of the group."""

    condition: Literal["normal", "fast"] = "normal"
    """The walking speed of the group: small 1.29 or 1.61 m/s, large 1.28 or 1.77 m/s. Source: Warren & Whang (1987)."""

    speed: Annotated[float | None, Ge(0.1), Le(3), Live("parameter", "walker.pace.wanted")] = None
    """The walking speed [m/s]; None: that of the condition."""

    margin: Annotated[float, Ge(0), Le(1)] | None = None
    """The walker turns if an opening exceeds its width by less than this fraction; None: 0.30 for people (Warren & Whang 1987), 0.139
    in the replication (docs/human-data.md). The predictive walker has no such number."""

    noise: Annotated[float, Ge(0), Le(0.2)] = 0.01
    """The standard deviation of perceived distances, as a fraction of them; 0 judges exactly. Source: chosen for this model. The
    predictive walker has `perceptual_noise` instead."""

    task: Literal["walk", "judge"] = "walk"
    """What the walker does: walks through the doorway, or only judges whether it could pass without turning."""

    body: Literal["learned", "known"] = "learned"
    """Whether the walker first learns how wide it is in each posture, or knows it from the start."""

    bar: Annotated[float, Ge(0.1), Le(2)] | None = None
    """The length of a bar that the walker holds crosswise in front of it [m]; None: empty hands."""

    start_aside: Annotated[float, Ge(-1), Le(1)] = 0.0
    """How far to the left of the middle of the doorway the walker starts [m]."""

    start_heading: Annotated[float, Ge(-20), Le(20)] = 0.0
    """The walking direction at the start [degrees]; 0 is straight ahead, positive to the left."""

    contact_cost: Annotated[float, Ge(0), Le(1000)] | None = None
    """Of the predictive walker: the cost of an impact of 1 J, in units of the effort of 1 J. None here and below: the value in
    predictive_walker.py."""

    perceptual_noise: Annotated[float, Ge(0), Le(10)] | None = None
    """Of the predictive walker: factor of all noise of what it sees and feels."""

    memory_noise: Annotated[float, Ge(0), Le(2)] | None = None
    """Of the predictive walker: noise of the activation of memories."""

    memories: Annotated[int, Ge(0), Le(1000)] | None = None
    """Of the predictive walker: the number of passages that it remembers."""

    impact: Literal["energy", "any"] = "energy"
    """Of the predictive walker: whether the cost of a contact grows with its energy, or is the same for any."""

    units: Literal["metres", "shoulders"] = "shoulders"
    """Of the predictive walker: the units in which it remembers how much room a passage had."""

    gait: bool = True
    """Of the predictive walker: whether it steps and sways, now and in its memories; the others glide."""


class Wait(Model):
    """A timer: `state` is «over» some time after `go`; another `go` restarts it."""

    state = "idle"
    begun = 0

    def go(self, seconds):
        self.state = "on"
        self.begun += 1
        mine = self.begun
        yield seconds
        if mine == self.begun:
            self.state = "over"

    def reset(self):
        self.state = "idle"
        self.begun += 1


class Arrival(Wait):
    """A timer that is over when a distance has been walked, at a speed that may change."""

    def walk(self, metres, speed):
        self.speed = speed
        self.due = self.now() + metres / speed
        self.go(metres / speed)

    def change(self, speed, further=0):
        """Changes the speed [m/s], and makes the distance longer [m]."""
        if self.state == "on":
            self.walk(max(0, max(0, self.due - self.now()) * self.speed + further), speed)


class Pace(Model):
    """The wanted walking speed [m/s], which a user may change; None: that of the condition."""


class Shoulders(Model):
    """Turns torso and shoulders, while the legs and the eye keep pointing in the walking direction."""

    groups = "torso", "head", "left_shoulder", "right_shoulder"
    posture = "rotate_torso"
    turned_left = f"torso_yaw:{TORSO} head_yaw:-{TORSO} left_shoulder_yaw:{CLAVICLE} right_shoulder_yaw:{CLAVICLE}"
    turned_right = f"torso_yaw:-{TORSO} head_yaw:{TORSO} left_shoulder_yaw:-{CLAVICLE} right_shoulder_yaw:-{CLAVICLE}"

    def know(self):
        """Knows the width of the body when it is turned as far as possible, to either side."""
        for turned in (self.turned_left, self.turned_right):
            self.parent.motor.know(self.posture, turned)

    def turn(self, part, rate):
        """Turns them to a fraction of their greatest turn, to the chosen side, at a rate [degrees/s]."""
        motor, angle = self.parent.motor, self.side * part
        motor.rotate_torso(angle * TORSO, rate)
        motor.rotate("head", "yaw", -angle * TORSO, rate)
        motor.rotate("left_shoulder", "yaw", angle * CLAVICLE, rate)
        motor.rotate("right_shoulder", "yaw", angle * CLAVICLE, rate)

    def change(self, rate):
        """Continues at another rate [degrees/s], if they are turning for a narrow doorway."""
        if self.parent.b_context["way"] == "narrow" and self.parent.motor[f"{self.groups[0]}_busy"]:
            self.stop()  # a muscle group that moves refuses another movement
            self.turn(1, rate)

    def stop(self):
        for group in self.groups:
            self.parent.motor.stop(group)

    def turned(self):
        """Returns whether the torso is felt to be turned as far as possible."""
        return abs(float(self.parent.motor.torso_yaw_angle)) >= TORSO


class WholeBody(Shoulders):
    """Turns the shoulders with the whole body, hips and legs included; the walking direction stays the same."""

    groups = "stance", "head", "eye"
    posture = "stance_yaw"
    turned_left = f"stance_yaw:{SIDEWAYS} head_yaw:-{NECK} eye_yaw:{NECK - SIDEWAYS}"
    turned_right = f"stance_yaw:-{SIDEWAYS} head_yaw:{NECK} eye_yaw:{SIDEWAYS - NECK}"

    def turn(self, part, rate):
        motor, angle, back = self.parent.motor, self.side * part, NECK / SIDEWAYS
        motor.rotate("stance", "yaw", angle * SIDEWAYS, rate)
        motor.rotate("head", "yaw", -angle * NECK, rate * back)
        motor.rotate("eye", "yaw", angle * (NECK - SIDEWAYS), rate * (1 - back))

    def turned(self):
        return self.angle() >= SIDEWAYS

    def angle(self):
        """Returns the felt turn of the body [degrees]."""
        return abs(float(self.parent.motor.stance_yaw_angle))


class Eyes(ACTR):
    """Scans for obstacles ahead, asks for an opening when there is an obstacle, and turns the shoulders.

    Source of the times: productions 10 ms, a scan 50 ms, a search for obstacles 20 ms, a request 50 ms (docs/human-data.md).
    """

    production_time = 0.01

    def scan_ahead(b_turn="watch:yes", scan="state:idle", vision="busy:False watching:False", b_visual=None):
        scan.go(0.05)

    def search(b_turn="watch:yes way:unknown", scan="state:over"):
        scan.reset()
        vision.request("feature:obstacle", bottom_up=True, radius=self.parent.radius, bearing=BEARING)

    def search_the_way(b_turn="watch:yes way:clear", scan="state:over", motor="width:?width"):
        scan.reset()
        self.look_before(self.parent.radius, self.parent.wanted(float(width)))

    def look_before(self, radius, width):
        """Searches for objects ahead of a walker of a width [m]; the edges of an opening that is wide enough are beside these."""
        self.parent.vision.request("feature:obstacle", bottom_up=True, radius=radius, bearing=BESIDE, aside=width / 2)

    def first_alert(b_turn="watch:yes way:unknown", b_context="way:open", b_visual="feature:obstacle distance:?far"):
        b_context.set("way:narrow")
        b_interrupt.set("planning_unit:squeeze when:now")
        b_turn.set(f"watch:no way:unknown near:{self.parent.nears(far)} do:{answer}")
        b_visual.clear()

    def alert(b_turn="watch:yes way:?way", b_context="way:!open", b_visual="feature:obstacle distance:?far"):
        b_turn.set(f"watch:no way:{way} near:{self.parent.nears(far)} do:ask")
        b_visual.clear()

    def turn(b_turn="do:turn"):
        shoulders.turn(1, self.parent.rate)
        b_turn.modify(do="ask")

    def ask(b_turn="do:ask", motor="width:?width"):
        vision.request(DOOR, width=f">{self.parent.wanted(float(width)):.4f}")
        b_turn.modify(do="wait")

    def found(b_turn="do:wait", vision="busy:False", b_visual="feature:opening distance:?far"):
        shoulders.stop()
        b_visual.clear()
        b_context.set("way:clear")
        b_turn.set("watch:yes way:clear")
        way.walk(float(far) + BEHIND, self.parent.speed)
        if not motor.walking:
            motor.walk(self.parent.speed)

    def doubt(b_turn="do:wait way:clear", vision="busy:False error:True", motor="width:?width"):
        """No opening was found: either the walker is in the doorway, whose edges are out of sight, or the doorway is now too narrow."""
        self.look_before(self.parent.radius, self.parent.wanted(float(width)))
        b_turn.modify(do="doubt")

    def pass_by(b_turn="do:doubt", vision="watching:False", b_visual=None):
        b_turn.set("watch:yes way:clear")

    def notice(b_turn="do:doubt", vision="watching:False", b_visual="feature:obstacle distance:?far"):
        b_visual.clear()
        b_context.set("way:narrow")
        b_interrupt.set("planning_unit:squeeze when:now")
        b_turn.modify(do="wait", way="unknown", near=self.parent.nears(far))

    def give_up(b_turn="do:wait near:True way:unknown", vision="busy:False error:True"):
        self.stay()

    def stay(self):
        """Stops for good."""
        self.parent.motor.stop()
        print(f"{self.now():.2f} s: stops")
        self.stop()


class EyesStepwise(Eyes):
    """Stops turning at each answer of vision, scans again, and continues to turn."""

    def not_found(b_turn="do:wait near:False way:unknown", vision="busy:False error:True"):
        shoulders.stop()
        scan.go(0.05)
        b_turn.modify(do="scan")

    def search_what_it_cannot_pass(b_turn="do:scan", scan="state:over"):
        scan.reset()
        self.look_before(self.parent.radius, TIGHT * self.parent.narrowest)
        b_turn.modify(do="search")

    def see_that_it_cannot_pass(b_turn="do:search", vision="watching:False", b_visual="feature:obstacle"):
        self.stay()

    def turn_on(b_turn="do:search", vision="watching:False", b_visual=None):
        b_turn.modify(do="turn")


class EyesContinuous(Eyes):
    """Turns until an opening is found; near the wall, it stands still while it turns."""

    def not_found(b_turn="do:wait near:False way:unknown", vision="busy:False error:True", motor="stance_busy:False", near="state:!over"):
        b_turn.modify(do="turn")

    def go_on(b_turn="do:wait near:!True way:unknown", vision="busy:False error:True", motor="stance_busy:True", near="state:!over"):
        b_turn.modify(do="ask")

    def beware(b_turn="do:wait near:False way:unknown", vision="busy:False error:True", near="state:over", motor="width:?width"):
        self.look_before(self.parent.stopping, self.parent.wanted(float(width)))
        b_turn.modify(do="beware")

    def go_on_with_care(b_turn="do:beware", vision="watching:False", b_visual=None):
        b_turn.modify(do="ask")

    def see_the_wall(b_turn="do:beware", vision="watching:False", b_visual="feature:obstacle"):
        b_visual.clear()
        b_turn.modify(do="ask", near=True)

    def halt(b_turn="do:wait near:True way:unknown", vision="busy:False error:True", motor="width:?width"):
        motor.stop("legs")
        way.reset()
        near.reset()
        self.look_before(self.parent.stopping, self.parent.wanted(float(width)))
        b_turn.modify(do="halt", near="halted")

    def turn_there(b_turn="do:halt", vision="watching:False", b_visual=None):
        b_turn.modify(do="turn")

    def turn_before(b_turn="do:halt", vision="watching:False", b_visual="feature:obstacle distance:?far aside:?aside"):
        b_visual.clear()
        if float(far) ** 2 - float(aside) ** 2 > (self.parent.shoulder_width / 2) ** 2:
            b_turn.modify(do="turn")
        else:
            self.stay()  # a shoulder would touch the wall

    def look_once_more(b_turn="do:wait near:halted way:unknown", vision="busy:False error:True", motor="stance_busy:False"):
        b_turn.modify(do="ask", near="at_last")

    def give_up(b_turn="do:wait near:at_last way:unknown", vision="busy:False error:True"):
        self.stay()


class Walker(SGOMS):
    """The common part of the `descriptive` and the `replication` variant.

    Source of the times: productions 50 ms, no latency of declarative memory (docs/human-data.md). Source of the standard deviation of 20 ms:
    the original's angle before wide doorways has one of 4.7 degrees, at 240 degrees/s.
    """

    b_visual = Buffer()
    b_turn = Buffer()
    DM = Memory(SGOMS.b_DM, latency=0)
    vision = Vision(b_visual, delay=0.05, bottom_up_delay=0.02, delay_sd=0.02, horizontal_fov=FIELD)
    motor = Motor(memory=DM, size_grid=0.001, extreme_step=8)
    scan = Wait()
    way = Arrival()
    near = Arrival()
    pace = Pace()
    pass_doorway = Ordered("learn", "judge", "approach", "leave")
    pass_with_known_body = Ordered("recall", "judge", "approach", "leave")
    squeeze = Situated(turn="way:narrow", until="way:clear")

    def init():
        vision.distance_noise = noise
        shoulders.side = 1
        b_context.set("way:open")
        if knows_body:
            shoulders.know()
        b_plan_unit.set("planning_unit:" + ("pass_with_known_body" if knows_body else "pass_doorway"))

    # -- recalling the width of the body, or learning it

    def recall(b_unit_task="unit_task:recall state:start", motor="busy:False"):
        b_unit_task.modify(state="recalling")
        DM.request(f"posture:{shoulders.posture} end:done extreme:maximum")

    def recalled(b_unit_task="unit_task:recall state:recalling", b_DM="posture:? width:?width"):
        self.narrowest = float(width)
        b_unit_task.modify(state="finished")
        b_DM.clear()

    def swing_out(b_unit_task="unit_task:learn state:start", motor="busy:False"):
        b_method.set("method:swing left:4")
        b_unit_task.modify(state="out")
        shoulders.turn(1, swing)

    def swing_back(b_unit_task="unit_task:learn state:out", motor="busy:False width:?width"):
        self.narrowest = float(width)
        b_unit_task.modify(state="back")
        shoulders.turn(0, swing)

    def swing_to_the_other_side(b_unit_task="unit_task:learn state:back", b_method="left:?left!1", motor="busy:False"):
        b_method.modify(left=int(left) - 1)
        b_unit_task.modify(state="out")
        shoulders.side = -shoulders.side
        shoulders.turn(1, swing)

    def know(b_unit_task="unit_task:learn state:back", b_method="left:1", motor="busy:False"):
        b_unit_task.modify(state="finished")

    # -- judging

    def look(b_unit_task="unit_task:judge state:start", motor="width:?width"):
        shoulders.side = self.random.choice([1, -1])
        b_unit_task.modify(state="looking")
        vision.request(DOOR, width=f">{passable * float(width):.4f}")

    def remember(b_unit_task="unit_task:judge state:looking", vision="busy:False error:True"):
        b_unit_task.modify(state="remembering")
        DM.request(f"posture:{shoulders.posture} end:done extreme:{'maximum' if shoulders.side > 0 else 'minimum'}")

    def imagine(b_unit_task="unit_task:judge state:remembering", b_DM="posture:? width:?width"):
        b_unit_task.modify(state="imagining")
        vision.request(DOOR, width=f">{passable * float(width):.4f}")
        b_DM.clear()

    def can_pass(b_unit_task="unit_task:judge state:?how", vision="busy:False", b_visual="feature:opening distance:?far"):
        print(f"{self.now():.2f} s: can pass {'as it is' if how == 'looking' else 'turned'}")
        self.judged = "as it is" if how == "looking" else "turned"
        if self.only_judges:
            self.stop()
        b_unit_task.modify(state="finished")
        b_visual.clear()
        way.walk(float(far) + BEHIND, self.speed)

    def decline(b_unit_task="unit_task:judge state:imagining", vision="busy:False error:True"):
        print(f"{self.now():.2f} s: cannot pass")
        self.judged = "not at all"
        self.stop()

    # -- walking

    def set_out(b_unit_task="unit_task:approach state:start resumed:no"):
        b_unit_task.modify(state="walking")
        b_turn.set("watch:yes way:unknown")
        motor.walk(self.speed)

    def walk_on(b_unit_task="unit_task:approach state:start resumed:yes"):
        b_unit_task.modify(state="walking")

    def change_pace(pace="wanted:?wanted kept:!?wanted"):
        pace.kept = pace.wanted
        before = self.stopping
        self.go_at(pace.wanted or usual)
        way.change(self.speed)
        near.change(self.speed, before - self.stopping)
        shoulders.change(self.rate)
        if motor.walking:
            motor.walk(self.speed)

    def go_at(self, speed):
        """Sets the walking speed [m/s]."""
        self.speed = speed

    def nears(self, far):
        """Starts the timer for coming too near to an object at a distance [m]; returns whether it is too near already."""
        left = float(far) - self.stopping
        self.near.walk(max(0, left), self.speed)
        return left < 0

    def arrive(b_unit_task="unit_task:approach state:walking", way="state:over"):
        b_unit_task.modify(state="finished")

    def arrive_while_turning(b_unit_task="unit_task:turn", way="state:over"):
        b_context.set("way:clear")
        b_unit_task.modify(state="finished")

    def turn_back(b_unit_task="unit_task:leave state:start"):
        b_turn.set("watch:no")
        b_unit_task.modify(state="turning")
        shoulders.stop()
        shoulders.turn(0, swing)
        motor.stop("legs")

    def stand(b_unit_task="unit_task:leave state:turning", motor="busy:False"):
        print(f"{self.now():.2f} s: is through")
        self.stop()

    def be_held(b_turn="watch:?", motor="legs_end:blocked"):
        print(f"{self.now():.2f} s: something is in the way")
        motor.stop()
        self.stop()


class Replication(Walker):
    """The original ACT-R 3D's model. Source of all numbers: facts about its code (docs/human-data.md)."""

    eyes = EyesStepwise()
    shoulders = Shoulders()
    answer = "turn"
    passable = 1.139
    stopping = 0.5  # without an opening, it stops at this distance [m]; chosen for this model, the original never stopped
    rate = swing = 120

    def wanted(self, width):
        """Returns the least width of an opening at which the walker need not turn further [m]."""
        fits = self.b_turn["way"] == "clear" or self.shoulders.turned()
        return (TIGHT if fits else 1 + self.margin) * width


class Descriptive(Walker):
    """A walker that is given people's behaviour.

    It keeps the same margin in any posture, a fraction of its shoulder width. Three of its numbers are not measured: when it reacts,
    how fast it turns, and how far it continues to turn. Because of the last two it turns more when it walks faster.
    """

    eyes = EyesContinuous()
    shoulders = WholeBody()
    answer = "ask"
    passable = 1.16
    swing = 120 * SIDEWAYS / TORSO  # learning takes as long as in the replication

    def go_at(self, speed):
        """Sets the walking speed [m/s], and the values that depend on it."""
        super().go_at(speed)
        # A body that is turned sideways reaches half its width ahead.
        self.stopping = max(ROOM * self.shoulder_width, self.shoulder_width / 2 + STOPPING * speed)
        self.radius = max(REACTION * speed, FAR)
        self.rate = TURNING * speed

    def wanted(self, width):
        """Returns the least width of an opening at which the walker need not turn further [m]."""
        if self.shoulders.turned():
            return TIGHT * width
        if self.shoulders.angle() <= 1:
            less = 0
        else:  # an opening that was wide enough still is if it is perceived a little narrower
            less = 2 * ON if self.b_turn["way"] == "clear" else ON
        return max(TIGHT * width, width + (self.margin - less) * self.shoulder_width)


REACTION = 1.6
"""A person reacts to a wall this long before reaching it [s], but at least at the distance `FAR`: nearer than that, a slow walker could
not turn fully, or would have the edges of the doorway out of sight. Source: chosen for this model; long enough for a full turn."""
FAR = 2.0
"""The least distance at which people react [m]. Source: chosen for this model: 1.3 m for a full turn (`TURNING`), 0.5 for stopping,
and 0.2 for reacting."""
TURNING = 62.0
"""The turn of a person's shoulders for each metre that the legs walk [degrees/m]: 80 degrees/s at 1.29 m/s. Source: chosen for this
model, fast enough to turn sideways within `REACTION`; also that it grows with the speed, because people turn more when they are fast."""
ON = 0.055
"""How much the room still grows after vision has found it sufficient, because the turn does not stop immediately, as a fraction of the
shoulder width. Source: chosen for this model."""
ROOM = 0.9
"""The least distance from the doorway that a person keeps until it can be passed, in shoulder widths. Source: chosen for this model: a
turning body needs half of its width, and the edges of the doorway must stay visible."""
STOPPING = 0.25
"""The time that a person needs to see that there is no way through, and to stop [s]. Source: chosen for this model: three answers of
vision."""
RADIUS = 3.0
"""The distance at which an obstacle alerts the replication, in shoulder widths. Source: docs/human-data.md."""
HEIGHT = 1.714
"""The height of the replication's body, in both groups [m]. Source: shoulders of 0.444 m, the mean of both, over `SHOULDERS`."""
BAR = 0.03
"""The thickness of a bar that the walker holds [m]. Source: chosen for this model."""
TRUNK = 0.11
"""The depth of the replication's trunk [m]. Source: the value that fits the original's means best; the original's depth is not known."""


def body_of(parameters: Parameters) -> Mannequin:
    """Returns the body of the walker."""
    p = parameters
    width = p.shoulder_width or WIDTHS[p.group]
    common = {"name": "walker", "shoulder_width": width, "position": (0.0, p.start_aside), "heading": radians(p.start_heading)}
    if p.bar is not None:
        common["load"] = Load(shape="bar", size=(p.bar, BAR))
    if p.variant == "descriptive":
        return Mannequin(height=width / SHOULDERS, depth=CHEST * width, sideways=True, **common)
    return Mannequin(height=HEIGHT, trunk="box", depth=TRUNK, **common)


def agent_of(parameters: Parameters) -> Walker:
    """Returns the agent in that body."""
    p = parameters
    width = p.shoulder_width or WIDTHS[p.group]
    given = {"usual": SPEEDS[p.group, p.condition], "noise": p.noise, "only_judges": p.task == "judge", "judged": None}
    given["knows_body"] = p.body == "known"
    if p.variant == "descriptive":
        agent = Descriptive(margin=0.30 if p.margin is None else p.margin, shoulder_width=width, **given)
    else:
        agent = Replication(margin=0.139 if p.margin is None else p.margin, radius=RADIUS * width, **given)
    agent.pace.wanted = agent.pace.kept = p.speed
    agent.go_at(p.speed or agent.usual)
    return agent


def predictive(parameters: Parameters) -> Simulation:
    """Builds the predictive walker, whose file is beside this one."""
    import predictive_walker

    p = parameters
    common = ("aperture", "task", "body", "bar", "start_aside", "start_heading")
    own = ("contact_cost", "perceptual_noise", "memory_noise", "memories", "impact", "units", "gait")
    values = {name: getattr(p, name) for name in (*common, *own) if getattr(p, name) is not None}
    values |= {"shoulder_width": p.shoulder_width or WIDTHS[p.group], "speed": p.speed or SPEEDS[p.group, p.condition]}
    return predictive_walker.build(predictive_walker.Parameters(**values))


def build(parameters: Parameters) -> Simulation:
    """Puts a walker 7 m before a doorway."""
    if parameters.variant == "predictive":
        return predictive(parameters)
    scene = Scene(parts=(Floor(), Aperture(width=parameters.aperture), body_of(parameters)))
    simulation = Simulation(scene, {"walker": lambda: agent_of(parameters)})
    simulation.measure(Passage("walker"))
    return simulation

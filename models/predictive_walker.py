"""A person walks through a doorway, and decides from experience how far to turn the shoulders.

No ratio and no margin is a rule of this model. One number, the cost of contacts, is fitted to one ratio of people: half of the passages of
small walkers at 1.30 shoulder widths, at normal speed, should be turned. The walker has passed doorways before, with empty hands or with a
bar as now. It remembers of 150 passages how much wider than its body the doorway looked, in widths of its own shoulders, how fast it
walked, and what came of it: nothing, a brush, or a hit, and how hard. Memories hold both widths and the turn, too, but only the room,
their difference, and the speed are compared. We assume that room is compared in shoulder widths. Almost from this assumption alone it
follows that large and small people turn alike at the same ratio of doorway and shoulders (`units = "metres"` shows what happens
otherwise).

For each turn of its shoulders that it can imagine, it knows from its body schema how wide it will be, and expects by blending its memories
what the passage will cost. It chooses the turn with the smallest sum of effort and expected cost of contacts. The effort is the work of
turning, and of walking more slowly and then fast again. Asked whether it could pass a doorway, it says what came of the one passage that is
most active for the room there is. When it walks, it declines if it was stopped in the passage that is most active for the cheapest turn.

The body walks with a gait (`actr3d.world.Gait`): it sways, and its steps vary. So it needs more room than its width, and the less room
it has the more often it touches the wall. The eyes see the doorway with noise, less when it is near; and the felt width has noise.

Four parallel systems:

- *Steering* (a production of 50 ms for each look and each turn) walks to the middle of the doorway by the law of Fajen & Warren (2003). A
  doorway is the opening between two things, however wide it is. If it is hidden, the walker goes to its expected position, computed
  from its own movement.
- *Avoiding* notices objects that are nearer than the doorway; the same law turns away from them. Near the doorway the walker waits if
  an object approaches the doorway, on either side, and is as near to it as the walker. It waits as long as the object approaches, and
  then until its patience ends. Then it looks for the doorway again, unless it has waited for somebody, and goes on; if there is none, it
  gives up.
- *Planning* imagines one turn after the other, and keeps the cheapest. It plans again and again until two steps before the doorway; what
  it does then is what the last finished plan says, which may have begun 3 s before.
- *Walking* turns the shoulders in one of these two steps, about half a step before the doorway, and turns them back behind it. With
  turned hips its steps are shorter, so it walks more slowly meanwhile.

Two people
----------
When somebody comes from the other side, the walker first plans for half of the doorway, as if a wall stood in the middle. If it is cheapest
not to turn there, it walks through the right half and does not wait. Otherwise it waits; when its patience ends, it plans again, and waits
again if somebody comes meanwhile. While it waits, it walks backwards from somebody who is nearer than three steps.

Which doorways are wide enough for two follows from experience, as all plans do. The other rules of this scene were chosen and are not
predictions: where the walker waits (`YIELD`), and for how long (`PATIENCE`), so also who goes first; that it keeps to the right, and backs
off; and that it does not share a doorway for which it once had another plan.

How pairs pass doorways of different widths is in docs/results.md.

What to expect
--------------
- `aperture = 0.5`: turns by 10 to 40 degrees, or not at all.
- `aperture = 0.8`: walks straight through.
- `aperture = 0.2`: sets out, and gives up before the doorway; the result is `stopped`.

What to try
-----------
- `aperture = 0.5, speed = 1.8`: a fast walker.
- `start_aside = 1.0, start_heading = 20.0`: steers to the middle of the doorway.
- `scene = "pillar", aperture = 1.2`: walks round a pillar.
- `scene = "two doorways", aperture = 1.0`: chooses one of two.
- `scene = "two people", aperture = 0.8`: somebody comes from the other side; both wait, and the one whose patience ends first goes first.
- `scene = "two people", aperture = 1.4`: both pass, each on its right.
- `closing = 0.065, aperture = 0.9`: the doorway closes while it walks there. It turns for a width that it saw before it decided.
- `contact_cost = 60.0`: fears to touch the wall.
- `gait = False`: glides, and so did all the bodies of its experience.
- `units = "metres"`: compares passages by their room in metres. Then a large walker turns less than a small one at the same ratio.
- In the 3D view, the label above the walker has the turn that it plans, and the costs that it expects of turns; the overlay «handles to move
  things» moves its start.
"""

from dataclasses import dataclass, replace
from functools import partial
from math import atan2, cos, degrees, exp, hypot, inf, pi, radians, sin, sqrt
from typing import Annotated, Literal

from annotated_types import Ge, Gt, Le

from actr3d.actr import *
from actr3d.configuration import Configuration, Live
from actr3d.experiment.aperture import Passage, experiences
from actr3d.motor import Motor, Plan
from actr3d.simulation import Simulation
from actr3d.vision import Vision
from actr3d.world import Aperture, Floor, Gait, Load, Mannequin, Scene, Wall

CONTACT_COST = 28.0
"""The one free parameter: fitted with `actr3d fit critical_ratio`, so that half of the passages at 1.30 shoulder widths are turned."""
PERCEPTUAL_NOISE, MEMORY_NOISE = 1.0, 0.1
"""The factor of the noise of what it sees and feels, and the noise of the activation of memories. Source: chosen for this model, before
any result was seen."""
DAMPING, ATTRACTION, NEARNESS, MIN_ATTRACTION = 3.25, 7.50, 0.40, 0.40
"""The walker turns towards its goal with the acceleration -b φ' - k (φ - ψ) (exp(-c1 d) + c2); b [1/s], k [1/s²], c1 [1/m], c2.
Source: Fajen & Warren (2003), J Exp Psychol Hum Percept Perform 29 (docs/human-data.md)."""
REPULSION, NARROWNESS, REACH = 198.0, 6.5, 0.8
"""It turns away from obstacles with the acceleration k (φ - ψ) exp(-c3 |φ - ψ|) exp(-c4 d); k [1/s²], c3 [1/rad], c4 [1/m].
Source: Fajen & Warren (2003)."""
NOTICE = 4.0
"""Objects count as obstacles up to this distance [m], and somebody who comes is noticed up to this distance behind the doorway. Source:
chosen, about the protective zone of 3.8 m that Hackney et al. (2013) found (docs/human-data.md)."""
BEFORE, LAG, FORGET = 0.15, 0.5, 0.5
"""An object counts as an obstacle if it is nearer than the doorway by more than the first number [m] plus the distance walked in the second
[s] (it looks at one after the other), and for the third [s] after it was last noticed. Source: chosen for this model."""
BETWEEN = 3.2
"""The distance between the middles of two doorways [m]. Source: chosen for this model."""
HEADING_NOISE = 0.02
"""Random changes of the speed of turning: its standard deviation after one second [rad/s]. Source: chosen for this model."""
SLOWEST = 0.01
"""Turns slower than this are not made [rad/s]. Source: chosen for this model."""
STEPS = 2.0
"""Distance from the doorway at which it stops planning, and does what the last finished plan says [steps]. Source: chosen, because people look
about two steps ahead (Patla & Vickers 2003); that they decide then is our assumption."""
TURNING = 1.0
"""Duration of a turn of the shoulders [steps]. As seeing and deciding take time, they begin about one and a half steps before the doorway,
and are turned about half a step before it. Source: chosen for this model."""
TURNS = tuple(range(0, 81, 10))
"""The turns that it imagines [degrees]. Source: chosen for this model."""
HEAD = 0.75
"""The part of a turn by which the head turns back against the shoulders; the eyes do the rest. Source: chosen from the neck's range."""
HIPS = 0.45
"""The part of a turn that the hips make; the torso makes the rest. Source: chosen from the ranges of both, about 45 and 55 degrees."""
SHARES = {"stance": HIPS, "torso": 1 - HIPS, "head": -HEAD, "eye": HEAD - 1}
"""How a turn is shared: the head turns back with the eyes, so that it looks where it walks. Source: follows from the two numbers above."""
INERTIA = 1.5
"""Moment of inertia of a turning person about the vertical [kg m²]. Source: chosen, of the order of a standing adult's."""
ROOM, PACE, ANGLE, TEMPERATURE = 0.02, 0.3, 5.0, 1.0
"""Differences of room [m], speed [m/s] and angle [degrees] at which the similarity of two memories is -1; and the temperature of blending.
At the same cost of contacts, the first one decides how much room it wants more than any other number; a fit of the cost makes up for it
(docs/results.md). Source: chosen for this model."""
BODY = 0.4
"""The shoulder width [m] at which the similarity of two rooms is the same in both units. Source: chosen for this model."""
DISTANCE_NOISE, EDGE_NOISE, WIDTH_NOISE = 0.02, 0.002, 0.005
"""Standard deviations, for `perceptual_noise = 1`: of seen distances, as a fraction; of seen directions of edges [rad]; of felt widths [m].
Source: chosen for this model. They have no bias, as people's have none up to 15 m (Fukusima, Loomis & Da Silva 1997, J Exp Psychol Hum
Percept Perform 23); no Weber fraction of people for doorways at such distances was at hand."""
CYCLE = 0.05
"""Time of a production, and of a search of vision [s]. Source: productions of ACT-R; the search as in the original (docs/human-data.md)."""
FEELING = 1.0
"""Duration of a turn to feel its width, of the turn back, and of the turn back behind the doorway [s]. Source: chosen for this model."""
GRAIN, FELT = 0.001, 4.0
"""Step to which the felt width is rounded [m], and the change of an angle after which the posture is stored again [degrees]. Source: chosen
for this model."""
LONGEST = 0.3
"""Upper limit of the time between two looks at the doorway that steering uses [s]. Source: chosen for this model."""
YIELD = 3.0
"""Distance from the doorway within which it waits if somebody else is nearer to it [steps]; if it stands within this distance, it sets out
only with a plan. While it waits, it keeps this distance from somebody who comes. Source: chosen for this model."""
PATIENCE = (0.5, 3.0)
"""The least and the greatest time that it waits while nobody comes nearer [s]. Source: chosen for this model."""
PAUSE = 0.4
"""Time between two plans [s]. Source: chosen for this model."""
MEMORIES = 150
"""Number of passages that a walker remembers. Source: chosen for this model."""
ANY = 10.0
"""Cost of any contact where its energy does not count [J]. Source: chosen for this model."""
DOOR = "feature:opening height:>2 depth:>0.5"
"""Doorways: openings as high as doors are, and free behind [m]. A gap beside a person is not as high. Source: chosen for this model."""
BLOCKED = 0.1
"""Time without progress after which a movement ends as blocked, and the walk with it [s]. Source: chosen for this model."""
FIELD = 2.6
"""The width of the field of view [rad]. Source: chosen for this model."""
BEHIND = 0.8
"""How far behind the doorway it turns back [m]. Source: chosen for this model."""
HEIGHT, CHEST = 1 / 0.259, 0.563
"""Height, and depth of the chest, in shoulder widths. Source: Drillis & Contini (1966); ANSUR II (2012)."""
BAR = 0.03
"""The thickness of a bar [m]. Source: chosen for this model."""
DISTANCE = 7.0
"""How far before the doorway a walk begins [m]. Source: the original's scene (docs/human-data.md)."""
PILLAR = 4.0, 0.3
"""The distance of the pillar from the start, and its width [m]. Source: chosen for this model."""
COLOUR = (0.62, 0.43, 0.35, 1.0)
"""The clothes of the other person. Source: chosen for this model."""


@dataclass(frozen=True, kw_only=True)
class Parameters(Configuration):
    """The parameters of the model."""

    aperture: Annotated[float, Gt(0), Le(3), Live("aperture")] = 0.5
    """The free width of the doorway [m]; or of each of two, which stay as they are during a run."""

    shoulder_width: Annotated[float, Ge(0.3), Le(0.7)] = 0.404
    """The shoulder width [m]. Source: the small group of Warren & Whang (1987)."""

    speed: Annotated[float, Ge(0.1), Le(3), Live("parameter", "walker.pace.wanted")] = 1.29
    """The walking speed [m/s]. Source: Warren & Whang (1987), small group."""

    contact_cost: Annotated[float, Ge(0), Le(1000)] = CONTACT_COST
    """The cost of an impact of 1 J, in units of the effort of 1 J. The free parameter."""

    perceptual_noise: Annotated[float, Ge(0), Le(10)] = PERCEPTUAL_NOISE
    """Factor of all noise of what it sees and feels."""

    memory_noise: Annotated[float, Ge(0), Le(2)] = MEMORY_NOISE
    """Noise of the activation of memories."""

    turn: Annotated[float, Ge(0), Le(80)] | None = None
    """The turn that it makes whatever it expects [degrees]; None: it decides. Used to make experiences."""

    task: Literal["walk", "judge"] = "walk"
    """What the walker does: walks through the doorway, or only judges whether it could pass without turning."""

    body: Literal["learned", "known"] = "learned"
    """Whether the walker first turns once to learn how wide it is in each posture, or knows it from the start."""

    bar: Annotated[float, Ge(0.1), Le(2)] | None = None
    """The length of a bar that the walker holds crosswise in front of it [m]; None: empty hands."""

    start_aside: Annotated[float, Ge(-1), Le(1)] = 0.0
    """How far to the left of the middle of the doorway the walker starts [m]."""

    start_heading: Annotated[float, Ge(-20), Le(20)] = 0.0
    """The walking direction at the start [degrees]; 0 is straight ahead, positive to the left."""

    scene: Literal["doorway", "pillar", "two doorways", "two people"] = "doorway"
    """What is before the walker: a doorway; the same with a pillar on the way, or with somebody who comes from the other side; or two
    doorways side by side."""

    closing: Annotated[float, Ge(0), Le(1)] = 0.0
    """How fast the doorway closes, from the start on [m/s]."""

    gait: bool = True
    """Whether it steps and sways, now and in its memories; otherwise it glides."""

    memories: Annotated[int, Ge(0), Le(1000)] = MEMORIES
    """The number of passages that it remembers, drawn at random from those that were simulated."""

    impact: Literal["energy", "any"] = "energy"
    """What the cost of a contact grows with: its energy; or nothing, each costs as much as an impact of 10 J."""

    units: Literal["metres", "shoulders"] = "shoulders"
    """The units in which it remembers how much room a passage had: its own shoulder width, or metres."""


def forward(speed, turn):
    """Returns the speed along the way [m/s] of somebody who walks at a speed [m/s] and has turned the shoulders by an angle [degrees].

    Steps go as far along the way as the hips face it. People slow down more if they turn more (Wilmut & Barnett 2010, Hum Mov Sci 29);
    here, the amount follows from the share of the turn that the hips make.
    """
    return speed * cos(radians(HIPS * turn))


def work(turn, speed, seconds, inertia=INERTIA):
    """Returns the effort of turning the shoulders by an angle [degrees] at a walking speed [m/s]: the work of all movements [J].

    These are the turn, in a time [s], the turn back, slowing down, and walking at the speed again. Each starts and stops something: its
    kinetic energy is put in once, and taken out once. The measured cost of speed changes in people agrees with a model of kinetic energy,
    among others (Seethapathi & Srinivasan 2015, Biol Lett 11).
    """
    turning = inertia * sum((radians(turn) / time) ** 2 for time in (seconds, FEELING))
    return turning + Mannequin.mass * (speed**2 - forward(speed, turn) ** 2)


class Similar(Partial):
    """Numbers are the more similar the nearer they are: the similarity is -1 at a difference that is given for each slot."""

    def match(self, key, a, b):
        return -self.strength * abs(float(a) - float(b)) / self.scales[key]


class Wait(Model):
    """A timer: `state` is «over» some time after the last `go`."""

    state = "idle"
    begun = 0

    def go(self, seconds):
        self.state = "on"
        self.begun += 1
        mine = self.begun
        yield seconds
        if mine == self.begun:
            self.state = "over"


class Pace(Model):
    """The wanted walking speed [m/s], which a user may change; None: that of the start."""


class Steering(ACTR):
    """Walks to the middle of the doorway that it sees."""

    production_time = CYCLE

    def look(b_course="steer:yes", vision="busy:False error:False", b_visual=None, b_door="left:?left right:?right"):
        """Looks for the doorway: the opening between the same two things, however wide it is now."""
        vision.request(DOOR, left="?left", right="?right")

    def steer(
        b_course="steer:yes",
        b_visual="feature:opening distance:?far direction:?aside width:?wide depth:?deep left:?left right:?right",
    ):
        b_visual.clear()
        b_door.modify(width=wide, left=left, right=right)
        self.parent.looks_around = False
        self.parent.steer_towards(float(far), float(aside), float(deep))

    def look_around(b_course="steer:yes", vision="busy:False error:True", motor="width:?width", b_door="left:?left right:?right"):
        """Looks for any opening that is wide enough; without one, something hides the doorway. A gap beside somebody is no doorway."""
        self.parent.looks_around = b_goal["do"] == "walk" and not (self.parent.looks_around or self.parent.met)
        if self.parent.looks_around:
            vision.request(DOOR, width=f">{width}")
        else:
            self.parent.steer_towards(*self.parent.expected(), 0)
            vision.request(DOOR, left="?left", right="?right")


class Avoiding(ACTR):
    """Notices objects that are nearer than the doorway, one after the other."""

    production_time = CYCLE

    def look(b_course="steer:yes", periphery="busy:False", b_obstacle=None, b_door="far:?far"):
        way = 0 if b_goal["do"] == "wait" else LAG * self.parent.speed
        nearer = min(NOTICE, float(far) - BEFORE - way)
        if nearer > 0:
            periphery.request("feature:obstacle", distance=f"<{nearer:.2f}")

    def avoid(b_obstacle="feature:obstacle object:?what distance:?far leftmost:?left rightmost:?right"):
        b_obstacle.clear()
        self.parent.obstacle = float(far), radians(float(left) + float(right)) / 2, self.now(), what


class Planning(ACTR):
    """Imagines turns of the shoulders, one after the other, and keeps the cheapest; some time later it begins again.

    It ends when the effort of a larger turn alone would cost more than the cheapest until then.
    """

    production_time = CYCLE

    def begin(b_goal="do:walk", b_imagined=None, b_door="width:?wide", pause="state:!on"):
        """Begins with half of the doorway if somebody comes, unless it is known that half is not enough."""
        self.half = self.parent.met and self.parent.shares is not False and self.parent.always is None
        self.consider(float(wide) / 2 if self.half else wide)

    def consider(self, door):
        """Begins to imagine turns for a doorway of a width [m]."""
        self.cheapest, self.costs = None, {}
        first = TURNS[0] if self.parent.always is None else self.parent.always
        self.parent.b_imagined.set(f"turn:{first} door:{door} state:new")

    def imagine(b_imagined="turn:?turn state:new"):
        DM.request(f"torso_yaw:{self.parent.side * (1 - HIPS) * float(turn):.2f} width:? middle:?")
        b_imagined.modify(state="felt")

    def expect(b_imagined="state:felt turn:?turn door:?door", b_DM="width:?width middle:?middle"):
        b_DM.clear()
        if self.parent.always is not None:
            self.decide(f"turn:{turn} width:{width} middle:{middle} cost:0 outcome:free")
            return
        room = self.parent.room(door, width, self.parent.shoulders)
        experience.request(f"event:passage room:{room} speed:{self.parent.speed:.2f} energy:? free:? outcome:?")
        b_imagined.set(f"turn:{turn} door:{door} width:{width} middle:{middle} state:expected")

    def know_nothing(b_imagined="state:expected turn:?turn width:?width middle:?middle", experience="error:True"):
        self.half = False
        self.decide(f"turn:{TURNS[0]} width:{width} middle:{middle} cost:0 outcome:free")

    def compare(
        b_imagined="state:expected turn:?turn door:?door width:?width middle:?middle",
        b_experience="energy:?energy free:?free outcome:?outcome",
    ):
        b_experience.clear()
        expected = float(energy) if self.parent.impact == "energy" else ANY * (1 - float(free))
        cost = self.parent.effort(float(turn)) + self.parent.contact_cost * expected
        self.costs[float(turn)] = cost
        if self.cheapest is None or cost < self.cheapest[0]:
            self.cheapest = cost, f"turn:{turn} width:{width} middle:{middle} cost:{cost:.3f} outcome:{outcome}"
        further = [other for other in TURNS if other > float(turn) and self.parent.effort(other) < self.cheapest[0]]
        if self.half and cost == self.cheapest[0] and float(turn):  # half of the doorway is not enough to walk through it straight
            self.half = self.parent.shares = False
            self.consider(2 * float(door))
        elif further:
            b_imagined.set(f"turn:{further[0]} door:{door} state:new")
        else:
            self.decide(self.cheapest[1])

    def decide(self, plan):
        """Stores a plan, unless it is too late; the walker then steers so that the middle of its turned body passes through the middle of the
        doorway, or of its right half."""
        if self.parent.b_goal["do"] == "walk":
            self.parent.b_plan.set(plan)
            self.parent.costs = self.costs
            self.parent.middle = float(self.parent.b_plan["middle"])
            if self.half:
                self.parent.shares = True
                self.parent.middle += float(self.parent.b_imagined["door"]) / 2
        self.parent.b_imagined.clear()
        self.parent.pause.go(PAUSE)


class Person(ACTR):
    """Feels how wide it is in each posture, then walks through the doorway."""

    production_time = CYCLE
    b_goal = Buffer()
    b_course = Buffer()
    b_visual = Buffer()
    b_door = Buffer()
    b_imagined = Buffer()
    b_plan = Buffer()
    b_DM = Buffer()
    DM = Memory(b_DM, latency=0, threshold=None)
    similar_posture = Similar(DM)
    b_experience = Buffer()
    experience = BlendingMemory(b_experience, latency=0, threshold=None, maximum_time=CYCLE)
    activation_noise = DMNoise(experience, noise=MEMORY_NOISE)
    alike = Similar(experience)
    vision = Vision(b_visual, delay=CYCLE, horizontal_fov=FIELD)
    b_obstacle = Buffer()
    periphery = Vision(b_obstacle, delay=CYCLE, horizontal_fov=FIELD)
    motor = Motor(memory=DM, size_grid=GRAIN, extreme_step=FELT, patience=BLOCKED)
    way = Wait()
    pause = Wait()
    pace = Pace()
    steering = Steering()
    avoiding = Avoiding()
    planning = Planning()

    def init():
        similar_posture.scales = {"torso_yaw": ANGLE}
        alike.scales = {"room": ROOM if units == "metres" else ROOM / BODY, "speed": PACE}
        experience.temperature = TEMPERATURE
        activation_noise.noise = memory_noise
        vision.distance_noise, vision.edge_noise = noise * DISTANCE_NOISE, noise * EDGE_NOISE
        motor.size_noise = noise * WIDTH_NOISE
        known = experiences(walks=walks, hands=hands) if always is None else ()
        for passage in self.random.sample(known, min(memories, len(known))):
            room = self.room(passage["seen"], passage["felt"], passage["shoulders"])
            numbers = " ".join(f"{slot}:{passage[slot]}" for slot in ("seen", "felt", "turn", "speed", "energy", "free"))
            outcome = "free" if passage["free"] else "touched" if passage["passed"] else "stopped"
            experience.add(f"event:passage room:{room} {numbers} outcome:{outcome}")
        self.side = self.random.choice([1, -1])
        self.rate, self.turned, self.middle, self.obstacle, self.looks_around = 0.0, 0, 0.0, None, False
        self.taken, self.nearest, self.patient_until = 0.0, inf, 0.0
        self.met, self.shares = False, None
        self.costs = {}
        b_goal.set("do:look" if knows_body else "do:feel")
        if knows_body:
            for turn in TURNS[1:]:  # it feels how wide it is now
                motor.know("torso_yaw", {f"{part}_yaw": self.side * share * turn for part, share in SHARES.items()})

    # -- the body schema

    def turn_out(b_goal="do:feel", motor="busy:False"):
        self.turn_shoulders(TURNS[-1], FEELING)
        b_goal.set("do:return")

    def turn_in(b_goal="do:return", motor="busy:False"):
        self.turn_shoulders(0, FEELING)
        b_goal.set("do:look")

    def turn_shoulders(self, angle, seconds):
        """Turns the shoulders to an angle [degrees], in a time [s]; head and eyes keep their direction."""
        rate = abs(angle - self.turned) / seconds
        for part, share in SHARES.items() if rate else ():
            self.motor.rotate(part, "yaw", self.side * share * angle, abs(share) * rate)
        self.turned = angle

    def planned(self):
        """Returns what the workbench shows of its plan: the turned body until it turns, and the expected costs until it is through."""
        if not self.b_goal or self.b_goal["do"] not in ("walk", "wait", "turn", "pass") or not self.costs:
            return None
        turn = float(self.b_plan["turn"])
        effort, cost = round(self.effort(turn), 1), round(float(self.b_plan["cost"]), 1)
        (none, straight), *others = self.costs.items()
        costs = "   ".join(f"{other:.0f}°: {value:.0f}" for other, value in [(none, straight), *others[-4:]])
        what = "declines; cheapest " if self.b_plan["outcome"] == "stopped" else ""
        text = f"{what}turn by {turn:.0f}°: cost {cost:.1f} = effort {effort:.1f} + contacts {cost - effort:.1f}\n{costs}"
        if turn == 0 or self.b_goal["do"] in ("turn", "pass"):
            return Plan(text=text)
        return Plan(text=text, posture={f"{part}_yaw": self.side * share * turn for part, share in SHARES.items()})

    # -- judging

    def room(self, seen, felt, shoulders):
        """Returns how much room a doorway leaves to a body [m], or in shoulder widths, to three decimals."""
        room = float(seen) - float(felt)
        return f"{room if self.units == 'metres' else room / shoulders:.3f}"

    def look(b_goal="do:look", motor="busy:False"):
        vision.request(DOOR)
        b_goal.set("do:judge" if self.only_judges else "do:start")

    def cannot_see(b_goal="do:!look", vision="error:True", b_course=None, b_door=None):
        print(f"{self.now():.2f} s: {self.who}sees no doorway")
        self.judged = "not at all"
        self.stop()

    def remember_a_passage(b_goal="do:judge", b_visual="feature:opening width:?wide", motor="width:?width"):
        """Requests what came of a passage through such a doorway, at any speed. Words are not blended: it is that of the most active one."""
        b_visual.clear()
        experience.request(f"event:passage room:{self.room(wide, width, self.shoulders)} outcome:?")
        b_goal.set(f"do:say door:{wide}")

    def say_as_it_is(b_goal="do:say", b_experience="outcome:free"):
        self.report("as it is")

    def imagine_the_greatest_turn(b_goal="do:say door:?door", b_experience="outcome:!free"):
        b_experience.clear()
        DM.request(f"torso_yaw:{self.side * (1 - HIPS) * TURNS[-1]:.2f} width:?")
        b_goal.set(f"do:imagine door:{door}")

    def remember_a_turned_passage(b_goal="do:imagine door:?door", b_DM="width:?width"):
        """Requests what came of a passage with the room that the greatest turn leaves."""
        b_DM.clear()
        experience.request(f"event:passage room:{self.room(door, width, self.shoulders)} outcome:?")
        b_goal.set("do:doubt")

    def say_turned(b_goal="do:doubt", b_experience="outcome:!stopped"):
        self.report("turned")

    def say_not_at_all(b_goal="do:doubt", b_experience="outcome:stopped"):
        self.report("not at all")

    def know_nothing(b_goal="do:say", experience="error:True"):
        """Without experience it judges as it would walk: it turns only if the turn is given."""
        self.report("turned" if self.always else "as it is")

    def report(self, judged):
        """Says whether and how it can pass."""
        self.judged = judged
        print(f"{self.now():.2f} s: {self.who}" + ("cannot pass" if judged == "not at all" else f"can pass {judged}"))
        self.stop()

    # -- walking

    def set_out(b_goal="do:start", b_visual="feature:opening distance:?far width:?wide direction:?aside left:?left right:?right"):
        b_visual.clear()
        b_door.set(f"far:{far} direction:{aside} width:{wide} left:{left} right:{right} near:False free:True close:False")
        b_course.set("steer:yes")
        b_goal.set("do:walk")
        self.seen_at = self.now() + CYCLE  # when it will look again
        if float(far) > YIELD * self.step:
            motor.walk(self.speed)

    def go(b_goal="do:walk", b_door="free:True", b_plan="outcome:!stopped", motor="walking:False legs_end:!blocked"):
        """Sets out near the doorway once it has a plan, unless it remembers that it was stopped in such a doorway."""
        motor.walk(self.speed)

    def stay(b_goal="do:walk", b_door="free:True", b_plan="outcome:stopped", motor="walking:False legs_end:!blocked"):
        """Does not set out: it remembers that it was stopped in such a doorway."""
        b_goal.set("do:decline")

    def change_pace(pace="wanted:?wanted kept:!?wanted"):
        """Walks at another speed from now on."""
        pace.kept = pace.wanted
        before = self.speed
        self.go_at(pace.wanted or usual)
        if way.state == "on":
            self.pass_in(max(0, self.through_at - self.now()) * before / self.speed)
        if motor.walking:
            motor.walk(self.forward())

    def go_at(self, speed):
        """Sets the walking speed [m/s], and with it the length of a step and the time for a turn, which takes one step."""
        frequency = Gait().steps_per_second(speed)
        self.speed, self.step, self.turning_time = speed, speed / frequency, TURNING / frequency

    def forward(self):
        """Returns its speed along the way [m/s], as far as it has turned."""
        return forward(self.speed, self.turned)

    def pass_in(self, seconds):
        """Starts the timer until the walker is through the doorway."""
        self.through_at = self.now() + seconds
        self.way.go(seconds)

    def steer_towards(self, far, left, deep):
        """Steers to the middle of a doorway at a distance [m] and a direction to the left [degrees], with free depth behind it [m].

        In the last step it keeps its course. Before, it waits for an object that approaches and is as near to the doorway as the walker,
        unless they share the doorway; it does not wait for objects that do not move. An object in front of the doorway has a negative depth,
        one that hides it a depth of 0. Each time the object has come nearer, or somebody hides the doorway, the patience starts again.
        Somebody has been met if the depth became smaller by a step.
        """
        now, waits = self.now(), self.b_goal["do"] == "wait"
        obstructed = False
        if self.nearest < inf and 0 < deep < min(NOTICE, self.nearest - self.step):
            self.met = True
        if self.obstacle is not None:
            distance, direction, noticed, what = self.obstacle
            obstructed = now - noticed < FORGET and distance < far - BEFORE
            in_front = abs(distance * sin(direction - radians(left))) < float(self.b_door["width"]) / 2
            if obstructed and in_front and what not in (self.b_door["left"], self.b_door["right"]):
                deep = distance - far
        comes = False
        if (waits or far < YIELD * self.step) and deep < far:
            self.taken = now
            comes = deep < self.nearest - BEFORE or (self.met and deep == 0)
        elif now - self.taken > FORGET:
            self.nearest = deep if self.nearest == inf else max(self.nearest, deep)
        if comes:
            self.nearest, self.patient_until = deep, now + self.random.uniform(*PATIENCE)
        if waits:
            free = now > min(self.patient_until, self.taken + FORGET)
        else:
            free = far < self.step or self.shares or not (comes and (self.motor.walking or self.met))
        elapsed, self.seen_at = min(now - self.seen_at, LONGEST), now
        self.b_door.modify(far=far, direction=left, near=far < STEPS * self.step, free=free)
        if self.met:
            self.b_door.modify(close=far + deep < YIELD * self.step)
        if waits:
            return
        if far < self.step:
            self.b_course.set("steer:no")
            self.turn_course(0.0)
            return
        aside = atan2(far * sin(radians(left)) - self.middle, far * cos(radians(left)))
        pull = ATTRACTION * aside * (exp(-NEARNESS * far) + MIN_ATTRACTION)
        if obstructed:
            pull -= REPULSION * direction * exp(-NARROWNESS * abs(direction)) * exp(-REACH * distance)
        self.rate += (pull - DAMPING * self.rate) * elapsed + self.random.gauss(0, HEADING_NOISE * sqrt(elapsed))
        self.turn_course(self.rate)

    def expected(self):
        """Returns where the doorway must be, by its own movement since it knew it last: distance [m] and direction [degrees]."""
        far, left = float(self.b_door["far"]), radians(float(self.b_door["direction"]))
        elapsed = self.now() - self.seen_at
        forward = -self.speed if self.b_goal["do"] == "wait" else self.forward()
        ahead = far * cos(left) - (forward * elapsed if self.motor.walking else 0)
        aside = far * sin(left)
        return hypot(ahead, aside), degrees(atan2(aside, ahead) - self.rate * elapsed)

    def turn_course(self, rate):
        """Turns the walking direction at a speed [rad/s]."""
        self.motor.turn(speed=degrees(rate) if abs(rate) > SLOWEST else 0)

    def effort(self, turn):
        """Returns the effort of turning the shoulders by an angle [degrees], as `turn` and `leave` do [J]."""
        return work(turn, self.speed, self.turning_time)

    def wait(b_goal="do:!wait", b_door="free:False"):
        """Stops for somebody or something at the doorway."""
        print(f"{self.now():.2f} s: {self.who}waits")
        motor.stop()
        self.rate = 0.0
        self.turn_course(0.0)
        b_goal.set("do:wait")

    def back_off(b_goal="do:wait", b_door="close:True", motor="walking:False"):
        """Walks backwards: somebody comes near."""
        motor.walk(-self.speed)

    def end_backing_off(b_goal="do:wait", b_door="close:False", motor="walking:True"):
        motor.stop()

    def go_on(b_goal="do:wait", b_door="free:True"):
        """Looks for a doorway again, unless it waited for somebody; and plans again: the way is free, or its patience is over."""
        if self.motor.walking:
            motor.stop()
        for buffer in (*(() if self.met else (b_course, b_door)), b_plan, b_imagined, b_DM, b_experience):
            buffer.clear()
        self.costs = {}
        b_goal.set("do:walk" if self.met else "do:look")

    def commit(b_goal="do:walk", b_door="width:?wide near:True free:True", b_plan="turn:?turn width:?width outcome:?outcome"):
        self.committed = {"seen": float(wide), "felt": float(width), "speed": self.speed}
        b_goal.set("do:decline" if outcome == "stopped" else f"do:turn turn:{turn}")

    def decline(b_goal="do:decline"):
        motor.stop()
        self.report("not at all")

    def turn(b_goal="do:turn turn:?turn", b_door="far:?far"):
        print(f"{self.now():.2f} s: {self.who}turns by {turn} degrees")
        self.judged = "turned" if float(turn) else "as it is"
        self.chosen = float(turn)
        self.turn_shoulders(float(turn), self.turning_time)
        motor.walk(self.forward())
        self.pass_in((float(far) + BEHIND) / self.forward())
        b_goal.set("do:pass")

    def leave(b_goal="do:pass", way="state:over"):
        motor.stop()
        self.turn_shoulders(0, FEELING)
        b_goal.set("do:stand")

    def stand(b_goal="do:stand", motor="busy:False"):
        print(f"{self.now():.2f} s: {self.who}is through")
        self.stop()

    def be_held(b_goal="do:!stand", motor="legs_end:blocked walking:False"):
        print(f"{self.now():.2f} s: {self.who}something is in the way")
        motor.stop()
        self.stop()


def person(parameters: Parameters, name: str = "walker") -> Person:
    """Returns an agent."""
    p = parameters
    given = {field: getattr(p, field) for field in ("contact_cost", "memory_noise", "memories", "impact", "units")}
    task = {"always": p.turn, "only_judges": p.task == "judge", "noise": p.perceptual_noise, "knows_body": p.body == "known"}
    remembered = {"walks": p.gait, "hands": "empty" if p.bar is None else "bar"}
    who = "" if p.scene != "two people" else f"{name} "
    body = {"shoulders": p.shoulder_width, "who": who, "usual": p.speed}
    agent = Person(judged=None, chosen=None, committed=None, **body, **given, **task, **remembered)
    agent.pace.wanted = agent.pace.kept = p.speed
    agent.go_at(p.speed)
    return agent


def build(parameters: Parameters) -> Simulation:
    """Builds a walker in front of one doorway or two; optionally with a pillar on the way, or with another walker on the other side."""
    p = parameters
    width = p.shoulder_width
    walker = Mannequin(
        name="walker",
        shoulder_width=width,
        height=HEIGHT * width,
        depth=CHEST * width,
        sideways=True,
        gait=Gait() if p.gait else None,
        load=None if p.bar is None else Load(shape="bar", size=(p.bar, BAR)),
        position=(0.0, p.start_aside),
        heading=radians(p.start_heading),
    )
    parts = [walker, Aperture(width=p.aperture, position=(DISTANCE, 0.0), closing=p.closing)]
    if p.scene == "pillar":
        at, wide = PILLAR
        parts.append(Wall(name="pillar", start=(at, -wide / 2), end=(at, wide / 2), thickness=wide))
    elif p.scene == "two people":
        parts.append(replace(walker, name="other", position=(2 * DISTANCE, 0.0), heading=pi, colour=COLOUR))
    elif p.scene == "two doorways":
        beside = BETWEEN / 2
        shared = {"width": p.aperture, "closing": p.closing, "segment": beside - p.aperture / 2}
        doorways = {"left_doorway": beside, "right_doorway": -beside}
        parts = [walker, *(Aperture(name=name, position=(DISTANCE, y), **shared) for name, y in doorways.items())]
    agents = {part.name: partial(person, p, part.name) for part in parts if isinstance(part, Mannequin)}
    simulation = Simulation(Scene(parts=(Floor(), *parts)), agents)
    if p.scene != "two doorways":
        simulation.measure(Passage("walker"))
    return simulation

"""A person walks through a doorway, and decides from experience how far to turn the shoulders."""

import csv
from dataclasses import dataclass
from math import exp, hypot, radians, sqrt
from pathlib import Path
from typing import Annotated, Literal

from annotated_types import Ge, Gt, Le

from actr3d.actr import *
from actr3d.configuration import Configuration, Live
from actr3d.experiment.aperture import Passage
from actr3d.motor import Motor
from actr3d.simulation import Simulation
from actr3d.vision import Vision
from actr3d.world import Aperture, Floor, Gait, Mannequin, Scene

DAMPING, GOAL, NEARER, LEAST = 3.25, 7.50, 0.40, 0.40
WALK_RATIO = Gait().walk_ratio
DOOR = "feature:opening height:>1.5 depth:>0.5"
TURNS = tuple(range(0, 81, 10))


@dataclass(frozen=True, kw_only=True)
class Parameters(Configuration):
    aperture: Annotated[float, Gt(0), Le(3), Live("aperture")] = 0.5
    shoulder_width: Annotated[float, Ge(0.3), Le(0.7)] = 0.404
    speed: Annotated[float, Ge(0.3), Le(3)] = 1.29
    noise: Annotated[float, Ge(0), Le(10)] = 1.0
    turn: Annotated[float, Ge(0), Le(80)] | None = None
    start_aside: Annotated[float, Ge(-1), Le(1)] = 0.0
    start_heading: Annotated[float, Ge(-20), Le(20)] = 0.0
    gait: bool = True


class Steering(ACTR):
    """Walks to the middle of the opening that it sees (Fajen & Warren 2003)."""

    production_time = 0.05

    def look(b_course="steer:yes", vision="busy:False", b_visual=None):
        vision.request(DOOR)

    def steer(b_course="steer:yes", b_visual="feature:opening distance:?far direction:?left width:?wide"):
        self.parent.sees(float(far), float(left), float(wide))
        b_visual.clear()


class Person(ACTR):
    production_time = 0.05
    b_goal = Buffer()
    b_course = Buffer()
    b_visual = Buffer()
    b_plan = Buffer()
    b_DM = Buffer()
    DM = Memory(b_DM, latency=0)
    vision = Vision(b_visual, delay=0.05, horizontal_fov=2.6)
    motor = Motor(memory=DM, size_grid=0.001, extreme_step=8)
    steering = Steering()

    def init():
        self.door = None
        self.rate = 0.0
        self.seen_at = 0.0
        b_goal.set("do:walk")
        b_course.set("steer:yes")
        motor.walk(self.speed)

    def sees(self, far, left, wide):
        """Steers to the middle of an opening at a distance [m] and a direction to the left [degrees]."""
        self.door = far, wide
        if far < self.onset / 2:  # the last step
            self.b_course.set("steer:no")
            self.motor.turn(speed=1e-3)
            return
        now = self.now()
        elapsed = min(now - self.seen_at, 0.2) if self.seen_at else 0.1
        self.seen_at = now
        pull = GOAL * radians(left) * (exp(-NEARER * far) + LEAST)
        self.rate += (pull - DAMPING * self.rate) * elapsed + self.random.gauss(0, self.sway_of_heading * sqrt(elapsed))
        if abs(self.rate) > 1e-3:
            self.motor.turn(speed=self.rate * 57.29578)

    def straight_on(b_course="steer:yes", vision="busy:False error:True"):
        """The edges of the doorway are out of sight."""
        b_course.set("steer:no")
        motor.turn(speed=1e-3)

    def near(b_goal="do:walk", b_course="steer:yes"):
        if self.door is not None and self.door[0] < self.onset:
            if self.planned:
                motor.rotate("stance", "yaw", 0.45 * self.planned, 0.45 * self.planned / self.turn_time)
                motor.rotate("torso", "yaw", 0.55 * self.planned, 0.55 * self.planned / self.turn_time)
                motor.rotate("head", "yaw", -self.planned * 60 / 80, 200)
            b_goal.set("do:pass")


def build(parameters: Parameters) -> Simulation:
    p = parameters
    body = Mannequin(name="walker", shoulder_width=p.shoulder_width, height=p.shoulder_width / 0.259, depth=0.563 * p.shoulder_width, sideways=True, gait=Gait() if p.gait else None, position=(0, p.start_aside), heading=radians(p.start_heading))
    scene = Scene(parts=(Floor(), Aperture(width=p.aperture), body))
    def agent():
        a = Person()
        a.speed = p.speed
        a.planned = p.turn or 0.0
        f = sqrt(60 * p.speed / WALK_RATIO) / 60
        a.onset = 2 * p.speed / f
        a.turn_time = 1.5 / f
        a.sway_of_heading = 0.02
        return a
    s = Simulation(scene, {"walker": agent})
    s.measure(Passage("walker"))
    return s

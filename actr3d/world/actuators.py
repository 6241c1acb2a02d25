"""What a body can be told to do, one word each: the name of the function that does it.

A command holds until another one of its kind replaces it. What is told to start does so at once where the body touches
nothing; while it touches something, only its bounded forces start it. What is told to stop stops dead, and keeps its place.
Numbers may come as text: what a pattern binds is text.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import TYPE_CHECKING

from actr3d.errors import WorldError
from actr3d.world.running import HEADING, TURN
from actr3d.world.words import Word, adder, known, number

if TYPE_CHECKING:
    from actr3d.world.anatomy import Steering
    from actr3d.world.body import Body
    from actr3d.world.joints import Joint

ACTUATORS: dict[str, Word] = {}
"""All actuators by their words."""

MODERATE = 2.0
"""How fast joints turn unless told otherwise [rad/s]. Source: the order of the original ACT-R 3D's 120 degrees a second (human-data)."""

SACCADE, SACCADE_PER_RAD = 0.02, 0.002 * math.degrees(1)
"""How long the eye moves: 20 ms and 2 ms for each degree, [s] and [s/rad]. Source: EMMA (Salvucci 2001; human-data)."""

_walks = adder(ACTUATORS, lambda body: body.anatomy.push is not None)
_joints = adder(ACTUATORS, lambda body: any(joint.driven for joint in body.joints.values()))
_driven = adder(ACTUATORS, lambda body: body.anatomy.steering is not None)
_moves = adder(ACTUATORS, lambda body: body.base.planar or body.base.free)
_looks = adder(ACTUATORS, lambda body: all(name in body.joints and body.joints[name].driven for name in ("eye_yaw", "eye_pitch")))
_holds = adder(ACTUATORS, lambda body: bool(body.hands))
_foreign = adder(ACTUATORS, lambda body: bool(body.controls) and not body.anatomy.servos)


@_walks
def walk(body: Body, speed: float, turn: float = 0.0, direction: float = 0.0) -> None:
    """Walks at a speed [m/s], turning [rad/s, left is positive], in a direction against where it faces [rad, 0 forward].

    Raises:
        WorldError: If a value is not a number, or faster than anyone can walk or turn.
    """
    fastest, spin, _ = _fastest(body)
    speed, turn = number(speed, "walk: speed", -fastest, fastest), number(turn, "walk: turn", -spin, spin)
    direction = number(direction, "walk: direction")
    _forget_the_way(body)
    left = speed * math.sin(direction) if direction else 0.0
    body.base.drive((speed * math.cos(direction), left, turn), body)
    body.world.changed()


@_walks
def heading(body: Body, angle: float, speed: float = MODERATE) -> None:
    """Turns the whole body to a heading [rad, in the world's frame] at a speed [rad/s], the shorter way round.

    Raises:
        WorldError: If a value is not a number, or the speed is not above 0 or too fast.
    """
    angle, speed = number(angle, "heading: angle"), number(speed, "heading: speed", 1e-6, _fastest(body)[1])
    _forget_the_way(body)
    body.running.targets[HEADING] = (angle, speed)


@_walks
def turn(body: Body, angle: float, speed: float = MODERATE) -> None:
    """Turns the whole body by an angle [rad, left is positive] at a speed [rad/s], also while it walks.

    Raises:
        WorldError: If a value is not a number, or the speed is not above 0 or too fast.
    """
    angle, speed = number(angle, "turn: angle"), number(speed, "turn: speed", 1e-6, _fastest(body)[1])
    _forget_the_way(body)
    body.running.targets[TURN] = (body.base.place[2] + angle, speed)


@_walks
def waypoint(body: Body, x: float, y: float, speed: float = 1.3, turn: float = MODERATE) -> None:
    """Turns to a point [m], walks to it at a speed [m/s], and stands there. Source of the speed: Warren & Whang (1987), normal walking.

    Raises:
        WorldError: If a value is not a number, or a speed is not above 0 or too fast.
    """
    x, y = number(x, "waypoint: x"), number(y, "waypoint: y")
    fastest, spin, _ = _fastest(body)
    speed, turn = number(speed, "waypoint: speed", 1e-6, fastest), number(turn, "waypoint: turn", 1e-6, spin)
    _forget_the_way(body)
    body.running.waypoint = (x, y, speed, turn)


@_walks
def stop(body: Body) -> None:
    """Stops dead: legs and all joints, whatever they were doing."""
    _forget_the_way(body)
    body.running.targets.clear()
    body.base.drive((0.0, 0.0, 0.0), body)
    for joint in body.joints.values():
        joint.drive(0.0, body)
    body.world.changed()


@_joints
def joint(body: Body, name: str, speed: float) -> None:
    """Turns a joint at a constant speed [rad/s] until told otherwise or at its limit.

    Raises:
        WorldError: If there is no such joint, no servo moves it, or the speed is not a number or too fast.
    """
    most = _fastest(body)[2]
    turned, speed = _servoed(body, name), number(speed, "joint: speed", -most, most)
    body.running.targets.pop(name, None)
    turned.drive(speed, body)
    body.world.changed()


@_joints
def position(body: Body, name: str, angle: float, speed: float = MODERATE) -> None:
    """Turns a joint to an angle [rad], or to its limit where that is nearer, at a constant speed [rad/s], and holds it there.

    Raises:
        WorldError: If there is no such joint, no servo moves it, the angle is not a number, or the speed is not above 0 or too fast.
    """
    body.running.targets[name] = _target(body, name, angle, speed)


@_joints
def posture(body: Body, angles: Mapping[str, float], speed: float = MODERATE) -> None:
    """Turns several joints to angles [rad], as `position` does.

    Raises:
        WorldError: If `angles` is not a mapping, or as for `position`; then no joint is told anything.
    """
    if not isinstance(angles, Mapping):  # pyright: ignore[reportUnnecessaryIsInstance] # it may come from a mind
        raise WorldError(f"posture: angles: must be angles by joint (got {angles!r})")
    body.running.targets |= {name: _target(body, name, angle, speed) for name, angle in angles.items()}


@_driven
def steering(body: Body, angle: float) -> None:
    """Turns the steering wheel to an angle [rad, left is positive], as fast as a driver can.

    Raises:
        WorldError: If the angle is not a number.
    """
    car = _car(body)
    position(body, "steer", number(angle, "steering: angle") / car.ratio, car.rate / car.ratio)


@_driven
def throttle(body: Body, pressed: float) -> None:
    """Presses the throttle, 0 to 1.

    Raises:
        WorldError: If it is not a number in 0 to 1.
    """
    body.world.mj_data.ctrl[body.control("throttle")] = number(pressed, "throttle", 0, 1)
    body.world.changed()


@_driven
def brake(body: Body, pressed: float) -> None:
    """Presses the brake, 0 to 1.

    Raises:
        WorldError: If it is not a number in 0 to 1.
    """
    body.running.brake = number(pressed, "brake", 0, 1)
    body.world.mj_data.ctrl[body.control("brake")] = 0
    body.world.changed()


@_moves
def teleport(body: Body, x: float, y: float, heading: float | None = None) -> None:
    """Puts the body elsewhere at once, (x, y) [m] and heading [rad]; posture and commands stay, what it holds comes with it.

    Raises:
        WorldError: If a value is not a number.
    """
    x, y = number(x, "teleport: x"), number(y, "teleport: y")
    faces = None if heading is None else number(heading, "teleport: heading")
    body.base.put(x, y, faces)
    body.holding.stand()
    body.world.changed()
    body.world.refresh()
    for hand in body.hands.values():
        hand.carry()
    body.world.changed()


@_looks
def gaze(body: Body, left: float, up: float = 0.0, speed: float | None = None) -> None:
    """Turns the eye to a direction against the head [rad, to the left and up], or to its limits; at a speed [rad/s] or as people do."""
    yaw, pitch = body.joints["eye_yaw"], body.joints["eye_pitch"]
    to_yaw = max(yaw.lower, min(yaw.upper, number(left, "gaze: left")))
    to_pitch = max(pitch.lower, min(pitch.upper, -number(up, "gaze: up")))
    turns = (abs(to_yaw - yaw.position), abs(to_pitch - pitch.position))
    farthest = max(turns)
    time = SACCADE + SACCADE_PER_RAD * farthest if speed is None else farthest / number(speed, "gaze: speed", 1e-6)
    for name, angle, turn in zip(("eye_yaw", "eye_pitch"), (to_yaw, to_pitch), turns, strict=True):
        body.running.targets[name] = (angle, max(turn / time, 1e-6) if time > 0 else MODERATE)


@_looks
def saccade(body: Body, left: float, up: float = 0.0) -> None:
    """Turns the eye by so much against where it looks [rad to the left, rad up], or to its limits, as fast as people do."""
    yaw, pitch = body.joints["eye_yaw"].position, body.joints["eye_pitch"].position
    gaze(body, yaw + number(left, "saccade: left"), number(up, "saccade: up") - pitch)


@_holds
def grasp(body: Body, object: str, hand: str = "right") -> None:
    """Holds a loose object with a hand, if the hand is empty and reaches it; the sensor `grasp` says whether it does.

    Raises:
        WorldError: If there is no such object or hand, or the object is fixed.
    """
    holds = body.hands[known(hand, body.hands, body.name, "hand")]
    number = body.world.loose(object)
    body.world.refresh()
    if holds.held is None and holds.reaches(number):
        holds.grasp(number)
        body.world.changed()


@_holds
def release(body: Body, hand: str | None = None) -> None:
    """Lets go of what a hand holds, or both hands.

    Raises:
        WorldError: If there is no such hand.
    """
    if hand is not None:
        known(hand, body.hands, body.name, "hand")
    for side, holds in body.hands.items():
        if hand in (None, side):
            holds.release()
    body.world.changed()


@_foreign
def control(body: Body, name: str, *values: float) -> None:
    """Sets the control of an actuator that an imported description names, in that actuator's own unit: one number, or all of several.

    Raises:
        WorldError: If there is no such actuator, or it does not take that many numbers.
    """
    controls = body.control(name)
    count = controls.stop - controls.start
    if len(values) != count:
        takes = "one number" if count == 1 else f"{count} numbers"
        raise WorldError(f"{body.name}: control '{name}' takes {takes} (got {', '.join(map(repr, values)) or 'none'})")
    body.world.mj_data.ctrl[controls] = [number(value, f"control {name}") for value in values]
    body.world.changed()


def _forget_the_way(body: Body) -> None:
    """Forgets where the body was going, for another command moves it now."""
    body.running.waypoint = None
    body.running.targets.pop(HEADING, None)
    body.running.targets.pop(TURN, None)


def _fastest(body: Body) -> tuple[float, float, float]:
    """Returns the fastest that a body can be told to walk [m/s], to turn [rad/s] and to turn a joint [rad/s]."""
    return body.anatomy.fastest or (math.inf, math.inf, math.inf)


def _servoed(body: Body, name: str) -> Joint:
    turned = body.joint(name)
    if not turned.driven:
        raise WorldError(f"{body.name}: joint '{name}' has no servo that could move it")
    return turned


def _target(body: Body, name: str, angle: float, speed: float) -> tuple[float, float]:
    """Returns where a joint is to go, within its limits, and how fast."""
    turned = _servoed(body, name)
    angle = max(turned.lower, min(turned.upper, number(angle, "position: angle")))
    return angle, number(speed, "position: speed", 1e-6, _fastest(body)[2])


def _car(body: Body) -> Steering:
    car = body.anatomy.steering
    assert car is not None
    return car

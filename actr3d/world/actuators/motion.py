"""The commands that move bodies.

A command holds until another one of its kind replaces it. Motion starts at once while the body touches nothing; otherwise its bounded
forces start it. A base or joint that is stopped stops immediately, and holds its position. Numbers may be given as text, because patterns
bind text.
"""

from __future__ import annotations

import math
from collections.abc import Mapping

from actr3d.errors import WorldError
from actr3d.world.body import MAX_CONTROL, Body, actuator
from actr3d.world.command_registry import checked_angle, checked_name, checked_number
from actr3d.world.frames import FULL_TURN
from actr3d.world.joints import Joint
from actr3d.world.motion_commands import HEADING, TURN
from actr3d.world.objects import checked_pose

MODERATE = 2.0
"""Default speed of joints [rad/s]. Source: about the 120 degrees/s of the original ACT-R 3D (docs/human-data.md)."""

MOST_TURNS = 3
"""How far a turn goes at most, in full turns; `walk(0, turn=...)` turns without an end. Source: chosen for this library."""

SACCADE, SACCADE_PER_RAD = 0.02, 0.002 * math.degrees(1)
"""Duration of a saccade: 20 ms, and 2 ms for each degree, [s] and [s/rad]. Source: EMMA (Salvucci 2001; docs/human-data.md)."""

_if_walking = actuator.if_body(lambda body: body.anatomy.walking_servos is not None)
_if_jointed = actuator.if_body(lambda body: any(joint.driven for joint in body.joints.values()))
_if_drivable = actuator.if_body(lambda body: body.anatomy.steering is not None)
_if_movable = actuator.if_body(lambda body: body.base.planar or body.base.free)
_if_eye_moves = actuator.if_body(lambda body: all(name in body.joints and body.joints[name].driven for name in ("eye_yaw", "eye_pitch")))
_if_hands = actuator.if_body(lambda body: bool(body.hands))
_if_foreign = actuator.if_body(lambda body: bool(body.controls) and not body.anatomy.servos)


@_if_walking
def walk(body: Body, speed: float, turn: float = 0.0, direction: float = 0.0) -> None:
    """Walks at a speed [m/s], turning [rad/s, left is positive], in a direction relative to its heading [rad, 0 forward].

    Raises:
        WorldError: If a value is not a number, or greater than the body's greatest speed.
    """
    fastest, spin, _ = body.fastest()
    speed, turn = checked_number(speed, "walk: speed", -fastest, fastest), checked_number(turn, "walk: turn", -spin, spin)
    direction = checked_angle(direction, "walk: direction")
    body.motion.cancel_base_movements()
    left = speed * math.sin(direction) if direction else 0.0
    body.hold.drive_base((speed * math.cos(direction), left, turn))
    body.physics.changed()


@_if_walking
def heading(body: Body, angle: float, speed: float = MODERATE) -> None:
    """Turns the whole body to a heading [rad, in the world's frame] at a speed [rad/s], the shorter way round.

    Raises:
        WorldError: If a value is not a number, the angle is more than a full turn, or the speed is not > 0 or is too fast.
    """
    angle, speed = checked_angle(angle, "heading: angle"), checked_number(speed, "heading: speed", 1e-6, body.fastest()[1])
    body.motion.cancel_base_movements()
    body.motion.targets[HEADING] = (angle, speed)


@_if_walking
def turn(body: Body, angle: float, speed: float = MODERATE) -> None:
    """Turns the whole body by an angle [rad, left is positive] at a speed [rad/s], also while it walks.

    Raises:
        WorldError: If a value is not a number, the angle is more than three full turns, or the speed is not > 0 or is too fast.
    """
    angle, speed = checked_angle(angle, "turn: angle", MOST_TURNS), checked_number(speed, "turn: speed", 1e-6, body.fastest()[1])
    body.motion.cancel_base_movements()
    body.motion.targets[TURN] = (body.base.pose[2] + angle, speed)


@_if_walking
def waypoint(body: Body, x: float, y: float, speed: float = 1.3, turn: float = MODERATE) -> None:
    """Turns to a point [m], walks to it at a speed [m/s], and stops there. Source of the speed: Warren & Whang (1987), normal walking.

    Raises:
        WorldError: If a value is not a number, or a speed is not > 0 or is too fast.
    """
    x, y = checked_number(x, "waypoint: x"), checked_number(y, "waypoint: y")
    fastest, spin, _ = body.fastest()
    speed, turn = checked_number(speed, "waypoint: speed", 1e-6, fastest), checked_number(turn, "waypoint: turn", 1e-6, spin)
    body.motion.cancel_base_movements()
    body.motion.waypoint = (x, y, speed, turn)


@_if_walking
def stop(body: Body) -> None:
    """Stops the legs and all joints immediately."""
    body.motion.cancel_base_movements()
    body.motion.targets.clear()
    body.hold.drive_base((0.0, 0.0, 0.0))
    for joint in body.joints.values():
        body.hold.drive_joint(joint, 0.0)
    body.physics.changed()


@_if_jointed
def joint(body: Body, name: str, speed: float) -> None:
    """Turns a joint at a constant speed [rad/s] until the next command or its limit.

    Raises:
        WorldError: If there is no such joint, no servo moves it, or the speed is not a number or too fast.
    """
    turned, most = _servoed(body, name), body.fastest()[2]
    least, greatest = turned.speeds
    speed = checked_number(speed, "joint: speed", max(-most, least), min(most, greatest))
    body.motion.targets.pop(name, None)
    body.hold.drive_joint(turned, speed)
    body.physics.changed()


@_if_jointed
def position(body: Body, name: str, angle: float, speed: float = MODERATE) -> None:
    """Turns a joint to an angle [rad], or to its limit where that is nearer, at a constant speed [rad/s], and holds it there.

    Raises:
        WorldError: If there is no such joint, no servo moves it, the angle is not a number or more than a full turn, or the speed
            is not > 0 or is too fast.
    """
    body.motion.targets[name] = _target(body, name, angle, speed, "position")


@_if_jointed
def posture(body: Body, angles: Mapping[str, float], speed: float = MODERATE) -> None:
    """Turns several joints to angles [rad], as `position` does.

    Raises:
        WorldError: If `angles` is not a mapping, or as for `position`; then no joint is commanded.
    """
    if not isinstance(angles, Mapping):  # pyright: ignore[reportUnnecessaryIsInstance] # an agent's code may give anything
        raise WorldError(f"posture: angles: must be angles by joint (got {angles!r})")
    body.motion.targets |= {name: _target(body, name, angle, speed, f"posture: {name}") for name, angle in angles.items()}


@_if_drivable
def steering(body: Body, angle: float) -> None:
    """Turns the steering wheel to an angle [rad, left is positive], as fast as a driver can.

    Raises:
        WorldError: If the angle is not a number.
    """
    car = body.anatomy.steering
    assert car is not None
    angle = checked_number(angle, "steering: angle") / car.ratio
    body.motion.targets["steer"] = (_within(body.joint("steer"), angle), car.rate / car.ratio)


@_if_drivable
def throttle(body: Body, pressed: float) -> None:
    """Presses the throttle, 0 to 1.

    Raises:
        WorldError: If it is not a number in 0 to 1.
    """
    body.physics.mj_data.ctrl[body.control("throttle")] = checked_number(pressed, "throttle", 0, 1)
    body.physics.changed()


@_if_drivable
def brake(body: Body, pressed: float) -> None:
    """Presses the brake, 0 to 1.

    Raises:
        WorldError: If it is not a number in 0 to 1.
    """
    body.motion.brake = checked_number(pressed, "brake", 0, 1)
    body.physics.mj_data.ctrl[body.control("brake")] = 0
    body.physics.changed()


@_if_movable
def teleport(body: Body, x: float, y: float, heading: float | None = None) -> None:
    """Puts the body elsewhere at once, (x, y) [m] and heading [rad]; posture and commands stay, held objects move along.

    Raises:
        WorldError: If a value is not a number, or out of bounds.
    """
    before = body.base.heading if body.base.planar else 0.0
    body.base.put(*checked_pose("teleport", x, y, heading))
    if TURN in body.motion.targets:  # the rest of a turn stays the same
        target, speed = body.motion.targets[TURN]
        body.motion.targets[TURN] = (target + body.base.heading - before, speed)
    body.hold.stand()
    body.physics.changed()
    body.physics.refresh_positions()
    for hand in body.hands.values():
        hand.carry()
    body.physics.changed()


@_if_eye_moves
def gaze(body: Body, left: float, up: float = 0.0, speed: float | None = None) -> None:
    """Turns the eye to a direction relative to the head [rad, left and up], or to its limits; without a speed [rad/s], as a saccade."""
    _look(body, checked_angle(left, "gaze: left"), checked_angle(up, "gaze: up"), speed)


@_if_eye_moves
def saccade(body: Body, left: float, up: float = 0.0) -> None:
    """Turns the eye by an angle from its present direction [rad, left and up], or to its limits, in the time of a human saccade."""
    yaw, pitch = body.joints["eye_yaw"].position, body.joints["eye_pitch"].position
    _look(body, yaw + checked_angle(left, "saccade: left"), checked_angle(up, "saccade: up") - pitch)


@_if_hands
def grasp(body: Body, object: str, hand: str = "right") -> None:
    """Holds a loose object with a hand, if the hand is empty and reaches it; the sensor `grasp` reports success.

    Raises:
        WorldError: If there is no such object or hand, or the object is fixed.
    """
    holds = body.hands[checked_name(hand, body.hands, body.name, "hand")]
    number = body.physics.loose(object)
    body.physics.refresh_positions()
    if holds.held is None and holds.reaches(number):
        holds.grasp(number)
        body.physics.changed()


@_if_hands
def release(body: Body, hand: str | None = None) -> None:
    """Releases the object in a hand, or in both hands.

    Raises:
        WorldError: If there is no such hand.
    """
    if hand is not None:
        checked_name(hand, body.hands, body.name, "hand")
    for side, holds in body.hands.items():
        if hand in (None, side):
            holds.release()
    body.physics.changed()


@_if_foreign
def control(body: Body, name: str, *values: float) -> None:
    """Sets the control of an actuator that an imported description names, in that actuator's own unit. It takes one number for each of its
    controls.

    Raises:
        WorldError: If there is no such actuator, it does not take that many numbers, or one is too great for the physics.
    """
    controls = body.control(name)
    count = controls.stop - controls.start
    if len(values) != count:
        takes = "one number" if count == 1 else f"{count} numbers"
        raise WorldError(f"{body.name}: control '{name}' takes {takes} (got {', '.join(map(repr, values)) or 'none'})")
    what = f"{body.name}: control '{name}'"
    body.physics.mj_data.ctrl[controls] = [checked_number(value, what, -MAX_CONTROL, MAX_CONTROL) for value in values]
    body.physics.changed()


def _servoed(body: Body, name: str) -> Joint:
    turned = body.joint(name)
    if not turned.driven:
        raise WorldError(f"{body.name}: joint '{name}' has no servo that could move it")
    return turned


def _target(body: Body, name: str, angle: float, speed: float, what: str) -> tuple[float, float]:
    """Returns the given angle [rad] of a joint, or the place of a slide [m], within its limits, and the speed.

    Args:
        body: The body.
        name: The joint.
        angle: The angle or place.
        speed: The speed.
        what: The command, for errors.
    """
    turned = _servoed(body, name)
    is_limb = turned.turns and max(map(abs, turned.limits)) <= FULL_TURN
    angle = (checked_angle if is_limb else checked_number)(angle, f"{what}: angle")
    least, greatest = turned.speeds
    return _within(turned, angle), checked_number(speed, f"{what}: speed", 1e-6, min(body.fastest()[2], -least, greatest))


def _within(joint: Joint, angle: float) -> float:
    """Returns an angle [rad], or the place of a slide [m], or the limit of the joint where that is nearer."""
    return max(joint.lower, min(joint.upper, angle))


def saccade_time(angle: float) -> float:
    """Returns the duration of an eye movement over an angle [rad], in seconds."""
    return SACCADE + SACCADE_PER_RAD * abs(angle)


def _look(body: Body, left: float, up: float, speed: float | None = None) -> None:
    """Turns the eye to a direction relative to the head [rad], or to its limits; at a speed [rad/s], or in the time of a saccade."""
    yaw, pitch = body.joints["eye_yaw"], body.joints["eye_pitch"]
    to_yaw, to_pitch = _within(yaw, left), _within(pitch, -up)
    turns = (abs(to_yaw - yaw.position), abs(to_pitch - pitch.position))
    farthest = max(turns)
    time = saccade_time(farthest) if speed is None else farthest / checked_number(speed, "gaze: speed", 1e-6)
    for name, angle, turn in zip(("eye_yaw", "eye_pitch"), (to_yaw, to_pitch), turns, strict=True):
        body.motion.targets[name] = (angle, max(turn / time, 1e-6) if time > 0 else MODERATE)

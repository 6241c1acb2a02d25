"""Velocity servos: actuators that hold a speed with bounded force, so that obstacles can stop them."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

import mujoco
import numpy as np
from mujoco import MjData, MjModel, MjSpec, mjtBias, mjtGain, mjtTrn, mjtWrap


def add_servo(mj_spec: MjSpec, name: str, target: str, force: float, gear: tuple[float, ...] | None = None) -> None:
    """Adds an actuator that keeps the speed of its target at its control, with at most `force`.

    Args:
        mj_spec: The specification.
        name: Its name.
        target: A joint, or a site where `gear` is given.
        force: Its greatest force or torque [N] or [N m].
        gear: (6,) the direction of its force and torque on a site, in the site's frame.
    """
    actuator: Any = mj_spec.add_actuator(name=name, target=target)
    actuator.trntype = mjtTrn.mjTRN_JOINT if gear is None else mjtTrn.mjTRN_SITE
    actuator.gaintype, actuator.biastype = mjtGain.mjGAIN_FIXED, mjtBias.mjBIAS_AFFINE
    actuator.forcelimited, actuator.forcerange = True, [-force, force]
    if gear is not None:
        actuator.gear = list(gear)
    _tune(actuator, 1.0)


def fit_servos(mj_model: MjModel, mj_data: MjData, names: Iterable[str]) -> None:
    """Sets each servo to the highest gain without oscillation, from the inertia that it moves while all else is held.

    While its force is at its bound, one step changes the speed by force * step / inertia; the band of speeds in which it is
    not at its bound is 2 * force / gain wide. A gain of inertia / step makes the band twice as wide as the change; with
    more than twice that gain the speed can jump over the band, back and forth for ever.

    Args:
        mj_model: The model whose gains are set.
        mj_data: Its state at the start, positions up to date.
        names: The names of the servos.
    """
    for name in names:
        actuator = mj_model.actuator(name)
        moment, product = np.zeros(mj_model.nv), np.zeros(mj_model.nv)
        start = mj_data.moment_rowadr[actuator.id]
        row = slice(start, start + mj_data.moment_rownnz[actuator.id])
        moment[mj_data.moment_colind[row]] = mj_data.actuator_moment[row]
        mujoco.mj_mulM(mj_model, mj_data, product, moment)
        inertia = float(moment @ product) / float(moment @ moment) ** 2
        _tune(actuator, inertia / mj_model.opt.timestep)


def moved_by(mj_model: Any, actuator: int) -> list[int]:
    """Returns the MuJoCo bodies that an actuator acts on: one, or all that a tendon connects."""
    kind, target = int(mj_model.actuator_trntype[actuator]), int(mj_model.actuator_trnid[actuator, 0])
    of_joint, of_site = mj_model.jnt_bodyid, mj_model.site_bodyid
    if kind == int(mjtTrn.mjTRN_TENDON):
        wraps = range(mj_model.tendon_adr[target], mj_model.tendon_adr[target] + mj_model.tendon_num[target])
        ends = {int(mjtWrap.mjWRAP_JOINT): of_joint, int(mjtWrap.mjWRAP_SITE): of_site}
        along = [(int(mj_model.wrap_type[wrap]), int(mj_model.wrap_objid[wrap])) for wrap in wraps]
        return [int(ends[type][number]) for type, number in along if type in ends]
    if kind in (int(mjtTrn.mjTRN_SITE), int(mjtTrn.mjTRN_SLIDERCRANK), int(mjtTrn.mjTRN_SO3)):
        return [int(of_site[target])]
    return [target if kind == int(mjtTrn.mjTRN_BODY) else int(of_joint[target])]


def _tune(actuator: Any, gain: float) -> None:
    actuator.gainprm[0], actuator.biasprm[2] = gain, -gain

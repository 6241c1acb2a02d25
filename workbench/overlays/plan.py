"""Shows what agents plan: a posture as a translucent copy of the body, and a label above it."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

from mujoco import MjData, mjtJoint

from workbench.overlays.overlay import Observed, Overlay, OverlayCanvas, overlay
from workbench.overlays.posture import Copies

if TYPE_CHECKING:
    from actr3d.actr.kernel.model import Model
    from actr3d.motor import Plan
    from actr3d.world.body import Body

ABOVE = 0.05
"""Distance of a label's point above the body [m]."""


@overlay("plan", "plan", shown=True)
class Plans(Overlay):
    """Shows the plan of each agent that has a method `planned`; see `actr3d.motor.Plan`."""

    def __init__(self, canvas: OverlayCanvas) -> None:
        self._copies = Copies(canvas, "/overlays/plan", (217, 138, 31))
        self.drawn = (self._copies,)

    @staticmethod
    def data(observed: Observed) -> dict[str, Any]:
        """Returns of each body with a plan its joints, as in the overlay `posture`, and its label: `text` and `place` [m]."""
        agents, bodies = observed.simulation.agents, observed.simulation.world.bodies
        plans = {name: _plan_of(agents[name]) for name in bodies if name in agents}
        return {name: _drawn(plan, bodies[name]) for name, plan in plans.items() if plan is not None}

    def draw(self, data: MjData, by_body: dict[str, Any] | None) -> None:
        """Draws copies and labels."""
        plans = (by_body or {}).values()
        self._copies.draw(data, [target for plan in plans for target in plan["targets"]])
        self.labels = [{"text": plan["text"], "place": plan["place"], "chosen": False} for plan in plans if plan["text"]]
        self.switch()


def _plan_of(agent: Model) -> Plan | None:
    """Returns an agent's plan; if its method fails, a plan that says so."""
    from actr3d.motor import Plan

    planned: Any = getattr(agent, "planned", None)
    if not callable(planned):
        return None
    try:
        plan = planned()
    except Exception as error:  # noqa: BLE001 # the method is the model's, and must not end a run that is only watched
        return Plan(text=f"planned(): {type(error).__name__}: {error}")
    return plan if isinstance(plan, Plan) else None


def _drawn(plan: Plan, body: Body) -> dict[str, Any]:
    """Returns a plan as plain values; joints that the body does not have are left out."""
    kinds = body.physics.mj_model.jnt_type
    joints = [(body.joints[name], float(value)) for name, value in plan.posture.items() if name in body.joints]
    targets = [[int(joint.q), value if kinds[joint.number] == mjtJoint.mjJNT_SLIDE else math.radians(value)] for joint, value in joints]
    box = body.bounding_box()
    place = (*box.centre[:2], box.upper[2] + ABOVE)
    return {"targets": targets, "text": plan.text, "place": [float(value) for value in place]}

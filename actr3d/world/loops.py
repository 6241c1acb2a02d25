"""Which degrees of freedom are in a loop: two hands that hold one load."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from mujoco import mjtEq, mjtObj
from numpy.typing import NDArray

if TYPE_CHECKING:
    from actr3d.world.body import Body


def in_loop(body: Body, dofs: NDArray[np.intp]) -> NDArray[np.bool_]:
    """Returns which degrees of freedom are in a loop that an equality between two parts of a body closes."""
    model: Any = body.world.mj_model
    found = np.zeros(len(dofs), dtype=bool)
    for number in range(int(model.neq)):
        ends = int(model.eq_obj1id[number]), int(model.eq_obj2id[number])
        kind = model.eq_type[number] == int(mjtEq.mjEQ_CONNECT) and model.eq_objtype[number] == int(mjtObj.mjOBJ_BODY)
        if kind and body.members[ends[0]] and body.members[ends[1]]:
            one, other = (_carriers(model, end) for end in ends)
            found |= np.isin(model.dof_bodyid[dofs], list(one ^ other))
    return found


def _carriers(model: Any, number: int) -> set[int]:
    """Returns a MuJoCo body and all that carry it."""
    found = {number}
    while number:
        number = int(model.body_parentid[number])
        found.add(number)
    return found

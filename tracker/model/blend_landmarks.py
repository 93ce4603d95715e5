"""Where people see the joints of a learnt hand, which need not be where it turns.

The joints of a hand of MANO's class are those that pose its surface best. In the four fingers they come out at a fifth
of the thickness beneath the back; the bones lie deeper. The thumb's saddle joint comes out level with the other
metacarpals, while the trapezium stands out of them towards the palm. Who marks joints marks bones.
"""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from tracker.model.hand_axes import HandChains, find_flexion_axis, unit
from tracker.model.joints import FINGERS, HAND_JOINTS
from tracker.model.skeleton import Array

FINGER_DEPTH = 1.0 / 3.0
"""Of the second and third joint of a finger and the thumb's last, share of the way from the back to the other side."""
THUMB_BASE_DEPTH = 0.6
"""The same of the thumb's base."""


def find_landmark_offsets(vertices: Array, faces: npt.NDArray[np.int64], chains: HandChains) -> Array:
    """(21, 3) from a hand's joints at rest to where they are seen, m; zero for those that are seen where they are.

    Args:
        vertices: (V, 3) at rest, closed.
        faces: (F, 3).
        chains: Its joints.
    """
    offsets = np.zeros((len(HAND_JOINTS), 3))
    for finger in FINGERS:
        points = [chains.wrist, *chains.fingers[finger][-4:]]
        for place, depth in (
            ((1, THUMB_BASE_DEPTH), (3, FINGER_DEPTH)) if finger == "thumb" else ((2, FINGER_DEPTH), (3, FINGER_DEPTH))
        ):
            before, joint, after = points[place - 1 : place + 2]
            along = unit(unit(joint - before) + unit(after - joint))
            back = chains.dorsal
            if finger == "thumb" and place > 1:  # that of the nail
                back = np.cross(along, find_flexion_axis(chains, finger))
            back = unit(back - (back @ along) * along)
            inner, outer = _find_skin(vertices[faces], joint, back)
            offsets[1 + 4 * FINGERS.index(finger) + place - 1] = (outer - depth * (outer - inner)) * back
    return offsets


def _find_skin(triangles: Array, point: Array, direction: Array) -> tuple[float, float]:
    """Where a line through a point inside leaves the surface on either side, m along the unit direction from it."""
    a, b, c = triangles[:, 0] - point, triangles[:, 1] - point, triangles[:, 2] - point
    volumes = np.stack([np.cross(b, c) @ direction, np.cross(c, a) @ direction, np.cross(a, b) @ direction], axis=1)
    is_hit = (np.all(volumes >= 0.0, axis=1) | np.all(volumes <= 0.0, axis=1)) & volumes.any(axis=1)
    shares = volumes[is_hit] / volumes[is_hit].sum(axis=1, keepdims=True)
    reach = np.einsum("fk,fkx,x->f", shares, triangles[is_hit] - point, direction)
    ahead, behind = reach[reach > 0.0], reach[reach < 0.0]
    return (behind.max(), ahead.min()) if len(ahead) and len(behind) else (0.0, 0.0)

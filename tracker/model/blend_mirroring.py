"""The other hand of a blend model."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from tracker.model.blend_model import BlendModel
from tracker.model.mirroring import MIRROR, OTHER_SIDE, mirror_name, mirror_pose_directions, mirror_provenance
from tracker.model.skeleton import Array


def mirror_blend(model: BlendModel, reflection: Array = MIRROR) -> BlendModel:
    """The model reflected in a plane of its frame; mirroring twice gives the model back.

    Vertices, joints and shape coefficients keep their meaning: at the rotation vectors -`reflection` times those of a
    pose, the same shape and the reflected place, the mirrored model is the mirror image of the model.

    Args:
        model: A hand.
        reflection: (3,) of which one is -1: (1, -1, 1), the plane y = 0; MANO's two hands are mirrored by (-1, 1, 1).
    """
    axial = np.tile(-reflection, model.num_bones - 1)
    return replace(
        model,
        name=mirror_name(model.name),
        side=OTHER_SIDE[model.side],
        template=model.template * reflection,
        faces=np.ascontiguousarray(model.faces[:, ::-1]),
        shape_directions=model.shape_directions * reflection[:, None],
        pose_directions=mirror_pose_directions(model.pose_directions, reflection),
        pose_mean=model.pose_mean * axial,
        pose_components=model.pose_components * axial,
        provenance=mirror_provenance(model.provenance),
    )

"""Models and motions in the format of T16's authors: an .OFF mesh and the files beside it."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import numpy.typing as npt

from tracker.errors import ModelFileError, reads
from tracker.model.articulated import ArticulatedModel
from tracker.model.decimation import decimate_file, limit_weights
from tracker.model.skeleton import Array, Skeleton
from tracker.model.t16_bind import estimate_frames, estimate_joints, find_motion_beside, turn_to_flexion
from tracker.model.t16_hand import find_hand
from tracker.model.t16_text import BoneLimits, read_limits, read_motion, read_off, read_skel, read_skin, read_voi

METRES_PER_UNIT = 1e-3
"""T16's files are in millimetres."""

AXIS_ORDER: tuple[int, ...] = (2, 0, 1)
"""Order in which a bone's axes 1, 2, 3 are multiplied, counted from 0 and from the parent outwards.

The files do not say it. Of the six orders this one leaves the published motions least outside their own limits (rms
excess over the joints with three axes .73, .44, .23 degrees for axis 1, 2, 3; order 1, 2, 3 has 4.13, .44, 1.10). With
three axes every order reaches every rotation; at the base of the thumb, which has two, no order follows the motions
exactly (about 1 degree on average).
"""


@reads(ModelFileError, "the files of a T16 model")
def load_t16_model(off_path: Path, max_faces: int | None = 1500, bind: Array | None = None) -> ArticulatedModel:
    """A hand or an object from its .OFF mesh with .SKEL, .SKIN and .LIMITS (and .VOI for a hand) beside it.

    The axes in .LIMITS are in the frame that a bone has at rest, which only a MOTION file holds (its first row). One is
    looked for beside the model and in `../seq/*/`; without any, the frames are estimated from mesh, weights, lengths.

    Args:
        off_path: The .OFF file.
        max_faces: Decimate to so many faces; None keeps the mesh.
        bind: (B, 4, 4) rest poses of the bones in .SKEL order, bone to model frame, m, when known.

    Raises:
        ModelFileError: A file is missing, or does not hold what it should.
    """
    off_path = Path(off_path)
    for suffix in (".SKEL", ".SKIN", ".LIMITS"):
        if not off_path.with_suffix(suffix).is_file():
            raise ModelFileError(
                off_path, f"no {off_path.stem}{suffix} beside it", ".SKEL, .SKIN and .LIMITS files of the same name"
            )
    vertices_mm, faces = read_off(off_path)
    vertices = vertices_mm * METRES_PER_UNIT
    names, parents, lengths_mm = read_skel(off_path.with_suffix(".SKEL"))
    weights = limit_weights(read_skin(off_path.with_suffix(".SKIN"), names, len(vertices)))
    limits = read_limits(off_path.with_suffix(".LIMITS"))
    if len(limits) != len(names):
        raise ModelFileError(
            off_path.with_suffix(".LIMITS"), f"{len(limits)} bones", f"the {len(names)} bones of the .SKEL file"
        )
    hand = find_hand(names)
    voi_path = off_path.with_suffix(".VOI")
    voi = read_voi(voi_path, len(vertices)) if hand is not None and voi_path.is_file() else None
    bind_source = "given"
    if bind is None:
        bind, bind_source = _find_bind(off_path, names)
    if bind is None:
        joints = estimate_joints(vertices, weights, parents, lengths_mm * METRES_PER_UNIT)
        bind = estimate_frames(joints, _find_ends(vertices, weights, parents, joints))
        bind_source = "estimated from mesh and weights"
        if hand is not None:
            chains = hand.chains(joints, vertices[hand.find_tips(vertices, weights, joints, voi)])
            bind = turn_to_flexion(bind, chains, hand.fingers, {b: limit.axes[1] for b, limit in enumerate(limits)})
    if bind.shape != (len(names), 4, 4):
        raise ModelFileError(off_path, f"a bind pose of shape {bind.shape}", f"({len(names)}, 4, 4), one for each bone")
    joints = bind[:, :3, 3]
    tips = np.zeros(0, dtype=np.int64) if hand is None else hand.find_tips(vertices, weights, joints, voi)
    model = ArticulatedModel(
        name=off_path.stem,
        vertices=vertices,
        faces=faces,
        skinning_weights=weights,
        skeleton=_build_skeleton(off_path, names, parents, bind, limits),
        hand=None if hand is None else hand.parts(vertices, weights, joints, tips),
        provenance={"file": off_path.name, "format": "T16 model", "bind_pose": bind_source},
    )
    return model if max_faces is None else decimate_file(off_path, model, max_faces)


@reads(ModelFileError, "a MOTION file of a T16 model")
def load_t16_motion(path: Path) -> tuple[tuple[str, ...], Array, Array]:
    """A motion of T16's authors.

    Returns:
        Names of the B bones; their poses `Ts_world_bone` (T, B, 4, 4), m; the bind pose (B, 4, 4), bone to
        the frame of the .OFF file, m.
    """
    names, Ts = read_motion(Path(path))
    Ts[..., :3, 3] *= METRES_PER_UNIT
    return names, Ts[1:], Ts[0]


def _find_bind(off_path: Path, names: tuple[str, ...]) -> tuple[Array | None, str]:
    motion = find_motion_beside(off_path)
    if motion is None:
        return None, ""
    motion_names, _, bind = load_t16_motion(motion)
    if len(motion_names) != len(names):
        raise ModelFileError(motion, f"{len(motion_names)} bones", f"the {len(names)} bones of {off_path.stem}.SKEL")
    return bind, f"first row of {motion.name}"


def _find_ends(vertices: Array, weights: Array, parents: npt.NDArray[np.int64], joints: Array) -> Array:
    """(B, 3) the joint of a bone's child, or the middle of what follows the bone."""
    ends = joints.copy()
    for bone in range(len(parents)):
        children = np.flatnonzero(parents == bone)
        follows = weights[:, bone] > 0.5
        if len(children):
            ends[bone] = joints[children[0]]
        elif follows.any():
            ends[bone] = vertices[follows].mean(axis=0)
    return ends


def _build_skeleton(
    path: Path, names: tuple[str, ...], parents: npt.NDArray[np.int64], bind: Array, limits: tuple[BoneLimits, ...]
) -> Skeleton:
    """Revolute joints of every bone but the root; a degree of freedom with an empty range is none."""
    dof_bones, axes, ranges = [], [], []
    for bone, limit in enumerate(limits):
        if parents[bone] < 0:
            continue
        if limit.flags[0]:
            raise ModelFileError(
                path.with_suffix(".LIMITS"), f"a translation of {limit.name}", "only the root to translate"
            )
        for axis in AXIS_ORDER:
            lower, upper = limit.ranges_deg[axis]
            if not limit.flags[1 + axis] or lower >= upper:
                continue
            length = np.linalg.norm(limit.axes[axis])
            if length < 1e-6:
                raise ModelFileError(
                    path.with_suffix(".LIMITS"), f"axis {axis + 1} of {limit.name} of length 0", "unit axes"
                )
            dof_bones.append(bone)
            axes.append(bind[bone, :3, :3] @ limit.axes[axis] / length)
            ranges.append((lower, upper))
    ranges_rad = np.radians(np.clip(np.array(ranges, dtype=np.float64).reshape(-1, 2), -360.0, 360.0))
    return Skeleton(
        bone_names=names,
        parents=parents,
        Ts_model_bone=bind,
        dof_bones=np.array(dof_bones, dtype=np.int64),
        dof_axes=np.array(axes, dtype=np.float64).reshape(-1, 3),
        lower=ranges_rad[:, 0].copy(),
        upper=ranges_rad[:, 1].copy(),
    )

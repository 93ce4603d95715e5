"""The body with hands: described, posed, and written for other programs."""

from __future__ import annotations

import tempfile
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from server.bodies.schemas import BodyExport, BodyFrame, BodyModelOut, BodyMotionOut, BodyPoses, Population
from server.errors import InvalidError
from server.scans.geometry import pack_arrays

if TYPE_CHECKING:
    from tracker import BlendModel
    from tracker.bodies import BodyMotion


def describe_body(population: Population) -> BodyModelOut:
    """What the body of a population has."""
    from tracker.bodies import body_model, smplx_vertex_ids

    model = body_model(population)
    return BodyModelOut(
        population=population,
        vertices=len(model.template),
        faces=len(model.faces),
        joints=list(model.joint_names),
        parents=model.parents.tolist(),
        shape_count=model.num_shape,
        hand_component_count=len(model.pose_components) // 2,
        landmarks=smplx_vertex_ids(model),
        provenance=model.provenance,
    )


def pack_body(population: Population) -> bytes:
    """The mesh of the mean person at rest."""
    from tracker.bodies import body_model

    model = body_model(population)
    arrays = {"vertices": model.template.astype(np.float32), "faces": model.faces.astype(np.uint32)}
    return pack_arrays(arrays, {"population": population})


def pack_poses(population: Population, asked: BodyPoses) -> bytes:
    """The vertices of every pose, (N, V, 3) m."""
    from tracker.bodies import body_model
    from tracker.export import pose_frames

    model = body_model(population)
    motion = _make_motion(model, asked.shape, asked.frames, 30.0)
    return pack_arrays({"vertices": pose_frames(model, motion, range(len(motion))).astype(np.float32)}, {})


def write_smplh(population: Population, suffix: str) -> bytes:
    """The bytes of a file that `smplx.SMPLH` loads, ".npz" or ".pkl"."""
    from tracker import save_mano
    from tracker.bodies import body_model

    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / f"SMPLH{suffix}"
        save_mano(body_model(population), path)
        return path.read_bytes()


def write_poses(population: Population, asked: BodyExport) -> bytes:
    """Poses as the bytes of one mesh, or of an animated glTF."""
    from tracker.bodies import body_model
    from tracker.export import write_body_glb, write_meshes

    model = body_model(population)
    if asked.format != "glb" and len(asked.frames) > 1:
        raise InvalidError(f"{len(asked.frames)} poses for one {asked.format}; send one, or ask for glb.")
    motion = _make_motion(model, asked.shape, asked.frames, asked.fps)
    if asked.format == "glb":
        return write_body_glb(model, motion, range(len(motion)))
    with tempfile.TemporaryDirectory() as folder:
        return write_meshes(model, motion, range(1), Path(folder), asked.format)[0].read_bytes()


def _make_motion(model: BlendModel, shape: Sequence[float], frames: Sequence[BodyFrame], fps: float) -> BodyMotion:
    from tracker.bodies import BodyMotion

    if len(shape) > model.num_shape:
        raise InvalidError(f"{len(shape)} coefficients of the shape; the body has {model.num_shape} directions.")
    poses = np.array([_find_pose(model, frame) for frame in frames])
    translations = np.array([frame.translation for frame in frames])
    return BodyMotion(poses, translations, np.array(shape, dtype=np.float64), fps)


def _find_pose(model: BlendModel, frame: BodyFrame) -> np.ndarray:
    """(52, 3) rotation vectors of a frame, rad."""
    from tracker.bodies import body_pose

    if frame.pose is not None:
        if frame.joints or frame.hands:
            raise InvalidError("A frame with `pose` has all joints in it; leave `joints` and `hands` out.")
        return np.array(frame.pose).reshape(-1, 3)
    names = list(model.joint_names)
    unknown = sorted(set(frame.joints) - set(names))
    if unknown:
        raise InvalidError(f"The body has no joint {unknown[0]!r}; it has {', '.join(names)}.")
    hands = {side: np.array(numbers, dtype=np.float64) for side, numbers in frame.hands.items()}
    pose = body_pose(model, np.zeros(3), np.zeros((21, 3)), hands)
    for name, vector in frame.joints.items():
        pose[names.index(name)] = vector
    return pose


def read_motion(path: Path, most: int) -> BodyMotionOut:
    """A motion file, every number checked.

    Raises:
        InvalidError: It has more frames than `most`, or its person has directions that the body has not.
    """
    from tracker.bodies import body_model, load_body_motion
    from tracker.export import check_shape

    motion = load_body_motion(path)
    if len(motion) > most:
        raise InvalidError(f"{path.name} has {len(motion)} frames; the page plays {most} at most. Cut it first.")
    check_shape(body_model(motion.population), motion)
    return BodyMotionOut(
        population=motion.population,  # type: ignore[arg-type]  # the reader lets no other pass
        fps=motion.fps,
        shape=motion.shape[: body_model(motion.population).num_shape].tolist(),
        poses=motion.poses.reshape(len(motion), -1).round(6).tolist(),
        translations=motion.translations.round(6).tolist(),
    )

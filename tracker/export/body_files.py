"""A body in motion as meshes that other programs open: OBJ, PLY, or one animated glTF."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from tracker.capture.atomic_file import write_atomically
from tracker.capture.scan_ply import write_ply
from tracker.errors import TrackerError
from tracker.export.glb_writer import ARRAY_BUFFER, ELEMENT_BUFFER, GlbWriter
from tracker.export.gltf_animation import add_targets, find_local, find_quaternions
from tracker.export.pose_morphs import choose_morphs
from tracker.geometry.vertex_normals import find_unit_normals
from tracker.model.blend_model import BlendModel
from tracker.model.body_motion import BodyMotion
from tracker.model.pose_blend import PoseBlend

Array = npt.NDArray[np.float64]

COLOR = (0.51, 0.36, 0.28, 1.0)
"""Linear RGBA of the body in glTF."""
GLTF_WEIGHTS = 4
"""Bones that a vertex follows in glTF; ten of the body's follow five."""


def check_shape(model: BlendModel, motion: BodyMotion) -> None:
    """Refuse a motion of a person whom the model has no directions for.

    Raises:
        TrackerError: With both numbers.
    """
    if len(motion.shape) > model.num_shape and np.any(motion.shape[model.num_shape :]):
        raise TrackerError(
            f"The motion's shape has {len(motion.shape)} coefficients, the body has {model.num_shape}. Cut the "
            f"motion's 'betas' to {model.num_shape} and pose again."
        )


def pose_frames(model: BlendModel, motion: BodyMotion, frames: range) -> Array:
    """(N, V, 3) vertices in those frames of a motion, m."""
    shape = motion.shape[: model.num_shape]
    return np.array([model.pose_at(motion.poses[t], shape, motion.translations[t]).vertices for t in frames])


def write_meshes(
    model: BlendModel,
    motion: BodyMotion,
    frames: range,
    folder: Path,
    kind: str,
    progress: Callable[[float, str], None] | None = None,
) -> list[Path]:
    """Write one OBJ or PLY a frame, `000000.obj` and so on by the frame's number; what `progress` raises ends it."""
    assert kind in ("obj", "ply")
    folder.mkdir(parents=True, exist_ok=True)
    paths = []
    for number, t in enumerate(frames):
        vertices = pose_frames(model, motion, range(t, t + 1))[0]
        path = folder / f"{t:06d}.{kind}"
        write_atomically(path, write_ply(vertices, model.faces) if kind == "ply" else write_obj(vertices, model.faces))
        paths.append(path)
        if progress is not None:
            progress((number + 1) / len(frames), path.name)
    return paths


def write_obj(vertices: Array, faces: npt.NDArray) -> bytes:
    """The bytes of an OBJ: vertices (V, 3) in m, to a tenth of a micrometre, and faces (F, 3)."""
    lines = [f"v {x:.7f} {y:.7f} {z:.7f}" for x, y, z in vertices.tolist()]
    lines += [f"f {a + 1} {b + 1} {c + 1}" for a, b, c in faces.tolist()]
    return ("\n".join(lines) + "\n").encode()


def write_body_glb(model: BlendModel, motion: BodyMotion, frames: range) -> bytes:
    """The bytes of a skinned, animated .glb; time 0 is the first of the frames. glTF's world is the body's: y is up.

    Vertices keep their numbers and unit (m). Pose blend shapes become morph targets.
    """
    writer = GlbWriter()
    shape = motion.shape[: model.num_shape]
    rest = model.pose_at(shape=shape)
    Ts_rest = np.tile(np.eye(4), (model.num_bones, 1, 1))
    Ts_rest[:, :3, 3] = rest.joints_rest
    motions = np.tile(np.eye(4), (len(frames), model.num_bones, 1, 1))
    for row, t in enumerate(frames):
        motions[row, :, :3] = model.pose_at(motion.poses[t], shape, motion.translations[t]).Ts
    times = writer.add((np.arange(len(frames)) / motion.fps).astype(np.float32), bounded=True)
    nodes: list[dict[str, Any]] = [{"name": "body", "mesh": 0, "skin": 0}]
    samplers: list[dict[str, Any]] = []
    channels: list[dict[str, Any]] = []

    def animate(node: int, path: str, values: Array) -> None:
        samplers.append({"input": times, "output": writer.add(values.astype(np.float32)), "interpolation": "LINEAR"})
        channels.append({"sampler": len(samplers) - 1, "target": {"node": node, "path": path}})

    at_rest = find_local(Ts_rest[None], model.parents)[:, 0]
    for bone, Ts in enumerate(find_local(motions @ Ts_rest, model.parents)):
        children = np.flatnonzero(model.parents == bone)
        node: dict[str, Any] = {"name": model.joint_names[bone], "translation": at_rest[bone, :3, 3].tolist()}
        nodes.append(node | ({"children": (children + 1).tolist()} if len(children) else {}))
        animate(bone + 1, "rotation", find_quaternions(Ts))
        if model.parents[bone] < 0:
            animate(bone + 1, "translation", Ts[:, :3, 3])
    morphs = choose_morphs(PoseBlend(np.arange(1, model.num_bones), model.pose_directions), model.parents, motions)
    mesh = {"name": "body", "primitives": [_add_mesh(writer, model, rest.arrays.shaped)]}
    mesh["primitives"][0]["targets"] = add_targets(writer, morphs)
    mesh["weights"] = [0.0] * len(morphs.targets)
    animate(0, "weights", morphs.weights.reshape(-1))
    inverse = np.linalg.inv(Ts_rest).transpose(0, 2, 1).reshape(-1, 16).astype(np.float32)
    skin = {"joints": list(range(1, 1 + model.num_bones)), "skeleton": 1, "inverseBindMatrices": writer.add(inverse)}
    surface = {"baseColorFactor": list(COLOR), "metallicFactor": 0.0, "roughnessFactor": 0.8}
    return writer.finish(
        {
            "asset": {"version": "2.0", "generator": "Handloom"},
            "scene": 0,
            "scenes": [{"nodes": [0, 1], "extras": {"fps": motion.fps, "first_frame": frames.start}}],
            "nodes": nodes,
            "meshes": [mesh],
            "skins": [skin],
            "materials": [{"name": "skin", "pbrMetallicRoughness": surface}],
            "animations": [{"name": "motion", "samplers": samplers, "channels": channels}],
        }
    )


def _add_mesh(writer: GlbWriter, model: BlendModel, shaped: Array) -> dict[str, Any]:
    bones = np.argsort(-model.skinning_weights, axis=1, kind="stable")[:, :GLTF_WEIGHTS]
    weights = np.take_along_axis(model.skinning_weights, bones, axis=1)
    weights = weights / weights.sum(axis=1, keepdims=True)
    joints = np.where(weights > 0.0, bones, 0).astype(np.uint8)
    normals = find_unit_normals(shaped, model.faces)
    attributes = {
        "POSITION": writer.add(shaped.astype(np.float32), target=ARRAY_BUFFER, bounded=True),
        "NORMAL": writer.add(normals.astype(np.float32), target=ARRAY_BUFFER),
        "JOINTS_0": writer.add(joints, target=ARRAY_BUFFER),
        "WEIGHTS_0": writer.add(weights.astype(np.float32), target=ARRAY_BUFFER),
    }
    indices = writer.add(model.faces.astype(np.uint32).reshape(-1), target=ELEMENT_BUFFER)
    return {"attributes": attributes, "indices": indices, "mode": 4, "material": 0}

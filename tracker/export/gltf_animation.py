"""A track as an animated glTF 2.0 file: every model a skinned mesh, every bone a node that moves."""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt
from scipy.spatial.transform import Rotation

from tracker.export.bone_motions import find_bone_motions
from tracker.export.glb_writer import ARRAY_BUFFER, ELEMENT_BUFFER, GlbWriter
from tracker.export.pose_morphs import PoseMorphs, find_pose_morphs
from tracker.model.articulated import ArticulatedModel
from tracker.tracking.track import Track

Array = npt.NDArray[np.float64]

T_GLTF_WORLD = np.diag([1.0, -1.0, -1.0, 1.0])
"""A recording's world looks as OpenCV cameras do, +Y down and +Z forward; that of glTF has +Y up and +Z backward."""

COLORS = {"right": (1.0, 0.287, 0.024, 1.0), "left": (0.033, 0.323, 0.896, 1.0), "object": (0.083, 0.624, 0.136, 1.0)}
"""Linear RGBA; on screen those of the studio."""

MOVED = 1e-6
"""m: a bone that stays this close to its place before its parent needs no moving translation."""


def write_glb(track: Track, fps: float) -> bytes:
    """The meshes, skeletons and movement of a track.

    Nodes stand at rest; the animation "track" turns and shifts them, its time 0 being the track's first frame.
    Vertices keep the numbers and units (m) that they have in the model. Pose blend shapes become morph targets.

    Args:
        track: Any track.
        fps: Frames per second of its recording.
    """
    scene, writer = track.setup.scene, GlbWriter()
    motions = find_bone_motions(track)
    normals = scene.pose_at(scene.rest_pose()).normals
    turned = Rotation.from_matrix(T_GLTF_WORLD[:3, :3]).as_quat()
    up: dict[str, Any] = {"name": "world", "rotation": turned.tolist(), "children": []}
    nodes: list[dict[str, Any]] = [up]
    document: dict[str, Any] = {"meshes": [], "skins": [], "materials": []}
    channels: list[dict[str, Any]] = []
    samplers: list[dict[str, Any]] = []
    weights_of: dict[int, int] = {}
    times = writer.add(((track.frame - track.frame[0]) / fps).astype(np.float32), bounded=True)
    for index, (name, model) in enumerate(zip(track.setup.names, scene.models, strict=True)):
        bones, first = scene.bone_slices[index], len(nodes)
        skeleton = model.skeleton
        Ts_rest = skeleton.Ts_model_bone
        nodes += _make_bones(name, model, first)
        up["children"].append(first)
        document["materials"].append(_make_material(name, model))
        weights = (scene.arrays.weight_bones, scene.arrays.weights)
        vertices = scene.vertex_slices[index]
        primitive = _add_mesh(
            writer, model, weights[0][vertices] - bones.start, weights[1][vertices], normals[vertices]
        )
        mesh: dict[str, Any] = {"name": name, "primitives": [primitive | {"material": index}]}
        morphs = find_pose_morphs(model, motions[:, bones])
        if morphs is not None:
            mesh["primitives"][0]["targets"] = add_targets(writer, morphs)
            mesh["weights"] = [0.0] * len(morphs.targets)
            weights_of[index] = writer.add(morphs.weights.astype(np.float32).reshape(-1))
        document["meshes"].append(mesh)
        inverse = np.linalg.inv(Ts_rest).transpose(0, 2, 1).reshape(-1, 16).astype(np.float32)
        inverse[:, 15] = 1.0
        document["skins"].append(
            {
                "name": name,
                "joints": list(range(first, first + skeleton.num_bones)),
                "skeleton": first,
                "inverseBindMatrices": writer.add(inverse),
            }
        )
        for bone, Ts in enumerate(find_local(motions[:, bones] @ Ts_rest, skeleton.parents)):
            paths = {"rotation": find_quaternions(Ts)}
            if skeleton.parents[bone] < 0 or np.ptp(Ts[:, :3, 3], axis=0).max() > MOVED:
                paths["translation"] = Ts[:, :3, 3]
            for path, values in paths.items():
                samplers.append(
                    {"input": times, "output": writer.add(values.astype(np.float32)), "interpolation": "LINEAR"}
                )
                channels.append({"sampler": len(samplers) - 1, "target": {"node": first + bone, "path": path}})
    roots = [0]
    for index, name in enumerate(track.setup.names):
        roots.append(len(nodes))
        if index in weights_of:
            samplers.append({"input": times, "output": weights_of[index], "interpolation": "LINEAR"})
            channels.append({"sampler": len(samplers) - 1, "target": {"node": len(nodes), "path": "weights"}})
        nodes.append({"name": f"{name} mesh", "mesh": index, "skin": index})
    return writer.finish(
        {
            "asset": {"version": "2.0", "generator": "Handloom"},
            "scene": 0,
            "scenes": [{"nodes": roots, "extras": _describe(track, fps)}],
            "nodes": nodes,
            **document,
            "animations": [{"name": "track", "samplers": samplers, "channels": channels}],
        }
    )


def _make_bones(name: str, model: ArticulatedModel, first: int) -> list[dict[str, Any]]:
    """Nodes of the bones at rest, the root's before `T_GLTF_WORLD`."""
    skeleton = model.skeleton
    nodes: list[dict[str, Any]] = []
    for bone, T in enumerate(find_local(skeleton.Ts_model_bone[None], skeleton.parents)[:, 0]):
        node: dict[str, Any] = {
            "name": f"{name}/{skeleton.bone_names[bone]}",
            "rotation": Rotation.from_matrix(T[:3, :3]).as_quat().tolist(),
            "translation": T[:3, 3].tolist(),
        }
        children = np.flatnonzero(skeleton.parents == bone)
        nodes.append(node | {"children": (children + first).tolist()} if len(children) else node)
    return nodes


def find_local(Ts: Array, parents: npt.NDArray[np.int64]) -> Array:
    """(B, T, 4, 4) bone to parent from (T, B, 4, 4) bone to world; a root stays as it is."""
    local = [Ts[:, b] if p < 0 else np.linalg.inv(Ts[:, p]) @ Ts[:, b] for b, p in enumerate(parents)]
    return np.stack(local)


def find_quaternions(Ts: Array) -> Array:
    """(T, 4) xyzw of (T, 4, 4), each on the side of the one before, so that nothing turns the long way round."""
    xyzw = Rotation.from_matrix(Ts[:, :3, :3]).as_quat()
    turns = np.where(np.sum(xyzw[1:] * xyzw[:-1], axis=1) < 0.0, -1.0, 1.0)
    return xyzw * np.cumprod(np.r_[1.0, turns])[:, None]


def _add_mesh(
    writer: GlbWriter, model: ArticulatedModel, bones: npt.NDArray[np.int32], weights: Array, normals: Array
) -> dict[str, Any]:
    lengths = np.linalg.norm(normals, axis=1, keepdims=True)
    unit = np.where(lengths > 0.5, normals / np.maximum(lengths, 1e-12), [0.0, 0.0, 1.0])  # of marks without faces
    joints = np.where(weights > 0.0, bones, 0).astype(np.uint8 if model.skeleton.num_bones <= 256 else np.uint16)
    attributes = {
        "POSITION": writer.add(model.vertices.astype(np.float32), target=ARRAY_BUFFER, bounded=True),
        "NORMAL": writer.add(unit.astype(np.float32), target=ARRAY_BUFFER),
        "JOINTS_0": writer.add(joints, target=ARRAY_BUFFER),
        "WEIGHTS_0": writer.add(weights.astype(np.float32), target=ARRAY_BUFFER),
    }
    indices = writer.add(model.faces.astype(np.uint32).reshape(-1), target=ELEMENT_BUFFER)
    return {"attributes": attributes, "indices": indices, "mode": 4}


def add_targets(writer: GlbWriter, morphs: PoseMorphs) -> list[dict[str, int]]:
    add = writer.add
    return [{"POSITION": add(each.astype(np.float32), target=ARRAY_BUFFER, bounded=True)} for each in morphs.targets]


def _make_material(name: str, model: ArticulatedModel) -> dict[str, Any]:
    color = COLORS.get(name if model.hand else "object", COLORS["object"])
    surface = {"baseColorFactor": list(color), "metallicFactor": 0.0, "roughnessFactor": 0.7}
    return {"name": name, "doubleSided": True, "pbrMetallicRoughness": surface}


def _describe(track: Track, fps: float) -> dict[str, Any]:
    """What glTF has no words for."""
    return {
        "fps": fps,
        "first_frame": int(track.frame[0]),
        "status": [str(status) for status in track.status],
        "T_gltf_world": T_GLTF_WORLD.tolist(),
    }

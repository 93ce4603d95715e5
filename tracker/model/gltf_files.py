"""Skinned hands in glTF 2.0 (.glb, .gltf), such as the hands of WebXR."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from tracker.errors import ModelFileError, reads
from tracker.model.articulated import ArticulatedModel
from tracker.model.decimation import decimate_file, limit_weights
from tracker.model.file_limits import MAX_VERTICES
from tracker.model.gltf_container import Gltf, read_gltf
from tracker.model.hand_axes import HandChains, derive_hand_joints
from tracker.model.hand_joint_names import find_side, map_joint_names, missing_joints
from tracker.model.hand_parts import find_hand_parts, find_tip, finger_segments
from tracker.model.hand_skeleton import build_hand_skeleton, hand_bone_names
from tracker.model.joints import FINGERS
from tracker.model.skeleton import Array

MAX_JOINTS = 512
"""Of a skin; a bound of ours."""
MAX_NODES = 4096
"""Of a file; a bound of ours."""
HAND_LENGTH = (0.08, 0.40)
"""Wrist to tip of the middle finger, m; outside of it the file is surely not in metres."""

Joints = dict[tuple[str, str], int]


@reads(ModelFileError, "a valid glTF 2.0 file with a skin")
def load_gltf_model(path: Path, max_faces: int | None = 1500) -> ArticulatedModel:
    """A hand from a skinned glTF, in the frame of the default hand (wrist at the origin, x forward, z out of its back).

    Joints are recognised by their names. A glTF knows no joint axes and limits; they are worked out from the rest
    pose, as `hand_axes` says: 31 revolute joints, fewer where a metacarpal of ring or little finger is missing.

    Args:
        path: The .glb or .gltf.
        max_faces: Decimate to so many faces; None keeps the mesh.

    Raises:
        ModelFileError: With what was found and what is needed.
    """
    gltf = read_gltf(Path(path))
    node, skin = _find_skinned_node(gltf)
    joint_nodes = skin.get("joints")
    if not isinstance(joint_nodes, list) or not 1 <= len(joint_nodes) <= MAX_JOINTS:
        raise gltf.fail("a skin without a list of joints", f"1 to {MAX_JOINTS} joints")
    names = [str(gltf.item("nodes", joint).get("name", "")) for joint in joint_nodes]
    joints = map_joint_names(names)
    missing = missing_joints(joints)
    if missing:
        raise gltf.fail(
            f"no joint named like {', '.join(missing[:6])} among {', '.join(names)[:160] or 'unnamed joints'}",
            "a skin whose joint names tell the wrist and each finger's bones, as in WebXR hands",
        )
    Ts_world_joint = np.stack([node_to_world(gltf, joint) for joint in joint_nodes])
    vertices, faces, weights = _read_mesh(gltf, node, len(joint_nodes))
    vertices = _pose_at_rest(gltf, skin, Ts_world_joint, vertices, weights)
    vertices, faces, weights = _merge_seams(vertices, faces, weights)
    positions = Ts_world_joint[:, :3, 3]
    side = find_side([*names, str(node.get("name", "")), gltf.path.stem]) or _side_from_curl(positions, joints)
    chains = _build_chains(gltf, side, positions, joints, vertices, weights)
    R = _hand_axes(chains)
    chains = HandChains(side, np.zeros(3), {f: (points - chains.wrist) @ R.T for f, points in chains.fingers.items()})
    vertices = (vertices - positions[joints["wrist", ""]]) @ R.T
    model = _build_model(gltf, chains, joints, vertices, faces, weights)
    return model if max_faces is None else decimate_file(gltf.path, model, max_faces)


def _find_skinned_node(gltf: Gltf) -> tuple[dict[str, Any], dict[str, Any]]:
    nodes = gltf.document.get("nodes", [])
    if isinstance(nodes, list) and len(nodes) > MAX_NODES:
        raise gltf.fail(f"{len(nodes)} nodes", f"at most {MAX_NODES} nodes, a single hand")
    skinned = (
        [n for n in nodes if isinstance(n, dict) and "skin" in n and "mesh" in n] if isinstance(nodes, list) else []
    )
    if len(skinned) != 1:
        raise gltf.fail(f"{len(skinned)} nodes with a skinned mesh", "exactly one, a single hand")
    return skinned[0], gltf.item("skins", skinned[0]["skin"])


def node_to_world(gltf: Gltf, index: Any) -> Array:
    """(4, 4) node to world at the pose the file stands in."""
    nodes = gltf.document["nodes"]
    T = np.eye(4)
    for _ in range(len(nodes) + 1):
        T = _node_matrix(gltf, gltf.item("nodes", index)) @ T
        above = [n for n, other in enumerate(nodes) if isinstance(other, dict) and _has_child(other, index)]
        if not above:
            return T
        index = above[0]
    raise gltf.fail("nodes that are their own parents", "a tree of nodes")


def _has_child(node: dict[str, Any], index: int) -> bool:
    children = node.get("children", [])
    return isinstance(children, list) and index in children


def _node_matrix(gltf: Gltf, node: dict[str, Any]) -> Array:
    def numbers(name: str, default: list[float]) -> Array:
        values = node.get(name, default)
        good = isinstance(values, list) and len(values) == len(default)
        if not good or not all(type(v) in (int, float) and abs(v) < 1e6 for v in values):
            raise gltf.fail(f"a node with the {name} {str(values)[:60]}", f"{len(default)} numbers")
        return np.array(values, dtype=np.float64)

    if "matrix" in node:
        return numbers("matrix", list(np.eye(4).ravel())).reshape(4, 4).T
    x, y, z, w = numbers("rotation", [0.0, 0.0, 0.0, 1.0])
    norm = x * x + y * y + z * z + w * w
    if norm < 1e-12:
        raise gltf.fail("a node with a rotation of length 0", "a unit quaternion")
    s = 2.0 / norm
    R = np.array(
        [
            [1 - s * (y * y + z * z), s * (x * y - z * w), s * (x * z + y * w)],
            [s * (x * y + z * w), 1 - s * (x * x + z * z), s * (y * z - x * w)],
            [s * (x * z - y * w), s * (y * z + x * w), 1 - s * (x * x + y * y)],
        ]
    )
    T = np.eye(4)
    T[:3, :3] = R * numbers("scale", [1.0, 1.0, 1.0])
    T[:3, 3] = numbers("translation", [0.0, 0.0, 0.0])
    return T


def _read_mesh(gltf: Gltf, node: dict[str, Any], num_joints: int) -> tuple[Array, npt.NDArray[np.int64], Array]:
    vertices, faces, weights, start = [], [], [], 0
    for primitive in gltf.primitives(node["mesh"]):
        points, ids = gltf.triangles(primitive)
        attributes = primitive["attributes"]
        if "JOINTS_0" not in attributes:
            raise gltf.fail("a primitive of triangles that are not skinned", "triangles with JOINTS_0 and WEIGHTS_0")
        if len(points) + start > MAX_VERTICES:
            raise gltf.fail(f"more than {MAX_VERTICES} vertices", "a lighter mesh")
        weights.append(_read_weights(gltf, attributes, len(points), num_joints))
        vertices.append(points)
        faces.append(ids + start)
        start += len(points)
    if not vertices:
        raise gltf.fail("a mesh without primitives", "triangles")
    return np.concatenate(vertices), np.concatenate(faces), np.concatenate(weights)


def _read_weights(gltf: Gltf, attributes: dict[str, Any], num_vertices: int, num_joints: int) -> Array:
    weights = np.zeros((num_vertices, num_joints))
    rows = np.arange(num_vertices)[:, None]
    for group in range(4):
        if f"JOINTS_{group}" not in attributes:
            break
        bones = gltf.accessor(attributes[f"JOINTS_{group}"], "VEC4")
        shares = gltf.accessor(attributes.get(f"WEIGHTS_{group}"), "VEC4").astype(np.float64)
        if (
            bones.dtype.kind != "u"
            or len(bones) != num_vertices
            or len(shares) != num_vertices
            or bones.max() >= num_joints
        ):
            raise gltf.fail(
                f"JOINTS_{group} that name no joint of the skin", f"{num_vertices} x 4 joints below {num_joints}"
            )
        if shares.min() < 0.0:
            raise gltf.fail("negative skinning weights", "weights that sum to one")
        np.add.at(weights, (rows, bones.astype(np.int64)), shares)
    sums = weights.sum(axis=1, keepdims=True)
    if sums.min() < 0.5 or sums.max() > 1.5:
        raise gltf.fail("skinning weights that do not sum to one", "weights that sum to one")
    return weights / sums


def _pose_at_rest(gltf: Gltf, skin: dict[str, Any], Ts_world_joint: Array, vertices: Array, weights: Array) -> Array:
    """(V, 3) world, m, as the file's own nodes pose the mesh."""
    if "inverseBindMatrices" in skin:
        inverse = (
            gltf.accessor(skin["inverseBindMatrices"], "MAT4").astype(np.float64).reshape(-1, 4, 4).transpose(0, 2, 1)
        )
        if len(inverse) < len(Ts_world_joint):
            raise gltf.fail(f"{len(inverse)} inverse bind matrices", f"one for each of {len(Ts_world_joint)} joints")
    else:
        inverse = np.tile(np.eye(4), (len(Ts_world_joint), 1, 1))
    moved = Ts_world_joint @ inverse[: len(Ts_world_joint)]
    homogeneous = np.concatenate([vertices, np.ones((len(vertices), 1))], axis=1)
    return np.einsum("vb,bij,vj->vi", weights, moved[:, :3], homogeneous, optimize=True)


def _merge_seams(vertices: Array, faces: npt.NDArray[np.int64], weights: Array) -> tuple:
    """One vertex where a seam of the texture split it in several."""
    _, first, inverse = np.unique(np.round(vertices, 7), axis=0, return_index=True, return_inverse=True)
    merged = inverse.ravel()[faces]
    whole = (merged[:, 0] != merged[:, 1]) & (merged[:, 1] != merged[:, 2]) & (merged[:, 2] != merged[:, 0])
    return vertices[first], merged[whole], weights[first]


def _side_from_curl(positions: Array, joints: Joints) -> str:
    """The side of the palm to which the fingers are bent at rest tells right from left."""
    across = positions[joints["index", "proximal"]] - positions[joints["little", "proximal"]]
    bend = np.zeros(3)
    for finger in FINGERS[1:]:
        a, b, c = (positions[joints[finger, segment]] for segment in ("proximal", "middle", "distal"))
        bend += np.cross(b - a, c - b) + np.cross(a - positions[joints["wrist", ""]], b - a)
    return "right" if bend @ across > 0.0 else "left"


def _build_chains(
    gltf: Gltf, side: str, positions: Array, joints: Joints, vertices: Array, weights: Array
) -> HandChains:
    fingers = {}
    for finger in FINGERS:
        segments = [segment for segment in finger_segments(finger) if (finger, segment) in joints]
        points = [positions[joints[finger, segment]] for segment in segments]
        if (finger, "tip") in joints:
            points.append(positions[joints[finger, "tip"]])
        else:
            along = points[-1] - points[-2]
            along = along / max(float(np.linalg.norm(along)), 1e-9)
            own = weights[:, joints[finger, "distal"]] > 0.5
            reach = float(np.max((vertices[own] - points[-1]) @ along)) if own.any() else 0.0
            points.append(points[-1] + max(reach, 0.01) * along)
        fingers[finger] = np.array(points)
        if np.linalg.norm(np.diff(fingers[finger], axis=0), axis=1).min() < 1e-4:
            raise gltf.fail(f"joints of the {finger} finger in one place", "a bone of some length between joints")
    wrist = positions[joints["wrist", ""]]
    length = float(np.linalg.norm(fingers["middle"][-1] - wrist))
    if not HAND_LENGTH[0] <= length <= HAND_LENGTH[1]:
        raise gltf.fail(
            f"a hand {length:.4g} m long from wrist to middle tip",
            f"{HAND_LENGTH[0]} to {HAND_LENGTH[1]} m: glTF is in metres",
        )
    across = np.cross(fingers["middle"][-4] - wrist, fingers["index"][-4] - fingers["little"][-4])
    if np.linalg.norm(across) < 1e-5:
        raise gltf.fail("knuckles in one line with the wrist", "the joints of a hand")
    return HandChains(side, wrist, fingers)


def _hand_axes(chains: HandChains) -> Array:
    """(3, 3) the file's axes to the hand's."""
    x, z = chains.forward, chains.dorsal
    return np.stack([x, np.cross(z, x), z])


def _build_model(
    gltf: Gltf, chains: HandChains, joints: Joints, vertices: Array, faces: npt.NDArray[np.int64], weights: Array
) -> ArticulatedModel:
    names = hand_bone_names(chains)
    ours = np.zeros((len(vertices), len(names)))
    mapped = {place: joint for joint, place in joints.items()}
    for place in range(weights.shape[1]):
        finger, segment = mapped.get(place, ("wrist", ""))
        bone = "wrist" if finger == "wrist" else f"{finger}_{'distal' if segment == 'tip' else segment}"
        ours[:, names.index(bone)] += weights[:, place]
    unmapped = [place for place in range(weights.shape[1]) if place not in mapped]
    if weights[:, unmapped].sum() > 0.5 * len(vertices):
        raise gltf.fail("a mesh that mostly follows joints which are no part of a hand", "the mesh of one hand")
    ours = limit_weights(ours)
    derived = derive_hand_joints(chains)
    if any(abs(np.linalg.norm(joint.axis) - 1.0) > 1e-6 for joint in derived):
        raise gltf.fail("a finger that stands square on the palm", "a rest pose with the fingers stretched forward")
    skeleton = build_hand_skeleton(chains, derived)
    bones = {f: tuple(names.index(f"{f}_{s}") for s in chains.segments(f)) for f in FINGERS}
    tips = np.array([find_tip(vertices, ours[:, bones[finger][-1]], chains.fingers[finger]) for finger in FINGERS])
    return ArticulatedModel(
        name=gltf.path.stem,
        vertices=vertices,
        faces=faces,
        skinning_weights=ours,
        skeleton=skeleton,
        hand=find_hand_parts(chains.side, vertices, ours, skeleton.joints_rest, 0, bones, tips),
        provenance={
            "file": gltf.path.name,
            "format": "glTF 2.0",
            "generator": str(gltf.document["asset"].get("generator", ""))[:200],
            "joints": "axes and limits derived from the rest pose",
        },
    )

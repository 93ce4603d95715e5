"""What the body with hands is worth: seams at the wrists, its hands beside the hand model, people's measurements.

    OPENBLAS_NUM_THREADS=1 python -m benchmarks.body_model [--poses 100] [--people 2000] [--json]

Bars (`docs/bodies.md`): the step at the seam at most 0.5 mm more than where nothing is sewn (95 %), the hands
within 0.3 mm of the hand model, means and deviations of stature and hand length within 3 % of ANSUR II's, their
correlation within 0.05. Exit code 1 when one is missed.
"""

from __future__ import annotations

import argparse
import json
import sys
from collections import Counter
from typing import Any

import numpy as np
import numpy.typing as npt

from tracker.model.blend_model import BLEND_JOINTS, BlendModel
from tracker.model.body_hands import BodyHand, body_hand
from tracker.model.body_model import SEXES, body_model

Array = npt.NDArray[np.float64]
Ints = npt.NDArray[np.int64]

ANSUR = {
    "male": ((1.75621, 0.19328), (0.06855, 0.00995), 0.6732),
    "female": ((1.62847, 0.18108), (0.06420, 0.01006), 0.6462),
}
"""Mean and deviation of stature and hand length, m, and their correlation: 4,082 men and 1,986 women, ANSUR II."""

WRIST_BEND = 0.5
"""Largest turn of a wrist in the poses compared, rad."""


def measure_seam(model: BlendModel, poses: int, seed: int = 0) -> dict[str, float]:
    """How high the step is where the hands are sewn on, mm, over random people, finger poses and turns of the wrist.

    The ring of vertices between hand and forearm is taken out and put back where the surfaces on both sides, carried on
    so that they bend least, meet. Were one side higher than the other by a step, the ring would be half a step away:
    twice its distance along the normals is the step. Coarse and uneven triangles count too, so the same is found where
    nothing is sewn: "hand" and "forearm" are the next three rings on either side, each taken out alone, and "smooth" is
    the ring at rest with its surroundings laid onto an elliptic limb, which has no step at all.
    """
    rng = np.random.default_rng(seed)
    hands = [body_hand(model, side) for side in ("right", "left")]
    rings = [find_rings(model, hand) for hand in hands]
    steps: dict[str, list[float]] = {}
    for _ in range(poses):
        pose = _hand_pose(model, rng)
        for hand in hands:
            pose[hand.wrist] = rng.uniform(-1.0, 1.0, 3) * WRIST_BEND / np.sqrt(3.0)
        posed = model.pose_at(pose, rng.standard_normal(model.num_shape))
        for hand, found in zip(hands, rings, strict=True):
            faces = _faces_near(model, hand, posed.arrays.shaped, posed.joints_rest)
            for kind, some in found.items():
                steps.setdefault(kind, []).extend(np.concatenate([_steps(posed.vertices, faces, r) for r in some]))
    for hand, found in zip(hands, rings, strict=True):
        joints = model.joints_of(model.template)
        faces = _faces_near(model, hand, model.template, joints)
        limb = _lay_onto_ellipse(model.template, joints[hand.wrist], faces, found[""][0])
        steps.setdefault("smooth_", []).extend(_steps(limb, faces, found[""][0]))
    return {
        f"{kind}{name}_mm": 1e3 * float(value)
        for kind, values in steps.items()
        for name, value in (("mean", np.mean(values)), ("p95", np.percentile(values, 95)), ("max", np.max(values)))
    }


def find_rings(model: BlendModel, hand: BodyHand) -> dict[str, list[Ints]]:
    """Vertices of a hand that share a face with the forearm, and the next three rings on the hand and the forearm."""
    is_hand = np.isin(np.arange(len(model.template)), hand.vertices)
    own = is_hand[model.faces]
    across = own.any(axis=1) & ~own.all(axis=1)
    seam = np.unique(model.faces[across][own[across]])
    rings: dict[str, list[Ints]] = {"": [seam], "hand_": [], "forearm_": []}
    for kind, side in (("hand_", is_hand), ("forearm_", ~is_hand)):
        seen = last = seam
        for _ in range(3):
            beside = np.unique(model.faces[np.isin(model.faces, last).any(axis=1)])
            last = beside[side[beside] & ~np.isin(beside, seen)]
            seen = np.concatenate([seen, last])
            rings[kind].append(last)
    return rings


def _faces_near(model: BlendModel, hand: BodyHand, rest: Array, joints: Array) -> Ints:
    """Faces within 6 cm of the wrist along the arm of a person at rest."""
    past = ((rest - joints[hand.wrist]) * hand.outwards)[:, 0]
    return model.faces[np.all(np.abs(past[model.faces]) < 0.06, axis=1)]


def _lay_onto_ellipse(vertices: Array, wrist: Array, faces: Ints, ring: Ints) -> Array:
    """Vertices (V, 3) with those of the faces laid onto one ellipse along x, as wide as the ring."""
    used = np.unique(faces)
    placed = vertices.copy()
    x, across = vertices[:, :1] - wrist[0], vertices[:, 1:]
    line = np.polyfit(x[used, 0], across[used], 1)
    middle = x * line[0] + line[1]
    wide = np.abs(across - middle)[ring].max(axis=0)
    outwards = (across - middle) / wide
    placed[used, 1:] = (middle + wide * outwards / np.linalg.norm(outwards, axis=1, keepdims=True))[used]
    return placed


def _steps(vertices: Array, faces: Ints, ring: Ints) -> Array:
    """Twice the distance (N,) of the ring's vertices from the smoothest surface through all others, m."""
    used, local = np.unique(faces, return_inverse=True)
    points, triangles, free = vertices[used], local.reshape(-1, 3), np.searchsorted(used, ring)
    laplacian, areas, normals = np.zeros((len(used), len(used))), np.zeros(len(used)), np.zeros((len(used), 3))
    for corner in range(3):
        a, b, c = (triangles[:, (corner + k) % 3] for k in range(3))
        u, v = points[b] - points[a], points[c] - points[a]
        crossed = np.cross(u, v)
        double = np.linalg.norm(crossed, axis=1)
        np.add.at(areas, a, double / 6.0)
        np.add.at(normals, a, crossed)
        cotangent = 0.5 * np.einsum("fx,fx->f", u, v) / double
        for first, second in ((b, c), (c, b)):
            np.add.at(laplacian, (first, second), -cotangent)
            np.add.at(laplacian, (first, first), cotangent)
    reached = np.flatnonzero(np.abs(laplacian[:, free]).sum(axis=1))
    matrix = laplacian[reached] / np.sqrt(areas[reached])[:, None]
    fixed = points.copy()
    fixed[free] = 0.0
    smooth = -np.linalg.lstsq(matrix[:, free], matrix @ fixed, rcond=None)[0]
    outwards = normals[free] / np.linalg.norm(normals[free], axis=1, keepdims=True)
    return 2.0 * np.abs(np.einsum("nx,nx->n", points[free] - smooth, outwards))


def compare_hands(model: BlendModel, hands: dict[str, BlendModel], poses: int, seed: int = 1) -> dict[str, float]:
    """The largest distance between the body's hands and the hand model's, mm, over random people and poses.

    Body and fingers are turned at random; the hand model is given the person's hand as its own template and turned and
    placed as the body's wrist is. "straight": all vertices of the hand, the wrist not turned; "bent": those beyond the
    band where the skin goes over to the forearm, the wrist turned, too.
    """
    rng = np.random.default_rng(seed)
    worst: dict[str, list[float]] = {"straight": [], "bent": []}
    for number in range(poses):
        pose = _hand_pose(model, rng)
        pose[:22] = 0.4 * rng.standard_normal((22, 3))
        kind = "straight" if number % 2 else "bent"
        if kind == "straight":
            pose[[body_hand(model, side).wrist for side in hands]] = 0.0
        posed = model.pose_at(pose, rng.standard_normal(model.num_shape), rng.standard_normal(3))
        for side, hand_model in hands.items():
            hand = body_hand(model, side)
            R = hand.R_body_hand
            rest = model.shaped(posed.shape)[hand.vertices]
            origin = posed.joints_rest[hand.wrist]
            turned = np.concatenate([np.zeros((1, 3)), pose[hand.fingers]]) @ R
            alone = hand_model.pose_at(turned, rest=(rest - origin) @ R)
            placed = (alone.vertices - alone.joints[0]) @ R.T @ posed.Ts[hand.wrist][:, :3].T
            placed += posed.joints[hand.wrist]
            apart = np.linalg.norm(placed - posed.vertices[hand.vertices], axis=1)
            if kind == "bent":
                apart = apart[model.skinning_weights[hand.vertices, hand.elbow] == 0.0]
            worst[kind].append(float(apart.max()))
    return {f"{kind}_max_mm": 1e3 * max(found) for kind, found in worst.items()}


def measure_people(model: BlendModel, people: int, seed: int = 2) -> dict[str, Any]:
    """Stature and hand length (m) of random people of the model's population."""
    rng = np.random.default_rng(seed)
    hand = body_hand(model, "right")
    rows = []
    for shape in rng.standard_normal((people, model.num_shape)):
        shaped = model.shaped(shape)
        joints = model.joints_of(shaped)
        chain = [hand.wrist, *(hand.fingers[BLEND_JOINTS.index(f"middle{k}") - 1] for k in (1, 2, 3))]
        points = np.concatenate([joints[chain], shaped[model.tips[2]][None]])
        rows.append((np.ptp(shaped[:, 1]), np.linalg.norm(np.diff(points, axis=0), axis=1).sum()))
    found = np.array(rows)
    return {
        "mean": found.mean(axis=0).tolist(),
        "deviation": found.std(axis=0, ddof=1).tolist(),
        "correlation": float(np.corrcoef(found.T)[0, 1]),
    }


def count_open_edges(faces: Ints) -> int:
    """Edges that do not have exactly one face on either side; none in a closed surface."""
    edges = Counter(tuple(sorted(edge)) for edge in faces[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2).tolist())
    return sum(count != 2 for count in edges.values())


def _hand_pose(model: BlendModel, rng: np.random.Generator) -> Array:
    """(52, 3) a body at rest with both hands anywhere within their pose space, six components each."""
    half = len(model.pose_components) // 2
    coefficients = np.zeros(len(model.pose_components))
    for first in (0, half):
        coefficients[first : first + 6] = 0.8 * rng.standard_normal(6)
    return np.concatenate([np.zeros((1, 3)), model.pose_of(coefficients)])


def find_misses(report: dict[str, Any]) -> list[str]:
    """Bars that the report misses, in words."""
    missed = []
    seam = report["seam"]
    if seam["p95_mm"] - seam["hand_p95_mm"] >= 0.5:
        missed.append("the step at the seam")
    if max(report["hands"].values()) >= 0.3:
        missed.append("the hands")
    for sex, (mean, deviation, correlation) in ANSUR.items():
        found = report[sex]
        for name, wanted in (("mean", mean), ("deviation", deviation)):
            if np.abs(np.array(found[name]) / wanted - 1.0).max() > 0.03:
                missed.append(f"{name} of {sex} people")
        if abs(found["correlation"] - correlation) > 0.05:
            missed.append(f"correlation of {sex} people")
    return missed


def main() -> int:
    from tracker.model.trained_hand import trained_hand

    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--poses", type=int, default=100)
    parser.add_argument("--people", type=int, default=2000, help="of each sex")
    parser.add_argument("--json", action="store_true")
    arguments = parser.parse_args()
    model = body_model()
    hands = {side: trained_hand(side) for side in ("right", "left")}
    report: dict[str, Any] = {
        "seam": measure_seam(model, arguments.poses),
        "hands": compare_hands(model, hands, arguments.poses),
        "open_edges": count_open_edges(model.faces),
    }
    report |= {sex: measure_people(body_model(sex), arguments.people) for sex in SEXES}
    report["missed"] = find_misses(report)
    print(json.dumps(report, indent=None if arguments.json else 1))
    return int(bool(report["missed"]))


if __name__ == "__main__":
    sys.exit(main())

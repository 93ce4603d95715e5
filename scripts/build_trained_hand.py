"""Build the trained hand that comes with Handloom and write `tracker/model/data/trained_hand.npz`.

    python scripts/build_trained_hand.py --work DIR [--people 25] [--poses 12]
    python scripts/build_trained_hand.py --registrations DIR/loop/round_2/registrations

DIR/scans gets scans of generated people (identities from MakeHuman's CC0 targets, a list of grasps of our own),
DIR/loop what `handloom model-loop` makes of them in two rounds: registered, judged by the program itself and learnt
from, nobody's truth used. About 20 minutes on two idle cores; an interrupted run goes on where it stopped. From the
second round's registrations that were called good the hand is then learnt once more, from the untrained hand on.
Numbers are rounded so that the file stays small.
"""

from __future__ import annotations

import argparse
import sys
from dataclasses import replace
from pathlib import Path

import numpy as np

ROOT = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(ROOT))

from benchmarks.model_training import write_own_scans  # noqa: E402
from tracker.cli.__main__ import main as handloom  # noqa: E402
from tracker.model.blend_files import save_blend_model  # noqa: E402
from tracker.model.blend_model import BlendModel  # noqa: E402
from tracker.model.untrained_hand import untrained_hand  # noqa: E402
from tracker.training.options import TrainingOptions  # noqa: E402
from tracker.training.train import train_model  # noqa: E402
from tracker.training.training_set import load_training_set  # noqa: E402

SHAPES = 20
STEP = 2.0**-20
"""Of lengths, about a micrometre."""
WEIGHT_STEP = 2.0**-16
MOST_BYTES = 1_500_000

ORIGIN = {
    "license": "CC0-1.0",
    "made_by": "scripts/build_trained_hand.py",
    "source": "Handloom's registrations of generated people: MakeHuman's CC0 targets, grasps of our own; no scan of "
    "a person, no other hand model. Blend weights began as the default hand's (MakeHuman, CC0).",
}


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--out", type=Path, default=ROOT / "tracker" / "model" / "data" / "trained_hand.npz")
    source = parser.add_mutually_exclusive_group(required=True)
    source.add_argument("--work", type=Path, metavar="DIR", help="where scans and registrations are kept")
    source.add_argument("--registrations", type=Path, metavar="FOLDER", help="those of an earlier run")
    parser.add_argument("--people", type=int, default=25)
    parser.add_argument("--poses", type=int, default=12, help="scans of each")
    args = parser.parse_args()
    folder = args.registrations or register(args.work, args.people, args.poses)
    options = TrainingOptions(name="trained right hand", num_shapes=SHAPES)
    training = train_model(load_training_set(folder), untrained_hand("right"), options)
    model = shorten(training.model)
    save_blend_model(model, args.out)
    size = args.out.stat().st_size
    left = training.report["residual_mm"]
    print(f"{args.out}: {len(model.template)} vertices, {model.num_shape} shapes, {left} mm, {size / 1e6:.2f} MB")
    return 0 if size <= MOST_BYTES else 1


def register(work: Path, people: int, poses: int) -> Path:
    """The folder of the second round's registrations."""
    write_own_scans(work / "scans", people, poses)
    if handloom(["model-loop", str(work / "scans"), "--out", str(work / "loop"), "--shapes", str(SHAPES)]):
        raise SystemExit("the loop failed")
    return work / "loop" / "round_2" / "registrations"


def shorten(model: BlendModel) -> BlendModel:
    """The right hand with its numbers rounded; weights still sum to one."""
    weights = np.round(model.skinning_weights / WEIGHT_STEP) * WEIGHT_STEP
    heaviest = np.arange(len(weights)), weights.argmax(axis=1)
    weights[heaviest] += 1.0 - weights.sum(axis=1)

    def rounded(lengths: np.ndarray) -> np.ndarray:
        return np.round(lengths / STEP) * STEP

    return replace(
        model,
        name="trained right hand",
        template=rounded(model.template),
        shape_directions=rounded(model.shape_directions),
        pose_directions=rounded(model.pose_directions),
        skinning_weights=weights,
        provenance={**model.provenance, **ORIGIN},
    )


if __name__ == "__main__":
    raise SystemExit(main())

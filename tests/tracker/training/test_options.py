"""What can be chosen about a training: bounds, and what a report says of it."""

import json

import pytest

from tracker.errors import TrainingError
from tracker.training.options import TrainingOptions


@pytest.mark.parametrize(
    ("bad", "told"),
    [
        ({"rounds": 21}, "rounds is 21; it must be from 1 to 20"),
        ({"ridge": -1.0}, "ridge is -1.0; it must be a finite number above 0"),
        ({"ridge": float("inf")}, "ridge is inf"),
        ({"num_shapes": 201}, "num_shapes is 201"),
        ({"num_local_shapes": -1}, "num_local_shapes is -1"),
        ({"joint_stiffness": 0.0}, "joint_stiffness and weight_stiffness must be above 0"),
        ({"weight_stiffness": -0.1}, "joint_stiffness and weight_stiffness must be above 0"),
        ({"threads": 257}, "threads is 257"),
    ],
)
def test_what_is_out_of_bounds_is_refused_with_the_bounds(bad, told):
    with pytest.raises(TrainingError, match=told):
        TrainingOptions(**bad)


def test_a_report_holds_all_that_changes_the_result_and_nothing_else():
    one, other = TrainingOptions(threads=1).describe(), TrainingOptions(threads=8).describe()
    assert one == other and "threads" not in one
    assert json.loads(json.dumps(one)) == one
    for name, value in {"rounds": 2, "ridge": 1e-3, "with_mirrored": False, "num_local_shapes": 4}.items():
        assert TrainingOptions(**{name: value}).describe() != one

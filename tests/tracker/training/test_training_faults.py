"""What keeps a model from being trained is told before the registrations are read."""

import numpy as np
import pytest

from tracker.training.training_faults import (
    FEWEST,
    FEWEST_OF_A_HAND,
    LEAST_BEND,
    TrainingHand,
    find_bend_fault,
    find_training_faults,
)


def make_hands(**counts: int) -> list[TrainingHand]:
    """So many right hands by person."""
    return [TrainingHand(name, False, 782) for name, count in counts.items() for _ in range(count)]


def find(hands, side: str = "right", vertices: int = 782, with_mirrored: bool = True) -> list[str]:
    return find_training_faults(hands, "the model", side, vertices, with_mirrored)


def test_just_enough_is_enough_and_one_less_is_not():
    assert find(make_hands(ada=FEWEST - 3, bob=3)) == []
    faults = find(make_hands(ada=FEWEST - 4, bob=3))
    assert faults == [
        "There are 19 registrations of 2 people; a model needs 20 of at least 2 people. Register and accept more scans."
    ]


def test_one_person_is_not_enough_however_many_registrations():
    assert "of 1 person;" in find(make_hands(ada=100))[0]


def test_a_hand_with_too_few_of_its_own_does_not_count_and_that_is_said():
    (fault,) = find(make_hands(ada=19, bob=FEWEST_OF_A_HAND - 1))
    assert "There are 19 registrations of 1 person" in fault and "2 registrations do not count" in fault


def test_left_and_right_of_a_person_are_two_hands():
    left = [TrainingHand("ada", True, 782) for _ in range(2)]
    (fault,) = find([*make_hands(ada=2, bob=17), *left])
    assert "There are 17 registrations of 1 person" in fault and "4 registrations do not count" in fault


def test_left_hands_count_only_where_they_are_mirrored():
    hands = [*make_hands(ada=10), *(TrainingHand("bob", True, 782) for _ in range(10))]
    assert find(hands) == []
    (fault,) = find(hands, with_mirrored=False)
    assert "left hands are left out" in fault


def test_a_left_model_and_another_topology_are_each_said():
    faults = find(make_hands(ada=12, bob=12), side="left", vertices=778)
    assert len(faults) == 2
    assert "the model is a left hand" in faults[0] and "782 vertices, the model has 778" in faults[1]


def test_nothing_at_all_is_told_with_the_same_sentence():
    assert find([])[0].startswith("There are 0 registrations of 0 people")


@pytest.mark.parametrize(("share", "is_fault"), [(0.9, True), (1.1, False)])
def test_hands_must_bend_at_one_joint_at_least(share, is_fault):
    turns = np.zeros((40, 15, 3))
    turns[::2, 4, 1] = 2.0 * share * LEAST_BEND  # half bent, half not: the deviation is half of it
    assert (find_bend_fault(turns) is not None) == is_fault


def test_no_poses_do_not_bend():
    fault = find_bend_fault(np.zeros((0, 15, 3)))
    assert fault is not None and "0 degrees" in fault

"""Which model stands for which hand: its own file, a built-in one for all, the default hand otherwise."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from tests.tracker.toys import tube
from tracker.cli.hands import load_hands, load_objects
from tracker.errors import ModelFileError, TrackerError
from tracker.model import save_model
from tracker.model.blend_articulated import articulated_of
from tracker.model.default_hand import default_hand
from tracker.model.trained_hand import trained_hand


@pytest.fixture(scope="module")
def left_file(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("models") / "left.npz"
    save_model(default_hand("left"), path)
    return path


@pytest.fixture(scope="module")
def tube_file(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("models") / "tube.npz"
    save_model(tube(), path)
    return path


@pytest.mark.parametrize("hands", [(), ("right",), ("left", "right")])
def test_hands_that_nothing_is_given_for_are_default_ones_in_the_order_asked_for(hands: tuple[str, ...]) -> None:
    models = load_hands([], hands)
    assert tuple(models) == hands
    for side, model in models.items():
        assert np.array_equal(model.vertices, default_hand(side).vertices)
    assert tuple(load_hands([(side, None) for side in hands], hands)) == hands


def test_a_file_stands_for_its_side_alone(left_file: Path) -> None:
    models = load_hands([("left", left_file)], ("right", "left"))
    assert np.allclose(models["left"].vertices, default_hand("left").vertices, atol=1e-6)
    assert np.array_equal(models["right"].vertices, default_hand("right").vertices)


def test_a_built_in_hand_is_that_of_every_side_but_those_with_a_file_of_their_own(left_file: Path) -> None:
    trained = articulated_of(trained_hand("right"))
    models = load_hands([("trained", None), ("left", left_file)], ("right", "left"))
    assert np.array_equal(models["right"].vertices, trained.vertices)
    assert len(models["left"].vertices) == len(default_hand("left").vertices)
    named = load_hands([("right", Path("trained"))], ("right",))
    assert np.array_equal(named["right"].vertices, trained.vertices)


def test_a_file_of_the_other_side_and_one_of_no_hand_are_refused(left_file: Path, tube_file: Path) -> None:
    with pytest.raises(TrackerError, match=r"left\.npz: is a left hand; needed a right hand\."):
        load_hands([("right", left_file)], ("right",))
    with pytest.raises(TrackerError, match=r"tube\.npz: is not a hand; needed a left hand\."):
        load_hands([("left", tube_file)], ("left",))
    with pytest.raises(ModelFileError, match=r"nowhere\.npz"):
        load_hands([("left", Path("nowhere.npz"))], ("left",))


def test_a_hand_that_the_recording_does_not_show_is_refused_with_those_it_does(left_file: Path) -> None:
    with pytest.raises(TrackerError, match=r"--hand left: there are the hands \['right'\] only\."):
        load_hands([("left", left_file)], ("right",))


def test_objects_are_loaded_by_name_and_an_unknown_one_is_told_the_known(tube_file: Path) -> None:
    assert load_objects([], ("rope",)) == {}
    (model,) = load_objects([("rope", tube_file)], ("rope", "ball")).values()
    assert np.allclose(model.vertices, tube().vertices)
    with pytest.raises(TrackerError, match=r"--object cup: the recording names \['rope', 'ball'\]\."):
        load_objects([("cup", tube_file)], ("rope", "ball"))
    with pytest.raises(TrackerError, match=r"--object cup: the recording names no objects\."):
        load_objects([("cup", tube_file)], ())

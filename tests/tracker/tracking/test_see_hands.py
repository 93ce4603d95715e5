"""Hands are looked for in all views of a moment; a lost one that one view alone shows, in the others where it says."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from tests.tracker.tracking.test_fit_views import CAMERAS, SCENE, SETUP, blank, with_depth
from tracker.capture.frame import CameraFrame
from tracker.capture.truth import load_truth
from tracker.fitting.options import TrackOptions
from tracker.fitting.setup import TrackSetup
from tracker.fitting.view_hands import ViewHands
from tracker.model.default_hand import default_hand
from tracker.model.npz_files import save_npz_model
from tracker.model.scene import PosedScene
from tracker.synthesis.motion import perform
from tracker.synthesis.recording import RecordingOptions, write_recording
from tracker.tracking.see_hands import Look, see_hands
from tracker.tracking.start import start_tracking

Drawn = tuple[TrackSetup, list[CameraFrame], PosedScene, np.ndarray]


@pytest.fixture(scope="module")
def drawn(tmp_path_factory: pytest.TempPathFactory) -> Drawn:
    """A hand before three cameras: views, a pose elsewhere, and (3, 21, 2) px where its joints are."""
    performance = perform({"right": default_hand("right")}, "open-close", 60, 3, (480, 360))
    folder: Path = tmp_path_factory.mktemp("views") / "hand"
    sequence = write_recording(performance, folder, RecordingOptions(range(1), sensor=None), save_npz_model)
    options = TrackOptions(calibrate=False, cameras="cam0,cam1,cam2", use_depth=False)
    setup, state = start_tracking(sequence, options)
    truth = load_truth(folder / "truth.npz").joints_2d[0]
    return setup, setup.read_views(sequence, 0), setup.scene.pose_at(state.pose), truth


def confirm(drawn: Drawn, views: list[CameraFrame], searched: tuple[int, ...]) -> ViewHands:
    """What is seen of a lost hand that some views alone were searched for."""
    setup, _, nowhere, _ = drawn
    look = Look(setup, views, nowhere, [])
    for number in searched:
        look.search(number, (0, 1, 2, 3))
    assert look.hands.count("right") == len(searched)
    look.confirm({0})
    return look.hands


def test_a_lost_hand_that_one_view_shows_is_found_in_the_others_where_that_one_tells_it_to_be(drawn):
    seen = confirm(drawn, drawn[1], (0,))
    assert seen.count("right") == 3
    for view, hands in enumerate(seen.hands):
        apart = np.linalg.norm(hands["right"].points - drawn[3][view], axis=1)
        assert np.median(apart) < 12.0, "px; the detector's own error on this drawing"


def test_nothing_is_confirmed_in_images_that_show_nothing_nor_where_two_views_show_the_hand(drawn):
    views = drawn[1]
    empty = [CameraFrame(view.camera, shown.frame) for view, shown in zip(views[1:], blank(), strict=False)]
    assert confirm(drawn, [views[0], *empty], (0,)).count("right") == 1
    assert confirm(drawn, views, (0, 2)).count("right") == 2
    assert confirm(drawn, views[:1], (0,)).count("right") == 1


def test_in_images_without_colour_or_without_hands_none_is_seen():
    pose = SCENE.rest_pose()
    posed = SCENE.pose_at(pose)
    assert see_hands(SETUP, [with_depth(pose, CAMERAS[0])], posed, set()) == ViewHands((), ())
    for gone in (set(), {0}):
        seen = see_hands(SETUP, blank(), posed, gone)
        assert [camera.id for camera in seen.cameras] == list(SETUP.view_ids)
        assert seen.count("right") == 0

"""A camera with mirrored pictures is named, with what to do, before anything is tracked."""

from __future__ import annotations

import shutil
from pathlib import Path

import cv2
import numpy as np
import pytest

from tracker.capture.sequence import Sequence, load_sequence
from tracker.cli.__main__ import main
from tracker.errors import TrackingError
from tracker.landmarks import default_hand_detector
from tracker.model.default_hand import default_hand
from tracker.model.npz_files import save_npz_model
from tracker.search.mirrored_views import check_mirrored
from tracker.synthesis.motion import perform
from tracker.synthesis.recording import RecordingOptions, write_recording

VIEWS = ("cam0", "cam1", "cam2")


@pytest.fixture(scope="module")
def rendered(tmp_path_factory: pytest.TempPathFactory) -> Sequence:
    """A right hand before three cameras."""
    folder = tmp_path_factory.mktemp("views") / "recording"
    performance = perform({"right": default_hand("right")}, "open-close", 6, 3, (480, 360))
    return write_recording(performance, folder, RecordingOptions(range(6)), save_npz_model)


@pytest.fixture(scope="module")
def mirrored(rendered: Sequence, tmp_path_factory: pytest.TempPathFactory) -> Sequence:
    """The same, its second camera mirrored."""
    folder = tmp_path_factory.mktemp("mirrored") / "recording"
    shutil.copytree(rendered.folder, folder)
    for path in (folder / "cam1" / "color").iterdir():
        image = cv2.imread(str(path))
        assert image is not None
        cv2.imwrite(str(path), np.ascontiguousarray(image[:, ::-1]))
    return load_sequence(folder)


def test_cameras_as_they_should_be_are_not_refused(rendered: Sequence) -> None:
    check_mirrored(rendered, VIEWS, "right", range(6), default_hand_detector())


def test_a_mirrored_camera_is_named_with_those_that_are_left(mirrored: Sequence) -> None:
    said = r"^cam1 sees a left hand in \d of \d frames, and cam0 and cam2 a right one: .* choose cam0,cam2\.$"
    with pytest.raises(TrackingError, match=said):
        check_mirrored(mirrored, VIEWS, "right", range(6), default_hand_detector())


def test_where_most_cameras_see_the_other_hand_none_is_named(mirrored: Sequence) -> None:
    check_mirrored(mirrored, VIEWS, "left", range(6), default_hand_detector())


def test_the_command_writes_nothing_for_a_mirrored_camera(mirrored: Sequence, tmp_path: Path, capsys) -> None:
    out = tmp_path / "track"
    words = ["track", str(mirrored.folder), "--cameras", ",".join(VIEWS), "--no-depth", "--out", str(out)]
    assert main(words) == 2
    assert "cam1 sees a left hand" in capsys.readouterr().err
    assert not out.exists()

"""Overlays of a track: drawn once, one file for each camera, frame and kind, and of nothing that is not there."""

from __future__ import annotations

import shutil
from pathlib import Path

import cv2
import pytest

from server.errors import NotFoundError
from server.tracks.overlay import Overlays


@pytest.fixture
def track(tracked_folder: Path, tmp_path: Path) -> Path:
    """A copy of the track of the first twelve frames, with nothing drawn."""
    return Path(shutil.copytree(tracked_folder, tmp_path / "track"))


def test_an_overlay_is_drawn_once_and_found_again(track: Path, rendered: Path) -> None:
    overlays = Overlays()
    path = overlays.find(track, rendered, 5, "cam0")
    image = cv2.imread(str(path), cv2.IMREAD_UNCHANGED)
    assert image.shape[2] == 4 and 0 < (image[..., 3] > 0).mean() < 0.9
    assert [found.name for found in path.parent.iterdir()] == [path.name], "no half of a file is left beside it"
    path.write_bytes(b"drawn before")
    for again in (overlays, Overlays()):
        assert again.find(track, rendered, 5, "cam0").read_bytes() == b"drawn before"


def test_each_frame_and_kind_has_a_file_of_its_own(track: Path, rendered: Path) -> None:
    overlays = Overlays()
    wanted = ((0, "mesh"), (11, "mesh"), (0, "unknown"))
    paths = {overlays.find(track, rendered, frame, "cam0", kind) for frame, kind in wanted}
    assert len(paths) == 3 and {path.parent for path in paths} == {track / "overlays"}


@pytest.mark.parametrize(
    ("frame", "camera", "told"),
    [
        (5, "cam7", "The recording has no camera 'cam7'; it has cam0"),
        (12, "cam0", "The track has no frame 12; it has 0 to 11"),
        (-1, "cam0", "The track has no frame -1; it has 0 to 11"),
    ],
)
def test_what_is_not_there_is_told_with_what_is(
    track: Path, rendered: Path, frame: int, camera: str, told: str
) -> None:
    with pytest.raises(NotFoundError, match=told):
        Overlays().find(track, rendered, frame, camera)
    assert not (track / "overlays").exists()

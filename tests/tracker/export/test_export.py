"""Every kind appears whole; what cannot be exported is said and leaves nothing."""

from __future__ import annotations

import dataclasses
from pathlib import Path

import numpy as np
import pytest

from tracker.errors import TrackingError
from tracker.export.export import EXPORT_KINDS, export_track


@pytest.mark.parametrize("kind", EXPORT_KINDS)
def test_a_file_appears_alone_and_is_the_same_when_written_again(moved, tmp_path: Path, kind: str):
    out = tmp_path / EXPORT_KINDS[kind]
    export_track(moved.track, moved.sequence, kind, out)
    first = out.read_bytes()
    export_track(moved.track, moved.sequence, kind, out)
    assert out.read_bytes() == first
    assert list(tmp_path.iterdir()) == [out]


def test_the_npz_is_the_file_of_the_track_itself(moved, tmp_path: Path):
    moved.track.save(tmp_path / "track")
    export_track(moved.track, moved.sequence, "npz", tmp_path / "track.npz")
    assert (tmp_path / "track.npz").read_bytes() == (tmp_path / "track" / "track.npz").read_bytes()


def test_what_cannot_be_exported_is_said_and_leaves_nothing(moved, only_ball, tmp_path: Path):
    def fails(message: str, one, kind: str, out: Path, **changes) -> None:
        with pytest.raises(TrackingError, match=message):
            export_track(dataclasses.replace(one.track, **changes), one.sequence, kind, out)

    out = tmp_path / "out"
    fails("as 'fbx'; there are npz, csv, glb, mano", moved, "fbx", out)
    fails("is not a folder; make it first", moved, "csv", tmp_path / "none" / "out.csv")
    fails("is a folder; give the name of a file", moved, "csv", tmp_path)
    fails("Give the recording it ran on", moved, "csv", out, camera_ids=("cam7",))
    fails("follows ball and no hand", only_ball, "mano", out)
    fails("no joints, only rigid objects", only_ball, "csv", out)
    pose = moved.track.pose.copy()
    pose[4, 0] = np.nan
    fails(
        "no pose in 1 frame, first in frame 7",
        moved,
        "glb",
        out,
        chunk=dataclasses.replace(moved.track.chunk, pose=pose),
    )
    assert list(tmp_path.iterdir()) == []

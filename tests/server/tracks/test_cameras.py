"""A track says when the cameras of its recording are others than those it was made with."""

from __future__ import annotations

import copy
import json
import uuid
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from sqlalchemy import select, update

from server.database import Database
from server.sequences.models import SequenceRow
from server.tracks.cameras import describe_tracks, digest_cameras
from server.tracks.models import TrackRow
from server.tracks.service import add_track

CAMERA: dict[str, Any] = {
    "id": "cam0",
    "K": [[500, 0, 320], [0, 500, 240], [0, 0, 1]],
    "distortion": [],
    "T_world_camera": np.eye(4).tolist(),
    "color": "color/{:06d}.png",
}


def move(camera: dict[str, Any], metres: float) -> dict[str, Any]:
    moved = copy.deepcopy(camera)
    moved["T_world_camera"][0][3] += metres
    return moved


@pytest.fixture
def sequence_id(database: Database) -> uuid.UUID:
    row = SequenceRow(
        name="wave",
        fps=30.0,
        frame_count=4,
        cameras=[CAMERA],
        hands=["right"],
        objects=[],
        report=None,
        content_key="x",
    )
    with database.writing() as session:
        session.add(row)
        session.flush()
        return row.id


@pytest.fixture
def track_files(tmp_path: Path) -> Path:
    (tmp_path / "summary.json").write_text(json.dumps({"frames": 4, "lost": 0}))
    np.savez(tmp_path / "track.npz", frame=np.arange(4), joint_names=np.array(["right/wrist"]))
    return tmp_path


def give_cameras(database: Database, sequence_id: uuid.UUID, cameras: list[dict[str, Any]]) -> None:
    with database.writing() as session:
        session.execute(update(SequenceRow).where(SequenceRow.id == sequence_id).values(cameras=cameras))


def find_marked(database: Database) -> dict[str, bool]:
    with database.reading() as session:
        tracks = describe_tracks(session, session.scalars(select(TrackRow)).all())
    return {track.name: track.is_of_earlier_cameras for track in tracks}


def test_tracks_of_other_cameras_are_marked_until_those_are_back(database, sequence_id, track_files) -> None:
    def add() -> None:
        with database.writing() as session:
            add_track(session, track_files, uuid.uuid4(), sequence_id, None)

    add()
    assert find_marked(database) == {"Track 1": False}
    give_cameras(database, sequence_id, [move(CAMERA, 0.01)])
    add()
    assert find_marked(database) == {"Track 1": True, "Track 2": False}
    give_cameras(database, sequence_id, [CAMERA])
    assert find_marked(database) == {"Track 1": False, "Track 2": True}


def test_a_track_whose_cameras_nobody_knows_is_not_marked(database, sequence_id, track_files) -> None:
    with database.writing() as session:
        add_track(session, track_files, uuid.uuid4(), sequence_id, None).cameras_digest = None
    give_cameras(database, sequence_id, [move(CAMERA, 0.01)])
    assert find_marked(database) == {"Track 1": False}


def test_the_digest_changes_with_lens_and_place_and_with_nothing_else() -> None:
    whole = digest_cameras([CAMERA])
    as_floats = CAMERA | {"K": [[float(value) for value in row] for row in CAMERA["K"]], "color": "other/{:06d}.png"}
    assert digest_cameras([as_floats]) == whole
    others = [
        [move(CAMERA, 1e-9)],
        [CAMERA | {"distortion": [0.1, 0, 0, 0, 0]}],
        [CAMERA | {"K": [[501, 0, 320], [0, 500, 240], [0, 0, 1]]}],
        [CAMERA, CAMERA],
        [],
    ]
    assert len({whole, *map(digest_cameras, others)}) == 1 + len(others)

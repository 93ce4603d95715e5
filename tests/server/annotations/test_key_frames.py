"""Key frames are kept once a place, listed in order, and hidden where the labels are."""

from __future__ import annotations

import pytest
from sqlalchemy import func, select

from server.access.models import LOCAL_ACCOUNT_ID
from server.access.places import HiddenPlaces, Place
from server.annotations.key_frames import add_key_frame, list_key_frames, remove_key_frame
from server.annotations.models import KeyFrameRow
from server.database import Database
from tests.server.rows import keep, make_recording


@pytest.fixture
def database_kind() -> str:
    return "sqlite"


def test_key_frames_come_by_frame_camera_and_hand_each_once(database: Database) -> None:
    recording, other = make_recording(cameras=("cam0", "cam1")), make_recording("other")
    keep(database, recording, other)
    keys = [(1, "cam0", "left"), (1, "cam0", "right"), (1, "cam1", "left"), (4, "cam0", "right")]
    with database.writing() as session:
        for frame, camera, hand in [*reversed(keys), *keys]:
            add_key_frame(session, Place(recording.id, camera, frame, hand), LOCAL_ACCOUNT_ID)
        add_key_frame(session, Place(other.id, "cam0", 2, "right"), LOCAL_ACCOUNT_ID)
    with database.reading() as session:
        rows = list_key_frames(session, recording.id)
        assert [(row.frame, row.camera, row.hand) for row in rows] == keys
        assert {row.created_by for row in rows} == {LOCAL_ACCOUNT_ID}
        hidden = [HiddenPlaces(frozenset({1}), frozenset({"cam0"}), frozenset({"left", "right"}))]
        shown = list_key_frames(session, recording.id, hidden=hidden)
        assert [(row.frame, row.camera, row.hand) for row in shown] == keys[2:]


def test_a_blind_replica_has_key_frames_of_its_own(database: Database) -> None:
    recording = make_recording()
    keep(database, recording)
    with database.writing() as session:
        for replica, frame in (("", 3), ("blind", 3), ("blind", 5)):
            add_key_frame(session, Place(recording.id, "cam0", frame, "right", replica), LOCAL_ACCOUNT_ID)
        assert [row.frame for row in list_key_frames(session, recording.id)] == [3]
        assert [row.frame for row in list_key_frames(session, recording.id, "blind")] == [3, 5]
        remove_key_frame(session, Place(recording.id, "cam0", 3, "right"))
        assert list_key_frames(session, recording.id) == []
        assert [row.frame for row in list_key_frames(session, recording.id, "blind")] == [3, 5]


def test_what_is_no_key_frame_is_removed_without_harm_to_others(database: Database) -> None:
    recording = make_recording()
    keep(database, recording)
    with database.writing() as session:
        add_key_frame(session, Place(recording.id, "cam0", 3, "right"), LOCAL_ACCOUNT_ID)
        for _ in range(2):
            remove_key_frame(session, Place(recording.id, "cam0", 4, "right"))
        assert session.scalar(select(func.count()).select_from(KeyFrameRow)) == 1

"""Rows of recordings: described from their files, changed by one at a time, hidden and brought back."""

from __future__ import annotations

import dataclasses
import uuid

import numpy as np
import pytest

from server.errors import NotFoundError
from server.sequences.content_key import compute_content_key
from server.sequences.models import SequenceRow
from server.sequences.schemas import SequencePatch
from server.sequences.service import (
    StaleSequenceError,
    change_cameras,
    delete_sequence,
    describe_places,
    describe_recording,
    get_sequence,
    list_sequences,
    open_sequence,
    restore_sequence,
    update_sequence,
)
from tests.server.conftest import MakeRecording
from tests.server.sequences.stored import Shelf
from tracker import load_sequence


def read(shelf: Shelf, row: SequenceRow) -> SequenceRow:
    with shelf.database.reading() as session:
        return session.get_one(SequenceRow, row.id)


def patch(shelf: Shelf, row: SequenceRow, revision: int = 1, **changes: object) -> SequenceRow:
    with shelf.database.writing() as session:
        held = session.get_one(SequenceRow, row.id)
        return update_sequence(session, shelf.storage, held, SequencePatch.model_validate(changes), revision)


def move(shelf: Shelf, row: SequenceRow, metres: float, revision: int = 1) -> None:
    """The camera so far to the right."""
    recording = open_sequence(shelf.storage, row.id)
    T = recording.cameras[0].T_world_camera.copy()
    T[0, 3] += metres
    moved = dataclasses.replace(
        recording, cameras=(dataclasses.replace(recording.cameras[0], T_world_camera=T), *recording.cameras[1:])
    )
    with shelf.database.writing() as session:
        held = session.get_one(SequenceRow, row.id)
        change_cameras(session, shelf.storage, held, moved, compute_content_key(moved), revision)


def test_a_camera_is_described_with_what_it_takes_and_depth_with_its_range(make_recording: MakeRecording) -> None:
    both = describe_recording(load_sequence(make_recording("both")))
    assert (both["name"], both["fps"], both["frame_count"], both["hands"]) == ("both", 30.0, 3, ["right"])
    [camera] = both["cameras"]
    assert (camera["has_color"], camera["has_depth"], camera["depth_scale"]) == (True, True, 0.001)
    assert 0.4 <= camera["depth_near"] < camera["depth_far"] <= 0.8
    [colour] = describe_recording(load_sequence(make_recording("colour", depth=False)))["cameras"]
    assert (colour["has_depth"], colour["depth_scale"], colour["depth_near"], colour["depth_far"]) == (
        *(False, None, None, None),
    )


def test_a_change_is_in_the_row_and_in_its_file_and_leaves_the_key_alone(shelf: Shelf, make_recording) -> None:
    row = shelf.put(make_recording("waving"))
    changed = patch(shelf, row, name="pointing", hands=["left", "right"])
    assert (changed.name, changed.hands, changed.revision) == ("pointing", ["left", "right"], 2)
    recording = open_sequence(shelf.storage, row.id)
    assert (recording.name, recording.hands) == ("pointing", ("left", "right"))
    assert compute_content_key(recording) == row.content_key


def test_what_a_patch_leaves_out_stays(shelf: Shelf, make_recording: MakeRecording) -> None:
    row = shelf.put(make_recording("waving"))
    changed = patch(shelf, row, hands=["left"])
    assert (changed.name, changed.hands) == ("waving", ["left"])
    changed = patch(shelf, row, revision=2, name=None)
    assert (changed.name, changed.hands, changed.revision) == ("waving", ["left"], 3)


def test_who_changes_an_older_revision_is_told_the_newer_one_and_changes_nothing(shelf: Shelf, make_recording) -> None:
    row = shelf.put(make_recording("waving"))
    patch(shelf, row, name="first")
    with shelf.database.writing() as session:
        held = session.get_one(SequenceRow, row.id)
        with pytest.raises(StaleSequenceError, match=r"is at revision 2\. Load it again") as stale:
            update_sequence(session, shelf.storage, held, SequencePatch(name="second"), 1)
        assert stale.value.row.name == "first"
    assert read(shelf, row).name == "first" == open_sequence(shelf.storage, row.id).name
    with pytest.raises(StaleSequenceError, match="is at revision 2"):
        move(shelf, row, 1.0)
    assert open_sequence(shelf.storage, row.id).cameras[0].T_world_camera[0, 3] == 0.0


def test_other_cameras_are_in_the_row_and_the_file_and_make_another_key(shelf: Shelf, make_recording) -> None:
    row = shelf.put(make_recording("waving"))
    patch(shelf, row, name="pointing")
    move(shelf, row, 0.25, revision=2)
    changed, recording = read(shelf, row), open_sequence(shelf.storage, row.id)
    assert changed.content_key == compute_content_key(recording) != row.content_key
    np.testing.assert_array_equal(changed.cameras[0]["T_world_camera"], recording.cameras[0].T_world_camera)
    assert changed.cameras[0]["T_world_camera"][0][3] == 0.25 and changed.revision == 3
    assert changed.cameras[0]["depth_near"] == row.cameras[0]["depth_near"], "what was measured stays"
    assert recording.name == "pointing", "what people changed stays"


def test_lens_and_place_of_a_camera_are_what_calibrates_it(shelf: Shelf, make_recording) -> None:
    row = shelf.put(make_recording("waving"))
    [of_row] = describe_places(row.cameras)
    [of_file] = describe_places([camera.to_json() for camera in open_sequence(shelf.storage, row.id).cameras])
    assert set(of_row) == {"K", "distortion", "T_world_camera"} and of_row == of_file
    assert describe_places([]) == []


def test_a_hidden_recording_is_found_by_who_asks_for_hidden_ones_and_by_all_when_it_is_back(
    shelf: Shelf, make_recording: MakeRecording
) -> None:
    row = shelf.put(make_recording("waving"))
    with shelf.database.writing() as session:
        delete_sequence(session, session.get_one(SequenceRow, row.id))
        with pytest.raises(NotFoundError, match=f"The recording {row.id} was deleted; it can be restored"):
            get_sequence(session, row.id)
        hidden = get_sequence(session, row.id, deleted_too=True)
        assert list_sequences(session, None, None, 10) == ([], None)
        for _ in range(2):
            restore_sequence(session, hidden)
        assert get_sequence(session, row.id) is hidden


@pytest.mark.parametrize("deleted_too", [False, True])
def test_a_recording_that_never_was_is_no_deleted_one(shelf: Shelf, deleted_too: bool) -> None:
    unknown = uuid.uuid4()
    with (
        shelf.database.reading() as session,
        pytest.raises(NotFoundError, match=f"The recording {unknown} does not exist"),
    ):
        get_sequence(session, unknown, deleted_too=deleted_too)

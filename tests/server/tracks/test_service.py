"""Tracks as rows and as columns: what was not measured is nothing, and a track that is gone comes back."""

from __future__ import annotations

import json
import uuid
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from server.database import Database
from server.errors import ConflictError, NotFoundError
from server.sequences.models import SequenceRow
from server.tracks.service import (
    TrackNotFoundError,
    add_track,
    delete_track,
    get_track,
    list_tracks,
    read_columns,
    read_energy,
    read_joints,
    restore_track,
)
from tracker import TrackChunk

FRAMES = np.array([10, 11, 12])
NAMES = ["right/wrist", "right/index_tip"]


def add_recording(database: Database) -> uuid.UUID:
    columns: dict[str, Any] = {"cameras": [], "hands": ["right"], "objects": [], "report": None, "content_key": "x"}
    with database.writing() as session:
        row = SequenceRow(name="wave", fps=30.0, frame_count=20, **columns)
        session.add(row)
        session.flush()
        return row.id


def write(folder: Path, names: list[str] = NAMES, frames: np.ndarray = FRAMES, **columns: Any) -> Path:
    """A track of three frames in two cameras; the second term had no part in the last frame."""
    count = len(frames)
    table = np.full((count, 4, 2), np.nan, dtype=np.float32)
    table[:, :2] = [[8.0, 3.0], [4.0, 1.0]]
    table[-1:, :, 1] = np.nan
    none = np.full(count, np.nan)
    arrays = {
        "frame": frames,
        "pose": np.zeros((count, 3)),
        "status": np.zeros(count, dtype=np.int8),
        "seconds": np.full(count, 0.5),
        "depth_residual_mm": np.where(np.arange(count) == 1, np.nan, 2.0),
        "silhouette_iou": none,
        "score": none,
        "iterations": np.full(count, 2),
        "cost_names": np.array(["model_to_data", "marks_right"]),
        "costs": np.array([[4.0, 1.0]] * count).reshape(count, 2),
        "stage_names": np.array(["observe"]),
        "stages": np.full((count, 1), 0.25),
        "iteration_costs": table,
    }
    folder.mkdir(parents=True, exist_ok=True)
    TrackChunk(**(arrays | columns)).save(folder / "frames.npz")
    points = np.arange(count * 2 * len(names) * 2, dtype=float).reshape(count, 2, len(names), 2)
    points[:1, 1, 0] = np.inf, np.nan
    states = np.full(count, "ok")
    np.savez(folder / "track.npz", frame=frames, status=states, joint_names=np.array(names), joints_2d=points)
    (folder / "summary.json").write_text(json.dumps({"frames": count, "lost": 0}))
    return folder


def test_a_track_is_added_once_named_by_its_number_and_tells_its_frames_and_hands(database, tmp_path: Path) -> None:
    recording, ids = add_recording(database), [uuid.uuid4() for _ in range(3)]
    both, none = [*NAMES, "left/wrist", "ball/centre"], ["ball/centre"]
    with database.writing() as session:
        rows = [
            add_track(session, write(tmp_path / "a"), ids[0], recording, None),
            add_track(session, write(tmp_path / "b", both, FRAMES[:1]), ids[1], recording, None),
            add_track(session, write(tmp_path / "c", none, FRAMES[:0]), ids[2], recording, None),
        ]
        assert [(row.name, row.frame_first, row.frame_count, row.hands) for row in rows] == [
            ("Track 1", 10, 3, ["right"]),
            ("Track 2", 10, 1, ["right", "left"]),
            ("Track 3", 0, 0, []),
        ]
        again = add_track(session, tmp_path / "gone", ids[0], recording, None)
        assert again is rows[0], "a step done twice finds it and reads no file"


def test_a_deleted_track_is_no_longer_found_until_it_is_restored(database: Database, tmp_path: Path) -> None:
    recording, id_ = add_recording(database), uuid.uuid4()
    with database.writing() as session:
        track = add_track(session, write(tmp_path), id_, recording, None)
        with pytest.raises(ConflictError, match="The track is not deleted"):
            restore_track(session, id_)
        delete_track(session, id_)
        with pytest.raises(TrackNotFoundError, match="This track was deleted"):
            get_track(session, id_)
        with pytest.raises(TrackNotFoundError, match="This track was deleted"):
            delete_track(session, id_)
        assert get_track(session, id_, deleted=True) is track and list_tracks(session, None, None, 9) == ([], None)
        assert restore_track(session, id_) is get_track(session, id_)
        with pytest.raises(TrackNotFoundError, match=f"There is no track {recording}"):
            get_track(session, recording, deleted=True)


def test_tracks_come_newest_first_and_those_of_one_recording_alone_where_asked(database, tmp_path: Path) -> None:
    folder, recordings = write(tmp_path), [add_recording(database), add_recording(database)]
    with database.writing() as session:
        ids = [add_track(session, folder, uuid.uuid4(), recordings[n % 2], None).id for n in range(4)]
    with database.reading() as session:
        first, cursor = list_tracks(session, None, None, 3)
        rest, end = list_tracks(session, None, cursor, 3)
        assert ([row.id for row in (*first, *rest)], end) == (ids[::-1], None)
        assert [row.id for row in list_tracks(session, recordings[1], None, 9)[0]] == [ids[3], ids[1]]


def test_columns_have_nothing_where_nothing_was_measured(tmp_path: Path) -> None:
    columns = read_columns(write(tmp_path))
    assert (columns["frame"], columns["status"], columns["iterations"]) == ([10, 11, 12], ["ok"] * 3, [2, 2, 2])
    assert columns["depth_residual_mm"] == [2.0, None, 2.0] and columns["silhouette_iou"] == [None] * 3
    assert columns["stages"] == {"observe": [0.25] * 3} and columns["views"] == []
    assert columns["costs"] == {"model_to_data": [4.0] * 3, "marks_right": [1.0, 1.0, None]}
    assert [term.name for term in columns["terms"]] == ["model_to_data", "marks_right"]
    assert json.dumps({name: value for name, value in columns.items() if name != "terms"}, allow_nan=False)


def test_a_track_without_costs_of_iterations_gives_those_that_it_has(tmp_path: Path) -> None:
    columns = read_columns(write(tmp_path, iteration_costs=np.zeros((3, 0, 2), dtype=np.float32)))
    assert columns["costs"]["marks_right"] == [1.0, 1.0, 1.0]


def test_a_camera_agrees_as_well_as_the_worse_of_its_hands(tmp_path: Path) -> None:
    """The farther distance and the smaller weight; a hand that was not measured does not count."""
    nan = np.nan
    far = np.array([[[1.0, 3.0], [nan, 2.0]], [[nan, nan], [4.00049, 0.0]], [[5.0, 5.0], [6.0, 7.0]]])
    np.savez(
        write(tmp_path) / "views.npz",
        fit_px=far,
        left_out_px=2.0 * far,
        weight=np.where(np.isnan(far), nan, 1.0 / (1.0 + far)),
        camera_ids=np.array(["cam0", "cam1"]),
    )
    first, second = read_columns(tmp_path)["views"]
    assert (first["camera"], first["fit_px"], first["weight"]) == ("cam0", [3.0, None, 5.0], [0.25, None, 0.167])
    assert (second["camera"], second["fit_px"], second["left_out_px"]) == (
        *("cam1", [2.0, 4.0, 7.0], [4.0, 8.001, 14.0]),
    )


def test_the_energy_of_a_frame_ends_with_its_last_iteration_and_leaves_out_what_had_no_part(tmp_path: Path) -> None:
    folder = write(tmp_path)
    assert read_energy(folder, 10) == {
        "frame": 10,
        "is_recorded": True,
        "iterations": 2,
        "costs": {"model_to_data": [8.0, 4.0], "marks_right": [3.0, 1.0]},
    }
    assert read_energy(folder, 12)["costs"] == {"model_to_data": [8.0, 4.0]}
    old = write(tmp_path / "old", iteration_costs=np.zeros((3, 0, 2), dtype=np.float32))
    assert read_energy(old, 10) == {"frame": 10, "is_recorded": False, "iterations": 0, "costs": {}}


@pytest.mark.parametrize("frame", [9, 13])
def test_a_frame_beside_the_track_has_no_energy_and_its_ends_are_told(tmp_path: Path, frame: int) -> None:
    with pytest.raises(NotFoundError, match=f"The track has no frame {frame}; it has 10 to 12"):
        read_energy(write(tmp_path), frame)


def test_a_joint_behind_the_camera_has_no_place_in_it_and_each_camera_its_own(tmp_path: Path) -> None:
    folder = write(tmp_path)
    names, frames, points = read_joints(folder, 1)
    assert (names, frames) == (NAMES, [10, 11, 12])
    assert points[0] == [[None, None], [6.0, 7.0]] and points[1] == [[12.0, 13.0], [14.0, 15.0]]
    assert read_joints(folder, 0)[2][0] == [[0.0, 1.0], [2.0, 3.0]]

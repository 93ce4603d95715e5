"""The table has what the track has."""

from __future__ import annotations

import csv
import dataclasses
import io

import numpy as np

from tracker.export.csv_files import write_csv
from tracker.fitting.setup import TrackSetup


def read(data: bytes) -> list[dict[str, str]]:
    return list(csv.DictReader(io.StringIO(data.decode(), newline="")))


def test_every_joint_of_every_frame_has_its_line_with_the_places_in_each_camera(moved):
    track, rows = moved.track, read(write_csv(moved.track))
    assert list(rows[0]) == ["frame", "status", "joint", "x", "y", "z", "u_cam0", "v_cam0", "u_b,1", "v_b,1"]
    count = len(track.joint_names)
    assert count == 2 * 21 + 3
    assert len(rows) == 6 * count
    assert [row["joint"] for row in rows[:count]] == list(track.joint_names)
    assert [int(row["frame"]) for row in rows[::count]] == [3, 4, 5, 6, 7, 8]
    assert [row["status"] for row in rows[::count]] == ["ok", "ok", "lost", "recovered", "ok", "ok"]
    points = np.array([[float(row[axis]) for axis in "xyz"] for row in rows]).reshape(6, count, 3)
    assert np.abs(points - track.joints_3d).max() < 1e-6  # m
    pixels = np.array([[float(row["u_cam0"]), float(row["v_cam0"])] for row in rows]).reshape(6, count, 2)
    assert np.abs(pixels - track.joints_2d[:, 0]).max() < 1e-3  # px


def test_a_joint_behind_a_camera_has_empty_cells_there(moved):
    rows = read(write_csv(moved.track))
    is_behind = ~np.isfinite(moved.track.joints_2d[:, 1, :, 0]).ravel()
    assert is_behind.any() and not is_behind.all()
    assert [row["u_b,1"] == "" for row in rows] == is_behind.tolist()


def test_no_name_of_an_object_is_a_formula(moved):
    setup = moved.track.setup
    names = TrackSetup(("right", "left", "=1+1", "ball"), setup.models, setup.camera_id, setup.options)
    rows = read(write_csv(dataclasses.replace(moved.track, setup=names)))
    assert rows[42]["joint"] == "'=1+1:bone_0"

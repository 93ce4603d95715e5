"""Tracks of one recording that differ by a known number of pixels."""

from __future__ import annotations

import json
import shutil
import uuid
from collections.abc import Callable

import numpy as np
import pytest

from server.tracks.service import add_track
from tests.server.conftest import Studio, Tracked

AddShifted = Callable[..., str]


@pytest.fixture
def add_shifted(studio: Studio, tracked: Tracked) -> AddShifted:
    """Adds a copy of the track whose joints lie (3, 4) x `times` px beside, with other options if so asked."""

    def add(times: float, sequence_id: uuid.UUID | None = None, **options: object) -> str:
        storage, track_id = studio.app.state.storage, uuid.uuid4()
        folder = storage.folder("tracks", track_id)
        shutil.copytree(storage.folder("tracks", tracked.track_id), folder)
        with np.load(folder / "track.npz") as arrays:
            changed = dict(arrays)
        changed["joints_2d"] = changed["joints_2d"] + times * np.array([3.0, 4.0])
        np.savez(folder / "track.npz", **changed)
        setup = json.loads((folder / "setup.json").read_text())
        setup["options"] |= options
        (folder / "setup.json").write_text(json.dumps(setup))
        with studio.database.writing() as session:
            add_track(session, folder, track_id, sequence_id or tracked.sequence_id, None)
        return str(track_id)

    return add

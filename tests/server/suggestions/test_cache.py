"""What an annotator looked at last stays open; what was asked for longest ago goes, and other files are read anew."""

from __future__ import annotations

import shutil
import uuid
from pathlib import Path

import numpy as np
import pytest

from server.jobs.detections import AREA
from server.storage import Storage
from server.suggestions import cache as cache_module
from server.suggestions.cache import RecordingCache
from tests.server.conftest import MakeRecording
from tests.server.quality.conftest import see
from tracker.errors import SequenceError


@pytest.fixture
def storage(tmp_path: Path) -> Storage:
    return Storage(tmp_path / "studio")


@pytest.fixture
def cache(storage: Storage) -> RecordingCache:
    return RecordingCache(storage)


def put(storage: Storage, folder: Path) -> uuid.UUID:
    id_ = uuid.uuid4()
    shutil.copytree(folder, storage.folder("sequences", id_))
    return id_


def test_a_recording_is_read_once_and_again_under_another_key(storage, cache, make_recording: MakeRecording) -> None:
    id_ = put(storage, make_recording())
    first = cache.recording(id_, "a")
    assert cache.recording(id_, "a") is first
    assert cache.recording(id_, "b") is not first


def test_a_frame_has_the_images_of_its_camera_and_is_read_once(storage, cache, make_recording: MakeRecording) -> None:
    id_ = put(storage, make_recording())
    frame = cache.frame(id_, "a", "cam0", 1)
    expected = cache.recording(id_, "a").frame(1, "cam0")
    np.testing.assert_array_equal(frame.color, expected.color)
    np.testing.assert_array_equal(frame.depth, expected.depth)
    shutil.rmtree(storage.folder("sequences", id_))
    assert cache.frame(id_, "a", "cam0", 1) is frame


def test_what_was_asked_for_longest_ago_makes_room(storage, cache, make_recording, monkeypatch) -> None:
    monkeypatch.setattr(cache_module, "KEPT", 2)
    ids = [put(storage, make_recording(f"r{number}")) for number in range(3)]
    first, second = (cache.recording(id_, "a") for id_ in ids[:2])
    assert cache.recording(ids[0], "a") is first
    cache.recording(ids[2], "a")
    assert cache.recording(ids[0], "a") is first, "it was asked for since"
    assert cache.recording(ids[1], "a") is not second


def test_what_could_not_be_read_is_tried_again(storage, cache, make_recording: MakeRecording) -> None:
    id_ = uuid.uuid4()
    with pytest.raises(SequenceError):
        cache.recording(id_, "a")
    shutil.copytree(make_recording(), storage.folder("sequences", id_))
    assert cache.recording(id_, "a").name == "waving"


def test_what_the_detector_found_comes_back_as_its_job_kept_it(storage, cache) -> None:
    job_id, hand = uuid.uuid4(), np.random.default_rng(0).uniform(0, 30, (21, 2)).round(2)
    path = storage.document(AREA, job_id)
    see({("cam0", 2, "right"): hand}, range(2, 5)).save(path)
    found = cache.detections(job_id)
    assert (found.frames, found.cameras) == (range(2, 5), ("cam0",))
    [item] = found.at(2, "cam0")
    np.testing.assert_array_equal(item.points[:, :2], hand)
    path.unlink()
    assert cache.detections(job_id) is found

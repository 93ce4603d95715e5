"""What is kept of a job that was broken off is told in words; a step that was not finished does not count."""

from __future__ import annotations

import json
import uuid
from pathlib import Path
from typing import Any

import pytest

from server.jobs.calibrating import KIND as CALIBRATE
from server.jobs.models import JobRow
from server.jobs.moving import KIND as MOVING
from server.jobs.restarting import list_kept
from server.storage import Storage

CHUNKS = [[0, 20], [20, 40], [40, 55]]


def kept(root: Path, kind: str, steps: tuple[str, ...] = (), **values: Any) -> list[str]:
    """Of a job in whose folder these steps' manifests lie."""
    storage, job = Storage(root), JobRow(id=uuid.uuid4(), kind=kind, **({"params": {}, "frames_done": 0} | values))
    folder = storage.folder("jobs", job.id)
    folder.mkdir(parents=True)
    for step in steps:
        (folder / f"{step}.json").write_text(json.dumps({"files": {}, "chunks": CHUNKS}))
    return list_kept(storage, job)


@pytest.mark.parametrize(
    ("kind", "steps", "values", "told"),
    [
        ("track", (), {}, []),
        ("track", ("chunk-0000",), {}, []),
        ("track", ("start",), {}, ["the fitted shape of the hands"]),
        ("track", ("start",), {"params": {"calibrate": False}}, ["the first pose"]),
        ("track", ("start", "chunk-0000", "chunk-0001"), {}, ["the fitted shape of the hands", "frames 0 to 39"]),
        ("track", ("start", "chunk-0000", "chunk-0002"), {}, ["the fitted shape of the hands", "frames 0 to 19"]),
        ("detect", ("start", "chunk-0000", "chunk-0001", "chunk-0002"), {}, ["frames 0 to 54"]),
        ("detect", ("start",), {}, []),
        (CALIBRATE, ("corners-0000", "corners-0001"), {}, ["where the board was seen in 2 cameras"]),
        (CALIBRATE, (), {"frames_done": 3}, []),
        (MOVING, ("template-0000",), {}, ["1 frame of the person's own model"]),
        (MOVING, ("template-0000",), {"frames_done": 7}, ["the person's own model", "7 registered frames"]),
        (MOVING, (), {}, []),
        ("register", (), {"frames_done": 1}, ["1 registration"]),
        ("train", ("train-0-round-1",), {}, ["1 stage of the training"]),
        ("loop", ("train-0", "train-1"), {"frames_done": 4}, ["4 registrations", "2 stages of the training"]),
        ("loop", ("train-0",), {"hand_model_id": uuid.UUID(int=1)}, ["the model that was trained"]),
    ],
)
def test_what_is_kept(
    kind: str, steps: tuple[str, ...], values: dict[str, Any], told: list[str], tmp_path: Path
) -> None:
    assert kept(tmp_path, kind, steps, **values) == told

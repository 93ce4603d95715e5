"""A person who moves before a scanner for three frames, few points each."""

from __future__ import annotations

import io
import json
import zipfile
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import pytest

from tests.server.conftest import Studio
from tracker.capture.scan import save_scan
from tracker.synthesis.bodies.generate import BODY_SCANNER, GeneratedBody
from tracker.synthesis.bodies.moving import MovingOptions, make_motion

API = "/api/v1"
SCANNER = replace(BODY_SCANNER, num_points=20_000, pixels=400)
FRAMES = 3


@dataclass(frozen=True)
class MovingPerson:
    """Files of the frames and their truth; the left hand is missing in the last frame."""

    folder: Path
    files: dict[str, bytes]
    bodies: list[GeneratedBody]


@pytest.fixture(scope="session")
def moving_person(tmp_path_factory: pytest.TempPathFactory) -> MovingPerson:
    folder = tmp_path_factory.mktemp("moving") / "walking"
    folder.mkdir()
    motion = make_motion(5, FRAMES, options=MovingOptions(still=2, missing=0.0))
    motion.is_missing[2, 0] = True
    bodies = [motion.scan(t, SCANNER) for t in range(FRAMES)]
    for t, body in enumerate(bodies):
        save_scan(body.scan, folder / f"frame{t}.ply")
    return MovingPerson(folder, {path.name: path.read_bytes() for path in sorted(folder.iterdir())}, bodies)


def pack(files: dict[str, bytes], folder: str = "walking") -> bytes:
    """A zip of files in a folder."""
    packed = io.BytesIO()
    with zipfile.ZipFile(packed, "w") as archive:
        for name, data in files.items():
            archive.writestr(f"{folder}/{name}", data)
    return packed.getvalue()


def send(studio: Studio, files: dict[str, bytes], **options: Any) -> Any:
    """Upload files as one moving scan; the answer as it comes."""
    parts = [("files", (name, data)) for name, data in files.items()]
    return studio.client.post(f"{API}/moving-scans", files=parts, data={"options": json.dumps(options)})


def add(studio: Studio, files: dict[str, bytes], **options: Any) -> dict[str, Any]:
    """Upload files as one moving scan; gives it as the API does."""
    answer = send(studio, files, **options)
    assert answer.status_code == 201, answer.text
    return answer.json()["moving_scan"]

"""A real recording through the API."""

from __future__ import annotations

import json
from pathlib import Path

import cv2
import numpy as np
import pytest
from fastapi.testclient import TestClient

from server.app import create_app
from server.settings import Settings
from tests.server.conftest import BASE_URL

FRAMES = 40
OPTIONS = {"fx": 238.95, "fy": 238.95, "cx": 160, "cy": 120, "depth_scale": 0.001, "fps": 30}


@pytest.mark.shared_data
def test_frames_of_a_real_camera_come_in_and_out_unchanged(shared_data: Path, tmp_path: Path) -> None:
    source = shared_data / "uvr_sphere_green"
    paths = [path for kind in ("c2d", "depth") for path in sorted((source / kind).glob("*.png"))[:FRAMES]]
    parts = [("files", (f"ball/{path.relative_to(source).as_posix()}", path.read_bytes())) for path in paths]
    settings = Settings(data_dir=tmp_path)
    with TestClient(create_app(settings), base_url=BASE_URL) as client:
        found = client.post("/api/v1/imports", files=parts, data={"options": json.dumps(OPTIONS)}).json()
        assert (found["state"], found["name"]) == ("checked", "ball"), found["report"]
        recording = client.post(f"/api/v1/imports/{found['id']}/confirm", json={"name": "green ball"}).json()
        assert (recording["frame_count"], recording["cameras"][0]["width"]) == (FRAMES, 320)
        frames = f"/api/v1/sequences/{recording['id']}/{recording['content_key']}/cameras/cam0/frames"
        for index, path in enumerate(paths[FRAMES:]):
            values = np.frombuffer(client.get(f"{frames}/{index}/depth.bin").content, "<u2").reshape(240, 320)
            assert np.array_equal(values, cv2.imread(str(path), cv2.IMREAD_UNCHANGED))

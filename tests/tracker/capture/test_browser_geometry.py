"""The browser draws epipolar lines by itself; what it must agree with is made here and committed.

`python -m tests.tracker.capture.test_browser_geometry` writes the file again.
"""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np

from tests.tracker.capture.test_camera import DISTORTIONS
from tracker.capture.camera import Camera
from tracker.geometry import se3

GOLDEN = Path(__file__).parents[3] / "web" / "src" / "model" / "epipolar.golden.json"


def make_cameras() -> list[Camera]:
    """Around a point half a metre from the first, one for each kind of distortion."""
    cameras = []
    center = np.array([0.0, 0.0, 0.5])
    for number, coefficients in enumerate(DISTORTIONS.values()):
        turn = se3.exp(np.array([0, 0, 0, 0.1 * (number % 3 - 1), -0.5 * number, 0.2 * (number % 2)]))
        T = np.eye(4)
        T[:3, :3] = turn[:3, :3]
        T[:3, 3] = center - turn[:3, :3] @ center
        K = np.array([[520.0 + number, 0, 311.3], [0, 517.0, 244.9], [0, 0, 1]])
        cameras.append(Camera(f"cam{number}", 640, 480, K, np.array(coefficients, dtype=np.float64), T))
    return cameras


def make_golden() -> dict[str, Any]:
    rng, cameras = np.random.default_rng(11), make_cameras()
    rays, points = [], []
    for camera in cameras:
        for pixel in rng.uniform([0, 0], [639, 479], (20, 2)):
            ray = camera.unproject(pixel[None])[0]
            rays.append({"camera": camera.id, "ray": ray[:2].tolist(), "pixel": pixel.tolist()})
    for start in cameras:
        for end in cameras:
            if start is end:
                continue
            for point in rng.uniform([-0.12, -0.12, 0.3], [0.12, 0.12, 0.7], (8, 3)):
                if start.can_see(point[None])[0] and end.can_see(point[None])[0]:
                    pixels = [camera.project(point[None])[0].tolist() for camera in (start, end)]
                    points.append({"from": start.id, "pixel": pixels[0], "to": end.id, "seen": pixels[1]})
    described = [
        {
            "id": camera.id,
            "width": camera.width,
            "height": camera.height,
            "K": camera.K.tolist(),
            "distortion": camera.distortion.tolist(),
            "T_world_camera": camera.T_world_camera.tolist(),
        }
        for camera in cameras
    ]
    return {"cameras": described, "rays": rays, "points": points}


def test_what_the_browser_is_tested_against_is_what_the_tracker_computes():
    committed, made = json.loads(GOLDEN.read_text()), make_golden()
    assert len(made["points"]) > 100
    assert len(committed["rays"]) == len(made["rays"]) and len(committed["points"]) == len(made["points"])
    for old, new in zip(committed["rays"] + committed["points"], made["rays"] + made["points"], strict=True):
        for name, value in new.items():
            if isinstance(value, str):
                assert old[name] == value
            else:
                np.testing.assert_allclose(old[name], value, atol=1e-7)


if __name__ == "__main__":
    GOLDEN.write_text(json.dumps(make_golden()) + "\n")

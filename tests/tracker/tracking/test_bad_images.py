"""Images that no recording should have: tiny or huge, without a hand, with three, with nothing but an elbow.

`handloom detect` and `handloom track` end with a clear error, find nothing, or call the hand lost; neither crashes.
"""

from __future__ import annotations

import json
from collections.abc import Callable
from itertools import pairwise
from pathlib import Path
from typing import Any, cast

import cv2
import numpy as np
import pytest
import trimesh

from tracker.cli.__main__ import main
from tracker.rendering.zbuffer import render_depth

FOCAL = 525.0
SKIN = (215, 165, 140)
"""RGB."""

Draw = Callable[[int], np.ndarray]


def write(folder: Path, size: tuple[int, int], frames: int, color: Draw | None, depth: Draw | None) -> Path:
    """A recording of a right hand, as it says; colour is RGB, depth in mm."""
    width, height = size
    focal = FOCAL * width / 640
    K = [[focal, 0, (width - 1) / 2], [0, focal, (height - 1) / 2], [0, 0, 1]]
    camera: dict[str, Any] = {"id": "cam0", "width": width, "height": height, "K": K, "distortion": []}
    camera["T_world_camera"] = np.eye(4).tolist()
    for name, draw in (("color", color), ("depth", depth)):
        if draw is None:
            continue
        (folder / name).mkdir(parents=True)
        camera[name] = f"{name}/{{:06d}}.png"
        for frame in range(frames):
            image = draw(frame)
            image = np.ascontiguousarray(image[..., ::-1]) if name == "color" else image.astype(np.uint16)
            assert image.shape[:2] == (height, width)
            cv2.imwrite(str(folder / name / f"{frame:06d}.png"), image)
    if depth is not None:
        camera["depth_scale"] = 0.001
    about = {"version": 1, "name": "bad", "fps": 30.0, "frame_count": frames, "hands": ["right"], "objects": []}
    (folder / "sequence.json").write_text(json.dumps({**about, "cameras": [camera]}))
    return folder


def detect(recording: Path, capsys) -> int:
    """In how many frames the hand was found."""
    assert main(["detect", str(recording), "--out", str(recording.parent / "hands.json"), "--json"]) == 0
    return json.loads(capsys.readouterr().out)["frames_with"]["right"]


def track(recording: Path, *options: str) -> dict[str, np.ndarray]:
    out = recording.parent / "track"
    assert main(["track", str(recording), "--no-calibration", "--out", str(out), *options]) == 0
    with np.load(out / "track.npz") as arrays:
        assert np.isfinite(arrays["pose"]).all() and np.isfinite(arrays["joints_3d"]).all()
        return {name: arrays[name] for name in ("status", "joints_2d")}


def refusal(capsys, *words: str) -> str:
    assert main(list(words)) == 2
    said = capsys.readouterr().err
    assert "Traceback" not in said and len(said.strip().splitlines()) == 1
    return said


def noise(size: tuple[int, int], channels: int) -> Draw:
    """Random colours, or random depths at arm's length."""
    low, high, shape = (0, 256, (*size[::-1], 3)) if channels == 3 else (400, 700, size[::-1])
    return lambda frame: np.random.default_rng(frame).integers(low, high, shape)


@pytest.mark.slow
@pytest.mark.parametrize("size", [(8, 8), (20, 15), (64, 8)])
def test_in_images_too_small_for_a_hand_none_is_found(tmp_path, capsys, size):
    color: Draw = lambda frame: noise(size, 3)(frame).astype(np.uint8)  # noqa: E731
    recording = write(tmp_path / "tiny", size, 2, color, noise(size, 1))
    assert detect(recording, capsys) == 0
    assert set(track(recording)["status"]) == {"lost"}
    bare = write(tmp_path / "bare", size, 2, None, noise(size, 1))
    assert set(track(bare)["status"]) == {"lost"}


def test_an_image_of_three_pixels_a_row_is_refused(tmp_path, capsys):
    recording = write(tmp_path / "thin", (3, 200), 1, None, noise((3, 200), 1))
    for command in ("detect", "track"):
        said = refusal(capsys, command, str(recording), "--out", str(tmp_path / "out"))
        assert "width is 3; needed a whole number from 8 to 16384" in said


@pytest.mark.slow
def test_in_an_image_of_48_million_pixels_without_a_hand_none_is_found(tmp_path, capsys):
    size = (8000, 6000)
    flat: Draw = lambda frame: np.full((*size[::-1], 3), 128, dtype=np.uint8)  # noqa: E731
    recording = write(tmp_path / "huge", size, 1, flat, lambda frame: np.full(size[::-1], 600))
    assert detect(recording, capsys) == 0
    assert set(track(recording)["status"]) == {"lost"}


def test_without_colour_detecting_is_refused_and_without_depth_nothing_is_no_hand(tmp_path, capsys):
    deep = write(tmp_path / "deep", (64, 48), 1, None, lambda frame: np.full((48, 64), 600))
    assert "only depth images; the hand detector needs colour or infrared" in refusal(capsys, "detect", str(deep))
    grey: Draw = lambda frame: np.full((48, 64, 3), 90, dtype=np.uint8)  # noqa: E731
    flat = write(tmp_path / "flat", (64, 48), 1, grey, None)
    said = refusal(capsys, "track", str(flat), "--no-detector", "--out", str(tmp_path / "track"))
    assert "hand detector" in said
    assert track(flat)["status"].tolist() == ["lost"]
    capsys.readouterr()
    assert detect(flat, capsys) == 0


def limb(*ends: tuple[float, float, float]) -> Draw:
    """(480, 640) mm: a bent arm of 45 mm radius along some points, m, that moves a little, with a sensor's noise."""

    def draw(frame: int) -> np.ndarray:
        parts = []
        for first, last in pairwise(ends):
            start, end = np.array(first), np.array(last)
            capsule = trimesh.creation.capsule(float(np.linalg.norm(end - start)), 0.045)
            turn = cast(np.ndarray, trimesh.geometry.align_vectors([0, 0, 1], end - start))
            turn[:3, 3] = start + np.array([0.002 * frame, 0.0, 0.0])
            capsule.apply_transform(turn)
            parts.append(capsule)
        mesh = cast(trimesh.Trimesh, trimesh.util.concatenate(parts))
        K = np.array([[FOCAL, 0.0, 319.5], [0.0, FOCAL, 239.5], [0.0, 0.0, 1.0]])
        depth = 1e3 * render_depth(np.array(mesh.vertices), np.array(mesh.faces, dtype=np.int32), K, 640, 480).depth
        return np.where(depth > 0, depth + np.random.default_rng(frame).normal(size=depth.shape), 0)

    return draw


ELBOWS = {
    "elbow": limb((-0.45, 0.15, 0.6), (0.0, -0.05, 0.6), (0.15, 0.45, 0.6)),
    "forearm through the image": limb((-0.6, 0.1, 0.6), (0.6, -0.05, 0.6)),
}


@pytest.mark.slow
@pytest.mark.parametrize(
    ("has_color", "name"),
    [
        pytest.param(True, "elbow", id="colour-elbow"),
        pytest.param(True, "forearm through the image", id="colour-forearm through the image"),
        pytest.param(False, "elbow", id="depth alone-elbow"),
        pytest.param(False, "forearm through the image", id="depth alone-forearm", marks=pytest.mark.slow),
    ],
)
def test_an_elbow_is_no_hand(tmp_path, capsys, name, has_color):
    depth = ELBOWS[name]

    def color(frame: int) -> np.ndarray:
        seen = depth(frame)[..., None]
        shade = np.clip(1.0 - (seen - seen[seen > 0].min()) / 150.0, 0.4, 1.0)
        return np.where(seen > 0, shade * np.array(SKIN), 40.0).astype(np.uint8)

    recording = write(tmp_path / "elbow", (640, 480), 3, color if has_color else None, depth)
    if has_color:
        assert detect(recording, capsys) == 0
    assert set(track(recording)["status"]) == {"lost"}


def test_of_three_hands_one_is_tracked_or_none(recorded, tmp_path):
    """The recording says that it shows one right hand; its images show that hand three times, side by side."""
    sequence, count, step = recorded.sequence, 3, 200
    frames = [sequence.frame(index, "cam0") for index in range(count)]
    shifts = (-step, 0, step)

    def thrice(image: np.ndarray, is_hand: np.ndarray) -> np.ndarray:
        result = image.copy()
        for shift in (-step, step):
            moved, where = np.roll(image, shift, axis=1), np.roll(is_hand, shift, axis=1)
            edge = slice(0, shift) if shift > 0 else slice(shift, None)
            where[:, edge] = False
            result[where] = moved[where]
        return result

    hands = [(frame.depth > 0) & (frame.depth < 0.8) for frame in frames]
    recording = write(
        tmp_path / "three",
        (640, 480),
        count,
        lambda index: thrice(frames[index].color, hands[index]),
        lambda index: 1e3 * thrice(frames[index].depth, hands[index]),
    )
    found = track(recording)
    truth = np.stack([sequence.cameras[0].project(recorded.truth.joints_3d[index]) for index in range(count)])
    apart = np.stack(
        [np.linalg.norm(found["joints_2d"][:, 0] - truth - (shift, 0.0), axis=2).mean(axis=1) for shift in shifts]
    ).min(axis=0)
    assert (apart[found["status"] != "lost"] < 12.0).all(), "px: with the hand's own size not fitted, but on a hand"

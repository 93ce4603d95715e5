"""What the images show around a joint: sorted depth within a few pixels, and how far the nearest thing is."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import cv2
import numpy as np
import pytest

from server.quality.surroundings import MASKED_SHARE, NEAR, WINDOW, Images, look_around
from tests.server.conftest import MakeRecording
from tracker import load_sequence

WIDTH, HEIGHT = 64, 48
Draw = Callable[..., Images]


@pytest.fixture
def draw(make_recording: MakeRecording, tmp_path: Path) -> Draw:
    """Images of a recording whose depth (raw, mm) and grey value are these in every frame; without one where None."""

    def made(depth: np.ndarray | None = None, grey: np.ndarray | None = None, frames: int = 1) -> Images:
        folder = make_recording(
            "drawn", frames, "png" if grey is not None else None, depth is not None, (WIDTH, HEIGHT)
        )
        for frame in range(frames):
            if depth is not None:
                cv2.imwrite(str(folder / f"depth/{frame:06d}.png"), depth.astype(np.uint16))
            if grey is not None:
                cv2.imwrite(str(folder / f"color/{frame:06d}.png"), np.repeat(grey[..., None], 3, axis=2))
        return Images(load_sequence(folder))

    return made


def mark(*joints: tuple[float, float, int]) -> np.ndarray:
    """(21, 3) px and v: these joints from the wrist on, and no others."""
    points = np.zeros((21, 3))
    points[: len(joints)] = joints
    return points


def test_depth_around_a_visible_joint_comes_sorted_in_metres_without_the_holes(draw: Draw, rng) -> None:
    depth = rng.integers(400, 900, (HEIGHT, WIDTH))
    depth[20, 30] = 0
    around = look_around(draw(depth), "cam0", 0, mark((30.2, 20.4, 2)))
    window = depth[20 - WINDOW : 21 + WINDOW, 30 - WINDOW : 31 + WINDOW].ravel()
    expected = np.sort(window[window > 0]) * 0.001
    np.testing.assert_allclose(around.depths[0, : len(expected)], expected)
    assert len(expected) == (2 * WINDOW + 1) ** 2 - 1 and np.isnan(around.depths[0, -1])
    assert around.to_depth[0] == 0.0


def test_only_a_visible_joint_is_asked_for_its_depth(draw: Draw) -> None:
    around = look_around(draw(np.full((HEIGHT, WIDTH), 500)), "cam0", 0, mark((30, 20, 2), (30, 20, 1), (30, 20, 0)))
    assert np.isfinite(around.depths[0]).all()
    assert np.isnan(around.depths[1:]).all() and np.isnan(around.to_depth[1:]).all()


def test_a_window_at_the_border_ends_with_the_image(draw: Draw) -> None:
    around = look_around(draw(np.full((HEIGHT, WIDTH), 500)), "cam0", 0, mark((0, 0, 2), (WIDTH - 1, HEIGHT - 1, 2)))
    assert np.isfinite(around.depths[:2]).sum(axis=1).tolist() == [(WINDOW + 1) ** 2] * 2


@pytest.mark.parametrize(("place", "is_inside"), [((-0.5, 5.0), True), ((-0.6, 5.0), False), ((63.6, 5.0), False)])
def test_how_far_depth_is_is_known_inside_the_image_only(draw: Draw, place: tuple[float, float], is_inside) -> None:
    depth = np.zeros((HEIGHT, WIDTH))
    depth[5, 40] = 500
    around = look_around(draw(depth), "cam0", 0, mark((*place, 2)))
    assert around.to_depth[0] == pytest.approx(40 - place[0] if is_inside else np.nan, nan_ok=True)


def test_the_nearest_depth_is_found_as_a_look_at_every_pixel_says_also_beyond_the_first_search(draw: Draw, rng) -> None:
    depth = np.where(rng.random((HEIGHT, WIDTH)) < 0.002, 500, 0)
    depth[47, 63] = 500
    images, rows_columns = draw(depth), np.argwhere(depth > 0)
    assert NEAR < WIDTH, "else the second search is never needed"
    for at in rng.uniform((0, 0), (WIDTH - 1, HEIGHT - 1), (30, 2)):
        around = look_around(images, "cam0", 0, mark((*at, 2)))
        if np.isnan(around.depths[0]).all():
            assert around.to_depth[0] == pytest.approx(np.linalg.norm(rows_columns[:, ::-1] - at, axis=1).min())


def test_an_image_without_any_depth_is_as_far_as_its_diagonal(draw: Draw) -> None:
    around = look_around(draw(np.zeros((HEIGHT, WIDTH))), "cam0", 0, mark((30, 20, 2)))
    assert around.to_depth[0] == pytest.approx(np.hypot(WIDTH, HEIGHT))


@pytest.mark.parametrize(("share", "is_masked"), [(MASKED_SHARE - 0.1, False), (MASKED_SHARE + 0.1, True)])
def test_a_background_was_cut_out_where_enough_is_black(draw: Draw, share: float, is_masked: bool) -> None:
    grey = np.full((HEIGHT, WIDTH), 90, dtype=np.uint8)
    grey[:, : round(share * WIDTH)] = 0
    around = look_around(draw(grey=grey), "cam0", 0, mark((2, 20, 1)))
    assert around.to_content[0] == pytest.approx(round(share * WIDTH) - 2 if is_masked else np.nan, nan_ok=True)


def test_what_has_depth_is_shown_though_it_is_black(draw: Draw) -> None:
    grey, depth = np.zeros((HEIGHT, WIDTH), dtype=np.uint8), np.zeros((HEIGHT, WIDTH))
    depth[20, 10] = 500
    around = look_around(draw(depth, grey), "cam0", 0, mark((14, 20, 1)))
    assert around.to_content[0] == pytest.approx(4.0) and np.isnan(around.to_depth[0])


def test_a_camera_without_colour_shows_no_content_and_one_without_depth_no_depth(draw: Draw) -> None:
    depth, content = draw(np.full((HEIGHT, WIDTH), 500)).load("cam0", 0)
    assert content is None and depth is not None and (depth == 0.5).all()


def test_without_depth_nothing_is_said_of_it(draw: Draw) -> None:
    around = look_around(draw(grey=np.full((HEIGHT, WIDTH), 90, dtype=np.uint8)), "cam0", 0, mark((14, 20, 2)))
    assert np.isnan(around.depths).all() and np.isnan(around.to_depth).all() and np.isnan(around.to_content).all()

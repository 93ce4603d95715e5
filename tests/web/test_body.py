"""The body with hands in the browser: posed, moved by a file, exported."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
import trimesh

from tests.web.conftest import OpenPage
from tracker.model.body_hands import body_pose
from tracker.model.body_model import body_model
from tracker.model.body_motion import BodyMotion, save_body_motion

pytestmark = pytest.mark.browser


def test_a_pose_of_the_sliders_and_a_frame_of_a_motion_are_exported_as_they_are_posed(
    open_page: OpenPage, tmp_path: Path
) -> None:
    from playwright.sync_api import expect

    page = open_page()
    page.goto("/models")
    page.get_by_role("link", name="Body with hands").click()
    view = page.get_by_role("img", name="Mesh of the body")
    expect(view).to_have_attribute("data-drawn", "true")
    page.get_by_role("slider", name="Elbows bent, degrees").focus()
    for _ in range(3):
        page.keyboard.press("ArrowRight")
    neutral = body_model("neutral")
    pose = body_pose(neutral, np.zeros(3), np.zeros((21, 3)), {})
    for name, sign in (("left_elbow", -1.0), ("right_elbow", 1.0)):
        pose[neutral.joint_names.index(name)] = [0.0, sign * np.deg2rad(3.0), 0.0]
    _check_export(page, neutral.pose_at(pose).vertices, tmp_path)

    female, rng = body_model("female"), np.random.default_rng(1)
    motion = BodyMotion(0.2 * rng.normal(size=(40, 52, 3)), np.zeros((40, 3)), np.array([1.0]), 25.0, "female")
    save_body_motion(motion, tmp_path / "dance.npz")
    page.set_input_files("input[type=file]", tmp_path / "dance.npz")
    expect(page.get_by_test_id("body-frame")).to_have_text("frame 0 of 40")
    page.get_by_role("slider", name="Frame").focus()
    page.keyboard.press("End")
    expect(page.get_by_test_id("body-frame")).to_have_text("frame 39 of 40")
    _check_export(page, female.pose_at(motion.poses[39], motion.shape).vertices, tmp_path)
    page.get_by_role("button", name="Play").click()
    expect(page.get_by_test_id("body-frame")).not_to_have_text("frame 39 of 40")
    page.get_by_role("button", name="Close the motion").click()
    expect(page.get_by_role("slider", name="Elbows bent, degrees")).to_be_visible()


def test_a_file_that_is_no_motion_is_refused_with_what_is_needed(open_page: OpenPage, tmp_path: Path) -> None:
    from playwright.sync_api import expect

    page = open_page()
    (tmp_path / "holiday.npz").write_bytes(b"no archive")
    page.goto("/models/body")
    page.set_input_files("input[type=file]", tmp_path / "holiday.npz")
    expect(page.get_by_role("alert")).to_contain_text("holiday.npz: found a damaged file")
    expect(page.get_by_role("img", name="Mesh of the body")).to_have_attribute("data-drawn", "true")


def _check_export(page: Any, vertices: np.ndarray, folder: Path) -> None:
    page.get_by_role("button", name="Export").click()
    with page.expect_download() as told:
        page.get_by_role("menuitem", name="This pose as OBJ").click()
    told.value.save_as(folder / "pose.obj")
    mesh = trimesh.load(folder / "pose.obj", process=False)
    np.testing.assert_allclose(mesh.vertices, vertices, atol=1e-5)

"""Images of frames: right pixels, addresses that never change, nothing sent twice."""

from __future__ import annotations

import json

import cv2
import numpy as np
import pytest
from fastapi.testclient import TestClient


def address(found: dict, frame: int, file: str) -> str:
    return f"/api/v1/sequences/{found['id']}/{found['content_key']}/cameras/cam0/frames/{frame}/{file}"


def decode(data: bytes, flags: int = cv2.IMREAD_COLOR) -> np.ndarray:
    image = cv2.imdecode(np.frombuffer(data, np.uint8), flags)
    assert image is not None
    return image


def test_a_stored_jpeg_is_sent_byte_for_byte(client: TestClient, add_recording, tmp_path) -> None:
    found = add_recording("waving", color="jpg")
    answer = client.get(address(found, 1, "color.jpg"))
    assert answer.content == (tmp_path / "recordings/waving/color/000001.jpg").read_bytes()
    assert answer.headers["content-type"] == "image/jpeg"


def test_a_stored_png_is_encoded_as_it_looks(client: TestClient, add_recording, tmp_path) -> None:
    found = add_recording("waving", size=(64, 48))
    shown = decode(client.get(address(found, 2, "color.jpg")).content)
    stored = cv2.imread(str(tmp_path / "recordings/waving/color/000002.png"))
    assert stored is not None
    assert shown.shape == stored.shape
    assert abs(float(shown.mean()) - float(stored.mean())) < 3


def test_raw_depth_has_every_value(client: TestClient, add_recording, tmp_path) -> None:
    found = add_recording("waving")
    answer = client.get(address(found, 1, "depth.bin"))
    size = int(answer.headers["x-height"]), int(answer.headers["x-width"])
    stored = cv2.imread(str(tmp_path / "recordings/waving/depth/000001.png"), cv2.IMREAD_UNCHANGED)
    assert np.array_equal(np.frombuffer(answer.content, "<u2").reshape(size), stored)
    assert float(answer.headers["x-depth-scale"]) == 0.001


@pytest.mark.parametrize("colormap", ["turbo", "viridis", "gray"])
def test_depth_in_colours_is_bright_where_it_is_near_and_clear_where_there_is_none(
    client: TestClient, add_recording, tmp_path, colormap: str
) -> None:
    found = add_recording("waving")
    answer = client.get(address(found, 1, "depth.png"), params={"colormap": colormap, "near": 0.4, "far": 0.8})
    assert answer.headers["content-type"] == "image/png"
    shown = decode(answer.content, cv2.IMREAD_UNCHANGED)
    stored = cv2.imread(str(tmp_path / "recordings/waving/depth/000001.png"), cv2.IMREAD_UNCHANGED)
    assert stored is not None
    assert shown.shape == (24, 32, 4)
    assert np.array_equal(shown[..., 3] == 0, stored == 0)
    if colormap != "turbo":  # turbo's ends are both dark
        luminance = cv2.cvtColor(shown[..., :3], cv2.COLOR_BGR2GRAY)[stored > 0].astype(float)
        assert np.corrcoef(luminance, stored[stored > 0])[0, 1] < -0.9


def test_depth_in_colours_uses_the_range_of_the_recording_unless_told(client: TestClient, add_recording) -> None:
    found = add_recording("waving")
    camera = found["cameras"][0]
    usual = client.get(address(found, 0, "depth.png")).content
    same = {"near": camera["depth_near"], "far": camera["depth_far"], "colormap": "turbo"}
    assert client.get(address(found, 0, "depth.png"), params=same).content == usual
    assert client.get(address(found, 0, "depth.png"), params={"far": 3}).content != usual


@pytest.mark.parametrize("colour", ["png", None])
def test_thumbnails_are_small(client: TestClient, add_recording, colour: str | None) -> None:
    found = add_recording("waving", color=colour, size=(640, 480))
    data = client.get(address(found, 0, "thumbnail.jpg")).content
    assert decode(data).shape == (180, 240, 3)
    assert len(data) < 40_000


@pytest.mark.parametrize("file", ["color.jpg", "depth.png", "depth.bin", "thumbnail.jpg"])
def test_an_image_is_kept_for_good_and_not_sent_to_who_has_it(client: TestClient, add_recording, file: str) -> None:
    found = add_recording("waving")
    answer = client.get(address(found, 0, file))
    assert answer.status_code == 200
    assert answer.headers["cache-control"] == "private, max-age=31536000, immutable"
    again = client.get(address(found, 0, file), headers={"If-None-Match": answer.headers["etag"]})
    assert (again.status_code, again.content) == (304, b"")
    assert client.get(address(found, 1, file)).headers["etag"] != answer.headers["etag"]


@pytest.mark.parametrize("frame", ["1.0", "+1", "%201", "1_0", "-1", "1e0", "9999999999", "\u0661"])
def test_the_number_of_a_frame_is_digits_alone(client: TestClient, add_recording, frame: str) -> None:
    here = address(add_recording(), 1, "color.jpg")
    answer = client.get(here.replace("/frames/1/", f"/frames/{frame}/"))
    assert answer.status_code == 422
    assert "frame" in answer.json()["detail"]


def test_images_that_are_not_there_are_said_to_be_missing(client: TestClient, add_recording) -> None:
    found = add_recording("waving", depth=False)
    other = {**found, "content_key": "0" * 32}
    for url in (
        address(found, 3, "color.jpg"),
        address(found, 0, "depth.png"),
        address(found, 0, "depth.bin"),
        address(found, 0, "color.jpg").replace("cam0", "cam1"),
        address(other, 0, "color.jpg"),
    ):
        answer = client.get(url)
        assert (answer.status_code, answer.json()["error"]) == (404, "NotFoundError"), url
        assert answer.headers["cache-control"] == "no-store"


@pytest.mark.parametrize("query", ["near=nan", "near=inf", "near=-1", "near=2&far=1", "colormap=jet", "far=abc"])
def test_ranges_that_make_no_sense_are_refused(client: TestClient, add_recording, query: str) -> None:
    answer = client.get(f"{address(add_recording('waving'), 0, 'depth.png')}?{query}")
    assert (answer.status_code, set(answer.json())) == (422, {"error", "detail"})


def test_a_camera_of_a_path_trick_is_only_an_unknown_camera(client: TestClient, add_recording) -> None:
    url = address(add_recording("waving"), 0, "color.jpg").replace("cam0", "..%2f..%2f..%2fetc")
    assert client.get(url).status_code == 404


def test_a_damaged_image_is_told_without_the_place_where_it_is_kept(client, add_recording, studio) -> None:
    found = add_recording("waving")
    (path,) = studio.settings.data_dir.glob("sequences/*/color/000002.png")
    path.write_bytes(path.read_bytes()[:200])
    answer = client.get(address(found, 2, "color.jpg"))
    assert answer.status_code == 422
    assert "000002.png" in answer.json()["detail"]
    assert str(studio.settings.data_dir) not in answer.text
    assert json.loads(answer.text).keys() == {"error", "detail"}

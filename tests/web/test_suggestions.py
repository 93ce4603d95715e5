"""Suggestions in a real browser: little work when they are good, no label without a gesture, no answer too late."""

from __future__ import annotations

import re
import shutil
import sqlite3
import time
import uuid
from contextlib import closing
from datetime import UTC, datetime

import numpy as np
import pytest

from tracker import TrackOptions, join_chunks, load_sequence, start_tracking, track_frames

pytestmark = [pytest.mark.browser, pytest.mark.timeout(240)]

FEW = (0, 5, 17, 4, 12, 20)


@pytest.fixture(scope="session")
def truth(synthesized):
    """(21, 2) px of the joints in frame 0."""
    return np.array(synthesized.joints)


@pytest.fixture(scope="session")
def track_folder(synthesized, tmp_path_factory):
    """A track of the first frames, made without the studio's worker."""
    folder = tmp_path_factory.mktemp("track") / "track"
    sequence = load_sequence(synthesized.folder)
    setup, state = start_tracking(sequence, TrackOptions(calibrate=False, last_frame=3))
    join_chunks(sequence, setup, [track_frames(sequence, setup, state, range(4))[1]]).save(folder)
    return folder


@pytest.fixture
def tracked(studio, recording, track_folder):
    """The recording with that track in the studio."""
    track_id = uuid.uuid4()
    shutil.copytree(track_folder, studio.data_dir / "tracks" / str(track_id))
    with closing(sqlite3.connect(next(studio.data_dir.glob("*.sqlite3")), timeout=30)) as database:
        database.execute(
            "INSERT INTO tracks (id, sequence_id, name, frame_first, frame_count, hands, summary, created_at)"
            " VALUES (?, ?, 'Track 1', 0, 4, '[\"right\"]', '{}', ?)",
            (track_id.hex, uuid.UUID(recording["id"]).hex, datetime.now(UTC).replace(tzinfo=None).isoformat(" ")),
        )
        database.commit()
    assert studio.get(f"/tracks/{track_id}")["name"] == "Track 1"
    return recording


def find_annotations(studio, recording):
    return studio.get(f"/sequences/{recording['id']}/annotations.json")["items"]


def open_annotator(page, recording, picture_of, address=""):
    page.goto(f"/recordings/{recording['id']}/annotate{address}")
    picture = picture_of(page)
    picture.wait()
    return picture


def test_a_good_suggestion_is_a_hand_in_one_action(studio, tracked, truth, open_page, picture_of, screenshots):
    from playwright.sync_api import expect

    page = open_page()
    picture = open_annotator(page, tracked, picture_of)
    line = page.get_by_test_id("suggested-by")
    expect(line).to_contain_text("Suggested by Track 1")
    page.keyboard.press("Shift+U")
    expect(line).to_contain_text("Suggestions are hidden")
    page.keyboard.press("Shift+U")
    expect(line).to_contain_text("Suggested by Track 1")
    screenshots.take(page, "40-suggested")
    assert find_annotations(studio, tracked) == [], "a suggestion is no annotation"

    saves = []
    page.on("request", lambda request: saves.append(request.url) if request.method == "PUT" else None)
    page.keyboard.press("Shift+T")
    expect(page.get_by_role("tab", name="right 21/21")).to_be_visible()
    picture.wait_until_saved()
    [item] = find_annotations(studio, tracked)
    assert np.linalg.norm(np.array(item["points"])[:, :2] - truth, axis=1).mean() < 2.0
    assert all(v in (1, 2) for _, _, v in item["points"])
    assert len([url for url in saves if "/annotations/" in url]) == 1, "one save a hand"
    assert {(source["kind"], source["label"]) for source in item["sources"]} == {("track", "Track 1")}
    assert all(source["track_id"] and source["model"] for source in item["sources"])
    page.keyboard.press("Control+z")
    expect(page.get_by_role("tab", name="right 0/21")).to_be_visible()
    picture.wait_until_saved()
    assert find_annotations(studio, tracked) == []


def test_joints_are_accepted_singly_and_a_double_click_takes_the_hand(studio, tracked, truth, open_page, picture_of):
    from playwright.sync_api import expect

    page = open_page()
    picture = open_annotator(page, tracked, picture_of)
    expect(page.get_by_test_id("suggested-by")).to_contain_text("Track 1")
    picture.click(100, 100)
    page.keyboard.press("a")
    expect(page.get_by_role("tab", name="right 2/21")).to_be_visible()

    page.keyboard.press("Shift+U")
    expect(page.get_by_test_id("suggested-by")).to_contain_text("Suggestions are hidden")
    page.keyboard.press("Shift+A")
    expect(page.get_by_role("tab", name="right 2/21")).to_be_visible()
    page.keyboard.press("Shift+U")

    page.wait_for_timeout(800)  # or the click before would be part of the double click
    page.mouse.dblclick(*picture.at(*truth[8]))
    expect(page.get_by_role("tab", name="right 21/21")).to_be_visible()
    picture.wait_until_saved()
    [item] = find_annotations(studio, tracked)
    points = np.array(item["points"])
    assert points[0].tolist() == pytest.approx([100, 100, 2], abs=0.6), "what a person placed stays"
    assert np.linalg.norm(points[1:, :2] - truth[1:], axis=1).mean() < 2.0
    assert np.linalg.norm(points[8, :2] - truth[8]) < 6.0, "the first click of the two places nothing"


def test_a_model_fitted_to_six_joints_suggests_the_rest(studio, recording, truth, open_page, picture_of, screenshots):
    from playwright.sync_api import expect

    page = open_page(1920, 1080)
    picture = open_annotator(page, recording, picture_of)
    keys = {0: "0", 5: "2", 17: "5", 4: "1111", 12: "3333", 20: "5555"}
    for joint in FEW:
        for key in keys[joint]:
            page.keyboard.press(key)
        picture.click(*truth[joint])
    line = page.get_by_test_id("suggested-by")
    expect(line).to_contain_text("Suggested by model fit of 6 joints")
    screenshots.take(page, "41-model-fit")
    picture.wait_until_saved()
    [item] = find_annotations(studio, recording)
    assert sum(1 for point in item["points"] if point[2]) == 6, "only what was placed is stored"

    page.keyboard.press("Shift+A")
    picture.wait_until_saved()
    [item] = find_annotations(studio, recording)
    points = np.array(item["points"])
    others = [joint for joint in range(21) if joint not in FEW]
    assert np.linalg.norm(points[others, :2] - truth[others], axis=1).mean() < 3.0
    assert np.linalg.norm(points[list(FEW), :2] - truth[list(FEW)], axis=1).max() < 1.0


def test_an_answer_to_older_joints_never_shows(recording, truth, open_page, picture_of):
    from playwright.sync_api import expect

    page = open_page()
    picture = open_annotator(page, recording, picture_of)
    asked = []

    def answer(route):
        asked.append(len([point for point in route.request.post_data_json["points"] if point[2]]))
        if asked[-1] == 4:
            time.sleep(2)  # so long that the fifth joint is placed meanwhile
        route.continue_()

    page.route(re.compile("/fit$"), answer)
    for joint in range(4):
        picture.click(*truth[joint])
    page.wait_for_timeout(400)
    for joint in range(4, 7):
        picture.click(*truth[joint])
    line = page.get_by_test_id("suggested-by")
    expect(line).to_contain_text("model fit of 7 joints")
    page.wait_for_timeout(2500)
    expect(line).to_contain_text("model fit of 7 joints")
    assert asked[0] == 4
    assert asked[-1] == 7


def test_the_hand_detector_suggests_in_the_moment_and_for_the_whole_recording(
    studio, recording, truth, open_page, picture_of, screenshots
):
    from playwright.sync_api import expect

    page = open_page()
    picture = open_annotator(page, recording, picture_of)
    line = page.get_by_test_id("suggested-by")
    expect(line).to_contain_text("Suggested by Hand detector", timeout=30_000)
    page.get_by_label("Suggestions", exact=True).click()
    group = page.get_by_role("group", name="Hand detector, whole recording")
    expect(group).to_contain_text("looks at each image by itself")
    screenshots.take(page, "42-detector")
    group.get_by_role("button", name="Look through the whole recording").click()
    expect(group).to_contain_text("looked through the whole recording", timeout=90_000)
    [job] = studio.get(f"/jobs?kind=detect&sequence_id={recording['id']}")["items"]
    assert (job["state"], job["frames_done"]) == ("succeeded", recording["frame_count"])
    screenshots.take(page, "43-detector-done")
    page.keyboard.press("Escape")
    expect(line).to_contain_text("Suggested by Hand detector")
    assert find_annotations(studio, recording) == [], "a suggestion is no annotation"

    page.keyboard.press("Shift+A")
    picture.wait_until_saved()
    [item] = find_annotations(studio, recording)
    assert np.linalg.norm(np.array(item["points"])[:, :2] - truth, axis=1).mean() < 8.0
    assert item["sources"] == [{"kind": "detector", "label": "Hand detector"}] * 21

    page.route(
        re.compile("/detector$"), lambda route: route.fulfill(status=503, json={"error": "x", "detail": "Busy."})
    )
    page.goto(f"/recordings/{recording['id']}/annotate?frame=9")
    page.get_by_label("Suggestions", exact=True).click()
    expect(page.get_by_text("The hand detector suggests nothing: Busy. Your joints are safe.")).to_be_visible()
    screenshots.take(page, "44-detector-fails")
    page.unroute_all()
    page.keyboard.press("Escape")
    expect(line).to_contain_text("Suggested by Hand detector")  # asked again by itself

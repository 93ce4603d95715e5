"""`/sequences/{id}/frames-to-look-at`: the hands that most need a person, labelled or not."""

from __future__ import annotations

import argparse
import json
import uuid

import numpy as np
import pytest

from server.access.models import LOCAL_ACCOUNT_ID
from server.imports.service import ImportContext, import_recording
from tests.server.quality.conftest import see
from tracker import add_commands, load_sequence

TRACKED = range(12)
"""Frames that the track has."""


@pytest.fixture(scope="module")
def surrounded(tmp_path_factory):
    """A hand that three cameras see in eight frames, without labels."""
    folder = tmp_path_factory.mktemp("surrounded") / "recording"
    parser = argparse.ArgumentParser()
    add_commands(parser.add_subparsers())
    command = ["synthesize", "--motion", "pinch", "--frames", "0:8", "--cameras", "3", "--size", "320x240"]
    args = parser.parse_args([*command, "--out", str(folder)])
    assert args.run(args) == 0
    document = json.loads((folder / "sequence.json").read_text())
    del document["annotations"]
    (folder / "sequence.json").write_text(json.dumps(document))
    return folder


@pytest.fixture
def several(studio, surrounded):
    """That recording in the studio."""
    desk = ImportContext(studio.database, studio.app.state.storage, studio.settings)
    return import_recording(desk, surrounded, {}, LOCAL_ACCOUNT_ID)


@pytest.fixture
def seen(surrounded):
    """What a detector without errors would see in the three cameras."""
    cameras = load_sequence(surrounded).cameras
    with np.load(surrounded / "truth.npz") as truth:
        joints = truth["joints_3d"]
    return {(camera.id, frame, "right"): camera.project(joints[frame]) for frame in range(8) for camera in cameras}


@pytest.fixture
def fits(studio, tracked):
    """(21, 2) px of the track, by camera, frame and hand."""
    with np.load(studio.app.state.storage.folder("tracks", tracked.track_id) / "track.npz") as arrays:
        joints = arrays["joints_2d"][:, 0, :21].astype(float)
    return {("cam0", frame, "right"): joints[frame] for frame in TRACKED}


@pytest.fixture
def unlabelled(client, tracked):
    """The recording of the track, its labels deleted."""
    sequence = f"/api/v1/sequences/{tracked.sequence_id}"
    for item in client.get(f"{sequence}/annotations", params={"limit": 1000}).json()["items"]:
        address = f"{sequence}/annotations/cam0/{item['frame']}/{item['hand']}"
        assert client.delete(address, headers={"If-Match": f'"{item["revision"]}"'}).status_code in (200, 204)
    return sequence


def find(client, sequence, **query):
    address = sequence if isinstance(sequence, str) else f"/api/v1/sequences/{sequence}"
    answer = client.get(f"{address}/frames-to-look-at", params=query)
    assert answer.status_code == 200, answer.text
    return answer.json()


def label(client, sequence, frame, pixels, sources=None):
    body = {"points": [[x, y, 2] for x, y in pixels.tolist()], "operation_id": str(uuid.uuid4()), "sources": sources}
    address = f"{sequence}/annotations/cam0/{frame}/right"
    there = client.get(address)
    headers = {"If-None-Match": "*"} if there.status_code == 404 else {"If-Match": there.headers["etag"]}
    answer = client.put(address, json=body, headers=headers)
    assert answer.status_code == 200, answer.text
    return answer.json()["revision"]


def reasons(item):
    return [doubt["reason"] for doubt in item["doubts"]]


def test_where_nothing_is_known_the_queue_is_empty_and_says_what_it_lacks(client, several):
    page = find(client, several)
    assert (page["items"], page["hands"], page["doubtful"], page["track"]) == ([], 0, 0, None)
    assert page["missing"] == [
        "There is no track: what it would suggest is not looked at.",
        "The hand detector has not looked through this recording.",
    ]


def test_a_fit_far_from_what_the_detector_saw_comes_first(client, unlabelled, tracked, fits, keep_detections):
    seen = dict(fits)
    seen["cam0", 7, "right"] = fits["cam0", 7, "right"] + (60, 0)
    keep_detections(tracked.sequence_id, see(seen, TRACKED))
    page = find(client, unlabelled)
    assert sorted(item["frame"] for item in page["items"]) == list(TRACKED), "every hand once, labelled or not"
    first = page["items"][0]
    assert (first["frame"], first["hand"], first["camera"], first["shows"]) == (7, "right", "cam0", "track")
    assert reasons(first)[0] == "The fit is 60 px from what the detector saw in cam0."
    assert np.allclose(np.array(first["points"])[:, :2], fits["cam0", 7, "right"])
    assert page["doubtful"] == 1 and first["score"] > 1 > page["items"][1]["score"]
    assert (page["track"], page["missing"]) == (
        "Track 1",
        ["This recording has one camera: no other one can disagree."],
    )


def test_a_single_joint_is_compared_with_what_is_usual_for_it(client, unlabelled, tracked, fits, keep_detections):
    seen = {place: pixels.copy() for place, pixels in fits.items()}
    for pixels in seen.values():
        pixels[4] += (9, 0)  # it always sees the thumb's tip elsewhere
    seen["cam0", 3, "right"][8] += (40, 0)
    keep_detections(tracked.sequence_id, see(seen, TRACKED))
    first, second = find(client, unlabelled)["items"][:2]
    assert (first["frame"], first["doubts"][0]["joints"]) == (3, [8])
    expected = "The index tip of the fit is 40 px from what the detector saw in cam0; usually it is 0 px."
    assert reasons(first)[0] == expected
    assert second["score"] <= 1.0


def test_a_hand_that_the_track_lost_and_the_detector_sees_comes_first(
    studio, client, unlabelled, tracked, fits, keep_detections
):
    path = studio.app.state.storage.folder("tracks", tracked.track_id) / "track.npz"
    with np.load(path) as arrays:
        changed = dict(arrays)
    for name in ("status", "hand_status"):
        changed[name] = changed[name].astype("<U9")
        changed[name][[5, 9]] = "lost"
    np.savez(path, **changed)
    keep_detections(tracked.sequence_id, see({p: m for p, m in fits.items() if p[1] != 9}, TRACKED))
    first, second = find(client, unlabelled)["items"][:2]
    assert (first["frame"], reasons(first)) == (5, ["The track lost the hand here, and the detector sees it."])
    assert (second["frame"], reasons(second)) == (9, ["The track lost the hand here; it may be out of sight."])
    assert (first["shows"], second["shows"]) == ("detector", "nothing")


def test_a_hand_that_was_held_in_a_frame_that_lost_another_one_was_not_lost(studio, client, unlabelled, tracked):
    path = studio.app.state.storage.folder("tracks", tracked.track_id) / "track.npz"
    with np.load(path) as arrays:
        changed = dict(arrays)
    changed["status"] = np.full(len(changed["frame"]), "lost")
    np.savez(path, **changed)
    assert not any("lost" in reason for one in find(client, unlabelled)["items"] for reason in reasons(one))


def test_who_placed_the_hand_settles_it_and_who_accepted_a_suggestion_does_not(
    client, unlabelled, tracked, fits, keep_detections
):
    seen = dict(fits)
    for frame in (4, 7):
        seen["cam0", frame, "right"] = fits["cam0", frame, "right"] + (60, 0)
    keep_detections(tracked.sequence_id, see(seen, TRACKED))
    accepted = {"kind": "track", "label": "Track 1", "track_id": str(tracked.track_id)}
    assert {item["frame"] for item in find(client, unlabelled)["items"][:2]} == {4, 7}
    label(client, unlabelled, 4, fits["cam0", 4, "right"], [accepted] * 21)
    label(client, unlabelled, 7, fits["cam0", 7, "right"])
    items = find(client, unlabelled)["items"]
    assert (items[0]["frame"], items[0]["shows"]) == (4, "label")
    assert reasons(items[0])[0] == "The label is 60 px from what the detector saw in cam0."
    assert not any("fit" in reason for reason in reasons(items[0])), "the label is looked at in place of the fit"
    assert 7 not in {item["frame"] for item in items}


def test_what_the_label_check_found_counts_until_it_is_put_away(client, unlabelled, fits):
    outside = fits["cam0", 6, "right"].copy()
    outside[12, 0] = -40.0
    revision = label(client, unlabelled, 6, outside)
    first = find(client, unlabelled)["items"][0]
    [doubt] = [one for one in first["doubts"] if one["flag"] == "outside"]
    assert (first["frame"], doubt["kind"], doubt["camera"], doubt["joints"]) == (6, "flag", "cam0", [12])
    for flag in client.get(f"{unlabelled}/flags").json()["items"]:
        address = f"{unlabelled}/flags/cam0/6/right/{flag['kind']}/dismissal"
        assert client.put(address, json={"revision": revision}).status_code == 204
    assert 6 not in {item["frame"] for item in find(client, unlabelled)["items"]}


def test_a_camera_that_sees_the_hand_elsewhere_than_the_others_is_named(client, several, seen, keep_detections):
    seen["cam1", 2, "right"] = seen["cam1", 2, "right"] + (0, 50)
    keep_detections(several, see(seen, range(8)))
    first, second = find(client, several)["items"][:2]
    assert (first["frame"], first["camera"], first["shows"]) == (2, "cam1", "detector")
    assert reasons(first)[0] == "In cam1 the detector saw the hand 50 px from where the other cameras see it."
    assert second["score"] < 0.1


def test_a_bone_that_is_longer_in_space_than_usual_is_told(client, several, seen, surrounded, keep_detections):
    """The joint is off in all cameras alike: only its bones tell."""
    with np.load(surrounded / "truth.npz") as truth:
        joints = truth["joints_3d"][5].copy()
    joints[8] += 0.04 * (joints[8] - joints[7]) / np.linalg.norm(joints[8] - joints[7])
    for camera in load_sequence(surrounded).cameras:
        seen[camera.id, 5, "right"] = camera.project(joints)
    keep_detections(several, see(seen, range(8)))
    first, second = find(client, several)["items"][:2]
    assert (first["frame"], first["doubts"][0]["kind"], first["doubts"][0]["joints"]) == (5, "bones", [7, 8])
    assert reasons(first)[0].startswith("By what the detector saw, index dip to index tip is ")
    assert second["score"] < 0.1


def test_pages_give_each_hand_once_the_worst_first(client, several, seen, keep_detections):
    for frame in range(8):
        seen["cam0", frame, "right"] = seen["cam0", frame, "right"] + (0, 7 * frame)
    keep_detections(several, see(seen, range(8)))
    everything = find(client, several)["items"]
    assert [item["frame"] for item in everything] == list(range(7, -1, -1))
    pages, cursor = [], None
    while True:
        page = find(client, several, limit=3, **({"cursor": cursor} if cursor else {}))
        pages += page["items"]
        cursor = page["next_cursor"]
        if cursor is None:
            break
    assert pages == everything


def test_what_makes_no_sense_is_refused(client, several):
    address = f"/api/v1/sequences/{several}/frames-to-look-at"
    assert client.get(address, params={"cursor": "abc"}).status_code == 404
    assert client.get(address, params={"limit": 0}).status_code == 422
    assert client.get(f"/api/v1/sequences/{uuid.uuid4()}/frames-to-look-at").status_code == 404

"""Suggestions are close to the truth, say where they come from, and are never stored."""

from __future__ import annotations

import uuid

import numpy as np
import pytest

from server.suggestions.service import warm_up
from tracker import load_annotations

FEW = (0, 5, 17, 4, 12, 20)


def find_truth(rendered, frame):
    return load_annotations(rendered / "annotations.json").find(frame, "cam0", "right").points


def keep(points, joints):
    return [[*point[:2], int(point[2])] if j in joints else [0.0, 0.0, 0] for j, point in enumerate(points.tolist())]


def measure(suggestion, truth, joints=range(21)):
    return np.array([np.linalg.norm(np.subtract(suggestion["joints"][j]["px"], truth[j, :2])) for j in joints])


def test_a_track_suggests_its_hands(client, tracked, rendered):
    page = client.get(f"/api/v1/sequences/{tracked.sequence_id}/suggestions/cam0/5").json()
    [suggestion] = page["items"]
    truth = find_truth(rendered, 5)
    assert (suggestion["source"], suggestion["label"], suggestion["hand"]) == ("track", "Track 1", "right")
    assert suggestion["track_id"] == str(tracked.track_id)
    assert measure(suggestion, truth).mean() < 2.0
    guesses = [2 if joint["guess"] == "visible" else 1 for joint in suggestion["joints"]]
    assert np.mean(np.equal(guesses, truth[:, 2])) > 0.8
    assert client.get(f"/api/v1/sequences/{tracked.sequence_id}/suggestions/cam0/40").json()["items"] == []


def test_a_frame_that_the_track_lost_suggests_nothing(client, studio, tracked):
    path = studio.app.state.storage.folder("tracks", tracked.track_id) / "frames.npz"
    with np.load(path, allow_pickle=False) as arrays:
        columns = dict(arrays)
    columns["status"][5] = 1
    np.savez(path, **columns)
    assert client.get(f"/api/v1/sequences/{tracked.sequence_id}/suggestions/cam0/5").json()["items"] == []
    assert len(client.get(f"/api/v1/sequences/{tracked.sequence_id}/suggestions/cam0/6").json()["items"]) == 1


def test_a_model_fit_of_six_joints_finds_the_others(client, tracked, rendered):
    truth = find_truth(rendered, 12)
    place = f"/api/v1/sequences/{tracked.sequence_id}/suggestions/cam0/12/right/fit"
    answer = client.post(place, json={"points": keep(truth, FEW)})
    assert answer.status_code == 200, answer.text
    suggestion = answer.json()
    assert (suggestion["source"], suggestion["label"]) == ("fit", "model fit of 6 joints")
    assert measure(suggestion, truth, [j for j in range(21) if j not in FEW]).mean() < 4.0


def test_no_suggestion_becomes_an_annotation(client, tracked, rendered):
    before = client.get(f"/api/v1/sequences/{tracked.sequence_id}/annotations.json").json()
    suggestion = client.get(f"/api/v1/sequences/{tracked.sequence_id}/suggestions/cam0/5").json()["items"][0]
    assert client.get(f"/api/v1/sequences/{tracked.sequence_id}/annotations.json").json() == before
    put = client.put(
        f"/api/v1/sequences/{tracked.sequence_id}/annotations/cam0/5/right",
        json={"points": suggestion["joints"], "operation_id": str(uuid.uuid4())},
        headers={"If-Match": '"1"'},
    )
    assert put.status_code == 422


@pytest.mark.parametrize("joints", [(), (0, 5, 9)])
def test_too_few_joints_are_refused_with_what_is_needed(client, tracked, rendered, joints):
    body = {"points": keep(find_truth(rendered, 0), joints)}
    answer = client.post(f"/api/v1/sequences/{tracked.sequence_id}/suggestions/cam0/0/right/fit", json=body)
    assert answer.status_code == 422
    assert f"{len(joints)} joints" in answer.json()["detail"]
    assert "4 or more" in answer.json()["detail"]


@pytest.mark.parametrize(
    "points",
    [
        [[5.0, 5.0, 2]] * 21,
        [[float(3 * j), 2.0, 2] for j in range(21)],
        [[-600.0, -400.0, 2]] * 21,
        [[5.0, 5.0, 1]] * 21,
    ],
)
def test_senseless_joints_are_answered_all_the_same(client, tracked, points):
    answer = client.post(
        f"/api/v1/sequences/{tracked.sequence_id}/suggestions/cam0/0/left/fit", json={"points": points}
    )
    assert answer.status_code in (200, 422), answer.text


def test_what_is_not_there_is_not_found(client, tracked, add_recording):
    place = f"/api/v1/sequences/{tracked.sequence_id}/suggestions"
    other = add_recording()
    assert client.get(f"{place}/cam9/0").status_code == 404
    assert client.get(f"{place}/cam0/9999").status_code == 404
    assert client.get(f"{place}/cam0/0", params={"track_id": str(uuid.uuid4())}).status_code == 404
    foreign = client.get(
        f"/api/v1/sequences/{other['id']}/suggestions/cam0/0", params={"track_id": str(tracked.track_id)}
    )
    assert foreign.status_code == 404
    assert client.get(f"/api/v1/sequences/{other['id']}/suggestions/cam0/0").json()["items"] == []


def test_without_depth_the_marks_alone_are_fitted(client, add_recording):
    recording = add_recording("colour", depth=False, size=(640, 480))
    points = [[300.0 + 20 * (j % 5), 300.0 - 25 * (j // 5), 2] for j in range(21)]
    answer = client.post(f"/api/v1/sequences/{recording['id']}/suggestions/cam0/0/right/fit", json={"points": points})
    assert answer.status_code == 200, answer.text
    assert sum(joint is not None for joint in answer.json()["joints"]) > 15


def test_the_hand_detector_suggests_the_hand_of_one_image_on_the_spot(client, tracked, rendered):
    before = client.get(f"/api/v1/sequences/{tracked.sequence_id}/annotations.json").json()
    [suggestion] = client.get(f"/api/v1/sequences/{tracked.sequence_id}/suggestions/cam0/5/detector").json()["items"]
    told = suggestion["source"], suggestion["label"], suggestion["hand"], suggestion["frame"], suggestion["track_id"]
    assert told == ("detector", "Hand detector", "right", 5, None)
    assert measure(suggestion, find_truth(rendered, 5)).mean() < 8.0
    assert {joint["guess"] for joint in suggestion["joints"]} == {"visible"}
    assert client.get(f"/api/v1/sequences/{tracked.sequence_id}/annotations.json").json() == before


def test_an_image_without_a_hand_and_one_without_colour_have_no_detected_hand(client, add_recording):
    for name, more in (("noise", {}), ("depth alone", {"color": None})):
        sequence = add_recording(name, **more)["id"]
        answer = client.get(f"/api/v1/sequences/{sequence}/suggestions/cam0/0/detector")
        assert (answer.status_code, answer.json()["items"]) == (200, [])
        assert client.get(f"/api/v1/sequences/{sequence}/suggestions/cam9/0/detector").status_code == 404
        assert client.get(f"/api/v1/sequences/{sequence}/suggestions/cam0/99/detector").status_code == 404


def test_an_accepted_detected_joint_stays_known_as_one_and_judges_no_track(client, tracked):
    [suggestion] = client.get(f"/api/v1/sequences/{tracked.sequence_id}/suggestions/cam0/5/detector").json()["items"]
    place = f"/api/v1/sequences/{tracked.sequence_id}/annotations/cam0/5/right"
    source = {"kind": suggestion["source"], "label": suggestion["label"]}
    answer = client.put(
        place,
        json={
            "points": [[*joint["px"], 2] for joint in suggestion["joints"]],
            "sources": [source] * 21,
            "operation_id": str(uuid.uuid4()),
        },
        headers={"If-Match": client.get(place).headers["etag"]},
    )
    assert answer.status_code == 200, answer.text
    items = client.get(f"/api/v1/sequences/{tracked.sequence_id}/annotations.json").json()["items"]
    [kept] = [item for item in items if item["frame"] == 5]
    assert kept["sources"] == [source] * 21
    found = client.get(f"/api/v1/tracks/{tracked.track_id}/evaluation").json()
    [left_out] = [one for one in found["sources"] if not one["is_counted"]]
    assert (left_out["words"], left_out["joints"]) == ("accepted from the hand detector", 21)
    assert 5 not in [item["frame"] for item in found["items"] if item["joints"]]


def test_beside_the_studio_the_same_is_suggested(studio, client, tracked, rendered):
    """`handloom serve` has a process of its own for this."""
    camera = f"/api/v1/sequences/{tracked.sequence_id}/suggestions/cam0"
    fits = [{"points": keep(find_truth(rendered, 12), joints)} for joints in (FEW, FEW[:3])]

    def ask():
        answers = [client.get(f"{camera}/5"), client.get(f"{camera}/12/detector")]
        answers += [client.post(f"{camera}/12/right/fit", json=body) for body in fits]
        return [(answer.status_code, answer.json()) for answer in answers]

    here = ask()
    assert [status for status, _ in here] == [200, 200, 200, 422]
    studio.app.state.compute.start(warm_up)
    assert ask() == here

"""Mistakes in labels are found, first among the flags, and what somebody looked at stays away until it changes."""

from __future__ import annotations

import shutil
import time
import uuid

import cv2
import numpy as np
import pytest

from server.access.models import LOCAL_ACCOUNT_ID
from server.database import utc_now
from server.imports.service import ImportContext, import_recording
from server.jobs.detections import AREA
from server.jobs.service import create_job
from server.quality import service
from server.suggestions.service import warm_up
from tests.server.quality.errors import Item, inject
from tracker import load_sequence
from tracker.detection import detect_hands
from tracker.landmarks import default_hand_detector


@pytest.fixture
def labelled(studio, rendered):
    """Every frame labelled rightly."""
    desk = ImportContext(studio.database, studio.app.state.storage, studio.settings)
    return f"/api/v1/sequences/{import_recording(desk, rendered, {}, LOCAL_ACCOUNT_ID)}"


def relabel(client, sequence, frame, points, revision=1):
    body = {"points": points, "operation_id": str(uuid.uuid4())}
    headers = {"If-Match": f'"{revision}"'}
    answer = client.put(f"{sequence}/annotations/cam0/{frame}/right", json=body, headers=headers)
    assert answer.status_code == 200, answer.text


def spoil(client, sequence, kind, frame, seed=0):
    """Make a mistake of some kind in a frame; gives the revision that has it."""
    stored = client.get(f"{sequence}/annotations/cam0/{frame}/right").json()
    item = Item(frame, "right", np.array(stored["points"], dtype=float))
    inject([item], kind, frame, np.random.default_rng(seed))
    relabel(client, sequence, frame, [[x, y, int(v)] for x, y, v in item.points.tolist()], stored["revision"])
    return stored["revision"] + 1


def ask(client, sequence, **query):
    answer = client.get(f"{sequence}/flags", params=query)
    assert answer.status_code == 200, answer.text
    return answer.json()


def find(client, sequence, **query):
    """Flags of the labels as they are: on a busy machine a check rests after the last one, and says so."""
    until = time.monotonic() + 60.0
    while (page := ask(client, sequence, **query))["checked"]["is_behind"] and time.monotonic() < until:
        time.sleep(0.3)
    return page


def test_right_labels_are_hardly_flagged(client, labelled):
    assert len({flag["frame"] for flag in find(client, labelled)["items"]}) <= 2


@pytest.mark.parametrize(
    ("mistake", "kinds"),
    [
        ("swapped fingers", {"finger_order", "jump", "bone_length"}),
        ("shifted joint", {"jump", "bone_length", "depth"}),
        ("jump", {"jump", "bone_length", "finger_order", "depth"}),
        ("on the background", {"depth", "bone_length", "jump"}),
        ("outside", {"outside"}),
    ],
)
def test_a_mistake_comes_first(client, labelled, mistake, kinds):
    spoil(client, labelled, mistake, 7)
    first = find(client, labelled)["items"][0]
    assert first["frame"] == 7, first
    assert {flag["kind"] for flag in find(client, labelled)["items"] if flag["frame"] == 7} & kinds


def test_a_label_of_the_wrong_hand_is_told_from_its_neighbours(client, labelled):
    stored = client.get(f"{labelled}/annotations/cam0/9/right").json()
    client.delete(f"{labelled}/annotations/cam0/9/right", headers={"If-Match": '"1"'})
    body = {"points": stored["points"], "operation_id": str(uuid.uuid4())}
    made = client.put(f"{labelled}/annotations/cam0/9/left", json=body, headers={"If-None-Match": "*"})
    assert made.status_code == 200
    [flag] = find(client, labelled, kind="handedness")["items"]
    assert (flag["frame"], flag["hand"]) == (9, "left")


def test_a_label_far_from_the_track_is_flagged(client, tracked):
    sequence = f"/api/v1/sequences/{tracked.sequence_id}"
    spoil(client, sequence, "jump", 5)
    [flag] = find(client, sequence, kind="residual")["items"]
    assert flag["frame"] == 5
    assert "from the track" in flag["reason"]


def by_kind(page):
    return {one["kind"]: one for one in page["checked"]["checks"]}


def shift(client, sequence, frames, offset, sources=None):
    """Move whole labels, as by hand or with sources."""
    for frame in frames:
        stored = client.get(f"{sequence}/annotations/cam0/{frame}/right").json()
        points = [[x + offset[0], y + offset[1], v] for x, y, v in stored["points"]]
        body = {"points": points, "operation_id": str(uuid.uuid4()), "sources": sources}
        headers = {"If-Match": f'"{stored["revision"]}"'}
        assert client.put(f"{sequence}/annotations/cam0/{frame}/right", json=body, headers=headers).status_code == 200


def test_a_whole_recording_beside_its_track_is_flagged(client, tracked):
    sequence = f"/api/v1/sequences/{tracked.sequence_id}"
    assert find(client, sequence, kind="residual")["items"] == []
    shift(client, sequence, range(45), (18, 22))
    flags = find(client, sequence, kind="residual")["items"]
    assert sorted(flag["frame"] for flag in flags) == list(range(12)), "all that the track holds"
    assert all("as in 12 of 12 hands that were compared: one of the two is wrong" in flag["reason"] for flag in flags)
    checked = by_kind(find(client, sequence))["residual"]
    assert checked["labels"] == 12 and "Track 1 does not have this hand or frame" in checked["missing"]


def test_what_came_from_the_track_is_not_compared_with_it(client, tracked):
    sequence = f"/api/v1/sequences/{tracked.sequence_id}"
    accepted = {"kind": "track", "label": "Track 1", "track_id": str(tracked.track_id)}
    shift(client, sequence, range(6), (0, 0), [accepted] * 21)
    page = find(client, sequence)
    assert by_kind(page)["residual"]["labels"] == 6
    shift(client, sequence, range(6, 12), (18, 22))
    flags = find(client, sequence, kind="residual")["items"]
    assert sorted(flag["frame"] for flag in flags) == list(range(6, 12))
    assert "as in 6 of 6 hands" in flags[0]["reason"]


def test_a_lonely_label_is_compared_with_what_the_hand_detector_sees(studio, client, labelled):
    """All but one label are gone: nobody but the detector, which has looked through the recording, speaks about it."""
    sequence_id = uuid.UUID(labelled.rpartition("/")[2])
    storage = studio.app.state.storage
    recording = load_sequence(storage.folder("sequences", sequence_id))
    for frame in range(recording.frame_count):
        if frame != 5:
            address = f"{labelled}/annotations/cam0/{frame}/right"
            client.delete(address, headers={"If-Match": client.get(address).headers["etag"]})
    stored = client.get(f"{labelled}/annotations/cam0/5/right").json()["points"]
    mirrored = [[2 * stored[9][0] - x, y, v] for x, y, v in stored]
    found, _ = detect_hands(recording, default_hand_detector(), ("cam0",), range(8), {})

    def look():
        checks = {one["kind"]: one["labels"] for one in find(client, labelled)["checked"]["checks"]}
        return checks["detector"], [flag["frame"] for flag in find(client, labelled, kind="detector")["items"]]

    assert look() == (0, []), "nobody has looked through the recording"
    with studio.database.writing() as session:
        job = create_job(session, "detect", sequence_id, {})
        job.state, job.ended_at = "succeeded", utc_now()
        storage.document(AREA, job.id)
        found.save(storage.root / AREA / f"{job.id}.json")
    assert look() == (1, []), "a right label agrees with it"
    relabel(client, labelled, 5, mirrored)
    assert look() == (1, [5])


def test_a_hand_of_another_frame_is_told_from_its_neighbours(client, labelled):
    shift(client, labelled, [20], (70, 0))
    flags = [flag for flag in find(client, labelled)["items"] if "the label of another frame" in flag["reason"]]
    assert [flag["frame"] for flag in flags] == [20]


def change_background(source, folder, color=None, depth=0):
    """A copy of a recording with another background; None leaves the colour as it is."""
    shutil.copytree(source, folder)
    for file in sorted((folder / "depth").iterdir()):
        image = cv2.imread(str(file), cv2.IMREAD_UNCHANGED)
        shown = next((folder / "color").glob(f"{file.stem}.*"))
        picture = cv2.imread(str(shown))
        if color is not None:
            picture[image == 0] = color
            cv2.imwrite(str(shown), picture)
        image[image == 0] = depth
        cv2.imwrite(str(file), image)
    return folder


def test_joints_in_the_empty_part_of_a_masked_image_are_flagged(studio, client, rendered, tmp_path):
    desk = ImportContext(studio.database, studio.app.state.storage, studio.settings)
    folder = change_background(rendered, tmp_path / "masked", color=0)
    masked = f"/api/v1/sequences/{import_recording(desk, folder, {}, LOCAL_ACCOUNT_ID)}"
    page = find(client, masked)
    assert [flag for flag in page["items"] if flag["kind"] == "background"] == []
    assert by_kind(page)["background"]["labels"] == page["checked"]["labels"] == 45
    shift(client, masked, range(5, 9), (24, 24))
    flags = find(client, masked, kind="background")["items"]
    assert sorted(flag["frame"] for flag in flags) == [5, 6, 7, 8]
    assert all("from anything that this image shows" in flag["reason"] for flag in flags)
    assert all(len(flag["joints"]) >= 2 for flag in flags)


def move_off(client, sequence, frames):
    """Whole labels to the corner of the image, where no hand is."""
    points = client.get(f"{sequence}/annotations/cam0/{frames[0]}/right").json()["points"]
    left, top = (min(point[axis] for point in points) - 4 for axis in (0, 1))
    shift(client, sequence, frames, (-left, -top))


def test_a_whole_label_without_depth_is_flagged(client, labelled):
    move_off(client, labelled, range(8, 11))
    flags = find(client, labelled, kind="background")["items"]
    assert sorted(flag["frame"] for flag in flags) == [8, 9, 10]
    assert "though it is marked as visible" in flags[0]["reason"]


@pytest.mark.parametrize("share", [0.4, 0.7, 1.0])
def test_a_joint_in_the_empty_part_is_flagged_however_far_away_it_is(client, labelled, rendered, share):
    """The mistake itself makes the hand look large; that does not excuse it."""
    camera = load_sequence(rendered).camera("cam0")
    stored = client.get(f"{labelled}/annotations/cam0/7/right").json()["points"]
    tip = np.array(stored[4][:2])
    corner = np.where(tip > np.array([camera.width, camera.height]) / 2, 4, [camera.width - 4, camera.height - 4])
    stored[4] = [*(tip + share * (corner - tip)).tolist(), 2]
    relabel(client, labelled, 7, stored)
    [flag] = find(client, labelled, kind="background")["items"]
    assert (flag["frame"], flag["joints"]) == (7, [4])
    assert "The thumb tip is" in flag["reason"]


def test_a_whole_recording_on_the_background_is_flagged(studio, client, rendered, tmp_path):
    """That all labels are alike does not excuse them: no hand that looks as large as these is so far away."""
    desk = ImportContext(studio.database, studio.app.state.storage, studio.settings)
    folder = change_background(rendered, tmp_path / "wall", depth=1500)
    wall = f"/api/v1/sequences/{import_recording(desk, folder, {}, LOCAL_ACCOUNT_ID)}"
    assert find(client, wall, kind="background")["items"] == []
    move_off(client, wall, range(45))
    flags = find(client, wall, kind="background")["items"]
    assert sorted(flag["frame"] for flag in flags) == list(range(45))
    assert "is it on the background?" in flags[0]["reason"] and "1.50 m" in flags[0]["reason"]


def test_an_all_clear_says_what_was_checked(client, labelled, tracked):
    page = find(client, labelled)
    assert (page["checked"]["labels"], page["checked"]["frames"], page["checked"]["track"]) == (45, 45, None)
    told = by_kind(page)
    assert (told["residual"]["labels"], told["residual"]["missing"]) == (0, "there is no track")
    assert (told["reprojection"]["labels"], told["reprojection"]["missing"]) == (0, "this recording has one camera")
    assert told["outside"] == {"kind": "outside", "labels": 45, "missing": ""}
    assert told["finger_order"]["labels"] == told["depth"]["labels"] == told["jump"]["labels"] == 45
    assert find(client, f"/api/v1/sequences/{tracked.sequence_id}")["checked"]["track"] == "Track 1"


def test_a_flag_is_put_away_for_the_revision_looked_at(client, labelled):
    revision = spoil(client, labelled, "outside", 4)
    [flag] = find(client, labelled, kind="outside")["items"]
    address = f"{labelled}/flags/cam0/4/right/outside/dismissal"
    stale = client.put(address, json={"revision": 1})
    assert stale.status_code == 409
    for _ in range(2):
        assert client.put(address, json={"revision": revision}).status_code == 204
    page = find(client, labelled, kind="outside")
    assert page["items"] == []
    assert page["dismissed"] == 1
    assert "outside" not in page["counts"]
    assert find(client, labelled, dismissed=True)["items"] == [flag | {"is_dismissed": True}]

    assert client.delete(address, params={"revision": revision}).status_code == 204
    assert len(find(client, labelled, kind="outside")["items"]) == 1
    client.put(address, json={"revision": revision})
    points = client.get(f"{labelled}/annotations/cam0/4/right").json()["points"]
    relabel(client, labelled, 4, [[x + 0.5 if v else x, y, v] for x, y, v in points], revision)
    assert len(find(client, labelled, kind="outside")["items"]) == 1, "a later revision is checked anew"


def test_pages_give_each_flag_once_the_worst_first(client, labelled):
    for seed, frame in enumerate((3, 12, 20, 31, 40)):
        spoil(client, labelled, "swapped fingers", frame, seed)
    everything = find(client, labelled)["items"]
    assert [flag["score"] for flag in everything] == sorted((flag["score"] for flag in everything), reverse=True)
    pages, cursor = [], None
    while True:
        page = find(client, labelled, limit=2, **({"cursor": cursor} if cursor else {}))
        pages += page["items"]
        cursor = page["next_cursor"]
        if cursor is None:
            break
    assert pages == everything


def test_what_makes_no_sense_is_refused(client, labelled):
    assert client.get(f"{labelled}/flags", params={"kind": "ugly"}).status_code == 422
    assert client.get(f"{labelled}/flags", params={"cursor": "abc"}).status_code == 404
    assert client.get(f"/api/v1/sequences/{uuid.uuid4()}/flags").status_code == 404
    assert client.put(f"{labelled}/flags/cam0/99/right/jump/dismissal", json={"revision": 1}).status_code == 404


def test_where_checks_would_take_too_long_the_last_one_is_given_and_says_that_it_is_behind(
    client, labelled, monkeypatch
):
    assert not ask(client, labelled)["checked"]["is_behind"]
    spoil(client, labelled, "outside", 3)
    monkeypatch.setattr(service, "CREDIT_SECONDS", 0.0)
    behind = ask(client, labelled)
    assert behind["checked"]["is_behind"]
    assert not [flag for flag in behind["items"] if flag["frame"] == 3], "it knows nothing of the new revision"
    monkeypatch.setattr(service, "CREDIT_SECONDS", 3.0)
    caught_up = ask(client, labelled)
    assert not caught_up["checked"]["is_behind"]
    assert caught_up["items"][0]["frame"] == 3


@pytest.mark.slow
def test_beside_the_studio_the_same_flags_are_found(studio, client, labelled):
    """`handloom serve` has a process of its own for this; its answers, and its refusals, are the same."""
    spoil(client, labelled, "outside", 4)
    here, refused = find(client, labelled), client.get(f"{labelled}/flags", params={"cursor": "abc"})
    queue = client.get(f"{labelled}/frames-to-look-at").json()
    studio.app.state.compute.start(warm_up)
    assert find(client, labelled) == here
    assert client.get(f"{labelled}/frames-to-look-at").json() == queue
    again = client.get(f"{labelled}/flags", params={"cursor": "abc"})
    assert (again.status_code, again.json()) == (404, refused.json())
    relabel(client, labelled, 4, client.get(f"{labelled}/annotations/cam0/3/right").json()["points"], 2)
    assert not find(client, labelled, kind="outside")["items"], "what is saved here is seen there"

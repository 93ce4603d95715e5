"""Mistakes in labels are found, first among the flags, and what somebody looked at stays away until it changes."""

from __future__ import annotations

import uuid

import numpy as np
import pytest

from server.accounts.models import LOCAL_ACCOUNT_ID
from server.imports.service import ImportDesk, import_recording
from tests.server.quality.errors import Item, inject


@pytest.fixture
def labelled(studio, rendered):
    """Every frame labelled rightly."""
    desk = ImportDesk(studio.database, studio.app.state.storage, studio.settings)
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


def find(client, sequence, **query):
    answer = client.get(f"{sequence}/flags", params=query)
    assert answer.status_code == 200, answer.text
    return answer.json()


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

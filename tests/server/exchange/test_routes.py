"""Labels out of the studio and in again: looked at first, nothing overwritten silently, nothing half-written."""

from __future__ import annotations

import io
import json
import uuid
import zipfile
from typing import Any

import pytest

from server.access.models import LOCAL_ACCOUNT_ID
from server.access.project_models import AssignmentRow, ProjectRow
from server.exchange import routes
from tests.server.conftest import AddRecording, Studio, Tracked
from tests.server.exchange.labels import API, get_labels, make_points, put, send, take_in

FORMATS_2D = ("annotations", "coco_keypoints", "coco_wholebody", "deeplabcut", "t16")
FILES = {
    "annotations": "annotations.json",
    "coco_keypoints": "labels.json",
    "coco_wholebody": "labels.json",
    "deeplabcut": "labels.zip",
    "t16": "labels.zip",
}


def export(studio: Studio, sequence: dict[str, Any], name: str, **params: Any) -> bytes:
    answer = studio.client.get(f"{API}/sequences/{sequence['id']}/labels/export", params={"format": name, **params})
    assert answer.status_code == 200, answer.text
    return answer.content


@pytest.mark.parametrize("name", FORMATS_2D)
def test_what_is_exported_comes_back_into_an_empty_copy(studio: Studio, add_recording: AddRecording, name: str) -> None:
    sequence, copy = add_recording(), add_recording("copy")
    whole = [[float(round(x)), float(round(y)), v] for x, y, v in make_points()]
    put(studio.client, sequence, 0, whole)
    put(studio.client, sequence, 2, whole, "left")
    files = {FILES[name]: export(studio, sequence, name)}
    done = take_in(studio.client, f"/sequences/{copy['id']}/labels", files, "keep")
    assert done.status_code == 200, done.text
    (one,) = done.json()["recordings"]
    assert (done.json()["format"], one["added"], one["replaced"], one["kept"]) == (name, 2, 0, 0)
    assert get_labels(studio.client, copy) == get_labels(studio.client, sequence)
    history = studio.client.get(f"{API}/sequences/{copy['id']}/annotations/cam0/2/left/history").json()["items"]
    assert [item["act"] for item in history] == ["import"]


def test_labels_that_are_there_are_listed_and_the_policy_decides(studio: Studio, add_recording: AddRecording) -> None:
    sequence = add_recording()
    address = f"/sequences/{sequence['id']}/labels"
    put(studio.client, sequence, 0, make_points())
    put(studio.client, sequence, 1, make_points())
    files = {"labels.json": export(studio, sequence, "coco_keypoints")}
    moved = make_points()
    moved[0][0] += 6.0
    put(studio.client, sequence, 0, moved)
    studio.client.delete(f"{API}/sequences/{sequence['id']}/annotations/cam0/1/right", headers={"If-Match": '"1"'})

    report = send(studio.client, f"{address}/check", files).json()
    (one,) = report["recordings"]
    assert (one["new"], one["same"], one["conflict_count"], one["locked"]) == (1, 0, 1, 0)
    assert one["conflicts"][0]["joints_moved"] == {"wrist": 6.0}
    assert get_labels(studio.client, sequence) == {(0, "right"): moved}

    kept = take_in(studio.client, address, files, "keep").json()["recordings"][0]
    assert (kept["added"], kept["replaced"], kept["kept"]) == (1, 0, 1)
    assert get_labels(studio.client, sequence) == {(0, "right"): moved, (1, "right"): make_points()}

    replaced = take_in(studio.client, address, files, "replace").json()["recordings"][0]
    assert (replaced["added"], replaced["replaced"], replaced["kept"]) == (0, 1, 0)
    assert get_labels(studio.client, sequence)[0, "right"] == make_points()
    history = studio.client.get(f"{API}/sequences/{sequence['id']}/annotations/cam0/0/right/history").json()["items"]
    assert [(item["revision"], item["act"]) for item in history] == [(3, "import"), (2, "put"), (1, "put")]

    undone = studio.client.post(f"{API}/snapshots/{replaced['before']['id']}/restore").json()
    assert (undone["changed"], undone["deleted"]) == (1, 0)
    assert get_labels(studio.client, sequence)[0, "right"] == moved

    again = take_in(studio.client, address, {"labels.json": export(studio, sequence, "coco_keypoints")}, "replace")
    assert again.json()["recordings"][0] | {"sequence_id": ""} == {
        "sequence_id": "",
        "added": 0,
        "replaced": 0,
        "kept": 0,
        "locked": 0,
        "before": None,
    }


def test_an_import_of_something_else_than_was_looked_at_is_refused(studio: Studio, add_recording: AddRecording) -> None:
    sequence = add_recording()
    address = f"/sequences/{sequence['id']}/labels"
    put(studio.client, sequence, 0, make_points())
    files = {"labels.json": export(studio, sequence, "coco_keypoints")}
    put(studio.client, sequence, 0, make_points(12.0))
    check = send(studio.client, f"{address}/check", files).json()["check"]
    put(studio.client, sequence, 0, make_points(13.0))  # somebody else is quicker
    late = send(studio.client, f"{address}/import", files, policy="replace", check=check)
    assert late.status_code == 409 and "nothing was imported" in late.json()["detail"]
    assert get_labels(studio.client, sequence) == {(0, "right"): make_points(13.0)}
    fresh = send(studio.client, f"{address}/check", files).json()["check"]
    other = {"labels.json": files["labels.json"].replace(b"10.0", b"10.5")}
    assert send(studio.client, f"{address}/import", other, policy="replace", check=fresh).status_code == 409
    assert send(studio.client, f"{address}/import", files, policy="replace").status_code == 422
    assert send(studio.client, f"{address}/import", files, policy="perhaps", check=fresh).status_code == 422
    assert send(studio.client, f"{address}/import", files, policy="replace", check=fresh).status_code == 200


def test_one_label_that_cannot_be_stored_refuses_all(studio: Studio, add_recording: AddRecording) -> None:
    sequence = add_recording()
    address = f"/sequences/{sequence['id']}/labels"
    put(studio.client, sequence, 0, make_points())
    document = json.loads(export(studio, sequence, "annotations"))
    far = json.loads(json.dumps(document["items"][0])) | {"frame": 1}
    far["points"][4] = [5000.0, 5.0, 2]
    document["items"] = [document["items"][0] | {"frame": 2}, far]
    files = {"annotations.json": json.dumps(document).encode()}
    report = send(studio.client, f"{address}/check", files).json()
    assert report["check"] is None
    assert "far outside the image" in report["problems"][0]
    refused = send(studio.client, f"{address}/import", files, policy="replace", check="x")
    assert refused.status_code == 422 and "Nothing was imported" in refused.json()["detail"]
    assert list(get_labels(studio.client, sequence)) == [(0, "right")]


@pytest.mark.parametrize(
    ("name", "content"),
    [
        ("a.json", b"[" * 100_000),
        ("a.json", b'{"items": [NaN]}'),
        ("a.json", b"{}"),
        ("a.csv", b"scorer\x00"),
        ("a.pkl", b"cos\nsystem\n(S'true'\ntR."),
        ("a.h5", b"\x89HDF"),
        ("a.zip", b"PK\x03\x04"),
        ("a.exe", b"MZ"),
        ("joints_2D_GT/1.txt", b"x y z"),
    ],
)
def test_files_that_are_no_labels_are_refused_and_leave_nothing(
    studio: Studio, add_recording: AddRecording, name: str, content: bytes
) -> None:
    sequence = add_recording()
    answer = send(studio.client, f"/sequences/{sequence['id']}/labels/check", {name: content})
    assert answer.status_code == 422, answer.text
    assert str(studio.settings.data_dir) not in answer.text
    assert list((studio.settings.data_dir / "label_uploads").iterdir()) == []
    assert get_labels(studio.client, sequence) == {}


def test_a_path_that_leads_out_and_wrong_options_are_refused(studio: Studio, add_recording: AddRecording) -> None:
    sequence = add_recording()
    address = f"/sequences/{sequence['id']}/labels/check"
    assert send(studio.client, address, {"../evil.json": b"{}"}).status_code == 422
    packed = io.BytesIO()
    with zipfile.ZipFile(packed, "w") as archive:
        archive.writestr("../../evil.json", "{}")
    assert send(studio.client, address, {"a.zip": packed.getvalue()}).status_code == 422
    for options in ({"hand": "both"}, {"pixel_centre": 3}, {"strange": 1}, 7, {"format": "yolo"}):
        answer = send(studio.client, address, {"a.json": b"{}"}, options=options)
        assert answer.status_code == 422, options
    assert studio.client.post(f"{API}{address}", json={}).status_code == 422


def test_more_than_labels_ever_have_is_not_read(
    studio: Studio, add_recording: AddRecording, monkeypatch: pytest.MonkeyPatch
) -> None:
    sequence = add_recording()
    monkeypatch.setattr(routes, "LIMITS", routes.UploadLimits(files=10, total_bytes=1000))
    answer = send(studio.client, f"/sequences/{sequence['id']}/labels/check", {"a.json": b" " * 2000})
    assert answer.status_code == 413
    answer = send(studio.client, f"/sequences/{sequence['id']}/labels/check", {"a.json": b" " * 2_000_000})
    assert answer.status_code == 413


def test_several_recordings_in_one_coco_file(studio: Studio, add_recording: AddRecording) -> None:
    one, other = add_recording("one"), add_recording("two")
    put(studio.client, one, 0, make_points(10.0))
    put(studio.client, other, 1, make_points(11.0), "left")
    query = f"sequence_id={one['id']}&sequence_id={other['id']}"
    made = studio.client.get(f"{API}/labels/export?format=coco_keypoints&{query}")
    document = json.loads(made.content)
    assert [image["sequence"] for image in document["images"]] == [one["id"], other["id"]]
    assert len({image["file_name"] for image in document["images"]}) == 2
    before = {id_: get_labels(studio.client, {"id": id_}) for id_ in (one["id"], other["id"])}
    for id_ in before:
        put(studio.client, {"id": id_}, 0, make_points(15.0))
    files = {"labels.json": made.content}
    report = send(studio.client, f"/labels/check?{query}", files).json()
    assert [(r["new"], r["conflict_count"]) for r in report["recordings"]] == [(0, 1), (1, 0)] or [
        (r["new"], r["conflict_count"], r["same"]) for r in report["recordings"]
    ] == [(0, 1, 0), (0, 0, 1)]
    sent = send(studio.client, f"/labels/import?{query}", files, policy="replace", check=report["check"])
    assert sent.status_code == 200, sent.text
    assert get_labels(studio.client, one) == before[one["id"]]
    assert get_labels(studio.client, other) == before[other["id"]] | {(0, "right"): make_points(15.0)}
    assert studio.client.get(f"{API}/labels/export?format=deeplabcut&{query}").status_code == 422
    twice = f"sequence_id={one['id']}&sequence_id={one['id']}"
    assert studio.client.get(f"{API}/labels/export?format=coco_keypoints&{twice}").status_code == 422


def test_what_a_format_loses_is_told_before(studio: Studio, add_recording: AddRecording) -> None:
    sequence = add_recording()
    points = make_points()
    points[1][2] = 1
    points[2] = [-1, -1, 0]
    put(studio.client, sequence, 0, points)
    address = f"{API}/sequences/{sequence['id']}/labels/export/notes"
    notes = studio.client.get(address, params={"format": "deeplabcut"}).json()
    assert (notes["items"], notes["joints"], notes["file"]) == (1, 20, "waving-deeplabcut.zip")
    assert notes["notes"] == [
        "1 occluded joint: DeepLabCut does not say what is occluded.",
        "1 joint marked as outside the image: DeepLabCut holds it like joints nobody looked at.",
    ]
    assert studio.client.get(address, params={"format": "annotations"}).json()["notes"] == []
    assert studio.client.get(address, params={"format": "yolo"}).status_code == 422
    formats = studio.client.get(f"{API}/label-formats").json()["items"]
    assert [item["name"] for item in formats] == [*FORMATS_2D[:3], "freihand", "interhand", *FORMATS_2D[3:]]
    assert all(item["loses"] for item in formats if item["name"] != "annotations")


def test_formats_in_3d_take_joints_from_a_track_of_the_recording(studio: Studio, tracked: Tracked) -> None:
    sequence = {"id": str(tracked.sequence_id)}
    made = export(studio, sequence, "interhand", track_id=str(tracked.track_id))
    with zipfile.ZipFile(io.BytesIO(made)) as archive:
        frames = json.loads(archive.read("InterHand2.6M_train_joint_3d.json"))["0"]
    assert sorted(map(int, frames)) == list(range(12))
    address = f"{API}/sequences/{sequence['id']}/labels/export/notes"
    notes = studio.client.get(address, params={"format": "freihand", "track_id": str(tracked.track_id)}).json()
    assert notes["items"] == 12 and "a machine's guess" in " ".join(notes["notes"])
    unknown = studio.client.get(address, params={"format": "freihand", "track_id": sequence["id"]})
    assert unknown.status_code == 404


def test_a_recording_without_labels_is_exported_as_empty_or_said_to_be(
    studio: Studio, add_recording: AddRecording
) -> None:
    sequence = add_recording()
    assert json.loads(export(studio, sequence, "coco_keypoints"))["annotations"] == []
    for name in ("deeplabcut", "t16", "freihand", "interhand"):
        answer = studio.client.get(f"{API}/sequences/{sequence['id']}/labels/export", params={"format": name})
        assert answer.status_code == 422 and answer.json()["error"] == "AnnotationError"


def test_many_hands_come_in_at_once(studio: Studio, add_recording: AddRecording) -> None:
    sequence = add_recording(frames=40)
    joints = json.loads(export(studio, sequence, "annotations"))["joints"]
    items = [
        {"frame": frame, "camera": "cam0", "hand": hand, "points": make_points()}
        for frame in range(40)
        for hand in ("right", "left")
    ]
    files = {"annotations.json": json.dumps({"version": 1, "joints": joints, "items": items}).encode()}
    done = take_in(studio.client, f"/sequences/{sequence['id']}/labels", files, "keep").json()
    assert done["recordings"][0]["added"] == 80
    assert len(get_labels(studio.client, sequence)) == 80


def test_finished_work_is_left_as_it_is_and_the_report_says_why(studio: Studio, add_recording: AddRecording) -> None:
    sequence = add_recording()
    put(studio.client, sequence, 0, make_points())
    put(studio.client, sequence, 1, make_points())
    old = studio.client.post(f"{API}/sequences/{sequence['id']}/labels/snapshots", json={"name": "old"}).json()
    files = {"labels.json": export(studio, sequence, "coco_keypoints")}
    for frame in (0, 1):
        put(studio.client, sequence, frame, make_points(12.0))
    with studio.database.writing() as session:
        project = ProjectRow(id=uuid.uuid4(), name="study")
        session.add(project)
        session.flush()
        accepted = AssignmentRow(
            project_id=project.id,
            sequence_id=uuid.UUID(sequence["id"]),
            account_id=LOCAL_ACCOUNT_ID,
            frame_first=0,
            frame_last=0,
            state="accepted",
        )
        session.add(accepted)
    address = f"/sequences/{sequence['id']}/labels"
    (one,) = send(studio.client, f"{address}/check", files).json()["recordings"]
    assert (one["conflict_count"], one["locked"]) == (1, 1)
    assert "is finished" in one["reasons"][0]
    done = take_in(studio.client, address, files, "replace").json()["recordings"][0]
    assert (done["replaced"], done["locked"]) == (1, 1)
    assert get_labels(studio.client, sequence) == {(0, "right"): make_points(12.0), (1, "right"): make_points()}
    refused = studio.client.post(f"{API}/snapshots/{old['id']}/restore")
    assert refused.status_code == 403 and "is finished" in refused.json()["detail"]
    assert get_labels(studio.client, sequence)[0, "right"] == make_points(12.0)


TRACKED = {"kind": "track", "label": "Track 1"}
FITTED = {"kind": "fit", "label": "model fit of 7 joints"}


def put_mixed(studio: Studio, sequence: dict[str, Any]) -> None:
    """Frame 0: five joints accepted from a track, one from a fit, the others by hand. Frame 1: all from the track."""
    for frame, sources in ((0, [TRACKED] * 5 + [FITTED] + [None] * 15), (1, [TRACKED] * 21)):
        body = {"points": make_points(), "sources": sources, "operation_id": str(uuid.uuid4())}
        place = f"{API}/sequences/{sequence['id']}/annotations/cam0/{frame}/right"
        assert studio.client.put(place, json=body, headers={"If-None-Match": "*"}).status_code == 200


@pytest.mark.parametrize("name", ["annotations", "coco_keypoints", "coco_wholebody"])
def test_sources_go_out_with_the_labels_and_come_back(studio: Studio, add_recording: AddRecording, name: str) -> None:
    sequence, copy = add_recording(), add_recording("copy")
    put_mixed(studio, sequence)
    files = {FILES[name]: export(studio, sequence, name)}
    assert take_in(studio.client, f"/sequences/{copy['id']}/labels", files, "keep").status_code == 200
    back = studio.client.get(f"{API}/sequences/{copy['id']}/annotations").json()["items"]
    kinds = [[source and source["kind"] for source in item["sources"]] for item in back]
    assert kinds == [["track"] * 5 + ["fit"] + [None] * 15, ["track"] * 21]


@pytest.mark.parametrize("name", FORMATS_2D)
def test_an_export_holds_the_sources_that_were_chosen_and_says_what_it_left_out(
    studio: Studio, add_recording: AddRecording, name: str
) -> None:
    sequence = add_recording()
    put_mixed(studio, sequence)
    address = f"{API}/sequences/{sequence['id']}/labels/export/notes"

    def look(*source: str) -> tuple[int, int, str]:
        answer = studio.client.get(address, params={"format": name, "source": source}).json()
        return answer["items"], answer["joints"], " ".join(answer["notes"])

    items, joints, notes = look("independent")
    assert (items, joints) == (1, 15)
    assert "27 joints are left out because of their source: 26 accepted from Track 1, 1 accepted" in notes
    assert look("hand", "fit")[:2] == (1, 16)
    everything = studio.client.get(address, params={"format": name}).json()
    assert (everything["items"], everything["joints"]) == (2, 42)
    said = any("does not say where joints came from: 26 accepted from Track 1" in note for note in everything["notes"])
    assert said == (name in ("deeplabcut", "t16"))

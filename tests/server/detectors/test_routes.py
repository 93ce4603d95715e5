"""A lab's own fingertip detectors: sent, given out, chosen for a job, refused when they are none."""

from __future__ import annotations

import io
import json
import uuid
import zipfile
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from sqlalchemy import select

from server.access.models import AuditRow
from tests.server.conftest import AddRecording, Studio
from tests.server.jobs.test_worker import Bench, bench
from tracker import TrackSetup
from tracker.detection import load_detector
from tracker.detection.default_detector import DATA as DETECTOR
from tracker.detection.forest_files import load_forest, save_forest
from tracker.landmarks.network import DATA as NETWORKS

__all__ = ["bench"]

API = "/api/v1"


def upload(studio: Studio, file: str, data: bytes, **fields: str) -> Any:
    return studio.client.post(f"{API}/detectors", files={"files": (file, data)}, data=fields)


def color_detector() -> bytes:
    """The one that comes along, made to look at colour."""
    out = io.BytesIO()
    with np.load(DETECTOR) as given, zipfile.ZipFile(out, "w") as archive:
        for name in given.files:
            with archive.open(f"{name}.npy", "w") as member:
                np.save(member, np.array(["color"]) if name == "kind" else given[name])
    return out.getvalue()


def test_a_detector_comes_in_is_offered_by_the_form_and_goes_out_to_the_byte(studio: Studio) -> None:
    data = DETECTOR.read_bytes()
    answer = upload(studio, "tips.npz", data, name="Our tips")
    assert answer.status_code == 201, answer.text
    made = answer.json()
    assert (made["name"], made["looks_at"], made["trees"], made["byte_count"]) == ("Our tips", "depth", 10, len(data))
    assert made["digest"] == load_detector(DETECTOR).sha256
    second = upload(studio, "tips.npz", color_detector()).json()
    assert (second["name"], second["looks_at"]) == ("tips", "color")
    assert studio.client.get(f"{API}/detectors").json()["items"] == [second, made]
    assert studio.client.get(f"{API}/detectors/{made['id']}").json() == made
    assert studio.client.get(f"{API}/detectors/{made['id']}/detector.npz").content == data
    [field] = [one for one in studio.client.get(f"{API}/jobs/form").json()["fields"] if one["name"] == "detector_id"]
    assert field["choices"] == ["", second["id"], made["id"]]
    assert field["choice_labels"] == ["The one that comes with Handloom", "tips", "Our tips"]
    path = studio.settings.data_dir / "detectors" / made["id"] / "detector.npz"
    path.write_bytes(data + b"x")
    answer = studio.client.get(f"{API}/detectors/{made['id']}/detector.npz")
    assert answer.status_code == 409 and "was changed" in answer.json()["detail"]


def test_a_deleted_detector_is_in_the_bin_comes_back_and_goes_for_good(studio: Studio) -> None:
    made = upload(studio, "tips.npz", DETECTOR.read_bytes()).json()
    address, binned = f"{API}/detectors/{made['id']}", f"{API}/bin/detector/{made['id']}"
    assert studio.client.delete(address).status_code == 204
    assert studio.client.get(address).status_code == studio.client.delete(address).status_code == 404
    assert studio.client.get(f"{API}/detectors").json()["items"] == []
    [item] = studio.client.get(f"{API}/bin").json()["items"]
    assert (item["word"], item["name"], item["byte_count"]) == ("fingertip detector", "tips", made["byte_count"])
    assert studio.client.post(f"{binned}/restore").status_code == 204
    assert studio.client.get(address).json() == made
    assert studio.client.delete(address).status_code == studio.client.delete(binned).status_code == 204
    assert not (studio.settings.data_dir / "detectors" / made["id"]).exists()
    with studio.database.reading() as session:
        acts = session.scalars(select(AuditRow.act).where(AuditRow.subject_id == uuid.UUID(made["id"]))).all()
    assert sorted(acts) == [f"detector.{act}" for act in ("delete", "delete", "erase", "restore", "upload")]


def bomb() -> bytes:
    """An archive whose array unpacks to 4 GB."""
    header = io.BytesIO()
    np.lib.format.write_array_header_1_0(header, {"descr": "<f8", "fortran_order": False, "shape": (2**29,)})
    out = io.BytesIO()
    with zipfile.ZipFile(out, "w", zipfile.ZIP_DEFLATED) as archive, archive.open("votes.npy", "w") as member:
        member.write(header.getvalue())
        for _ in range(300):
            member.write(bytes(2**20))
    return out.getvalue()


def test_a_file_that_is_no_detector_is_refused_with_one_reason_and_nothing_is_kept(
    studio: Studio, tmp_path: Path
) -> None:
    model = io.BytesIO()
    np.savez(model, template=np.zeros((3, 3)))
    nails = tmp_path / "nails.npz"
    save_forest(replace(load_forest(DETECTOR), kind="color", what="nails"), nails)
    pickled = io.BytesIO()
    np.savez(pickled, format=np.array([{"a": 1}], dtype=object))
    for name, data, said in (
        ("hand.onnx", (NETWORKS / "landmarks.onnx").read_bytes(), "found an ONNX file by its name"),
        ("hand.npz", (NETWORKS / "landmarks.onnx").read_bytes(), "bytes that are no .npz archive"),
        ("tips.npz", DETECTOR.read_bytes()[:5000], "damaged file"),
        ("tips.npz", b"", "an empty file"),
        ("model.npz", model.getvalue(), "an archive of something else"),
        ("nails.npz", nails.read_bytes(), "a detector of nails; needed one of fingertips"),
        ("pickled.npz", pickled.getvalue(), "object"),
        ("bomb.npz", bomb(), "too large members"),
    ):
        answer = upload(studio, name, data)
        detail = answer.json()["detail"]
        assert answer.status_code == 422 and said in detail, (name, answer.text)
        assert detail.startswith(f"{name}: found ") and "needed" in detail
        assert str(studio.settings.data_dir) not in detail
    assert upload(studio, "big.npz", bytes(33 * 2**20)).status_code == 413
    answer = studio.client.post(f"{API}/detectors", files=[("files", (f"{n}.npz", b"PK")) for n in "ab"])
    assert answer.status_code in (413, 422), answer.text
    assert studio.client.get(f"{API}/detectors").json()["items"] == []
    assert not (studio.settings.data_dir / "detectors").exists()


@settings(max_examples=40, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(data=st.data())
def test_garbled_bytes_are_a_detector_or_a_clear_refusal(studio: Studio, data: st.DataObject) -> None:
    content = bytearray(DETECTOR.read_bytes())
    for _ in range(data.draw(st.integers(1, 5))):
        # A zip's directory is at its end: garbled there as often as anywhere else.
        first = data.draw(st.sampled_from([0, len(content) - 1200]))
        content[data.draw(st.integers(first, len(content) - 1))] = data.draw(st.integers(0, 255))
    del content[data.draw(st.sampled_from([len(content), len(content), len(content) // 2, 100, 3])) :]
    answer = upload(studio, "tips.npz", bytes(content))
    assert answer.status_code in (201, 422), answer.text
    if answer.status_code == 422:
        assert answer.json()["detail"].startswith("tips.npz: found ")


def test_a_job_that_could_not_use_the_detector_is_not_queued(studio: Studio, add_recording: AddRecording) -> None:
    bare = add_recording("depth only", color=False)
    depth = upload(studio, "depth.npz", DETECTOR.read_bytes()).json()["id"]
    color = upload(studio, "color.npz", color_detector()).json()["id"]
    for params, said in (
        ({"detector_id": color}, "The fingertip detector looks at colour, and the camera has no colour images."),
        ({"detector_id": depth, "terms": "LO"}, "The terms LO use no fingertips"),
        ({"detector_id": str(uuid.uuid4())}, "There is no fingertip detector"),
        ({"detector_id": "../x"}, "needed a fingertip detector's id, or nothing"),
        ({"detector_id": [1]}, "needed a fingertip detector's id, or nothing"),
    ):
        body = {"sequence_id": bare["id"], "params": params}
        checked = studio.client.post(f"{API}/jobs/check", json=body).json()
        assert not checked["can_start"] and said in checked["obstacles"][0], checked
        answer = studio.client.post(f"{API}/jobs", json=body)
        assert answer.status_code in (404, 422) and said in answer.json()["detail"]
    body = {"sequence_id": bare["id"], "params": {"detector_id": depth}}
    assert studio.client.post(f"{API}/jobs", json=body).json()["params"]["detector_id"] == depth


@pytest.mark.slow
def test_a_job_tracks_with_the_detector_that_was_chosen_and_its_track_tells_which(bench: Bench) -> None:
    from server.access.models import LOCAL_ACCOUNT_ID
    from server.detectors.service import add_detector

    own = load_detector(DETECTOR)
    with bench.database.writing() as session:
        row = add_detector(session, bench.storage, DETECTOR, own, "Our tips", LOCAL_ACCOUNT_ID)
    job_id = bench.queue(detector_id=str(row.id), last_frame=2, terms="LO+S")
    bench.start_worker()
    track_id = bench.wait_for_end(job_id).track_id
    assert track_id is not None
    folder = bench.storage.folder("tracks", track_id)
    told = {"name": "Our tips", "sha256": row.digest}
    assert json.loads((folder / "summary.json").read_text())["detector"] == told
    setup = TrackSetup.load(folder)
    assert setup.own_detector is not None and setup.own_detector.to_json() == told
    assert setup.own_detector.forest.votes.tobytes() == own.forest.votes.tobytes()
    with np.load(folder / "frames.npz") as arrays:
        salient = arrays["cost_names"].tolist().index("salient")
        assert np.isfinite(arrays["costs"][:, salient]).all(), "it looked in every frame"

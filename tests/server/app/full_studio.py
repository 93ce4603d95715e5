"""A studio that holds one of everything the API knows, so that made-up requests get past "no such thing"."""

from __future__ import annotations

import json
import shutil
import uuid
from collections.abc import Callable
from dataclasses import dataclass, field
from datetime import timedelta
from pathlib import Path
from typing import Any

import cv2
import numpy as np
from fastapi import FastAPI
from fastapi.testclient import TestClient

from server.access.logins import Browser, add_login
from server.access.models import LOCAL_ACCOUNT_ID
from server.imports.service import ImportContext, import_recording
from server.tracks.service import add_track
from tests.server.conftest import GeneratedHand
from tests.server.curation import add_curation
from tracker import untrained_hand
from tracker.detection.default_detector import DATA as DETECTOR
from tracker.model.mano_writer import save_mano

API = "/api/v1"
FRAME = 3
LEFT_OUT = object()
"""In the place of a value: the request goes without it."""


@dataclass
class Known:
    """What is there, by the names that requests use."""

    parameters: dict[str, Any]
    """Of paths, of queries and of bodies alike: `sequence_id` is the same thing everywhere."""
    places: dict[str, dict[str, Any]] = field(default_factory=dict)
    """By how an address ends: names that mean something else there."""

    def find(self, path: str) -> dict[str, Any]:
        """All names as an address understands them."""
        more = [names for end, names in self.places.items() if path.endswith(end)]
        return self.parameters | {name: value for names in more for name, value in names.items()}


@dataclass
class Sender:
    """Asks the studio, and hands each answer to a check that compares it with the document."""

    client: TestClient
    check: Callable[[str, str, Any], None]

    def send(self, method: str, path: str, ids: dict[str, Any] | None = None, **options: Any) -> Any:
        """The answer's JSON; `path` as the document writes it, such as `/jobs/{job_id}`."""
        answer = self.client.request(method, (API + path).format(**ids or {}), **options)
        assert answer.status_code < 300, f"{method} {path}: {answer.text}"
        self.check(method, API + path, answer)
        return answer.json() if answer.content else None

    def upload(self, path: str, files: dict[str, bytes], ids: dict[str, Any] | None = None, **fields: Any) -> Any:
        parts = [("files", file) for file in files.items()]
        return self.send("POST", path, ids, files=parts, data=fields, params=(ids or {}).get("query"))


def fill(app: FastAPI, sender: Sender, rendered: Path, track: Path, hand: GeneratedHand) -> Known:
    """Put one of everything into an empty studio of one person."""
    ids = _add_recordings(app, sender, rendered, track)
    _add_team(sender, ids)
    _add_labels(sender, ids)
    _add_uploads(app, sender, ids, hand)
    ids |= add_curation(app, hand, LOCAL_ACCOUNT_ID)
    kinds = {"training_set": "training_set_id", "scan": "scan_id", "hand_model": "model_id"}
    for kind, name in kinds.items():
        sender.send("GET", "/lineage/{kind}/{id}", {"kind": kind, "id": ids[name]})
    marks = {"points": [[150 + 5 * joint, 200, 2] for joint in range(21)], "sources": LEFT_OUT}
    places: dict[str, dict[str, Any]] = {
        "/annotations/{camera}/{frame}/{hand}": marks,
        "/fit": marks,
        "/triangulation": {"views": [{"camera": ids["camera"], "points": marks["points"]}]},
        "/accept": {"assignment_id": ids["submitted_assignment_id"]},
        "/return": {"assignment_id": ids["submitted_assignment_id"]},
        "/evaluations/report.{kind}": {"reference": LEFT_OUT, "snapshot": LEFT_OUT, "source": LEFT_OUT},
        "/bin/{kind}/{item_id}/restore": {"kind": "scan", "item_id": ids["binned_scan_id"]},
        "/bin/{kind}/{item_id}/erasure": {"kind": "scan", "item_id": ids["binned_scan_id"]},
        "/bin/{kind}/{item_id}": {"kind": "scan", "item_id": ids["binned_scan_id"]},
        "/lineage/{kind}/{id}": {"kind": "scan", "id": ids["scan_id"]},
        "/dismissal": {"kind": "jump", "revision": 1},
        "/{sequence_id}/labels/export": {"snapshot_id": LEFT_OUT, "track_id": LEFT_OUT},
        "/{sequence_id}/labels/export/notes": {"snapshot_id": LEFT_OUT, "track_id": LEFT_OUT},
        "/labels/export": {"sequence_id": [ids["sequence_id"]]},
        "/labels/check": {"sequence_id": [ids["sequence_id"]]},
        "/labels/import": {"sequence_id": [ids["sequence_id"]]},
        "/tracks/{track_id}/restore": {"track_id": ids["binned_track_id"]},
        "/retry": {"job_id": ids["cancelled_job_id"]},
        "/unit": {"metres_per_unit": 1.0},
        "/files/{name}": {"name": "track.npz"},
        "/calibrations/{calibration_id}/files/{name}": {"name": "cameras.toml"},
        "/calibrations/{calibration_id}/check": {"options": {}, "name": "fed"},
        "/body-models/{population}/poses": {"frames": [{"hands": {"left": [0.5]}}]},
        "/body-models/{population}/export": {"frames": [{"translation": [0, 1, 0]}], "format": "obj"},
    }
    return Known(ids, places)


def _add_recordings(app: FastAPI, sender: Sender, rendered: Path, track: Path) -> dict[str, Any]:
    desk = ImportContext(app.state.database, app.state.storage, app.state.settings)
    sequence_id = import_recording(desk, rendered, {}, LOCAL_ACCOUNT_ID)
    tracks = uuid.uuid4(), uuid.uuid4()
    for track_id in tracks:
        folder = app.state.storage.folder("tracks", track_id)
        shutil.copytree(track, folder)
        with app.state.database.writing() as session:
            add_track(session, folder, track_id, sequence_id, None)
    with app.state.database.writing() as session:
        add_login(session, LOCAL_ACCOUNT_ID, Browser("test", "test", timedelta(days=1)))
    ids: dict[str, Any] = {"sequence_id": str(sequence_id), "track_id": str(tracks[0])}
    ids["binned_track_id"] = str(tracks[1])
    sender.send("DELETE", "/tracks/{track_id}", {"track_id": tracks[1]})
    recording = sender.send("GET", "/sequences/{sequence_id}", ids)
    ids |= {"content_key": recording["content_key"], "camera": recording["cameras"][0]["id"], "frame": FRAME}
    ids |= {"hand": "right", "revision": 1, "visit_id": str(uuid.uuid4())}
    ids |= {"track": [ids["track_id"]], "sequence": [ids["sequence_id"]], "format": "annotations"}
    ids |= {"sequence_ids": [ids["sequence_id"]], "frame_first": 0, "frame_last": 9, "frames": [0, 1]}
    ids |= {"cameras": [ids["camera"]], "hands": ["right"]}
    jobs = [sender.send("POST", "/jobs", json={"sequence_id": ids["sequence_id"]})["id"] for _ in range(2)]
    batch = sender.send("POST", "/jobs/batch", json={"sequence_ids": [ids["sequence_id"]]})
    sender.send("POST", "/jobs/{job_id}/cancel", {"job_id": jobs[1]})
    ids |= {"job_id": jobs[0], "cancelled_job_id": jobs[1], "job_ids": [jobs[0]], "batch_id": batch["batch"]["id"]}
    ids["login_id"] = sender.send("GET", "/account/logins")["items"][0]["id"]
    ids["token_id"] = sender.send("POST", "/account/tokens", json={"name": "fed"})["id"]
    return ids


def _add_team(sender: Sender, ids: dict[str, Any]) -> None:
    added = [sender.send("POST", "/accounts", json={"name": name}) for name in ("Anna", "Bert", "Cleo")]
    people = [one["person"]["id"] for one in added]
    ids |= {"account_id": people[0], "account_ids": people[:2]}
    ids["project_id"] = sender.send("POST", "/projects", json={"name": "fed"})["id"]
    sender.send("PUT", "/projects/{project_id}/sequences/{sequence_id}", ids)
    asked = {name: ids[name] for name in ("sequence_id", "frame_first", "frame_last")} | {"account_id": people[2]}
    ids["assignment_id"] = sender.send("POST", "/projects/{project_id}/assignments", ids, json=asked)["id"]
    asked |= {"frame_first": 30, "frame_last": 35}
    submitted = sender.send("POST", "/projects/{project_id}/assignments", ids, json=asked)["id"]
    headers = {"If-Match": '"1"'}
    sender.send("POST", "/assignments/{assignment_id}/submit", {"assignment_id": submitted}, headers=headers)
    ids |= {"submitted_assignment_id": submitted, "frame_first": 12, "frame_last": 15, "replica": LEFT_OUT}
    said = sender.send("POST", "/assignments/{assignment_id}/comments", ids, json={"text": "Look."})
    ids["comment_id"] = said["id"]
    names = ("sequence_id", "cameras", "hands", "account_ids")
    asked = {name: ids[name] for name in names} | {"name": "fed", "frames": [20, 21]}
    ids["replica_set_id"] = sender.send("POST", "/projects/{project_id}/replica-sets", ids, json=asked)["id"]


def _add_labels(sender: Sender, ids: dict[str, Any]) -> None:
    sequence = {"sequence_id": ids["sequence_id"]}
    labels = json.dumps(sender.send("GET", "/sequences/{sequence_id}/annotations.json", sequence)).encode()
    report = sender.upload("/sequences/{sequence_id}/labels/check", {"a.json": labels}, sequence)
    fields = {"check": report["check"], "policy": "replace"}
    sender.upload("/sequences/{sequence_id}/labels/import", {"a.json": labels}, sequence, **fields)
    made = sender.send("POST", "/sequences/{sequence_id}/labels/snapshots", sequence, json={"name": "fed"})
    ids |= {"snapshot_id": made["id"], "labels": f"snapshot-{made['id']}", "with": "now"}


def _add_uploads(app: FastAPI, sender: Sender, ids: dict[str, Any], hand: GeneratedHand) -> None:
    scan = (hand.folder / "hand.ply").read_bytes()
    sender.upload("/scans/measure", {"hand.ply": scan})
    # another file than the curated scan, so another scan
    added = sender.upload("/scans", {"bin.ply": scan.replace(b"comment", b"comment x", 1)})["added"]
    ids["binned_scan_id"] = added[0]["id"]
    sender.send("DELETE", "/scans/{scan_id}", {"scan_id": ids["binned_scan_id"]})
    file = app.state.settings.data_dir / "MANO_RIGHT.npz"
    save_mano(untrained_hand("right"), file)
    sender.send("POST", "/hand-models", files={"files": ("MANO_RIGHT.npz", file.read_bytes())}, data={"name": "fed"})
    added = sender.upload("/detectors", {"tips.npz": DETECTOR.read_bytes()}, name="tips")
    ids["detector_id"] = added["id"]
    sender.send("GET", "/detectors/{detector_id}", ids)
    picture = cv2.imencode(".png", np.zeros((24, 32, 3), np.uint8))[1].tobytes()
    pictures = {f"waving/color/{frame:06d}.png": picture for frame in range(3)}
    options = {"fps": 30, "fx": 30, "fy": 30, "cx": 15.5, "cy": 11.5}
    found = sender.upload("/imports", pictures, options=json.dumps(options))
    ids |= {"import_id": found["id"], "name": "waving/color/000000.png", "options": options}
    films = {f"{camera}/{frame}.png": picture for camera in "ab" for frame in range(2)}
    ids["calibration_id"] = sender.upload("/calibrations", films)["id"]

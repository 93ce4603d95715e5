"""Tracks against labels: the error that is kept, what is compared with what, and the pictures of the worst hands."""

from __future__ import annotations

import uuid
from pathlib import Path
from urllib.parse import parse_qs, urlsplit

import cv2
import numpy as np
import pytest

from server.access.models import LOCAL_ACCOUNT_ID, Account
from server.annotations.snapshots import create_snapshot
from server.database import Database
from server.errors import ForbiddenError, NotFoundError
from server.evaluations.choice import Chosen
from server.evaluations.labels import LabelsId
from server.evaluations.schemas import EvaluationQuery
from server.evaluations.service import compare, describe_comparison, draw_picture, evaluate, write_picture_address
from server.tracks.models import TrackRow
from tests.server.access.test_policy import Bench
from tests.server.conftest import MakeRecording
from tests.server.evaluations.known_tracks import Known, store_known
from tests.server.rows import make_recording as make_row
from tests.server.rows import make_track

LOCAL = Account(id=LOCAL_ACCOUNT_ID, name="local", role="admin")
TRACK = [{"kind": "track", "label": "Track 1"}] * 21
INDEPENDENT = ["independent"]


@pytest.fixture
def database_kind() -> str:
    return "sqlite"


@pytest.fixture
def known(database: Database, tmp_path: Path, make_recording: MakeRecording) -> Known:
    return store_known(database, tmp_path / "files", make_recording)


def read_error(known: Known) -> float | None:
    with known.context.database.reading() as session:
        return session.get_one(TrackRow, known.track.id).error_px


def test_the_error_by_joints_of_no_track_is_kept_with_the_track(known: Known) -> None:
    assert evaluate(known.context, known.track, INDEPENDENT)["joint_error_px"]["mean"] is None
    assert read_error(known) is None
    known.mark(0, (3.0, 4.0))
    known.mark(1, (0.0, 1.0), sources=TRACK)
    told = evaluate(known.context, known.track, ["all"])
    assert told["joint_error_px"]["mean"] == pytest.approx((5.0 + 1.0) / 2) and told["joint_error_px"]["count"] == 42
    assert read_error(known) == pytest.approx(5.0), "whatever was asked for"
    assert evaluate(known.context, known.track, INDEPENDENT)["joint_error_px"]["count"] == 21


def test_a_comparison_holds_what_was_asked_for_and_names_its_labels(known: Known) -> None:
    for frame, shift in ((0, (3.0, 4.0)), (1, (0.0, 2.0)), (2, (9.0, 0.0))):
        known.mark(frame, shift)
    query = EvaluationQuery(track=[known.track.id], within=5.5)
    comparison, judged = compare(known.context, query, LOCAL)
    [track] = comparison.tracks
    assert comparison.reference == known.track.id and comparison.cameras == ["cam0"] and len(judged) == 1
    assert track.error.mean == pytest.approx(16 / 3) and track.within == pytest.approx(2 / 3)
    assert track.curve.mean == pytest.approx([5.0, 2.0, 9.0])
    assert track.labels["revision"] == 3 and track.origin["id"] == str(known.track.id)
    assert [worst.frame for worst in track.worst] == [2, 0, 1]
    later = describe_comparison(known.context, query.model_copy(update={"without_start": True}), LOCAL)
    assert later.tracks[0].error.mean == pytest.approx(5.5)
    nothing = describe_comparison(known.context, EvaluationQuery(), LOCAL)
    assert nothing.tracks == [] and nothing.reference is None and nothing.cameras == []


def test_who_marks_the_recording_blindly_sees_no_comparison(known: Known) -> None:
    bench = Bench(known.context.database)
    bench.recording = known.recording.id
    ann = bench.person("ann")
    bench.give_blindly(ann, [2])
    with pytest.raises(ForbiddenError, match=r"You mark frames of this recording blindly \(Agreement\)"):
        compare(known.context, EvaluationQuery(track=[known.track.id]), ann)


@pytest.mark.parametrize("source", [INDEPENDENT, ["all"], ["hand", "fit"]])
def test_the_address_of_a_picture_names_the_labels_and_any_camera(source: list[str]) -> None:
    recording = make_row()
    track = make_track(recording)
    chosen = Chosen(track, recording, LabelsId(recording.id, "now-7", 7))
    address = urlsplit(write_picture_address(chosen, "cam 0/ü?", 12, "left", source))
    assert address.path == f"/api/v1/tracks/{track.id}/evaluation/now-7/cam%200%2F%C3%BC%3F/12/left.jpg"
    assert parse_qs(address.query) == ({} if source == INDEPENDENT else {"source": source})


def test_the_worst_hand_is_drawn_and_others_are_not_found(known: Known) -> None:
    known.mark(1, (3.0, 4.0))

    def draw(labels: str = "now-1", place: tuple[str, int, str] = ("cam0", 1, "right")) -> bytes:
        return draw_picture(known.context, known.track, labels, place, INDEPENDENT)

    picture = cv2.imdecode(np.frombuffer(draw(), np.uint8), cv2.IMREAD_COLOR)
    assert picture.ndim == 3 and picture.std() > 1
    for place in (("cam0", 2, "right"), ("cam0", 1, "left"), ("cam1", 1, "right")):
        camera, frame, hand = place
        said = f"The {hand} hand in frame {frame} of {camera} is not both annotated and tracked"
        with pytest.raises(NotFoundError, match=said):
            draw(place=place)
    known.mark(0, (1.0, 1.0))
    with pytest.raises(NotFoundError, match=r"at revision 2 now; pictures of revision 1 are no longer made. Load"):
        draw()
    assert draw("now-2") == draw("now-2")


def test_a_picture_by_a_snapshot_is_of_its_recording_alone(known: Known, database: Database) -> None:
    known.mark(1, (3.0, 4.0))
    other = make_row("other")
    with database.writing() as session:
        session.add(other)
        session.flush()
        storage = known.context.storage
        good, _ = create_snapshot(session, storage, known.recording, "Good", LOCAL_ACCOUNT_ID)
        wrong, _ = create_snapshot(session, storage, other, "Wrong", LOCAL_ACCOUNT_ID)

    def draw(snapshot_id: uuid.UUID) -> bytes:
        place = ("cam0", 1, "right")
        return draw_picture(known.context, known.track, f"snapshot-{snapshot_id}", place, INDEPENDENT)

    drawn = draw(good.id)
    known.mark(0, (1.0, 1.0))
    assert draw(good.id) == drawn, "it shows the same for good"
    with pytest.raises(NotFoundError, match=f"The snapshot {wrong.id} is not of this track's recording"):
        draw(wrong.id)

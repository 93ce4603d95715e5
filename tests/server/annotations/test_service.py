"""Annotations as they are read: which places and joints there can be, in what order they come, what counts as done."""

from __future__ import annotations

import uuid

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from sqlalchemy.orm import Session

from server.access.places import HiddenPlaces, Place
from server.annotations import service
from server.annotations.models import AnnotationRevisionRow
from server.database import Database
from server.errors import InvalidError, NotFoundError
from tests.server.exchange.labels import make_points
from tests.server.rows import keep, make_annotation, make_recording

RECORDING = make_recording(cameras=("cam0", "cam1"))


@pytest.fixture
def database_kind() -> str:
    return "sqlite"


@pytest.mark.parametrize("frame", [0, 11])
def test_the_first_and_the_last_frame_are_places(frame: int) -> None:
    place = service.check_place(RECORDING, "cam1", frame, "left", "blind")
    assert place == Place(RECORDING.id, "cam1", frame, "left", "blind")


@pytest.mark.parametrize("frame", [-1, 12])
def test_a_frame_beside_the_recording_is_refused_with_those_there_are(frame: int) -> None:
    with pytest.raises(NotFoundError, match=rf"waving has no frame {frame}; they go from 0 to 11\."):
        service.check_place(RECORDING, "cam0", frame, "right")


def test_an_unknown_camera_is_refused_with_those_there_are() -> None:
    with pytest.raises(NotFoundError, match=r"waving has no camera 'cam9'; it has \['cam0', 'cam1'\]"):
        service.check_place(RECORDING, "cam9", 0, "right")


@given(st.floats(-100, 100), st.floats(-100, 100), st.sampled_from([0, 1, 2]))
def test_a_joint_lies_at_most_one_image_beside_the_image_unless_it_is_absent(x: float, y: float, v: int) -> None:
    place = Place(RECORDING.id, "cam0", 3, "right")
    if v == 0 or (-32 <= x <= 64 and -24 <= y <= 48):
        assert service.check_points(RECORDING, place, [[x, y, v]]) == [[x, y, v]]
    else:
        with pytest.raises(InvalidError, match="far outside the image of 32x24 px"):
            service.check_points(RECORDING, place, [[x, y, v]])


def test_the_first_joint_too_far_out_is_named_with_where_it_is_and_what_to_do() -> None:
    points = [[0, 0, 2], [64, 48, 1], [64.5, 3, 2], [999, 3, 2]]
    with pytest.raises(InvalidError, match=r"points\.2 is at \(64\.5, 3\).*Mark a joint.*absent \(v = 0\)"):
        service.check_points(RECORDING, Place(RECORDING.id, "cam0", 3, "right"), points)


def test_a_deleted_annotation_is_found_only_by_who_asks_for_it_and_a_replica_has_its_own(database: Database) -> None:
    recording = make_recording()
    gone = make_annotation(recording, 1, None)
    blind = make_annotation(recording, 1, make_points(), replica=str(uuid.uuid4()))
    keep(database, recording, gone, blind)
    place = Place(recording.id, "cam0", 1, "right")
    with database.reading() as session:
        assert service.get_annotation(session, place, deleted_too=True).id == gone.id
        own = Place(recording.id, "cam0", 1, "right", blind.replica)
        assert service.get_annotation(session, own).id == blind.id
        with pytest.raises(NotFoundError, match="There is no annotation of the right hand in frame 1 of cam0"):
            service.get_annotation(session, place)
        assert service.find_annotation(session, Place(recording.id, "cam0", 2, "right")) is None
        assert service.find_revisions(session, recording.id) == {}


def test_the_history_comes_newest_first_and_a_deletion_in_it_cannot_be_restored(database: Database) -> None:
    recording = make_recording()
    row = make_annotation(recording, 1, make_points(3.0), revision=3)
    steps = [(1, "put", make_points()), (2, "delete", None), (3, "put", make_points(3.0))]
    past = [
        AnnotationRevisionRow(
            annotation_id=row.id, revision=n, act=act, points=points, sources=None, operation_id=uuid.uuid4()
        )
        for n, act, points in steps
    ]
    keep(database, recording, row, *past)
    with database.reading() as session:
        assert [line.revision for line in service.list_history(session, row)] == [3, 2, 1]
        assert service.get_past(session, row, 1).points == make_points()
        with pytest.raises(InvalidError, match=r"Revision 2 is a deletion\. Delete the annotation instead"):
            service.get_past(session, row, 2)
        with pytest.raises(NotFoundError, match=r"There is no revision 4; they go from 1 to 3\."):
            service.get_past(session, row, 4)
        assert service.find_revisions(session, recording.id) == {row.id: 3}


def list_keys(session: Session, recording_id: uuid.UUID, **asked: object) -> list[tuple[int, str, str]]:
    rows, _ = service.list_annotations(session, recording_id, **asked)  # type: ignore[arg-type]
    return [(row.frame, row.camera, row.hand) for row in rows]


def test_annotations_come_by_frame_camera_and_hand_without_deleted_hidden_and_blind_ones(database: Database) -> None:
    recording, other = make_recording(cameras=("cam0", "cam1")), make_recording("other")
    keys = [(frame, camera, hand) for frame in range(4) for camera in ("cam0", "cam1") for hand in ("left", "right")]
    rows = [make_annotation(recording, f, make_points(), hand, camera=camera) for f, camera, hand in reversed(keys)]
    more = [make_annotation(recording, 5, None), make_annotation(recording, 6, make_points(), replica="blind")]
    keep(database, recording, other, *rows, *more, make_annotation(other, 0, make_points()))
    hidden = [
        HiddenPlaces(frozenset({0, 1}), frozenset({"cam1"}), frozenset({"left", "right"})),
        HiddenPlaces(frozenset({3}), frozenset({"cam0", "cam1"}), frozenset({"left"})),
    ]
    with database.reading() as session:
        assert list_keys(session, recording.id) == keys
        assert list_keys(session, recording.id, replica="blind") == [(6, "cam0", "right")]
        assert list_keys(session, recording.id, frames=(1, 2)) == [key for key in keys if key[0] in (1, 2)]
        assert list_keys(session, recording.id, frames=(None, 0), camera="cam1") == keys[2:4]
        seen = [key for key in keys if not any(Place(recording.id, key[1], key[0], key[2]) in one for one in hidden)]
        assert 0 < len(seen) < len(keys) and list_keys(session, recording.id, hidden=hidden) == seen


def test_the_exported_file_holds_the_joints_to_the_last_digit(database: Database, rng: np.random.Generator) -> None:
    recording = make_recording()
    points = [[float(x), float(y), 2] for x, y in rng.uniform(0, 24, (21, 2))]
    keep(database, recording, make_annotation(recording, 7, points))
    with database.reading() as session:
        [item] = service.load_annotations(session, recording.id).items
        document = service.export_annotations(session, recording.id)
    assert item.key == (7, "cam0", "right") and item.points.tolist() == points and item.sources is None
    assert [(one["frame"], one["points"]) for one in document["items"]] == [(7, points)]


def test_frames_are_counted_as_a_plain_loop_over_the_labels_counts_them(
    database: Database, rng: np.random.Generator
) -> None:
    recording = make_recording(cameras=("cam0", "cam1"), hands=["right", "left"])
    empty = make_recording("empty")
    rows = []
    decided: dict[int, list[tuple[str, int]]] = {}
    for frame in range(12):
        for camera in ("cam0", "cam1"):
            for hand in ("right", "left"):
                if (many := int(rng.choice([-1, 0, 20, 21, 21, 21]))) >= 0:
                    rows.append(make_annotation(recording, frame, make_points(), hand, camera=camera, decided=many))
                    decided.setdefault(frame, []).append((hand, many))
    blind = make_annotation(recording, 0, make_points(), replica="blind", decided=5)
    keep(database, recording, empty, *rows, blind)
    begun = {frame: [one for one in found if one[1]] for frame, found in decided.items()}
    begun = {frame: found for frame, found in begun.items() if found}
    done = [
        frame
        for frame, found in begun.items()
        if all(many == 21 for _, many in found) and {hand for hand, _ in found} == {"right", "left"}
    ]
    assert 0 < len(done) < len(begun)
    with database.reading() as session:
        assert service.find_annotated_frames(session, [recording.id, empty.id]) == {
            recording.id: {"annotated_frames": len(begun), "done_frames": len(done)}
        }
        assert service.find_annotated_frames(session, []) == {}


@pytest.mark.parametrize(
    ("hands", "least", "asked", "is_done"),
    [(1, 21, 1, True), (2, 21, 1, True), (1, 21, 2, False), (1, 20, 1, False), (0, 0, 1, False)],
)
def test_a_frame_is_done_when_every_hand_is_and_nothing_is_half_done(
    hands: int, least: int, asked: int, is_done: bool
) -> None:
    assert service.is_frame_done(hands, least, asked) is is_done

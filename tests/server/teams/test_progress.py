"""How far an assignment is: frames in which all that is asked for is decided, and those that were begun."""

from __future__ import annotations

import uuid

import pytest

from server.access.models import LOCAL_ACCOUNT_ID
from server.access.project_models import AssignmentRow, ProjectRow, ReplicaSetRow
from server.annotations.models import AnnotationRow
from server.annotations.sources import JOINT_COUNT
from server.database import Database
from server.sequences.models import SequenceRow
from server.teams.progress import Progress, find_progress


class Bench:
    """A recording of two hands, and frames of it that somebody is to mark."""

    def __init__(self, database: Database) -> None:
        self.database = database
        recording = SequenceRow(
            name="ball", fps=30.0, frame_count=99, cameras=[], hands=["right", "left"], objects=[], content_key="x"
        )
        with database.writing() as session:
            session.add_all([recording, project := ProjectRow(name="Balls")])
            session.flush()
            self.recording, self.project = recording.id, project.id

    def give(self, first: int, last: int, replica_set_id: uuid.UUID | None = None) -> uuid.UUID:
        with self.database.writing() as session:
            row = AssignmentRow(
                project_id=self.project,
                sequence_id=self.recording,
                account_id=LOCAL_ACCOUNT_ID,
                frame_first=first,
                frame_last=last,
                replica_set_id=replica_set_id,
            )
            session.add(row)
            session.flush()
            return row.id

    def give_blindly(self, frames: list[int], cameras: list[str]) -> uuid.UUID:
        places = {"frames": frames, "cameras": cameras, "hands": ["right"]}
        with self.database.writing() as session:
            row = ReplicaSetRow(project_id=self.project, sequence_id=self.recording, name="Twice", **places)
            session.add(row)
            session.flush()
            set_id = row.id
        return self.give(min(frames), max(frames), set_id)

    def mark(self, frame: int, hand: str, decided: int = JOINT_COUNT, camera: str = "cam0", replica: str = "") -> None:
        with self.database.writing() as session:
            session.add(
                AnnotationRow(
                    sequence_id=self.recording,
                    camera=camera,
                    frame=frame,
                    hand=hand,
                    replica=replica,
                    points=[[1.0, 1.0, 2]] * JOINT_COUNT,
                    decided=decided,
                    revision=1,
                    author_id=LOCAL_ACCOUNT_ID,
                )
            )

    def look(self, *ids: uuid.UUID) -> list[Progress]:
        with self.database.reading() as session:
            rows = [session.get_one(AssignmentRow, id_) for id_ in ids]
            sets = {row.id: row for row in session.query(ReplicaSetRow)}
            found = find_progress(session, rows, sets)
        return [found[id_] for id_ in ids]


@pytest.fixture
def bench(database: Database) -> Bench:
    return Bench(database)


def test_what_nobody_has_begun_is_not_done_and_begins_with_its_first_frame(bench: Bench) -> None:
    assert bench.look(bench.give(10, 19)) == [Progress(frames=10, done=0, partial=0, next_frame=10)]


def test_a_frame_is_done_when_every_hand_is_decided_whole(bench: Bench) -> None:
    given = bench.give(10, 12)
    bench.mark(10, "right")
    bench.mark(10, "left")
    bench.mark(11, "right")
    bench.mark(12, "right")
    bench.mark(12, "left", decided=JOINT_COUNT - 1)
    bench.mark(13, "right")  # of nobody's frames
    assert bench.look(given) == [Progress(frames=3, done=1, partial=2, next_frame=11)]
    bench.mark(11, "left")
    assert bench.look(given) == [Progress(frames=3, done=2, partial=1, next_frame=12)]


def test_another_camera_counts_as_well_but_nothing_begun_may_stay_half_done(bench: Bench) -> None:
    given = bench.give(10, 10)
    bench.mark(10, "right", camera="cam0")
    bench.mark(10, "left", camera="cam1")
    assert bench.look(given)[0].done == 1
    bench.mark(10, "left", camera="cam2", decided=3)
    assert bench.look(given) == [Progress(frames=1, done=0, partial=1, next_frame=10)]


def test_of_a_replica_every_hand_in_every_camera_is_asked_for(bench: Bench) -> None:
    given = bench.give_blindly([3, 7], ["cam0", "cam1"])
    bench.mark(3, "right", camera="cam0")  # everybody's, not the replica's
    assert bench.look(given) == [Progress(frames=2, done=0, partial=0, next_frame=3)]
    bench.mark(7, "right", camera="cam0", replica=str(given))
    assert bench.look(given) == [Progress(frames=2, done=0, partial=1, next_frame=3)]
    for frame, camera in ((7, "cam1"), (3, "cam0"), (3, "cam1")):
        bench.mark(frame, "right", camera=camera, replica=str(given))
    assert bench.look(given) == [Progress(frames=2, done=2, partial=0, next_frame=None)]


def test_several_are_measured_together_as_each_alone(bench: Bench) -> None:
    ranges, blind = bench.give(10, 19), bench.give_blindly([10], ["cam0"])
    bench.mark(10, "right")
    bench.mark(10, "left")
    bench.mark(10, "right", replica=str(blind))
    together = bench.look(ranges, blind)
    assert together == [*bench.look(ranges), *bench.look(blind)]
    assert [one.done for one in together] == [1, 1]

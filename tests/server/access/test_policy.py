"""Who may read and change which annotations: by assignments, by blind replicas, by role."""

from __future__ import annotations

import uuid
from typing import Any

import pytest

from server.access.models import Account, Role
from server.access.places import HiddenPlaces, Place
from server.access.policy import (
    LockedError,
    NotYoursError,
    check_change,
    check_read,
    check_sees_tracks,
    find_hidden,
)
from server.access.project_models import AssignmentRow, ProjectRow, ReplicaSetRow
from server.database import Database, utc_now
from server.errors import ForbiddenError, NotFoundError
from server.sequences.models import SequenceRow


class Bench:
    """A recording in a project, people, and work that is given to them."""

    def __init__(self, database: Database) -> None:
        self.database = database
        with database.writing() as session:
            recording = SequenceRow(
                name="ball", fps=30.0, frame_count=100, cameras=[], hands=[], objects=[], content_key="x"
            )
            project = ProjectRow(name="Balls")
            session.add_all([recording, project])
            session.flush()
            self.recording, self.project = recording.id, project.id

    def person(self, name: str, role: Role = "annotator") -> Account:
        with self.database.writing() as session:
            row = Account(name=name, role=role)
            session.add(row)
            session.flush()
            return Account(id=row.id, name=name, role=role)

    def give(self, person: Account, first: int, last: int, state: str = "open", **columns: Any) -> uuid.UUID:
        with self.database.writing() as session:
            row = AssignmentRow(
                project_id=self.project,
                sequence_id=self.recording,
                account_id=person.id,
                frame_first=first,
                frame_last=last,
                state=state,
                **columns,
            )
            session.add(row)
            session.flush()
            return row.id

    def give_blindly(self, person: Account, frames: list[int], state: str = "open") -> uuid.UUID:
        """Gives the id of the assignment, which names the replica."""
        with self.database.writing() as session:
            row = ReplicaSetRow(
                project_id=self.project,
                sequence_id=self.recording,
                name="Agreement",
                frames=frames,
                cameras=["cam0"],
                hands=["right"],
            )
            session.add(row)
            session.flush()
            replica_set_id = row.id
        return self.give(person, min(frames), max(frames), state, replica_set_id=replica_set_id)

    def put_away(self) -> None:
        with self.database.writing() as session:
            session.get_one(ProjectRow, self.project).archived_at = utc_now()

    def place(self, frame: int, replica: str = "", hand: str = "right") -> Place:
        return Place(self.recording, "cam0", frame, hand, replica)

    def change(self, person: Account, place: Place) -> None:
        with self.database.writing() as session:
            check_change(session, person, place)

    def read(self, person: Account, place: Place) -> None:
        with self.database.reading() as session:
            check_read(session, person, place)

    def hidden(self, person: Account, replica: str = "") -> list[HiddenPlaces]:
        with self.database.reading() as session:
            return find_hidden(session, person, self.recording, replica)


@pytest.fixture
def bench(database: Database) -> Bench:
    return Bench(database)


def test_what_is_given_to_nobody_is_anybodys(bench: Bench) -> None:
    anna = bench.person("anna")
    bench.change(anna, bench.place(7))
    bench.give(bench.person("ben"), 10, 20)
    bench.change(anna, bench.place(9))
    bench.change(anna, bench.place(21))


def test_frames_of_somebody_else_are_theirs_and_a_reviewers(bench: Bench) -> None:
    anna, ben, rita = bench.person("anna"), bench.person("ben"), bench.person("rita", "reviewer")
    bench.give(ben, 10, 20)
    for frame in (10, 15, 20):
        with pytest.raises(NotYoursError, match=f"Frame {frame} is assigned to ben. Ask a lead"):
            bench.change(anna, bench.place(frame))
    bench.change(ben, bench.place(15))
    bench.change(rita, bench.place(15))
    bench.give(anna, 15, 30)
    bench.change(anna, bench.place(15))


@pytest.mark.parametrize(("state", "said"), [("submitted", "waits for its review"), ("accepted", "is finished")])
def test_work_that_was_handed_in_is_locked_for_its_annotator(bench: Bench, state: str, said: str) -> None:
    anna = bench.person("anna")
    bench.give(anna, 10, 20, state)
    with pytest.raises(LockedError, match=said):
        bench.change(anna, bench.place(15))


def test_a_reviewer_corrects_what_was_submitted_and_nobody_what_was_accepted(bench: Bench) -> None:
    anna, rita = bench.person("anna"), bench.person("rita", "reviewer")
    bench.give(anna, 10, 20, "submitted")
    bench.give(anna, 30, 40, "accepted")
    bench.change(rita, bench.place(15))
    with pytest.raises(LockedError):
        bench.change(rita, bench.place(35))


def test_a_project_put_away_gives_its_frames_free_but_not_what_was_accepted(bench: Bench) -> None:
    anna, ben = bench.person("anna"), bench.person("ben")
    bench.give(ben, 10, 20)
    bench.give(ben, 30, 40, "accepted")
    bench.put_away()
    bench.change(anna, bench.place(15))
    with pytest.raises(LockedError):
        bench.change(anna, bench.place(35))


def test_who_marks_blindly_neither_reads_nor_changes_the_shared_labels_there(bench: Bench) -> None:
    anna, ben = bench.person("anna"), bench.person("ben")
    bench.give_blindly(anna, [3, 5])
    assert bench.hidden(anna) == [HiddenPlaces(frozenset({3, 5}), frozenset({"cam0"}), frozenset({"right"}))]
    assert bench.hidden(ben) == []
    for act in (bench.read, bench.change):
        with pytest.raises(ForbiddenError, match="blindly"):
            act(anna, bench.place(3))
        act(anna, bench.place(4))
        act(anna, bench.place(3, hand="left"))
        act(ben, bench.place(3))


def test_tracks_are_hidden_until_the_blind_work_is_accepted(bench: Bench) -> None:
    anna, ben = bench.person("anna"), bench.person("ben")
    bench.give_blindly(anna, [3])
    bench.give_blindly(ben, [3], "accepted")
    with bench.database.reading() as session:
        with pytest.raises(ForbiddenError, match="tracks and evaluations are shown to you when your work is accepted"):
            check_sees_tracks(session, anna, bench.recording)
        check_sees_tracks(session, ben, bench.recording)
    assert bench.hidden(ben) == []


def test_a_replica_is_changed_by_its_annotator_only_where_it_has_places(bench: Bench) -> None:
    anna, rita = bench.person("anna"), bench.person("rita", "reviewer")
    replica = str(bench.give_blindly(anna, [3, 5]))
    bench.change(anna, bench.place(3, replica))
    with pytest.raises(NotYoursError):
        bench.change(rita, bench.place(3, replica))
    with pytest.raises(NotFoundError, match="does not have the right hand in frame 4"):
        bench.change(anna, bench.place(4, replica))


def test_a_replica_that_was_submitted_is_locked(bench: Bench) -> None:
    anna = bench.person("anna")
    replica = str(bench.give_blindly(anna, [3], "submitted"))
    with pytest.raises(LockedError, match="A reviewer can return them to you"):
        bench.change(anna, bench.place(3, replica))


def test_reviewers_see_a_replica_when_it_was_submitted_unless_they_mark_it_themselves(bench: Bench) -> None:
    anna, ben, rita = bench.person("anna"), bench.person("ben"), bench.person("rita", "reviewer")
    at_work, done = (str(bench.give_blindly(anna, [3], state)) for state in ("open", "submitted"))
    assert bench.hidden(anna, at_work) == [] and bench.hidden(rita, done) == []
    with pytest.raises(ForbiddenError, match="when it was submitted"):
        bench.hidden(rita, at_work)
    with pytest.raises(ForbiddenError, match="to its annotator and to reviewers only"):
        bench.hidden(ben, done)
    with bench.database.writing() as session:
        replica_set_id = session.get_one(AssignmentRow, uuid.UUID(done)).replica_set_id
    bench.give(rita, 3, 3, replica_set_id=replica_set_id)
    with pytest.raises(ForbiddenError, match="You mark Agreement blindly yourself"):
        bench.hidden(rita, done)


def test_a_replica_that_nobody_has_is_not_found(bench: Bench) -> None:
    anna = bench.person("anna")
    for act in (
        lambda: bench.hidden(anna, str(uuid.uuid4())),
        lambda: bench.change(anna, bench.place(3, str(uuid.uuid4()))),
    ):
        with pytest.raises(NotFoundError, match="no blind replica"):
            act()

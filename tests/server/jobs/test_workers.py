"""Workers that fall silent are given up, and their work is taken over once."""

from __future__ import annotations

from datetime import timedelta

from server.database import Database, utc_now
from server.jobs import workers
from server.jobs.models import WorkerRow


def register(database: Database, slot: str) -> WorkerRow:
    with database.writing() as session:
        return workers.register_worker(session, slot)


def fall_silent(database: Database, worker: WorkerRow) -> None:
    with database.writing() as session:
        row = session.get_one(WorkerRow, worker.id)
        row.last_seen_at = utc_now() - workers.LOST_AFTER - timedelta(seconds=1)


def find_abandoned(database: Database) -> list[str]:
    with database.writing() as session:
        return [row.slot for row in workers.find_abandoned_workers(session)]


def test_a_silent_worker_is_given_up_and_learns_of_it(database) -> None:
    silent, alive = register(database, "a"), register(database, "b")
    assert find_abandoned(database) == []
    fall_silent(database, silent)
    assert find_abandoned(database) == ["a"]
    with database.writing() as session:
        assert not workers.beat(session, silent.id), "it must end itself"
        assert workers.beat(session, alive.id)


def test_a_worker_that_stopped_leaves_its_work_to_the_others(database) -> None:
    worker = register(database, "a")
    with database.writing() as session:
        workers.stop_worker(session, worker.id)
    assert find_abandoned(database) == ["a"]


def test_the_work_of_a_slot_that_lives_again_is_left_to_it(database) -> None:
    old = register(database, "a")
    new = register(database, "a")
    assert find_abandoned(database) == []
    with database.reading() as session:
        assert session.get_one(WorkerRow, old.id).state == "lost"
        assert workers.is_alive(session.get_one(WorkerRow, new.id), utc_now())

"""What a worker finds when it looks for jobs to put into the queue."""

from __future__ import annotations

from datetime import timedelta

from server.database import Database, utc_now
from server.jobs.dispatcher import AT_ONCE, find_waiting
from server.jobs.models import JobRow


def add_job(database: Database, age: int, state: str, attempt: int = 1, dispatched: int = 0) -> None:
    with database.writing() as session:
        made = utc_now() - timedelta(seconds=age)
        session.add(
            JobRow(
                kind="train",
                state=state,
                title=f"{state} {age}",
                params={},
                attempt=attempt,
                dispatched_attempt=dispatched,
                created_at=made,
            )
        )


def look(database: Database) -> list[str]:
    with database.reading() as session:
        return [job.title for job in find_waiting(session)]


def test_jobs_that_want_to_start_or_to_end_are_found_and_no_others(database: Database) -> None:
    add_job(database, 5, "queued")
    add_job(database, 4, "queued", attempt=2, dispatched=1)
    add_job(database, 3, "cancelled", dispatched=1)
    add_job(database, 9, "queued", dispatched=1)
    add_job(database, 8, "cancelled")
    add_job(database, 7, "running", dispatched=1)
    add_job(database, 6, "succeeded", dispatched=1)
    assert look(database) == ["queued 5", "queued 4", "cancelled 3"]


def test_however_many_wait_one_look_takes_the_oldest_hundred(database: Database) -> None:
    for age in range(AT_ONCE + 20):
        add_job(database, age, "queued")
    assert look(database) == [f"queued {age}" for age in range(AT_ONCE + 19, 19, -1)]

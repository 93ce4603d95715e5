"""Listeners hear every change once, also those made while they were away."""

from __future__ import annotations

import asyncio
import json
import uuid

from server.jobs import events, service
from server.jobs.models import JobRow


def parse(texts: list[str]) -> list[tuple[str, str, dict]]:
    """(event, id, data) of each."""
    parsed = []
    for text in texts:
        fields = dict(line.split(": ", 1) for line in text.strip().splitlines())
        parsed.append((fields["event"], fields.get("id", ""), json.loads(fields["data"])))
    return parsed


def queue_job(database, sequence_id) -> uuid.UUID:
    with database.writing() as session:
        return service.create_job(session, "track", sequence_id, {}).id


def test_a_feed_gives_the_state_first_and_then_only_what_changed(database, sequence_id) -> None:
    job_id = queue_job(database, sequence_id)
    feed = events.JobFeed.after(job_id, None)
    first = parse(feed.poll(database))
    assert [name for name, _, _ in first] == ["log", "job"]
    assert first[-1][2]["state"] == "queued"
    assert feed.poll(database) == []
    with database.writing() as session:
        service.cancel_job(session, job_id)
    second = parse(feed.poll(database))
    assert [(name, data.get("state", data.get("text"))) for name, _, data in second] == [
        ("log", "cancelled"),
        ("job", "cancelled"),
    ]
    assert feed.has_ended


def test_a_listener_that_comes_back_hears_what_it_missed_and_nothing_else(database, sequence_id) -> None:
    job_id = queue_job(database, sequence_id)
    last_id = parse(events.JobFeed.after(job_id, None).poll(database))[-1][1]
    assert events.JobFeed.after(job_id, last_id).poll(database) == []
    with database.writing() as session:
        service.append_log(session, job_id, "info", "meanwhile")
    missed = parse(events.JobFeed.after(job_id, last_id).poll(database))
    assert [(name, data["text"]) for name, _, data in missed] == [("log", "meanwhile")]


def test_an_id_that_is_none_of_ours_starts_from_the_beginning(database, sequence_id) -> None:
    job_id = queue_job(database, sequence_id)
    for odd in ("", "x", "1", "-1.2", "9" * 40 + ".1", "1.2.3"):
        assert len(events.JobFeed.after(job_id, odd).poll(database)) == 2


def test_the_feed_of_all_jobs_goes_on_after_the_last_one_heard(database, sequence_id) -> None:
    first, second = queue_job(database, sequence_id), queue_job(database, sequence_id)
    feed = events.AllJobsFeed.after(None)
    heard = parse(feed.poll(database))
    assert [data["id"] for _, _, data in heard] == [str(first), str(second)]
    assert feed.poll(database) == []
    with database.writing() as session:
        service.cancel_job(session, first)
    assert [data["id"] for _, _, data in parse(feed.poll(database))] == [str(first)]
    later = events.AllJobsFeed.after(heard[-1][1])
    assert str(first) in [data["id"] for _, _, data in parse(later.poll(database))]


def test_a_stream_ends_with_its_job(database, sequence_id) -> None:
    job_id = queue_job(database, sequence_id)

    async def listen() -> list[str]:
        heard = []
        async for text in events.stream(events.JobFeed.after(job_id, None), database, lambda: False):
            heard.append(text)
            if "queued" in text:
                with database.writing() as session:
                    session.get_one(JobRow, job_id)
                    service.cancel_job(session, job_id) if '"state":"queued"' in text else None
        return heard

    heard = asyncio.run(asyncio.wait_for(listen(), 10))
    assert heard[0].startswith("retry: ")
    assert heard[-1].startswith("event: end")
    assert '"state":"cancelled"' in heard[-2]

"""Jobs by the client: started, watched to their end, and waited for no longer than was said."""

from __future__ import annotations

import time
import uuid

import pytest

from server.client import JobFailed
from server.client import Studio as Remote
from server.client import jobs as jobs_module
from server.jobs.models import JobLogRow, JobRow
from tests.server.conftest import Studio


def test_a_job_is_watched_to_its_end(remote: Remote, studio: Studio, add_recording) -> None:
    recording = add_recording("waving")
    [job] = remote.jobs.track_all([remote.recording("waving")["id"]], iterations=4)
    assert [found["id"] for found in remote.jobs.find(search="waving", state="queued")] == [job["id"]]
    heard: list[str] = []

    def hear(changed: dict) -> None:
        heard.append(changed["state"])
        with studio.database.writing() as session:
            row = session.get_one(JobRow, uuid.UUID(job["id"]))
            row.state, row.error, row.version = "failed", "no hand in sight", row.version + 1

    with pytest.raises(JobFailed, match="no hand in sight"):
        remote.jobs.wait(job["id"], hear)
    assert heard == ["queued", "failed"]
    assert "queued" in list(remote.jobs.log(job["id"]))
    assert remote.jobs.resume(job["id"])["attempt"] == 2
    with pytest.raises(TimeoutError, match="it is not finished"):
        remote.jobs.wait(job["id"], timeout=0.0)
    assert remote.jobs.cancel(job["id"])["state"] == "cancelled"
    assert job["sequence_id"] == recording["id"]


def test_a_job_that_succeeds_is_given_and_every_change_of_it_heard_once(
    remote: Remote, studio: Studio, add_recording, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(jobs_module, "POLL_SECONDS", 0.0)
    job = remote.jobs.track(add_recording()["id"], iterations=4)
    steps = iter([("running", 0.0), ("running", 0.0), ("running", 0.5), ("succeeded", 1.0)])
    heard: list[tuple[str, float]] = []

    def hear(changed: dict) -> None:
        heard.append((changed["state"], changed["progress"]))
        with studio.database.writing() as session:
            row = session.get_one(JobRow, uuid.UUID(job["id"]))
            row.state, row.progress = next(steps, (row.state, row.progress))
            row.version += 1

    assert remote.jobs.wait(job["id"], hear, timeout=20.0)["progress"] == 1.0
    assert heard == [("queued", 0.0), ("running", 0.0), ("running", 0.0), ("running", 0.5), ("succeeded", 1.0)]


def test_a_cancelled_job_is_waited_for_no_longer(remote: Remote, add_recording) -> None:
    job = remote.jobs.track(add_recording()["id"])
    remote.jobs.cancel(job["id"])
    began = time.monotonic()
    with pytest.raises(JobFailed, match=rf"^The job {job['id']} cancelled\.$") as failed:
        remote.jobs.wait(job["id"])
    assert failed.value.job["state"] == "cancelled" and time.monotonic() - began < 10.0


def test_a_log_longer_than_an_answer_is_read_to_its_end(remote: Remote, studio: Studio, add_recording) -> None:
    job = remote.jobs.track(add_recording()["id"])
    before = list(remote.jobs.log(job["id"]))
    more = [f"frame {number}" for number in range(1100)]
    with studio.database.writing() as session:
        session.add_all(
            JobLogRow(job_id=uuid.UUID(job["id"]), number=len(before) + number, level="info", text=text)
            for number, text in enumerate(more, 1)
        )
    assert list(remote.jobs.log(job["id"])) == before + more

"""Who has a recording open hears what others do in it, once, and nothing that is hidden from them."""

from __future__ import annotations

import json
import uuid
from collections.abc import Callable
from typing import Any

import pytest
from sqlalchemy import event

from server.access.models import Account
from server.jobs.models import JobRow
from server.live import watch as watching
from server.live.feed import Listener, RecordingFeed
from server.live.visits import SILENCE_SECONDS, Visit, Visits

EPOCH = "~1970-01-01T00:00:00+00:00"
Listen = Callable[..., RecordingFeed]


@pytest.fixture(autouse=True)
def _no_pause(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(watching, "LOOK_SECONDS", 0.0)


@pytest.fixture
def listen(studio: Any, project: Any) -> Listen:
    """Opens a feed as somebody does who has just loaded the labels."""

    def made(
        person: Any,
        replica: str = "",
        last_id: str | None = None,
        visit: uuid.UUID | None = None,
    ) -> RecordingFeed:
        role = {"lea": "lead", "rob": "reviewer"}.get(person.name, "annotator")
        account = Account(id=uuid.UUID(person.id), name=person.name, role=role)
        state = studio.app.state
        listener = Listener(account, replica, visit)
        return RecordingFeed.after(last_id, state.watches.of(uuid.UUID(project.sequence)), state.visits, listener)

    return made


def hear(feed: RecordingFeed, studio: Any) -> dict[str, list[Any]]:
    """What the feed has to say now, by event; ids under "ids"."""
    heard: dict[str, list[Any]] = {}
    for text in feed.poll(studio.database):
        fields = dict(line.split(": ", 1) for line in text.strip().splitlines())
        heard.setdefault(fields["event"], []).append(json.loads(fields["data"]))
        heard.setdefault("ids", []).append(fields["id"])
    return heard


def places(heard: dict[str, list[Any]]) -> list[tuple[int, int]]:
    return [(label["frame"], label["revision"]) for label in heard.get("label", [])]


def test_saves_deletions_and_key_frames_of_others_are_heard_once(studio, project, ann, bob, listen) -> None:
    ann.mark(project.sequence, 1)
    feed = listen(ann)
    first = hear(feed, studio)
    assert set(first) == {"sight", "keys", "people", "ids"}, "what was loaded before is no news"
    assert bob.mark(project.sequence, 4, 7).status_code == 200
    heard = hear(feed, studio)["label"]
    assert [(one["frame"], one["author"], one["points"][0]) for one in heard] == [(4, "bob", [7, 2, 2])]
    assert hear(feed, studio) == {}
    path = f"/sequences/{project.sequence}/annotations/cam0/4/right"
    assert bob.send("DELETE", path, revision=1).status_code == 204
    bob.send("PUT", f"/sequences/{project.sequence}/key-frames/cam0/4/right")
    heard = hear(feed, studio)
    assert [(one["points"], one["revision"]) for one in heard["label"]] == [(None, 2)]
    assert heard["keys"] == [{"items": [{"frame": 4, "camera": "cam0", "hand": "right"}]}]
    bob.send("DELETE", f"/sequences/{project.sequence}/key-frames/cam0/4/right")
    assert hear(feed, studio)["keys"] == [{"items": []}]


def test_who_comes_back_hears_what_was_missed(studio, project, ann, bob, listen) -> None:
    feed = listen(ann)
    last_id = hear(feed, studio)["ids"][-1]
    feed.close()
    bob.mark(project.sequence, 2)
    studio.app.state.watches.__init__()  # the server was started anew meanwhile
    assert places(hear(listen(ann, last_id=last_id), studio)) == [(2, 1)]
    assert places(hear(listen(ann, last_id=EPOCH), studio)) == [(2, 1)]
    assert places(hear(listen(ann), studio)) == []
    for odd in ("", "x", "~", "~2026", "~~", "9" * 99):
        assert places(hear(listen(ann, last_id=odd), studio)) == []


def test_who_was_too_slow_for_the_watch_looks_up_what_it_forgot(studio, project, ann, bob, listen, monkeypatch) -> None:
    slow, other = listen(ann), listen(bob)
    for feed in (slow, other):
        hear(feed, studio)
    monkeypatch.setattr(watching, "KEPT_CHANGES", 1)
    for frame in (1, 2, 3):
        bob.mark(project.sequence, frame)
        hear(other, studio)
    assert [frame for frame, _ in places(hear(slow, studio))] == [1, 2, 3]


def test_fifty_who_listen_cost_the_database_what_one_does(studio, project, ann, listen, monkeypatch) -> None:
    feeds = [listen(ann) for _ in range(50)]
    for feed in feeds:
        hear(feed, studio)
    monkeypatch.setattr(watching, "LOOK_SECONDS", 60.0)
    asked: list[str] = []
    event.listen(studio.database.engine, "before_cursor_execute", lambda *args: asked.append(args[2]))
    for feed in feeds:
        hear(feed, studio)
    assert asked == []
    assert all(feed.is_quiet() for feed in feeds), "and no thread"
    feeds[0].visits.put(uuid.uuid4(), Visit(uuid.UUID(project.sequence), uuid.uuid4(), "zoe", "cam0", 1, "right"))
    assert not any(feed.is_quiet() for feed in feeds)


def test_what_fifty_hear_is_written_once(studio, project, ann, bob, listen, monkeypatch) -> None:
    feeds = [listen(ann) for _ in range(50)]
    for feed in feeds:
        hear(feed, studio)
    written: list[int] = []
    write = watching.LabelChange.model_dump_json

    def note(label: watching.LabelChange) -> str:
        written.append(label.frame)
        return write(label)

    monkeypatch.setattr(watching.LabelChange, "model_dump_json", note)
    bob.mark(project.sequence, 4, 7)
    assert [places(hear(feed, studio)) for feed in feeds] == [[(4, 1)]] * 50
    assert written == [4]


def test_a_job_is_heard_of_by_everybody_and_asked_for_only_when_one_has_changed(studio, project, ann, listen) -> None:
    feeds = [listen(ann) for _ in range(2)]
    for feed in feeds:
        assert "job" not in hear(feed, studio)
    job = JobRow(kind="track", params={}, sequence_id=uuid.UUID(project.sequence))
    with studio.database.writing() as session:
        session.add(job)
    for feed in feeds:
        assert [one["id"] for one in hear(feed, studio)["job"]] == [str(job.id)]
        assert "job" not in hear(feed, studio)
    with studio.database.writing() as session:
        session.get_one(JobRow, job.id).version += 1
    for feed in feeds:
        assert [one["id"] for one in hear(feed, studio)["job"]] == [str(job.id)]


def test_who_marks_blindly_hears_of_their_own_version_only(studio, project, ann, bob, lead, listen) -> None:
    shared = listen(ann)
    hear(shared, studio)
    made = project.replicate([ann, bob], [2, 5])
    own = {person.name: person.get("/assignments", mine=True)["items"][0]["id"] for person in (ann, bob)}
    lead.mark(project.sequence, 2)
    lead.mark(project.sequence, 3)
    heard = hear(shared, studio)
    assert places(heard) == [(3, 1)], "frame 2 is marked blindly, from the moment on that it was given"
    assert len(heard["sight"]) == 1
    assert len(heard["work"]) == 1
    mine, theirs = listen(ann, own["ann"]), listen(bob, own["bob"])
    for feed in (mine, theirs):
        hear(feed, studio)
    visit = Visit(uuid.UUID(project.sequence), uuid.UUID(lead.id), "lea", "cam0", 3, "right")
    studio.app.state.visits.put(uuid.uuid4(), visit)
    assert ann.mark(project.sequence, 2, 5, replica=own["ann"]).status_code == 200
    assert places(hear(mine, studio)) == [(2, 1)]
    assert hear(theirs, studio) == {}
    assert places(hear(shared, studio)) == []
    assert hear(listen(lead), studio)["people"] == [{"items": []}]
    path = f"/sequences/{project.sequence}/live"
    assert bob.send("GET", path, params={"replica": own["ann"]}).status_code == 403
    lead.send("DELETE", f"/replica-sets/{made['id']}")
    assert hear(mine, studio) == {}
    assert mine.has_ended, "the replica was withdrawn"
    assert len(hear(shared, studio)["sight"]) == 1, "what was hidden is to be loaded"


def test_assignments_and_comments_are_heard_of(studio, project, ann, reviewer, listen) -> None:
    feed = listen(ann)
    hear(feed, studio)
    given = project.assign(ann, 0, 3)
    assert hear(feed, studio)["work"] == [{}]
    ann.act(given, "submit")
    assert hear(feed, studio)["work"] == [{}]
    said = reviewer.make(f"/assignments/{given['id']}/comments", text="Look again.")
    assert hear(feed, studio)["work"] == [{}]
    ann.send("POST", f"/assignments/{given['id']}/comments/{said['id']}/resolve")
    assert hear(feed, studio)["work"] == [{}]
    assert hear(feed, studio) == {}


def test_a_deleted_recording_and_a_stranger_end_the_stream(studio, project, ann, lead, listen) -> None:
    feed = listen(ann)
    hear(feed, studio)
    path = f"/sequences/{project.sequence}/live"
    assert ann.send("GET", path, params={"reader": lead.id}).json()["error"] == "OtherAccountError"
    assert ann.send("GET", f"/sequences/{uuid.uuid4()}/live").status_code == 404
    assert lead.send("DELETE", f"/sequences/{project.sequence}").status_code < 300
    hear(feed, studio)
    assert feed.has_ended


def test_everybody_else_who_is_here_is_named_and_gone_when_they_leave(studio, project, ann, bob, listen) -> None:
    feed = listen(ann)
    assert hear(feed, studio)["people"] == [{"items": []}]
    page = uuid.uuid4()
    his = listen(bob, visit=page)
    body = {"camera": "cam0", "frame": 6, "hand": "left"}
    assert bob.send("PUT", f"/sequences/{project.sequence}/visits/{page}", body).status_code == 204
    assert hear(feed, studio)["people"] == [{"items": [{"name": "bob", "camera": "cam0", "frame": 6, "hand": "left"}]}]
    assert hear(feed, studio) == {}
    assert hear(his, studio)["people"] == [{"items": []}], "nobody is told of themselves"
    for odd in ({**body, "frame": 99}, {**body, "camera": "cam9"}):
        assert bob.send("PUT", f"/sequences/{project.sequence}/visits/{page}", odd).status_code == 404
    his.close()
    assert hear(feed, studio)["people"] == [{"items": []}]


def test_a_page_that_falls_silent_has_gone_and_nobody_fills_the_memory() -> None:
    time = [0.0]
    visits = Visits(lambda: time[0])
    sequence, bob, ann = uuid.uuid4(), uuid.uuid4(), uuid.uuid4()
    for frame in range(100):
        visits.put(uuid.uuid4(), Visit(sequence, bob, "bob", "cam0", frame, "right"))
    assert len(visits._visits) == 30
    assert [visit.frame for visit in visits.find_others(sequence, ann)] == [99]
    time[0] = SILENCE_SECONDS + 1
    assert visits.find_others(sequence, ann) == []
    assert visits._visits == {}

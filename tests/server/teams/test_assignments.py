"""Work goes from open to accepted, and what was handed in stays as it is."""

from __future__ import annotations

import uuid
from concurrent.futures import ThreadPoolExecutor
from threading import Barrier
from typing import Any

from sqlalchemy import select

from server.access.models import AuditRow


def find_acts(studio: Any, subject_id: str) -> list[str]:
    with studio.database.reading() as session:
        query = select(AuditRow.act).where(AuditRow.subject_id == uuid.UUID(subject_id)).order_by(AuditRow.time)
        return list(session.scalars(query))


def test_work_goes_from_open_to_accepted_and_every_act_is_recorded(studio, project, ann, reviewer) -> None:
    given = project.assign(ann, 0, 3, note="both thumbs, please")
    assert (given["state"], given["frames"], given["frames_done"], given["next_frame"]) == ("open", 4, 0, 0)
    for frame in (0, 1):
        assert ann.mark(project.sequence, frame).status_code == 200
    [mine] = ann.get("/assignments", mine=True)["items"]
    assert (mine["frames_done"], mine["next_frame"], mine["note"]) == (2, 2, "both thumbs, please")

    assert ann.act(given, "submit")["state"] == "submitted"
    returned = reviewer.act(given, "return", {"text": "The wrist of frame 1 is on the sleeve."})
    assert (returned["state"], returned["reviewer"], returned["open_comments"]) == ("returned", "rob", 1)
    [comment] = ann.get(f"/assignments/{given['id']}/comments")["items"]
    assert (comment["author"], comment["text"]) == ("rob", "The wrist of frame 1 is on the sleeve.")
    assert ann.mark(project.sequence, 2).status_code == 200, "returned work is open again"
    ann.act(given, "submit")
    assert reviewer.act(given, "accept")["state"] == "accepted"
    assert find_acts(studio, given["id"]) == [
        "assignment.create",
        "assignment.submit",
        "assignment.return",
        "assignment.submit",
        "assignment.accept",
    ]


def test_what_was_handed_in_is_locked(project, ann, reviewer, lead) -> None:
    given = project.assign(ann, 0, 3)
    made = ann.mark(project.sequence, 1)
    ann.act(given, "submit")
    place = f"/sequences/{project.sequence}/annotations/cam0/1/right"
    change = {"points": [[5, 5, 2]] * 21, "operation_id": str(uuid.uuid4())}
    back = {"operation_id": str(uuid.uuid4())}

    def attempts(person: Any) -> list[tuple[int, str]]:
        answers = [
            person.send("PUT", place, change, revision=1),
            person.send("DELETE", place, revision=1),
            person.send("POST", f"{place}/history/1/restore", back, revision=1),
            person.mark(project.sequence, 2),
        ]
        return [(answer.status_code, answer.json().get("error", "") if answer.content else "") for answer in answers]

    assert attempts(ann) == [(403, "LockedError")] * 4
    assert ann.get(place) == made.json()
    assert ann.mark(project.sequence, 4).status_code == 200, "frames beside it are free"
    corrected = {"points": [[6, 6, 2]] * 21, "operation_id": str(uuid.uuid4())}
    assert reviewer.send("PUT", place, corrected, revision=1).json()["author"] == "rob"
    reviewer.act(given, "accept")
    for person in (ann, reviewer, lead):
        assert attempts(person) == [(403, "LockedError")] * 4
    assert ann.get(place)["revision"] == 2


def test_a_save_whose_answer_was_lost_is_answered_although_the_work_was_submitted_since(project, ann) -> None:
    given = project.assign(ann, 0, 3)
    body = {"points": [[1, 2, 2]] * 21, "operation_id": str(uuid.uuid4())}
    place, first = f"/sequences/{project.sequence}/annotations/cam0/1/right", {"If-None-Match": "*"}
    made = ann.send("PUT", place, body, headers=first)
    ann.act(given, "submit")
    assert ann.send("PUT", place, body, headers=first).json() == made.json()


def test_frames_of_others_are_theirs(project, ann, bob, reviewer) -> None:
    project.assign(ann, 0, 3)
    refused = bob.mark(project.sequence, 2)
    assert (refused.status_code, refused.json()["error"]) == (403, "NotYoursError")
    assert "ann" in refused.json()["detail"]
    assert bob.mark(project.sequence, 7).status_code == 200, "nobody was given this one"
    assert reviewer.mark(project.sequence, 2).status_code == 200


def test_no_frame_is_given_to_two(project, ann, bob, lead) -> None:
    given = project.assign(ann, 2, 5)
    body = {"sequence_id": project.sequence, "account_id": bob.id, "frame_first": 5, "frame_last": 8}
    assert lead.send("POST", f"/projects/{project.id}/assignments", body).status_code == 409
    assert lead.send("POST", f"/projects/{project.id}/assignments", body | {"frame_last": 12}).status_code == 422
    assert lead.send("DELETE", f"/assignments/{given['id']}", revision=given["revision"]).status_code == 204
    project.assign(bob, 5, 8)
    back = lead.send("POST", f"/assignments/{given['id']}/restore")
    assert (back.status_code, "bob" in back.json()["detail"]) == (409, True)


def test_two_leads_at_once_do_not_give_one_frame_to_two(project, ann, bob, lead) -> None:
    together = Barrier(6)

    def work(person: Any) -> int:
        body = {"sequence_id": project.sequence, "account_id": person.id, "frame_first": 0, "frame_last": 9}
        together.wait()
        return lead.send("POST", f"/projects/{project.id}/assignments", body).status_code

    with ThreadPoolExecutor(6) as pool:
        assert sorted(pool.map(work, [ann, bob] * 3)) == [201] + [409] * 5


def test_nothing_slips_in_after_a_submission(project, ann) -> None:
    """Of marks and a submission that run at once, every acknowledged mark was made before it."""
    given = project.assign(ann, 0, 11)
    together = Barrier(7)

    def mark(frame: int) -> tuple[int, str]:
        together.wait()
        answer = ann.mark(project.sequence, frame)
        return answer.status_code, answer.json().get("updated_at", "")

    def submit(_: int) -> tuple[int, str]:
        together.wait()
        answer = ann.send("POST", f"/assignments/{given['id']}/submit", revision=1)
        return answer.status_code, answer.json()["updated_at"]

    with ThreadPoolExecutor(7) as pool:
        marks = [pool.submit(mark, frame) for frame in range(6)]
        status, at = pool.submit(submit, 0).result()
    assert status == 200
    answers = [one.result() for one in marks]
    assert {code for code, _ in answers} <= {200, 403}
    assert all(made < at for code, made in answers if code == 200)


def test_who_is_late_gets_the_assignment_as_it_is_now(project, ann, reviewer) -> None:
    given = project.assign(ann, 0, 3)
    assert ann.send("POST", f"/assignments/{given['id']}/submit").status_code == 428
    ann.act(given, "submit")
    late = ann.send("POST", f"/assignments/{given['id']}/submit", revision=1)
    assert (late.status_code, late.json()["theirs"]["state"]) == (409, "submitted")
    assert reviewer.send("POST", f"/assignments/{given['id']}/accept", revision=1).status_code == 409
    assert ann.get(f"/assignments/{given['id']}")["state"] == "submitted"


def test_roles_say_who_may_do_what(project, ann, bob, join, lead) -> None:
    given = project.assign(ann, 0, 3)
    path = f"/assignments/{given['id']}"
    assert bob.send("POST", f"{path}/submit", revision=1).status_code == 403
    ann.act(given, "submit")
    for person, act in ((ann, "accept"), (bob, "accept"), (ann, "return")):
        assert person.send("POST", f"{path}/{act}", {"text": "no"}, revision=2).status_code == 403
    assert bob.send("GET", f"{path}/comments").status_code == 403
    assert bob.send("POST", f"{path}/comments", {"text": "hm"}).status_code == 403
    assert ann.send("POST", "/projects", {"name": "Mine"}).status_code == 403
    assert ann.send("DELETE", path, revision=2).status_code == 403
    own = join("rita", "reviewer")
    hers = project.assign(own, 6, 7)
    own.act(hers, "submit")
    refused = own.send("POST", f"/assignments/{hers['id']}/accept", revision=2)
    assert (refused.status_code, "own work" in refused.json()["detail"]) == (403, True)
    assert lead.act(hers, "accept")["state"] == "accepted"


def test_states_come_in_their_order(project, ann, reviewer) -> None:
    given = project.assign(ann, 0, 3)
    path = f"/assignments/{given['id']}"
    assert reviewer.send("POST", f"{path}/accept", revision=1).status_code == 409
    assert reviewer.send("POST", f"{path}/return", {"text": "why"}, revision=1).status_code == 409
    ann.act(given, "submit")
    assert ann.send("POST", f"{path}/submit", revision=2).status_code == 409
    nothing = reviewer.send("POST", f"{path}/return", {}, revision=2)
    assert (nothing.status_code, "Say what" in nothing.json()["detail"]) == (422, True)
    reviewer.act(given, "accept")
    assert reviewer.act(given, "return", {"text": "Frame 2 after all."})["state"] == "returned"


def test_comments_stand_at_places_and_are_resolved(project, ann, reviewer) -> None:
    given = project.assign(ann, 0, 3)
    path = f"/assignments/{given['id']}/comments"
    place = {"camera": "cam0", "frame": 2, "hand": "left", "joint": 8}
    made = reviewer.make(path, text="This tip is hidden.", **place)
    assert {name: made[name] for name in place} == place
    reviewer.make(path, text="Thanks!")
    assert ann.send("POST", f"{path}/{made['id']}/resolve").json()["resolved_by"] == "ann"
    assert ann.get(f"/assignments/{given['id']}")["open_comments"] == 1
    assert reviewer.send("POST", f"{path}/{made['id']}/reopen").json()["resolved_at"] is None
    page = ann.get(path, limit=1)
    rest = ann.get(path, limit=1, cursor=page["next_cursor"])
    assert [item["text"] for item in (*page["items"], *rest["items"])] == ["This tip is hidden.", "Thanks!"]


WRONG_COMMENTS: tuple[dict[str, Any], ...] = (
    {"text": "  "},
    {"text": "a\x00b"},
    {"text": "x", "frame": 4},
    {"text": "x", "frame": 1, "camera": "cam9"},
    {"text": "x", "frame": 1, "camera": "cam0", "hand": "third"},
    {"text": "x", "frame": 1, "camera": "cam0", "joint": 3},
    {"text": "x", "frame": 1, "camera": "cam0", "hand": "left", "joint": 21},
    {"text": "x", "hand": "left"},
    {"text": "x" * 4001},
)


def test_comments_that_make_no_sense_are_refused(project, ann) -> None:
    given = project.assign(ann, 0, 3)
    path = f"/assignments/{given['id']}/comments"
    for wrong in WRONG_COMMENTS:
        assert ann.send("POST", path, wrong).status_code in (404, 422), wrong
    assert ann.get(path)["items"] == []


def test_a_lead_changes_whose_work_it_is_unless_it_was_handed_in(project, ann, bob, lead) -> None:
    given = project.assign(ann, 0, 3)
    path = f"/assignments/{given['id']}"
    changed = lead.send("PATCH", path, {"account_id": bob.id, "frame_last": 5}, revision=1).json()
    assert (changed["account"], changed["frame_last"], changed["frames"]) == ("bob", 5, 6)
    assert lead.send("PATCH", path, {"account_id": str(uuid.uuid4())}, revision=2).status_code == 422
    backwards = lead.send("PATCH", path, {"frame_first": 6}, revision=2)
    assert backwards.status_code == 422
    assert "Frames 6 to 5 are not valid" in backwards.json()["detail"]
    bob.act(given, "submit")
    assert lead.send("PATCH", path, {"account_id": ann.id}, revision=3).status_code == 409
    assert lead.send("PATCH", path, {"note": "well done"}, revision=3).json()["note"] == "well done"

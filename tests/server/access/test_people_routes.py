"""`/accounts` and `/audit`: who is told of people, what of them, and what the trail is asked by."""

from __future__ import annotations

import uuid

import pytest

from tests.server.access.conftest import Lab

ACCOUNTS = "/api/v1/accounts"


@pytest.fixture
def database_kind() -> str:
    return "sqlite"


def test_the_list_says_who_may_be_managed_by_whoever_asks(lab: Lab) -> None:
    lab.add("Ann", "annotator")
    lab.add("Rob", "reviewer")
    lead, admin = lab.person("lead", "Lea"), lab.person("admin", "Root")
    told = {one["name"]: one for one in admin.get(ACCOUNTS).json()["items"]}
    assert list(told) == ["Ann", "Lea", "local", "Rob", "Root"]
    assert {name for name, one in told.items() if one["may_manage"]} == {"Ann", "Lea", "Rob"}
    assert {name for name, one in told.items() if one["is_local"]} == {"local"}
    assert {name for name, one in told.items() if one["last_seen_at"]} == {"Lea", "Root"}
    assert {name for name, one in told.items() if not one["has_password"]} == {"local"}
    seen_by_lead = {one["name"]: one["may_manage"] for one in lead.get(ACCOUNTS).json()["items"]}
    assert {name for name, may in seen_by_lead.items() if may} == {"Ann", "Rob"}


def test_a_change_answers_with_the_revision_that_the_next_one_needs(lab: Lab) -> None:
    admin = lab.person("admin", "Root")
    person = admin.post(ACCOUNTS, json={"name": "Ann"}).json()["person"]
    assert (person["role"], person["revision"], person["is_disabled"]) == ("annotator", 1, False)
    address, etag = f"{ACCOUNTS}/{person['id']}", '"1"'
    for number, change in enumerate(({"role": "lead"}, {"is_disabled": True}, {}), 2):
        answer = admin.patch(address, json=change, headers={"If-Match": etag})
        assert answer.status_code == 200, answer.text
        assert answer.json()["revision"] == number and answer.headers["ETag"] == f'"{number}"'
        etag = answer.headers["ETag"]
    late = admin.patch(address, json={"role": "reviewer"}, headers={"If-Match": '"2"'})
    assert late.status_code == 409 and late.headers["ETag"] == etag and "revision 4 now, not 2" in late.json()["detail"]
    unknown = admin.patch(f"{ACCOUNTS}/{uuid.uuid4()}", json={}, headers={"If-Match": etag})
    assert unknown.status_code == 404 and unknown.json()["detail"] == "There is no such account."


def test_the_trail_is_narrowed_by_act_and_thing_and_names_who_it_was(lab: Lab) -> None:
    lead = lab.person("lead", "Lea")
    person = lead.post(ACCOUNTS, json={"name": "Ann"}).json()["person"]
    lead.post(f"{ACCOUNTS}/{person['id']}/code")
    lines = lead.get("/api/v1/audit", params={"subject_id": person["id"]}).json()["items"]
    assert [(line["account"], line["act"], line["subject"]) for line in lines] == [
        ("Lea", "account.code", "account"),
        ("Lea", "account.add", "account"),
    ]
    assert lines[1]["detail"] == {"name": "Ann", "role": "annotator"}
    only = lead.get("/api/v1/audit", params={"act": "account.code", "subject": "account"}).json()
    assert [line["id"] for line in only["items"]] == [lines[0]["id"]] and only["next_cursor"] is None
    for act in ("account%", "a" * 61, "Account"):
        assert lead.get("/api/v1/audit", params={"act": act}).status_code == 422

"""People: added, given roles, shut out; and the trail of it."""

from __future__ import annotations

import pytest
from fastapi.testclient import TestClient

from server.access.models import LOCAL_ACCOUNT_ID
from tests.server.access.conftest import Lab

ACCOUNTS = "/api/v1/accounts"


def find(client: TestClient, name: str) -> dict:
    return next(person for person in client.get(ACCOUNTS).json()["items"] if person["name"] == name)


def change(client: TestClient, person: dict, **what: object):
    etag = {"If-Match": f'"{person["revision"]}"'}
    return client.patch(f"{ACCOUNTS}/{person['id']}", json=what, headers=etag)


def test_a_lead_manages_those_below_and_nobody_else(lab: Lab) -> None:
    lab.add("Anna")
    lab.add("Root", "admin")
    lab.add("Lea", "lead")
    lead = lab.person("lead", "Lou")
    assert change(lead, find(lead, "Anna"), role="reviewer").json()["role"] == "reviewer"
    assert change(lead, find(lead, "Anna"), role="lead").status_code == 403
    for name in ("Root", "Lea", "Lou", "local"):
        person = find(lead, name)
        assert not person["may_manage"]
        assert change(lead, person, role="annotator").status_code == 403
        # a lead who could reset an admin's password would be one
        assert lead.post(f"{ACCOUNTS}/{person['id']}/code").status_code == 403
    assert lead.post(ACCOUNTS, json={"name": "Max", "role": "admin"}).status_code == 403
    assert lead.post(ACCOUNTS, json={"name": "Max", "role": "reviewer"}).status_code == 201


def test_annotators_and_reviewers_see_no_people(lab: Lab) -> None:
    for role in ("annotator", "reviewer"):
        client = lab.person(role)
        assert client.get(ACCOUNTS).status_code == 403
        assert client.get("/api/v1/audit").status_code == 403
        assert client.post(ACCOUNTS, json={"name": "Max"}).status_code == 403


def test_a_change_on_an_old_revision_is_told_so(lab: Lab) -> None:
    lab.add("Anna")
    first, second = lab.person("admin", "First"), lab.person("admin", "Second")
    seen = find(first, "Anna")
    assert change(first, seen, role="reviewer").status_code == 200
    assert change(second, seen, role="lead").status_code == 409
    assert second.patch(f"{ACCOUNTS}/{seen['id']}", json={"role": "lead"}).status_code == 428
    assert find(second, "Anna")["role"] == "reviewer"


def test_who_is_disabled_is_out_at_once_and_keeps_their_work(lab: Lab) -> None:
    anna = lab.browser(lab.add("Anna"))
    token = anna.post("/api/v1/account/tokens", json={"name": "t"}).json()["secret"]
    admin = lab.person("admin")
    assert change(admin, find(admin, "Anna"), is_disabled=True).json()["is_disabled"]
    assert anna.get("/api/v1/account").status_code == 401
    assert lab.nobody.get("/api/v1/account", headers={"Authorization": f"Bearer {token}"}).status_code == 401
    assert not change(admin, find(admin, "Anna"), is_disabled=False).json()["is_disabled"]
    assert lab.nobody.get("/api/v1/account", headers={"Authorization": f"Bearer {token}"}).status_code == 200


def test_nobody_changes_their_own_role_and_the_last_admin_stays(lab: Lab) -> None:
    admin = lab.person("admin", "Root")
    assert change(admin, find(admin, "Root"), is_disabled=True).status_code == 403
    other = lab.person("admin", "Other")
    assert change(other, find(other, "Root"), role="lead").status_code == 200
    assert change(admin, find(other, "Other"), role="lead").status_code == 403
    assert str(LOCAL_ACCOUNT_ID) == find(other, "local")["id"]


@pytest.mark.parametrize(
    "name", ["", " ", "a\nb", "<script>alert(1)</script>", "a\u202eb", "\u200b", "x" * 81, "a  b", "../../etc", "a\0b"]
)
def test_a_name_that_could_be_taken_for_something_else_is_refused(lab: Lab, name: str) -> None:
    admin = lab.person("admin")
    assert admin.post(ACCOUNTS, json={"name": name}).status_code == 422


def test_two_people_have_two_names(lab: Lab) -> None:
    admin = lab.person("admin")
    assert admin.post(ACCOUNTS, json={"name": "Jürgen O'Neil-Ağaoğlu"}).status_code == 201
    assert admin.post(ACCOUNTS, json={"name": "Anna"}).status_code == 201
    for name in ("Anna", "anna", " Anna ", "\uff21nna"):  # the last begins with a full-width A
        assert admin.post(ACCOUNTS, json={"name": name}).status_code == 409


def test_the_list_of_people_is_paged(lab: Lab) -> None:
    admin = lab.person("admin", "Root")
    for n in range(5):
        lab.add(f"Person {n}")
    names, cursor = [], None
    while True:
        page = admin.get(ACCOUNTS, params={"limit": 2} | ({"cursor": cursor} if cursor else {})).json()
        names += [person["name"] for person in page["items"]]
        cursor = page["next_cursor"]
        if cursor is None:
            break
    assert names == ["local", *(f"Person {n}" for n in range(5)), "Root"]


def test_the_trail_says_who_did_what(lab: Lab) -> None:
    admin = lab.person("admin", "Root")
    made = admin.post(ACCOUNTS, json={"name": "Anna"}).json()["person"]
    change(admin, made, role="reviewer")
    change(admin, find(admin, "Anna"), is_disabled=True)
    lines = admin.get("/api/v1/audit", params={"subject_id": made["id"]}).json()["items"]
    assert [(line["account"], line["act"]) for line in lines] == [
        ("Root", "account.disable"),
        ("Root", "account.role"),
        ("Root", "account.add"),
    ]
    assert lines[1]["detail"] == {"before": "annotator", "after": "reviewer"}
    me = admin.get("/api/v1/account").json()["id"]
    mine = admin.get("/api/v1/audit", params={"account_id": me, "act": "account", "limit": 2}).json()
    rest = admin.get("/api/v1/audit", params={"account_id": me, "cursor": mine["next_cursor"]}).json()
    acts = [line["act"] for line in mine["items"] + rest["items"]]
    assert acts == ["account.disable", "account.role", "account.add", "account.login"]
    assert "four words" not in str(lines)

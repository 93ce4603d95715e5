"""`/accounts` and `/audit`, for leads and admins."""

from __future__ import annotations

import uuid
from typing import Annotated

from fastapi import APIRouter, Depends, Query, Response

from server.access import logins, people
from server.access.audit import AuditFilter, list_acts, record_act
from server.access.models import LOCAL_ACCOUNT_ID, Account
from server.access.schemas import AuditLine, CodeOut, PersonAdded, PersonIn, PersonOut, PersonPatch
from server.access.service import LeadAccount, find_names, require_person
from server.database import SessionDep
from server.database.paging import Cursor, Limit, Page
from server.database.revision import IfMatch, read_if_match, write_etag
from server.errors import error_responses

router = APIRouter(tags=["accounts"], dependencies=[Depends(require_person)], responses=error_responses())
Word = Annotated[str | None, Query(max_length=60, pattern=r"^[a-z_.]+$")]


def _describe(session: SessionDep, rows: list[Account], lead: Account) -> list[PersonOut]:
    seen = people.find_last_seen(session, [row.id for row in rows])
    return [
        PersonOut(
            id=row.id,
            name=row.name,
            role=row.role,
            revision=row.revision,
            created_at=row.created_at,
            last_seen_at=seen.get(row.id),
            has_password=row.password_hash is not None,
            is_disabled=row.disabled_at is not None,
            is_local=row.id == LOCAL_ACCOUNT_ID,
            may_manage=row.id not in (LOCAL_ACCOUNT_ID, lead.id) and people.may_manage(lead, row.role),
        )
        for row in rows
    ]


@router.get("/accounts")
def list_accounts(lead: LeadAccount, session: SessionDep, cursor: Cursor = None, limit: Limit = 100) -> Page[PersonOut]:
    """Everybody, by name."""
    rows, next_cursor = people.list_accounts(session, cursor, limit)
    return Page(items=_describe(session, rows, lead), next_cursor=next_cursor)


@router.post("/accounts", status_code=201, responses=error_responses(409))
def create_account(body: PersonIn, lead: LeadAccount, session: SessionDep) -> PersonAdded:
    """Add somebody. The answer holds the code with which they set their password; it is not shown again."""
    account = people.add_account(session, lead, body.name, body.role)
    code, expires_at = logins.make_code(session, account.id)
    return PersonAdded(person=_describe(session, [account], lead)[0], code=CodeOut(code=code, expires_at=expires_at))


@router.patch("/accounts/{account_id}", responses=error_responses(404, 409, 428))
def change_account(
    account_id: uuid.UUID,
    body: PersonPatch,
    lead: LeadAccount,
    session: SessionDep,
    response: Response,
    if_match: IfMatch = None,
) -> PersonOut:
    """Change a role, or disable or enable an account. The work of the person is kept."""
    expected = read_if_match(if_match)
    was_admin = people.get_managed(session, lead, account_id).role == "admin"
    account = people.change_account(session, lead, account_id, expected, body.role, body.is_disabled)
    if was_admin:
        people.check_an_admin_is_left(session)
    response.headers["ETag"] = write_etag(account.revision)
    return _describe(session, [account], lead)[0]


@router.post("/accounts/{account_id}/code", status_code=201, responses=error_responses(404))
def create_code(account_id: uuid.UUID, lead: LeadAccount, session: SessionDep) -> CodeOut:
    """A one-time code for somebody who forgot the password. The old password counts until the code is used."""
    account = people.get_managed(session, lead, account_id)
    code, expires_at = logins.make_code(session, account.id)
    record_act(session, lead.id, "account.code", "account", account.id)
    return CodeOut(code=code, expires_at=expires_at)


@router.get("/audit")
def list_audit(
    _lead: LeadAccount,
    session: SessionDep,
    account_id: uuid.UUID | None = None,
    act: Word = None,
    subject: Word = None,
    subject_id: uuid.UUID | None = None,
    cursor: Cursor = None,
    limit: Limit = 100,
) -> Page[AuditLine]:
    """Who did what, the newest first. `act=assignment` finds all acts on assignments."""
    rows, next_cursor = list_acts(session, AuditFilter(account_id, act, subject, subject_id), cursor, limit)
    names = find_names(session, [row.account_id for row in rows])
    items = [
        AuditLine(
            id=row.id,
            time=row.time,
            account_id=row.account_id,
            account=names.get(row.account_id),
            act=row.act,
            subject=row.subject,
            subject_id=row.subject_id,
            detail=row.detail,
        )
        for row in rows
    ]
    return Page(items=items, next_cursor=next_cursor)

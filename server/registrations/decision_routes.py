"""Decisions about registrations, and `/curation`."""

from __future__ import annotations

import uuid
from datetime import UTC, datetime, time
from typing import Annotated

from fastapi import APIRouter, Query, Response
from pydantic import AwareDatetime, BeforeValidator

from server.access.audit import record_act
from server.access.service import AccountIdDep, CurrentAccount, LeadAccount, ReviewerAccount
from server.database import SessionDep, utc_now
from server.database.paging import Cursor, Limit, Page
from server.errors import error_responses
from server.registrations import decisions as service
from server.registrations import review
from server.registrations.decision_models import DecisionRow
from server.registrations.decision_schemas import (
    REASONS,
    DecisionDone,
    DecisionMake,
    DecisionOut,
    DecisionUndo,
    ReasonOut,
    ReviewAgreement,
    SecondReviewAsk,
    SecondReviewAsked,
    Throughput,
)
from server.registrations.models import RegistrationRow
from server.registrations.service import describe_registrations, get_registration

router = APIRouter(tags=["curation"], responses=error_responses())


@router.post(
    "/registrations/{registration_id}/decisions",
    status_code=201,
    responses={200: {"model": DecisionDone}, **error_responses(404)},
)
def make_decision(
    registration_id: uuid.UUID, body: DecisionMake, session: SessionDep, account: ReviewerAccount, response: Response
) -> DecisionDone:
    """Accept, reject or be unsure. The same operation sent again is answered by 200 and what it made at first."""
    decision, row, is_new = service.decide(session, registration_id, account.id, body)
    response.status_code = 201 if is_new else 200
    return _describe(session, decision, row, account.id)


@router.get("/registrations/{registration_id}/decisions", responses=error_responses(404))
def list_registration_decisions(
    registration_id: uuid.UUID, session: SessionDep, account_id: AccountIdDep, cursor: Cursor = None, limit: Limit = 100
) -> Page[DecisionOut]:
    """Everything that was decided about a registration, the newest first; without what is hidden from you."""
    get_registration(session, registration_id)
    rows, next_cursor = service.list_decisions(session, None, registration_id, account_id, cursor, limit)
    return Page(items=service.describe_decisions(session, rows), next_cursor=next_cursor)


@router.get("/decisions")
def list_decisions(
    session: SessionDep,
    account: CurrentAccount,
    account_id: Annotated[uuid.UUID | None, Query(description="Whose.")] = None,
    cursor: Cursor = None,
    limit: Limit = 100,
) -> Page[DecisionOut]:
    """Decisions, the newest first; without what is hidden from you."""
    rows, next_cursor = service.list_decisions(session, account_id, None, account.id, cursor, limit)
    return Page(items=service.describe_decisions(session, rows), next_cursor=next_cursor)


@router.post(
    "/decisions/{decision_id}/undo",
    status_code=201,
    responses={200: {"model": DecisionDone}, **error_responses(404, 409)},
)
def undo_decision(
    decision_id: uuid.UUID, body: DecisionUndo, session: SessionDep, account: ReviewerAccount, response: Response
) -> DecisionDone:
    """Undo your own decision; the one before it counts again. Both stay in the history."""
    decision, row, is_new = service.undo(session, decision_id, account.id, body.operation_id)
    response.status_code = 201 if is_new else 200
    return _describe(session, decision, row, account.id)


@router.get("/curation/reasons")
def list_reasons() -> Page[ReasonOut]:
    """Reasons to reject, in the order of their keys."""
    items = [ReasonOut(name=name, label=label, key=str(n)) for n, (name, label) in enumerate(REASONS.items(), 1)]
    return Page(items=items, next_cursor=None)


def _check_moment(text: str) -> str:
    if "T" not in text.upper():  # pydantic takes a number for seconds since 1970
        raise ValueError("needed a day, a time and their zone, as in 2026-01-31T00:00:00Z")
    return text


Moment = Annotated[AwareDatetime, BeforeValidator(_check_moment)]


@router.get("/curation/throughput")
def get_throughput(
    session: SessionDep,
    since: Annotated[Moment | None, Query(description="Left out: midnight UTC.")] = None,
) -> Throughput:
    """How many registrations everybody decided about, and how fast."""
    since = since or datetime.combine(utc_now().date(), time(), UTC)
    return review.measure_throughput(session, since)


@router.get("/curation/agreement")
def get_review_agreement(
    session: SessionDep, collection: Annotated[str | None, Query(max_length=200)] = None
) -> ReviewAgreement:
    """How people agree who decided about the same registrations without seeing each other's decisions."""
    return review.measure_agreement(session, collection)


@router.post("/curation/second-reviews")
def ask_second_review(body: SecondReviewAsk, session: SessionDep, lead: LeadAccount) -> SecondReviewAsked:
    """Have a second person decide about a share of the registrations, without seeing the first one's decision."""
    asked = review.ask_second_review(session, body)
    record_act(session, lead.id, "curation.second_review", "collection", None, marked=asked.marked)
    return asked


def _describe(session: SessionDep, decision: DecisionRow, row: RegistrationRow, account_id: uuid.UUID) -> DecisionDone:
    return DecisionDone(
        decision=service.describe_decisions(session, [decision])[0],
        registration=describe_registrations(session, [row], account_id)[0],
    )

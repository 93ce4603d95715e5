"""`/account/tokens`."""

from __future__ import annotations

import uuid

from fastapi import APIRouter

from server.access import tokens
from server.access.schemas import NewToken, TokenIn, TokenOut
from server.access.service import PersonDep
from server.database import SessionDep
from server.database.paging import Page
from server.errors import error_responses

router = APIRouter(prefix="/account/tokens", tags=["accounts"], responses=error_responses())


@router.get("")
def list_tokens(person: PersonDep, session: SessionDep) -> Page[TokenOut]:
    """My tokens that are not revoked, the newest first."""
    rows = tokens.list_tokens(session, person.account_id)
    return Page(items=[TokenOut.model_validate(row) for row in rows], next_cursor=None)


@router.post("", status_code=201, responses=error_responses(409))
def create_token(body: TokenIn, person: PersonDep, session: SessionDep) -> NewToken:
    """Make a token. Its secret is in this answer only."""
    row, secret = tokens.add_token(session, person.account_id, body.name, body.may_write, body.days)
    return NewToken.model_validate(TokenOut.model_validate(row).model_dump() | {"secret": secret})


@router.delete("/{token_id}", status_code=204, responses=error_responses(404))
def revoke_token(token_id: uuid.UUID, person: PersonDep, session: SessionDep) -> None:
    """Revoke a token."""
    tokens.revoke_token(session, person.account_id, token_id)

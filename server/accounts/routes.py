"""`/account`."""

from __future__ import annotations

from fastapi import APIRouter

from server.accounts.models import Account
from server.accounts.schemas import AccountOut
from server.accounts.service import CurrentAccount
from server.errors import error_responses

router = APIRouter(tags=["accounts"], responses=error_responses())


@router.get("/account", response_model=AccountOut)
def get_account(account: CurrentAccount) -> Account:
    """Who I am."""
    return account

"""What a role may, who is asked, and how people are named."""

from __future__ import annotations

import asyncio
import uuid
from itertools import product

import pytest
from starlette.requests import HTTPConnection

from server.access.current_user import LOCAL_USER, CurrentUser, put_current_user
from server.access.models import LOCAL_ACCOUNT_ID, ROLES, Account
from server.access.service import (
    RequireRole,
    find_names,
    get_current_account,
    get_current_account_id,
    get_current_user,
    has_role,
    require_person,
)
from server.database import Database
from server.errors import ForbiddenError
from tests.server.rows import keep, make_person


@pytest.fixture
def database_kind() -> str:
    return "sqlite"


@pytest.mark.parametrize(("role", "needed"), list(product(ROLES, ROLES)))
def test_each_role_may_what_those_before_it_may(role, needed) -> None:
    order = ["annotator", "reviewer", "lead", "admin"]
    is_enough = order.index(role) >= order.index(needed)
    person = make_person("Ann", role)
    assert has_role(person, needed) is is_enough
    if is_enough:
        assert asyncio.run(RequireRole(needed)(person)) is person
    else:
        with pytest.raises(ForbiddenError, match=rf"^Ann is {role}; this needs {needed} or higher\. Ask a lead"):
            asyncio.run(RequireRole(needed)(person))


def test_whoever_made_the_request_is_found_without_a_query() -> None:
    user = CurrentUser(uuid.uuid4(), "Ann", "lead", login_id=uuid.uuid4())
    scope = {"type": "http", "headers": []}
    put_current_user(scope, user)
    connection = HTTPConnection(scope)
    assert asyncio.run(get_current_user(connection)) is user
    account = asyncio.run(get_current_account(connection))
    assert (account.id, account.name, account.role) == (user.account_id, "Ann", "lead")
    assert asyncio.run(get_current_account_id(user)) == user.account_id


def test_a_script_is_no_person() -> None:
    user = CurrentUser(uuid.uuid4(), "Ann", "admin", may_write=True, token_id=uuid.uuid4())
    with pytest.raises(ForbiddenError, match=r"A token opens no account administration. Do it in a browser"):
        asyncio.run(require_person(user))
    assert asyncio.run(require_person(LOCAL_USER)) is LOCAL_USER


def test_names_are_found_for_those_that_there_are(database: Database) -> None:
    ann, bob = make_person("Ann"), make_person("Bob")
    keep(database, ann, bob)
    with database.reading() as session:
        assert find_names(session, [ann.id, None, bob.id, ann.id, uuid.uuid4()]) == {ann.id: "Ann", bob.id: "Bob"}
        assert find_names(session, [LOCAL_ACCOUNT_ID]) == {
            LOCAL_ACCOUNT_ID: session.get_one(Account, LOCAL_ACCOUNT_ID).name
        }
        assert find_names(session, []) == find_names(session, [None]) == {}

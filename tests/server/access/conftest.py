"""A studio where people log in, and people of every role in their browsers."""

from __future__ import annotations

import uuid
from collections.abc import Iterator
from contextlib import ExitStack
from dataclasses import dataclass
from datetime import timedelta
from functools import cache

import pytest
from fastapi import FastAPI
from fastapi.testclient import TestClient

from server.access.authentication import name_cookie
from server.access.logins import Browser, add_login
from server.access.models import Account, Role
from server.access.passwords import hash_password
from server.app import create_app
from server.database import Database
from server.settings import Settings
from tests.server.conftest import BASE_URL

PASSWORD = "four words in a row"


@cache
def password_hash() -> str:
    return hash_password(PASSWORD)


@dataclass
class Lab:
    """A studio that asks for login."""

    app: FastAPI
    settings: Settings
    nobody: TestClient

    @property
    def database(self) -> Database:
        return self.app.state.database

    def add(self, name: str, role: Role = "annotator") -> uuid.UUID:
        with self.database.writing() as session:
            account = Account(name=name, role=role, password_hash=password_hash())
            session.add(account)
        return account.id

    def browser(self, account_id: uuid.UUID | None = None) -> TestClient:
        """A browser of somebody who is logged in there already; of nobody without an account."""
        client = TestClient(self.app, base_url=BASE_URL, raise_server_exceptions=False)
        if account_id is not None:
            with self.database.writing() as session:
                secret = add_login(session, account_id, Browser("test", "test", timedelta(days=1)))
            self.give_cookie(client, secret)
        return client

    def give_cookie(self, client: TestClient, secret: str) -> None:
        client.cookies.set(name_cookie(self.settings), secret, domain="127.0.0.1", path="/")

    def person(self, role: Role, name: str | None = None) -> TestClient:
        """A browser of a new person of this role."""
        return self.browser(self.add(name or f"the {role}", role))


@pytest.fixture
def lab(settings: Settings) -> Iterator[Lab]:
    settings = settings.model_copy(update={"login": "required"})
    app = create_app(settings)
    with ExitStack() as stack:
        nobody = stack.enter_context(TestClient(app, base_url=BASE_URL, raise_server_exceptions=False))
        yield Lab(app, settings, nobody)

"""The session of a request."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Annotated

from fastapi import Depends
from sqlalchemy.orm import Session
from starlette.requests import HTTPConnection

from server.database.database import Database


def get_database(connection: HTTPConnection) -> Database:
    """The app's database, for routes whose work is longer than one transaction."""
    return connection.app.state.database


DatabaseDep = Annotated[Database, Depends(get_database)]


def get_session(connection: HTTPConnection, database: DatabaseDep) -> Iterator[Session]:
    """Commits when the route has returned and before the answer leaves, so that what was answered is stored."""
    reads_only = connection.scope.get("method") in ("GET", "HEAD")
    with database.reading() if reads_only else database.writing() as session:
        yield session


SessionDep = Annotated[Session, Depends(get_session, scope="function")]
"""Services flush; the request commits."""

"""`/health`."""

from __future__ import annotations

from fastapi import APIRouter
from pydantic import BaseModel
from sqlalchemy import text

from server.database import SessionDep
from server.errors import error_responses

router = APIRouter(tags=["studio"], responses=error_responses())


class Health(BaseModel):
    """The studio answers and reaches its database."""

    status: str
    database: str


@router.get("/health")
def get_health(session: SessionDep) -> Health:
    """Whether the studio works."""
    session.execute(text("SELECT 1"))
    return Health(status="ok", database=session.get_bind().dialect.name)

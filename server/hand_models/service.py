"""The hand models there are: those that come with Handloom, and those that were trained or uploaded."""

from __future__ import annotations

import uuid
from collections.abc import Sequence
from functools import cache
from typing import TYPE_CHECKING

from sqlalchemy import Uuid, column, func, select, table
from sqlalchemy.orm import Session

from server.access.service import find_names
from server.database import utc_now
from server.database.paging import fetch_page
from server.errors import NotFoundError
from server.hand_models.models import HandModelRow
from server.hand_models.schemas import HandModelOut

if TYPE_CHECKING:
    from tracker import ArticulatedModel

AREA = "models"
FILE = "model.npz"
NAMESPACE = uuid.UUID("6d9a0f4e-64d5-4f0e-9a39-0b8f3f4c6f11")
"""Of the ids of models that come with Handloom: they are the same everywhere."""


@cache
def list_default_models() -> tuple[HandModelOut, ...]:
    """The default right and left hand."""
    from tracker import default_hand  # loads numba: not before somebody asks

    return tuple(_describe_default(default_hand(side)) for side in ("right", "left"))


def _describe_default(model: ArticulatedModel) -> HandModelOut:
    assert model.hand is not None
    return HandModelOut(
        id=uuid.uuid5(NAMESPACE, f"default/{model.hand.side}"),
        name=model.name,
        kind="default",
        side="right" if model.hand.side == "right" else "left",
        vertices=len(model.vertices),
        faces=len(model.faces),
        bones=list(model.skeleton.bone_names),
        degrees_of_freedom=model.num_dofs,
        shape_parameters=[] if model.shape is None else list(model.shape.names),
        provenance=model.provenance,
    )


def list_hand_models(session: Session, cursor: str | None, limit: int) -> tuple[Sequence[HandModelRow], str | None]:
    """Those that were trained or uploaded, the newest first."""
    query = select(HandModelRow).where(HandModelRow.deleted_at.is_(None))
    return fetch_page(session, query, (HandModelRow.created_at, HandModelRow.id), cursor, limit)


def get_hand_model(session: Session, model_id: uuid.UUID, *, deleted_too: bool = False) -> HandModelRow:
    """The stored model of this id."""
    row = session.get(HandModelRow, model_id)
    if row is None or (row.deleted_at is not None and not deleted_too):
        raise NotFoundError(f"There is no hand model {model_id}." if row is None else "This hand model was deleted.")
    return row


def delete_hand_model(session: Session, row: HandModelRow) -> None:
    """Hide a model; `restore_hand_model` brings it back. What came of it stays."""
    row.deleted_at = utc_now()
    session.flush()


def restore_hand_model(session: Session, row: HandModelRow) -> None:
    """Undo a deletion; nothing happens when there was none."""
    row.deleted_at = None
    session.flush()


def describe_hand_models(session: Session, rows: Sequence[HandModelRow]) -> list[HandModelOut]:
    """Stored models as the API gives them."""
    people = find_names(session, (row.created_by for row in rows))
    counts = _count_registrations(session, [row.id for row in rows])
    return [
        HandModelOut.model_validate(
            {
                **row.facts,
                "id": row.id,
                "name": row.name,
                "kind": row.kind,
                "side": row.side,
                "digest": row.digest,
                "round": row.round,
                "parent_id": row.parent_id,
                "training_set_id": row.training_set_id,
                "job_id": row.job_id,
                "registers": True,
                "has_report": row.report is not None,
                "registration_count": counts.get(row.id, 0),
                "created_at": row.created_at,
                "created_by_name": people.get(row.created_by),
            }
        )
        for row in rows
    ]


def _count_registrations(session: Session, ids: Sequence[uuid.UUID]) -> dict[uuid.UUID, int]:
    """By model. The table is of a room above this one, which only its name is known of here."""
    made_by = column("model_id", Uuid)
    query = select(made_by, func.count().label("made")).select_from(table("registrations")).group_by(made_by)
    return {row.model_id: row.made for row in session.execute(query.where(made_by.in_(ids)))}

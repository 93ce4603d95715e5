"""The model of a person from accepted frames: the next registration of that person begins with it."""

from __future__ import annotations

import uuid
from collections.abc import Iterator, Sequence
from functools import cache
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING, Literal

import numpy as np
from sqlalchemy import select
from sqlalchemy.exc import IntegrityError
from sqlalchemy.orm import Session

from server.access.audit import record_act
from server.access.service import find_names
from server.compute import ComputeContext
from server.database.paging import fetch_page
from server.errors import NotFoundError
from server.moving_scans.body_set_archive import check_member
from server.moving_scans.body_sets import get_body_set, read_members
from server.moving_scans.models import BodySetRow, MovingRegistrationRow, MovingScanRow, PersonModelRow
from server.moving_scans.person_model_schemas import PersonModelOut
from server.moving_scans.service import get_moving_scan
from server.moving_scans.storing import BODY, TEMPLATE, TEMPLATES
from server.storage import Storage
from server.storage.digest import compute_digest

if TYPE_CHECKING:
    from tracker import BlendModel
    from tracker.bodies import BodyRegistration

NAMESPACE = uuid.UUID("8d1f5f0e-62b5-4a8e-9a55-0f3f6b1c7d42")
MOST_FRAMES = 200
"""Frames of a set, spread over it, that the model is made from."""


def make_person_model(context: ComputeContext, set_id: uuid.UUID, account_id: uuid.UUID) -> bool:
    """Unpose the frames of a set, average them ([R17] 4.3.1), and store the model; whether it is new."""
    from tracker import load_blend_model, save_blend_model
    from tracker.bodies import body_model, load_body_registration, make_template

    id_, storage = name_person_model(set_id), context.storage
    with context.database.reading() as session:
        if session.get(PersonModelRow, id_) is not None:
            return False
        row = get_body_set(session, set_id)
        members = read_members(session, row)
        made = {each.registration_id: session.get_one(MovingRegistrationRow, each.registration_id) for each in members}
    places = np.unique(np.linspace(0, len(members) - 1, min(MOST_FRAMES, len(members))).astype(int))
    population = made[members[0].registration_id].population

    @cache
    def load(template_id: uuid.UUID) -> BlendModel:
        return load_blend_model(storage.folder(TEMPLATES, template_id) / TEMPLATE)

    def read() -> Iterator[tuple[BlendModel, BodyRegistration]]:
        for each in (members[place] for place in places):
            found = load_body_registration(check_member(storage, row.name, each) / BODY)
            yield load(made[each.registration_id].template_id), found

    own = make_template(body_model(population), read())  # type: ignore[arg-type]  # as the schema lets it pass
    folder = storage.folder(TEMPLATES, id_)
    folder.mkdir(parents=True, exist_ok=True)
    save_blend_model(own, folder / TEMPLATE)
    storage.publish(TEMPLATES, id_)
    stored = PersonModelRow(
        id=id_,
        body_set_id=set_id,
        name=row.name,
        population=population,
        digest=compute_digest(folder / TEMPLATE),
        frame_count=len(places),
        created_by=account_id,
    )
    try:
        with context.database.writing() as session:
            session.add(stored)
            record_act(session, account_id, "person_model.make", "person_model", id_, frames=len(places))
    except IntegrityError:  # somebody makes the same at this very moment
        return False
    return True


def name_person_model(set_id: uuid.UUID) -> uuid.UUID:
    """The id of a set's model: there is one."""
    return uuid.uuid5(NAMESPACE, str(set_id))


def get_person_model(session: Session, id_: uuid.UUID) -> PersonModelRow:
    """The model of this id."""
    row = session.get(PersonModelRow, id_)
    if row is None:
        raise NotFoundError(f"There is no model of a person {id_}.")
    return row


def list_person_models(
    session: Session, moving_scan_id: uuid.UUID | None, cursor: str | None, limit: int
) -> tuple[Sequence[PersonModelRow], str | None]:
    """The newest first; of the person of one moving scan: from its sets, and those of scans with the same subject."""
    query = select(PersonModelRow)
    if moving_scan_id is not None:
        scan = get_moving_scan(session, moving_scan_id, deleted_too=True)
        is_same = MovingScanRow.id == scan.id
        if scan.subject:
            is_same |= MovingScanRow.subject == scan.subject
        query = query.join(BodySetRow, BodySetRow.id == PersonModelRow.body_set_id)
        query = query.join(MovingScanRow, MovingScanRow.id == BodySetRow.moving_scan_id).where(is_same)
    return fetch_page(session, query, (PersonModelRow.created_at, PersonModelRow.id), cursor, limit)


def describe_person_models(session: Session, rows: Sequence[PersonModelRow]) -> list[PersonModelOut]:
    """Models as the API gives them."""
    people = find_names(session, (row.created_by for row in rows))
    own = PersonModelOut.model_fields.keys() - {"created_by_name"}
    return [
        PersonModelOut.model_validate(
            {name: getattr(row, name) for name in own} | {"created_by_name": people.get(row.created_by)}
        )
        for row in rows
    ]


def write_smplh(storage: Storage, row: PersonModelRow, kind: Literal["npz", "pkl"]) -> bytes:
    """The bytes of a file that `smplx.SMPLH` loads: the person without a shape, others with one."""
    from dataclasses import replace

    from tracker import load_blend_model, save_mano
    from tracker.bodies import body_model

    own = load_blend_model(storage.folder(TEMPLATES, row.id) / TEMPLATE)
    people = body_model(row.population)  # type: ignore[arg-type]  # as the schema lets it pass
    with TemporaryDirectory() as folder:
        path = Path(folder) / f"SMPLH.{kind}"
        save_mano(replace(own, shape_directions=people.shape_directions), path)
        return path.read_bytes()

"""Training sets: chosen by a rule, kept as a list that never changes, and whose hash names every file in it."""

from __future__ import annotations

import hashlib
import json
import uuid
import zipfile
from collections.abc import Sequence
from dataclasses import dataclass
from typing import IO, Any

import numpy as np
from sqlalchemy import func, select
from sqlalchemy.orm import Session

from server.access.audit import record_act
from server.access.service import find_names
from server.database.paging import fetch_page
from server.errors import ConflictError, InvalidError, NotFoundError
from server.hand_models.models import HandModelRow
from server.registrations import service as registrations
from server.registrations.models import RegistrationRow
from server.registrations.training_set_models import TrainingMemberRow, TrainingSetRow
from server.registrations.training_set_schemas import (
    TrainingMember,
    TrainingPreview,
    TrainingRule,
    TrainingSetOut,
    TrainingVerification,
)
from server.scans.models import ScanRow
from server.storage import Storage
from server.storage.digest import compute_digest

AREA = "training_sets"
MOST_DAMAGED = 100


class DamagedSetError(ConflictError):
    """A file of a training set is not what it was when the set was made."""


@dataclass(frozen=True)
class Chosen:
    """A registration that a rule chooses."""

    registration: RegistrationRow
    scan: ScanRow

    @property
    def decision_id(self) -> uuid.UUID | None:
        """The last decision that accepts it."""
        accepts = [entry["id"] for entry in self.registration.standing.values() if entry["decision"] == "accept"]
        return uuid.UUID(accepts[-1]) if accepts else None


def choose_registrations(session: Session, rule: TrainingRule) -> list[Chosen]:
    """One registration a scan at most: the newest one that the rule allows. By the scans' names."""
    query = (
        select(RegistrationRow, ScanRow)
        .join(ScanRow, ScanRow.id == RegistrationRow.scan_id)
        .where(ScanRow.deleted_at.is_(None), ~RegistrationRow.is_outdated)
        .order_by(RegistrationRow.created_at.desc(), RegistrationRow.id)
    )
    if rule.by == "decisions":
        query = query.where(RegistrationRow.decision == "accept")
    else:
        is_free = RegistrationRow.decision.is_(None) | (RegistrationRow.decision == "accept")
        query = query.where(RegistrationRow.verdict == "good", is_free)
        if rule.model_id is None:
            query = query.where(RegistrationRow.is_current)
    if rule.collections:
        query = query.where(ScanRow.collection.in_(rule.collections))
    if rule.model_id is not None:
        query = query.where(RegistrationRow.model_id == rule.model_id)
    if rule.verdicts:
        query = query.where(RegistrationRow.verdict.in_(rule.verdicts))
    if rule.leave_out_subjects:
        query = query.where(ScanRow.subject.not_in(rule.leave_out_subjects))
    found: dict[uuid.UUID, Chosen] = {}
    for row, scan in session.execute(query):
        if rule.needs_two and not _is_accepted_by_two(row):
            continue
        found.setdefault(scan.id, Chosen(row, scan))
    return sorted(found.values(), key=lambda chosen: (chosen.scan.name, str(chosen.scan.id)))


def choose_members(session: Session, set_id: uuid.UUID) -> list[Chosen]:
    """The registrations of a training set."""
    query = (
        select(RegistrationRow, ScanRow)
        .join(ScanRow, ScanRow.id == RegistrationRow.scan_id)
        .join(TrainingMemberRow, TrainingMemberRow.registration_id == RegistrationRow.id)
        .where(TrainingMemberRow.training_set_id == set_id)
        .order_by(ScanRow.name, ScanRow.id)
    )
    return [Chosen(row, scan) for row, scan in session.execute(query)]


def _is_accepted_by_two(row: RegistrationRow) -> bool:
    said = [entry["decision"] for entry in row.standing.values()]
    return said.count("accept") >= 2 and "reject" not in said


def preview(session: Session, rule: TrainingRule) -> TrainingPreview:
    """What a rule would choose now."""
    chosen = choose_registrations(session, rule)
    query = select(func.count()).select_from(RegistrationRow).join(ScanRow, ScanRow.id == RegistrationRow.scan_id)
    query = query.where(RegistrationRow.is_current, RegistrationRow.reviewer_count == 0, ScanRow.deleted_at.is_(None))
    if rule.collections:
        query = query.where(ScanRow.collection.in_(rule.collections))
    return TrainingPreview(
        registrations=len(chosen),
        subjects=_count_subjects(chosen),
        mirrored=sum(one.registration.side == "left" for one in chosen),
        undecided=session.scalar(query) or 0,
    )


def _count_subjects(chosen: Sequence[Chosen]) -> int:
    return len({one.scan.subject for one in chosen})


def create_training_set(
    session: Session, storage: Storage, name: str, rule: TrainingRule, account_id: uuid.UUID | None
) -> tuple[TrainingSetRow, bool]:
    """Keep what a rule chooses now. Gives the set and whether it is new: the same registrations are kept once."""
    chosen = choose_registrations(session, rule)
    if not chosen:
        raise InvalidError(
            "The rule chooses no registration. Accept some on the page Curate first, or widen the rule: "
            f"{rule.model_dump_json()}."
        )
    models = {model.id: model.digest for model in session.execute(select(HandModelRow.id, HandModelRow.digest))}
    data = write_canonical(chosen, models)
    digest = hashlib.sha256(data).hexdigest()
    same = select(TrainingSetRow).where(TrainingSetRow.digest == digest).order_by(TrainingSetRow.created_at)
    if (known := session.scalars(same.limit(1)).one_or_none()) is not None:
        return known, False
    row = TrainingSetRow(
        id=uuid.uuid4(),
        name=name,
        rule=rule.model_dump(mode="json"),
        digest=digest,
        registration_count=len(chosen),
        subject_count=_count_subjects(chosen),
        mirrored_count=sum(one.registration.side == "left" for one in chosen),
        created_by=account_id,
    )
    storage.add_document(AREA, row.id, data)
    session.add(row)
    session.flush()
    session.add_all(
        TrainingMemberRow(training_set_id=row.id, registration_id=one.registration.id, decision_id=one.decision_id)
        for one in chosen
    )
    session.flush()
    record_act(session, account_id, "training_set.create", "training_set", row.id, sha256=digest, size=len(chosen))
    return row, True


def write_canonical(chosen: Sequence[Chosen], model_digests: dict[uuid.UUID, str]) -> bytes:
    """The list as bytes: the same for the same registrations, whatever the database or the machine."""
    items = [
        {
            "registration": str(one.registration.id),
            "sha256": one.registration.digest,
            "scan": str(one.scan.id),
            "scan_sha256": one.scan.digest,
            "crop_revision": one.registration.crop_revision,
            "model": str(one.registration.model_id),
            "model_sha256": model_digests[one.registration.model_id],
            "subject": one.scan.subject,
            "pose": one.scan.pose,
            "side": one.registration.side,
            "decision": None if one.decision_id is None else str(one.decision_id),
        }
        for one in chosen
    ]
    return (json.dumps({"version": 1, "registrations": items}, separators=(",", ":"), sort_keys=True) + "\n").encode()


def list_training_sets(session: Session, cursor: str | None, limit: int) -> tuple[Sequence[TrainingSetRow], str | None]:
    """Newest first."""
    return fetch_page(session, select(TrainingSetRow), (TrainingSetRow.created_at, TrainingSetRow.id), cursor, limit)


def get_training_set(session: Session, set_id: uuid.UUID) -> TrainingSetRow:
    """The training set of this id."""
    row = session.get(TrainingSetRow, set_id)
    if row is None:
        raise NotFoundError(f"There is no training set {set_id}.")
    return row


def describe_training_sets(session: Session, rows: Sequence[TrainingSetRow]) -> list[TrainingSetOut]:
    """Training sets as the API gives them."""
    people = find_names(session, (row.created_by for row in rows))
    query = select(HandModelRow.training_set_id, func.count().label("models")).group_by(HandModelRow.training_set_id)
    query = query.where(HandModelRow.training_set_id.in_([row.id for row in rows]))
    models = {found.training_set_id: found.models for found in session.execute(query)}
    own = TrainingSetOut.model_fields.keys() - {"model_count", "created_by_name"}
    return [
        TrainingSetOut.model_validate(
            {name: getattr(row, name) for name in own}
            | {"model_count": models.get(row.id, 0), "created_by_name": people.get(row.created_by)}
        )
        for row in rows
    ]


def list_members(
    session: Session, set_id: uuid.UUID, cursor: str | None, limit: int
) -> tuple[list[TrainingMember], str | None]:
    """Registrations of a set, by the scans' names."""
    query = (
        select(TrainingMemberRow, RegistrationRow, ScanRow)
        .join(RegistrationRow, RegistrationRow.id == TrainingMemberRow.registration_id)
        .join(ScanRow, ScanRow.id == RegistrationRow.scan_id)
        .where(TrainingMemberRow.training_set_id == set_id)
    )
    order = (ScanRow.name, TrainingMemberRow.id)
    found, next_cursor = fetch_page(session, query, order, cursor, limit, is_falling=False)
    items = [
        TrainingMember.model_validate(
            {
                "registration_id": row.id,
                "scan_id": scan.id,
                "scan_name": scan.name,
                "subject": scan.subject,
                "pose": scan.pose,
                "side": row.side,
                "digest": row.digest,
                "decision_id": member.decision_id,
            }
        )
        for member, row, scan in found
    ]
    return items, next_cursor


def read_list(storage: Storage, row: TrainingSetRow) -> dict[str, Any]:
    """The set's own list; raises when it is not what it was."""
    try:
        data = storage.document(AREA, row.id).read_bytes()
    except FileNotFoundError:
        data = b""
    if (found := hashlib.sha256(data).hexdigest()) != row.digest:
        raise DamagedSetError(
            f"The list of the training set {row.name!r} is damaged: its SHA-256 is {found[:12]}, expected "
            f"{row.digest[:12]}. Restore {AREA}/{row.id}.json from a backup."
        )
    return json.loads(data)


def verify_training_set(storage: Storage, row: TrainingSetRow) -> TrainingVerification:
    """Hash every file of a set again."""
    try:
        listed = read_list(storage, row)["registrations"]
    except DamagedSetError:
        return TrainingVerification(is_intact=False, damaged=[])
    damaged = [uuid.UUID(item["registration"]) for item in listed if _find_fault(storage, item)]
    return TrainingVerification(is_intact=not damaged, damaged=damaged[:MOST_DAMAGED])


def _find_fault(storage: Storage, item: dict[str, Any]) -> bool:
    path = storage.folder(registrations.AREA, uuid.UUID(item["registration"])) / registrations.FILE
    return not path.is_file() or compute_digest(path) != item["sha256"]


def list_files(storage: Storage, row: TrainingSetRow) -> list[tuple[str, Any]]:
    """Names, as `handloom train-model` takes them, and paths of the registrations of a set; each is checked."""
    files = []
    for item in read_list(storage, row)["registrations"]:
        if _find_fault(storage, item):
            raise DamagedSetError(
                f"The registration {item['registration']} of the training set {row.name!r} was changed. "
                f"Restore {registrations.AREA}/{item['registration']} from a backup; nothing was trained."
            )
        path = storage.folder(registrations.AREA, uuid.UUID(item["registration"])) / registrations.FILE
        files.append((f"{item['registration']}/{registrations.FILE}", path))
    return files


def write_archive(storage: Storage, row: TrainingSetRow, file: IO[bytes]) -> None:
    """A set as a zip: a folder for each registration, the list, and the scans' names for `train-model --accepted`."""
    accepted = set()
    with zipfile.ZipFile(file, "w", zipfile.ZIP_STORED) as archive:
        archive.writestr("training_set.json", storage.document(AREA, row.id).read_bytes())
        for name, path in list_files(storage, row):
            archive.write(path, name)
            with np.load(path, allow_pickle=False) as arrays:
                accepted.add(str(arrays["scan"]))
        archive.writestr("accepted.json", json.dumps(sorted(accepted)))

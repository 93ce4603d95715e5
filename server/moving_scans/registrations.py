"""Registrations of moving scans: looked up, described, and added to frame by frame."""

from __future__ import annotations

import uuid
from collections import Counter
from collections.abc import Sequence

from sqlalchemy import select
from sqlalchemy.orm import Session

from server.access.service import find_names
from server.errors import NotFoundError
from server.moving_scans.accepted import find_last, number_registrations
from server.moving_scans.decisions import find_standing, list_decisions
from server.moving_scans.models import FrameRegistrationRow, MovingRegistrationRow
from server.moving_scans.registration_schemas import FrameRegistrationOut, Hand, MovingRegistrationOut
from server.moving_scans.storing import name_frame


def get_registration(session: Session, id_: uuid.UUID) -> MovingRegistrationRow:
    """The registration of a moving scan of this id."""
    row = session.get(MovingRegistrationRow, id_)
    if row is None:
        raise NotFoundError(f"There is no registration {id_} of a moving scan.")
    return row


def list_registrations(session: Session, moving_scan_id: uuid.UUID) -> Sequence[MovingRegistrationRow]:
    """Those of a moving scan, the newest first."""
    query = select(MovingRegistrationRow).where(MovingRegistrationRow.moving_scan_id == moving_scan_id)
    order = (MovingRegistrationRow.created_at.desc(), MovingRegistrationRow.id.desc())
    return session.scalars(query.order_by(*order)).all()


def find_frame(session: Session, registration_id: uuid.UUID, frame: int) -> FrameRegistrationRow | None:
    """What a registration made of a frame, where it is done."""
    return session.get(FrameRegistrationRow, name_frame(registration_id, frame))


def get_frame(session: Session, registration_id: uuid.UUID, frame: int) -> FrameRegistrationRow:
    """What a registration made of a frame."""
    row = find_frame(session, registration_id, frame)
    if row is None:
        raise NotFoundError(f"The registration {registration_id} has no frame {frame}, or not yet.")
    return row


def find_before(session: Session, parent_id: uuid.UUID | None, frame: int) -> FrameRegistrationRow | None:
    """The nearest earlier frame of the registration that one goes on from, or of its own ancestors."""
    while parent_id is not None:
        query = select(FrameRegistrationRow).where(
            FrameRegistrationRow.registration_id == parent_id, FrameRegistrationRow.frame < frame
        )
        found = session.scalars(query.order_by(FrameRegistrationRow.frame.desc()).limit(1)).one_or_none()
        if found is not None:
            return found
        parent_id = session.get_one(MovingRegistrationRow, parent_id).parent_id
    return None


def list_frames(session: Session, row: MovingRegistrationRow) -> list[FrameRegistrationOut]:
    """Every frame of a registration, in order."""
    last = find_last(find_standing(list_decisions(session, row.moving_scan_id)), row.id)
    query = select(FrameRegistrationRow).where(FrameRegistrationRow.registration_id == row.id)
    return [
        FrameRegistrationOut(
            frame=each.frame,
            verdict=each.verdict,  # type: ignore[arg-type]  # the table lets no other pass
            reasons=each.reasons,
            mean_mm=each.scan_to_mesh_mm["mean"],
            p95_mm=each.scan_to_mesh_mm["p95"],
            guessed=_list_guessed(each),
            decision=last[each.frame].decision if each.frame in last else None,  # type: ignore[arg-type]
        )
        for each in session.scalars(query.order_by(FrameRegistrationRow.frame))
    ]


def _list_guessed(row: FrameRegistrationRow) -> list[Hand]:
    shown: dict[Hand, bool] = {"left": row.has_left, "right": row.has_right}
    return [hand for hand, is_shown in shown.items() if not is_shown]


def describe_registrations(session: Session, rows: Sequence[MovingRegistrationRow]) -> list[MovingRegistrationOut]:
    """Registrations as the API gives them."""
    numbers = number_registrations(session, {row.moving_scan_id for row in rows})
    people = find_names(session, (row.created_by for row in rows))
    own = ("id", "moving_scan_id", "job_id", "parent_id", "prior", "holds_hands", "has_velocity", "population")
    own += ("first_frame", "last_frame", "created_at")
    described = []
    for row in rows:
        frames = list_frames(session, row)
        means = [frame.mean_mm for frame in frames if frame.mean_mm is not None]
        decisions = Counter(frame.decision for frame in frames)
        described.append(
            MovingRegistrationOut.model_validate(
                {name: getattr(row, name) for name in own}
                | {
                    "number": numbers[row.id],
                    "frames_done": len(frames),
                    "verdicts": Counter(frame.verdict for frame in frames),
                    "guessed": Counter(hand for frame in frames for hand in frame.guessed),
                    "scan_to_mesh_mm": sum(means) / len(means) if means else None,
                    "accepted_count": decisions["accept"],
                    "rejected_count": decisions["reject"],
                    "created_by_name": people.get(row.created_by),
                }
            )
        )
    return described

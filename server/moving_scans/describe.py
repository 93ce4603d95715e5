"""Moving scans with what else is known of them."""

from __future__ import annotations

from collections.abc import Sequence

from sqlalchemy import func, select
from sqlalchemy.orm import Session

from server.access.service import find_names
from server.moving_scans.accepted import count_accepted
from server.moving_scans.models import MovingRegistrationRow, MovingScanRow
from server.moving_scans.schemas import FrameProblem, MovingScanOut


def describe_moving_scans(session: Session, rows: Sequence[MovingScanRow]) -> list[MovingScanOut]:
    """Moving scans as the API gives them."""
    ids = [row.id for row in rows]
    counted = select(MovingRegistrationRow.moving_scan_id, func.count()).group_by(MovingRegistrationRow.moving_scan_id)
    counted = counted.where(MovingRegistrationRow.moving_scan_id.in_(ids))
    made = {row[0]: row[1] for row in session.execute(counted)}
    accepted = count_accepted(session, ids)
    people = find_names(session, (row.created_by for row in rows))
    own = ("id", "name", "subject", "fps", "frame_count", "usable_count", "byte_count", "metres_per_unit")
    own += ("is_unit_guessed", "box_m", "notes", "created_at")
    return [
        MovingScanOut.model_validate(
            {name: getattr(row, name) for name in own}
            | {
                "point_count": max(frame["point_count"] for frame in row.frames),
                "problems": [
                    FrameProblem(frame=number, name=frame["name"], detail=frame["problem"])
                    for number, frame in enumerate(row.frames)
                    if frame["problem"] is not None
                ],
                "registration_count": made.get(row.id, 0),
                "accepted_count": accepted.get(row.id, 0),
                "created_by_name": people.get(row.created_by),
            }
        )
        for row in rows
    ]

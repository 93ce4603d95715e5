"""A moving scan and its registrations as rows alone, without files."""

from __future__ import annotations

import uuid
from collections.abc import Iterator, Sequence
from typing import Any

import pytest
from sqlalchemy.orm import Session

from server.access.models import LOCAL_ACCOUNT_ID
from server.database import Database
from server.moving_scans.accepted import find_accepted
from server.moving_scans.decision_schemas import StretchDecisionMake
from server.moving_scans.decisions import decide
from server.moving_scans.models import FrameRegistrationRow, MovingRegistrationRow, MovingScanRow
from server.moving_scans.storing import name_frame

__all__ = ["bench"]

FRAMES = 8


def describe_frame(frame: int, problem: str | None = None) -> dict[str, Any]:
    """As the row of a moving scan has it."""
    file = f"{frame:06d}.ply"
    return {"file": file, "name": f"frame{frame}.ply", "digest": f"{frame:x}" * 64, "point_count": 100 + frame} | {
        "problem": problem
    }


def add_scan(session: Session) -> MovingScanRow:
    """Eight frames of somebody who waves."""
    row = MovingScanRow(
        name="Ada waves",
        subject="Ada",
        fps=30.0,
        frames=[describe_frame(frame) for frame in range(FRAMES)],
        frame_count=FRAMES,
        usable_count=FRAMES,
        digest="d" * 64,
        byte_count=1,
        metres_per_unit=1.0,
        is_unit_guessed=False,
        box_m=[],
        notes=[],
    )
    session.add(row)
    session.flush()
    return row


class Bench:
    """A moving scan of eight frames with two registrations; the second lacks frames 0 and 3."""

    def __init__(self, session: Session) -> None:
        self.session = session
        self.scan = add_scan(session)
        self.registrations = [self.register(range(FRAMES)), self.register([1, 2, 4, 5, 6, 7])]

    def register(self, frames: Sequence[int], **columns: Any) -> MovingRegistrationRow:
        row = MovingRegistrationRow(
            id=(id_ := uuid.uuid4()),
            moving_scan_id=self.scan.id,
            job_id=uuid.uuid4(),
            template_id=id_,
            prior="mixture",
            holds_hands=True,
            has_velocity=True,
            population="neutral",
            first_frame=min(frames),
            last_frame=FRAMES - 1,
            **columns,
        )
        self.session.add(row)
        self.session.flush()
        self.session.add_all(
            FrameRegistrationRow(
                id=name_frame(id_, frame),
                registration_id=id_,
                frame=frame,
                digest=f"{frame:064d}",
                verdict="good",
                reasons=[],
                scan_to_mesh_mm={"mean": 1.0 + frame, "p95": 3.0},
                has_left=True,
                has_right=True,
                seconds=1.0,
            )
            for frame in frames
        )
        self.session.flush()
        return row

    def decide(self, which: int, decision: str, first: int, last: int, operation: uuid.UUID | None = None):
        made = StretchDecisionMake(
            decision=decision,  # type: ignore[arg-type]
            first_frame=first,
            last_frame=last,
            operation_id=operation or uuid.uuid4(),
        )
        return decide(self.session, self.registrations[which], LOCAL_ACCOUNT_ID, made)

    def damage(self, frame: int) -> None:
        """From now on the file of this frame cannot be used."""
        frames = list(self.scan.frames)
        frames[frame] = describe_frame(frame, "it holds no points")
        self.scan.frames = frames
        self.session.flush()

    def accepted(self) -> dict[int, int]:
        """Frame to the number of the registration that counts."""
        ids = [row.id for row in self.registrations]
        return {each.frame: ids.index(each.registration_id) for each in find_accepted(self.session, self.scan.id)}


@pytest.fixture
def bench(database: Database) -> Iterator[Bench]:
    with database.writing() as session:
        yield Bench(session)
        session.rollback()

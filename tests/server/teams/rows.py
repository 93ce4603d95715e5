"""People, a recording and their work, as rows: for what is asked of the database and not over the API."""

from __future__ import annotations

import uuid
from dataclasses import dataclass, field
from typing import Any

from sqlalchemy.orm import Session

from server.access.models import Account, Role
from server.access.project_models import AssignmentRow, ProjectRow, ReplicaSetRow
from server.sequences.models import SequenceRow


@dataclass
class Work:
    """A project with a recording of twenty frames in two cameras."""

    session: Session
    project: ProjectRow = field(init=False)
    sequence: SequenceRow = field(init=False)

    def __post_init__(self) -> None:
        cameras = [{"id": camera, "width": 640, "height": 480} for camera in ("cam0", "cam1")]
        more: dict[str, Any] = {"hands": ["right"], "objects": [], "report": None, "content_key": "x"}
        self.sequence = SequenceRow(name="waving", fps=30.0, frame_count=20, cameras=cameras, **more)
        self.project = ProjectRow(name=f"Hands {uuid.uuid4()}")
        self.session.add_all([self.sequence, self.project])
        self.session.flush()

    def join(self, name: str, role: Role = "annotator") -> Account:
        account = Account(id=uuid.uuid4(), name=name, role=role)
        self.session.add(account)
        self.session.flush()
        return account

    def assign(self, person: Account, first: int = 3, last: int = 8, **columns: Any) -> AssignmentRow:
        row = AssignmentRow(
            project_id=self.project.id,
            sequence_id=self.sequence.id,
            account_id=person.id,
            frame_first=first,
            frame_last=last,
            **columns,
        )
        self.session.add(row)
        self.session.flush()
        return row

    def replicate(self, name: str, frames: list[int]) -> ReplicaSetRow:
        row = ReplicaSetRow(
            project_id=self.project.id,
            sequence_id=self.sequence.id,
            name=name,
            frames=frames,
            cameras=["cam0"],
            hands=["right"],
        )
        self.session.add(row)
        self.session.flush()
        return row

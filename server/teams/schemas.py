"""Projects, assignments, comments and replica sets as the API gives and takes them."""

from __future__ import annotations

import uuid
from datetime import datetime
from typing import Annotated, Literal

from pydantic import BaseModel, ConfigDict, Field, model_validator

from server.access.models import Role
from server.access.project_models import AssignmentState
from server.database.numbers import FrameNumber, Joint
from server.database.texts import Name, Text, Words

Hand = Literal["right", "left"]


class Person(BaseModel):
    """Somebody who can be given work."""

    id: uuid.UUID
    name: str
    role: Role


class StateCounts(BaseModel):
    """Assignments by state."""

    open: int = 0
    submitted: int = 0
    returned: int = 0
    accepted: int = 0


class ProjectOut(BaseModel):
    """Recordings that belong together."""

    model_config = ConfigDict(title="Project")

    id: uuid.UUID
    name: str
    description: str
    revision: int
    created_at: datetime
    archived_at: datetime | None
    recordings: int
    assignments: StateCounts


class ProjectMake(BaseModel):
    """A new project."""

    model_config = ConfigDict(extra="forbid")

    name: Name
    description: Text = ""


class ProjectPatch(BaseModel):
    """What can be changed of a project; what is left out stays."""

    model_config = ConfigDict(extra="forbid")

    name: Name | None = None
    description: Text | None = None


class ProjectRecording(BaseModel):
    """A recording of a project."""

    id: uuid.UUID
    name: str
    frame_count: int
    cameras: list[str]
    hands: list[Hand]
    assigned_frames: int = Field(description="Frames that somebody is to mark.")
    accepted_frames: int
    added_at: datetime


class AssignmentOut(BaseModel):
    """Frames that somebody is to mark."""

    model_config = ConfigDict(title="Assignment")

    id: uuid.UUID
    project_id: uuid.UUID
    project: str
    sequence_id: uuid.UUID
    recording: str
    account_id: uuid.UUID
    account: str
    replica_set_id: uuid.UUID | None = Field(description="Marked blindly, into `?replica=` of this assignment's id.")
    replica_set: str | None
    frame_first: int
    frame_last: int
    frames: int = Field(description="How many frames are to be marked.")
    frames_done: int = Field(
        description="Frames in which every joint asked for is marked, or marked as outside: of a range each hand of "
        "the recording, of a replica set every hand in every camera."
    )
    frames_partial: int = Field(description="Frames that were begun and are not done.")
    next_frame: int | None = Field(description="The first one that is not done.")
    state: AssignmentState
    note: str
    open_comments: int
    revision: int
    created_at: datetime
    updated_at: datetime
    reviewer: str | None = Field(description="Who accepted or returned it last.")


class AssignmentMake(BaseModel):
    """A range of frames for somebody; both ends are taken in."""

    model_config = ConfigDict(extra="forbid")

    sequence_id: uuid.UUID
    account_id: uuid.UUID
    frame_first: FrameNumber
    frame_last: FrameNumber
    note: Text = ""


class AssignmentPatch(BaseModel):
    """What can be changed of an assignment; what is left out stays."""

    model_config = ConfigDict(extra="forbid")

    account_id: uuid.UUID | None = None
    frame_first: FrameNumber | None = None
    frame_last: FrameNumber | None = None
    note: Text | None = None


class CommentMake(BaseModel):
    """Something said about an assignment, or about one place in it."""

    model_config = ConfigDict(extra="forbid")

    text: Words
    camera: Annotated[str, Field(max_length=64)] | None = None
    frame: FrameNumber | None = None
    hand: Hand | None = None
    joint: Joint | None = None

    @model_validator(mode="after")
    def check(self) -> CommentMake:
        """A joint is of a hand, a hand is in an image."""
        if self.joint is not None and self.hand is None:
            raise ValueError("a joint needs its hand")
        if self.hand is not None and (self.frame is None or self.camera is None):
            raise ValueError("a hand needs its frame and camera")
        return self


class AssignmentReturn(BaseModel):
    """Why work goes back to its annotator."""

    model_config = ConfigDict(extra="forbid")

    text: Text = Field("", description="May be left out when there are comments that are not resolved.")


class CommentOut(BaseModel):
    """Something said about an assignment."""

    model_config = ConfigDict(title="Comment")

    id: uuid.UUID
    assignment_id: uuid.UUID
    author: str | None
    text: str
    camera: str | None
    frame: int | None
    hand: Hand | None
    joint: int | None
    created_at: datetime
    resolved_at: datetime | None
    resolved_by: str | None


class ReplicaSetMake(BaseModel):
    """Frames, cameras and hands that several people are to mark blindly."""

    model_config = ConfigDict(extra="forbid")

    name: Name
    sequence_id: uuid.UUID
    frames: Annotated[list[FrameNumber], Field(min_length=1, max_length=2000)]
    cameras: Annotated[list[Annotated[str, Field(max_length=64)]], Field(min_length=1, max_length=16)]
    hands: Annotated[list[Hand], Field(min_length=1, max_length=2)]
    account_ids: Annotated[list[uuid.UUID], Field(min_length=2, max_length=20)]
    note: Text = ""


class ReplicaSetOut(BaseModel):
    """Frames that several people mark without seeing each other's joints."""

    model_config = ConfigDict(title="ReplicaSet")

    id: uuid.UUID
    project_id: uuid.UUID
    sequence_id: uuid.UUID
    recording: str
    name: str
    frames: list[int]
    cameras: list[str]
    hands: list[Hand]
    annotators: int
    finished: int = Field(description="Annotators whose work was submitted or accepted.")
    created_at: datetime


class ReplicaAnnotator(BaseModel):
    """One more annotator of a replica set."""

    model_config = ConfigDict(extra="forbid")

    account_id: uuid.UUID

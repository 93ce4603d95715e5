"""Flags as the API gives them."""

from __future__ import annotations

from pydantic import BaseModel, ConfigDict, Field

from server.annotations.schemas import Hand, Points
from server.database.numbers import Whole
from server.database.paging import Page
from server.quality.finding import Kind


class FlagOut(BaseModel):
    """Something about a label that looks wrong."""

    model_config = ConfigDict(title="Flag")

    kind: Kind
    score: float = Field(description="1 is where it begins to look wrong; more is worse.")
    reason: str = Field(description="For people: what was seen.")
    camera: str
    frame: int
    hand: Hand
    joints: list[int] = Field(description="Those meant, in the order of `/hand-skeleton`; empty: the whole hand.")
    points: Points = Field(description="The label as it was looked at.")
    revision: int = Field(description="Of the label.")
    is_dismissed: bool = Field(description="Somebody looked at this revision and the label is right.")


class CheckOut(BaseModel):
    """How many labels one check could look at."""

    model_config = ConfigDict(title="Check")

    kind: Kind
    labels: int
    missing: str = Field(description="What it lacks for the other labels; empty where it looked at all.")


class Checked(BaseModel):
    """What was looked at: an all-clear says no more than this."""

    labels: int = Field(description="Labelled hands in images.")
    frames: int
    is_behind: bool = Field(description="Labels have changed since; ask again in a few seconds.")
    track: str | None = Field(description="Name of the track that they are compared with; null where there is none.")
    checks: list[CheckOut]


class FlagPage(Page[FlagOut]):
    """Part of the flags, the worst first."""

    counts: dict[str, int] = Field(description="Open flags of each kind in the whole recording.")
    dismissed: int = Field(description="Flags that were put away.")
    checked: Checked


class FlagLook(BaseModel):
    """What somebody looked at."""

    model_config = ConfigDict(extra="forbid")

    revision: Whole = Field(ge=1, le=10**9, description="Of the label. A later revision is checked anew.")

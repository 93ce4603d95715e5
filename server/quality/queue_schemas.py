"""The queue of hands to look at as the API gives it."""

from __future__ import annotations

from typing import Literal

from pydantic import BaseModel, ConfigDict, Field

from server.annotations.schemas import Hand, Points
from server.database.paging import Page
from server.quality.doubt import DoubtKind
from server.quality.finding import Kind


class DoubtOut(BaseModel):
    """One reason to look at a hand."""

    model_config = ConfigDict(title="Doubt")

    kind: DoubtKind
    score: float = Field(description="1 is where it begins to look wrong; more is worse.")
    reason: str = Field(description="For people: what was seen.")
    camera: str | None = Field(description="The one that it is about; null: all.")
    joints: list[int] = Field(description="Those meant, in the order of `/hand-skeleton`; empty: the whole hand.")
    flag: Kind | None = Field(description="The label check's kind, of what it found; null of other doubts.")


class HandToLookAt(BaseModel):
    """A hand in a frame, labelled or not."""

    frame: int
    hand: Hand
    score: float = Field(description="1 is where something begins to look wrong; several doubts count more than one.")
    doubts: list[DoubtOut] = Field(description="Why, the worst first; one below 1 where nothing looks wrong.")
    camera: str = Field(description="Where to look: the camera of the worst doubt that is about one.")
    points: Points = Field(description="The hand in that camera; v is 2, or 0 where a joint is not known.")
    shows: Literal["label", "track", "detector", "nothing"] = Field(description="Whose joints `points` are.")


class QueuePage(Page[HandToLookAt]):
    """Part of the queue, the worst first."""

    hands: int = Field(description="In the whole queue.")
    doubtful: int = Field(description="Of those that look wrong: with a score of 1 or more.")
    track: str | None = Field(description="Name of the track that was looked at; null where there is none.")
    missing: list[str] = Field(description="What could not be asked, and so may have hidden a mistake. Sentences.")
    is_behind: bool = Field(description="Labels have changed since; ask again in a few seconds.")

"""Decisions as the API gives and takes them."""

from __future__ import annotations

import uuid
from datetime import datetime
from typing import Annotated, Literal

from pydantic import AfterValidator, BaseModel, ConfigDict, Field, StrictBool

from server.database.numbers import Number
from server.registrations.schemas import RegistrationOut, Standing

REASONS: dict[str, str] = {
    "wrong_pose": "Wrong pose",
    "fingers_swapped": "Fingers swapped",
    "wrong_side": "Left taken for right",
    "finger_off": "A finger off the scan",
    "slid": "Surface slid along itself",
    "wrist_off": "Wrist or palm off",
    "folded": "Mesh folded or crossing itself",
    "bad_scan": "The scan itself is bad",
    "other": "Other",
}
"""Reasons to reject, in the order of the keys 1 to 9."""


Reason = Annotated[str, Field(json_schema_extra={"enum": list(REASONS)})]


def _check_text(text: str) -> str:
    if "\x00" in text:
        raise ValueError("a text cannot hold the character NUL")
    return text.strip()


def _check_reasons(reasons: list[str]) -> list[str]:
    if unknown := [reason for reason in reasons if reason not in REASONS]:
        raise ValueError(f"no reason is called {unknown[0]!r}; there are: {', '.join(REASONS)}")
    return list(dict.fromkeys(reasons))


class ReasonOut(BaseModel):
    """A reason to reject a registration."""

    name: str
    label: str
    key: str = Field(description="The key that gives it.")


class DecisionMake(BaseModel):
    """What somebody decides."""

    model_config = ConfigDict(extra="forbid")

    decision: Standing
    reasons: Annotated[
        list[Reason],
        Field(max_length=9),
        AfterValidator(_check_reasons),
    ] = Field(default_factory=list, description="Names from `/curation/reasons`.")
    note: Annotated[str, Field(max_length=2000), AfterValidator(_check_text)] = ""
    seconds: Number | None = Field(default=None, ge=0, le=86400, description="How long it was looked at.")
    operation_id: uuid.UUID = Field(description="Made anew for each decision; sent again, nothing is done twice.")


class DecisionUndo(BaseModel):
    """Take a decision of one's own back."""

    model_config = ConfigDict(extra="forbid")

    operation_id: uuid.UUID = Field(description="Made anew for each undo; sent again, nothing is done twice.")


class DecisionOut(BaseModel):
    """One thing that somebody decided, or took back."""

    model_config = ConfigDict(title="Decision")

    id: uuid.UUID
    registration_id: uuid.UUID
    account_id: uuid.UUID
    author_name: str
    model_id: uuid.UUID = Field(description="The model version that was judged.")
    model_name: str
    number: int = Field(description="Counts the decisions about the registration from 1.")
    decision: Literal["accept", "reject", "unsure", "undo"]
    undoes_id: uuid.UUID | None
    stands: bool = Field(description="Whether it is what its author thinks now.")
    reasons: list[str]
    note: str
    seconds: float | None
    is_blind: bool = Field(description="Whether its author could not see what others had decided.")
    operation_id: uuid.UUID
    created_at: datetime


class DecisionDone(BaseModel):
    """A decision and what it makes of its registration."""

    decision: DecisionOut
    registration: RegistrationOut


class SecondReviewAsk(BaseModel):
    """Have a second person decide, who does not see the first one's decision."""

    model_config = ConfigDict(extra="forbid")

    collection: Annotated[str, Field(max_length=200)] | None = Field(default=None, description="Null: of all.")
    share: Number = Field(default=1.0, gt=0, le=1, description="Of the registrations there are.")
    only_decided: StrictBool = Field(default=False, description="Only of those that somebody has decided about.")


class SecondReviewAsked(BaseModel):
    """What was asked for."""

    marked: int = Field(description="Registrations that now need a second person.")
    already: int


class PersonThroughput(BaseModel):
    """What somebody decided since a moment."""

    account_id: uuid.UUID
    name: str
    decisions: int = Field(description="Without those that were taken back.")
    accept: int
    reject: int
    unsure: int
    undone: int = Field(description="How many they took back, older ones among them.")
    active_minutes: float = Field(description="Pauses of more than a minute count as none.")
    per_minute: float | None = Field(description="Decisions in an active minute; null before the second decision.")


class Throughput(BaseModel):
    """How fast registrations are decided about."""

    since: datetime
    people: list[PersonThroughput]


class ReviewerPair(BaseModel):
    """How two people agree, on what both decided."""

    first_id: uuid.UUID
    first_name: str
    second_id: uuid.UUID
    second_name: str
    both: int = Field(description="Registrations that both decided about.")
    share_agreed: float
    kappa: float | None = Field(description="Cohen's; null where both always decided the same one thing.")
    table: dict[Standing, dict[Standing, int]] = Field(description="First person's decision, then the second's.")


class ReviewAgreement(BaseModel):
    """How people agree about registrations that two of them decided about."""

    both: int
    share_agreed: float | None
    kappa: float | None = Field(description="Cohen's, all pairs together.")
    pairs: list[ReviewerPair]
    waiting: int = Field(description="Registrations that still need a second person.")
    disputed: list[uuid.UUID] = Field(
        description="Registrations about which two people decided otherwise, the first 200."
    )

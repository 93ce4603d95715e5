"""A job that trains a hand model."""

from __future__ import annotations

import uuid
from typing import Annotated, Literal

from pydantic import BaseModel, ConfigDict, Field, StrictBool, model_validator

from server.database.numbers import Whole
from server.database.texts import Label, Name
from server.registrations.training_set_schemas import TrainingRule


class TrainingParams(BaseModel):
    """How a model is trained."""

    model_config = ConfigDict(extra="forbid")

    rounds: Whole = Field(default=3, ge=1, le=20, description="Times that all parts of the model are improved in turn.")
    num_shapes: Whole = Field(default=10, ge=1, le=200, description="Shape directions of the whole hand kept, at most.")
    num_local_shapes: Whole = Field(
        default=0,
        ge=0,
        le=200,
        description="Shape directions of parts of the hand that follow them, at most: they fit people unlike those "
        "learnt from.",
    )
    with_pose_shapes: StrictBool = Field(default=True, description="Without: plain linear blend skinning.")
    with_mirrored: StrictBool = Field(default=True, description="Learn from left hands too, mirrored.")


Evaluate = Annotated[
    Literal["no", "quick", "full"],
    Field(
        description="Judge the model on people that it was not trained on, once it is stored. `quick`: beside the "
        "untrained hand and without blend shapes; `full`: also beside plain skinning and right hands only, which are "
        "trained for it."
    ),
]


class TrainCreate(BaseModel):
    """A hand model to train."""

    model_config = ConfigDict(extra="forbid")

    training_set_id: uuid.UUID | None = Field(default=None, description="To learn from; or else `rule`.")
    rule: TrainingRule | None = Field(
        default=None, description="What it chooses now is kept as a training set of this name, and learnt from."
    )
    name: Name
    model_id: uuid.UUID | None = Field(default=None, description="To begin with; null: the one not trained yet.")
    options: TrainingParams = Field(default_factory=TrainingParams)
    evaluate: Evaluate = "no"
    test_subjects: list[Label] = Field(
        default_factory=list, max_length=1000, description="To judge on; empty: those whom the training set leaves out."
    )

    @model_validator(mode="after")
    def _names_one_source(self) -> TrainCreate:
        if (self.training_set_id is None) == (self.rule is None):
            raise ValueError("give either `training_set_id` or `rule`")
        return self


class TrainJobCreate(TrainCreate):
    """A job that trains a hand model from a training set."""

    kind: Literal["train"]

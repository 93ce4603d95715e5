"""Annotations as the API gives and takes them."""

from __future__ import annotations

import uuid
from datetime import datetime
from typing import Annotated, Literal

from pydantic import BaseModel, ConfigDict, Field, WithJsonSchema

from server.annotations.models import Act
from server.database.numbers import IsNumber, Number
from server.database.texts import LongLabel
from server.errors import ErrorBody

Hand = Literal["right", "left"]
Pixel = Annotated[Number, Field(ge=-1e6, le=1e6)]
Visibility = Annotated[Literal[0, 1, 2], IsNumber]
Point = Annotated[
    tuple[Pixel, Pixel, Visibility],
    WithJsonSchema({"type": "array", "items": {"type": "number"}, "minItems": 3, "maxItems": 3}, mode="serialization"),
]
Points = Annotated[
    list[Point],
    Field(
        min_length=21,
        max_length=21,
        description="[x, y, v] of each joint in the order of `/hand-skeleton`: px, the centre of the top-left pixel is "
        "(0, 0); v is 0 absent, 1 occluded, 2 visible.",
    ),
]


class JointSourceOut(BaseModel):
    """What somebody accepted for a joint instead of placing it."""

    model_config = ConfigDict(title="JointSource", extra="forbid")

    kind: Literal["track", "fit", "detector", "triangulation", "interpolation", "copy", "import"]
    label: LongLabel = Field(default="", description="For people.", examples=["Track 2", "model fit of 7 joints"])
    track_id: uuid.UUID | None = None
    model: LongLabel = Field(default="", description="The hand model behind it.")
    is_independent: bool = Field(
        default=False,
        description="Of a triangulation, an interpolation or a copy: no track, no model fit and no detector had a "
        "part in any joint that it was made of. Only such joints judge a track, unless others are asked for.",
    )


SOURCE_DEFAULTS = {
    name: field.default for name, field in JointSourceOut.model_fields.items() if not field.is_required()
}
"""What the database leaves out of a source."""

SourceChoice = Literal[
    "independent",
    "all",
    "hand",
    "unknown",
    "track",
    "fit",
    "detector",
    "triangulation",
    "interpolation",
    "copy",
    "import",
]
"""Which joints are meant, by where they came from; a test holds it equal to the tracker's SOURCE_CHOICES."""


class JointsOfSource(BaseModel):
    """Placed joints of one origin."""

    origin: str = Field(description="`hand`, `unknown`, or the kind of the source.")
    words: str = Field(description="For people: `accepted from Track 2`.")
    joints: int
    is_counted: bool = Field(description="They count; otherwise they are left out because of where they came from.")


SOURCES_HELP = (
    "Joints that count, by where they came from; given several times, a joint counts that is one of them. "
    "`independent`: no track had a part in it, so that nothing is judged by what it made itself. `all`: "
    "whatever it came from. Or a kind: `hand`, `unknown` (never noted), `import`, `triangulation`, `interpolation`, "
    "`copy`, `fit`, `detector`, `track`."
)

Sources = Annotated[
    list[JointSourceOut | None],
    Field(
        min_length=21,
        max_length=21,
        description="Of each joint what a person accepted there, which is otherwise no label; null: placed by hand, or "
        "not placed.",
    ),
]


class AnnotationOut(BaseModel):
    """One hand in one image."""

    model_config = ConfigDict(title="Annotation")

    frame: int
    camera: str
    hand: Hand
    points: Points
    sources: Sources | None = Field(description="Null: never noted.")
    revision: int
    updated_at: datetime
    author: str | None


class AnnotationPut(BaseModel):
    """A hand as somebody marked it."""

    model_config = ConfigDict(extra="forbid")

    points: Points
    sources: Sources | None = Field(
        default=None, description="Left out: joints that stay keep theirs, the others count as placed by hand."
    )
    operation_id: uuid.UUID = Field(description="Made by the client, new for each change; a repeated one does nothing.")


class AnnotationRestore(BaseModel):
    """Whose wish it is to go back."""

    model_config = ConfigDict(extra="forbid")

    operation_id: uuid.UUID


class AnnotationRevision(BaseModel):
    """What one operation made of an annotation."""

    revision: int
    act: Act
    points: Points | None = Field(description="Null: it was deleted.")
    sources: Sources | None
    created_at: datetime
    author: str | None
    operation_id: uuid.UUID


class AnnotationConflict(ErrorBody):
    """Somebody else was first."""

    theirs: AnnotationOut | None = Field(description="How it is now; null when it is deleted or was never made.")


class KeyFrame(BaseModel):
    """One hand in one image; between it and the next one a machine may propose the rest."""

    model_config = ConfigDict(from_attributes=True)

    frame: int
    camera: str
    hand: Hand


class KeyFrames(BaseModel):
    """All key frames of a recording or a blind replica, by frame."""

    items: list[KeyFrame]


class AnnotationItem(BaseModel):
    """An entry of `annotations.json`."""

    frame: int
    camera: str
    hand: Hand
    points: Points
    sources: Sources | None = None


class AnnotationFile(BaseModel):
    """`annotations.json` of a recording folder."""

    version: Literal[1] = 1
    joints: list[str]
    items: list[AnnotationItem]

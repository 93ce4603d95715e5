"""Scans as the API gives and takes them."""

from __future__ import annotations

import uuid
from datetime import datetime
from typing import Annotated, Literal

from pydantic import BaseModel, ConfigDict, Field, StrictBool

from server.database.numbers import Number
from server.database.texts import Label, Name

Side = Literal["right", "left"]
State = Literal["new", "registered", "failed"]
Verdict = Literal["good", "doubtful", "bad"]

MOST_STROKES = 200
MOST_CORNERS = 2000


Finite = Annotated[Number, Field(ge=-1e9, le=1e9)]
UnitScale = Annotated[Number, Field(gt=0, le=1000)]


class ScanRegistration(BaseModel):
    """The newest registration of a scan, in brief."""

    id: uuid.UUID
    verdict: Verdict
    score: float
    round: int
    model_id: uuid.UUID


class ScanOut(BaseModel):
    """A 3D scan of a hand."""

    model_config = ConfigDict(title="Scan")

    id: uuid.UUID
    name: str
    collection: str = Field(description="Scans that belong together carry the same text here.")
    subject: str = Field(description="Whose hand; empty when nobody said.")
    pose: str = Field(description="Name of the pose; empty when nobody said.")
    side: Side | None = Field(description="As the uploader says; null leaves it to the registration.")
    state: State = Field(description="`failed`: it could not be registered; `problem` says why.")
    problem: str | None
    digest: str = Field(description="SHA-256 of the file.")
    byte_count: int
    point_count: int
    face_count: int
    has_colors: bool
    extent_m: list[float] = Field(description="Of its box along x, y, z.")
    size_m: list[float] = Field(
        description="Of what is registered, without what is cropped or left out: sides of a box that stands along it, "
        "the longest first."
    )
    metres_per_unit: float | None = Field(
        description="Length of the file's unit. Null: found from the size by an earlier version, and never confirmed."
    )
    is_unit_guessed: bool = Field(description="The unit was not given; it was recognised by the size.")
    notes: list[str] = Field(description="What was noticed when it was read.")
    revision: int = Field(description="Of what is cropped and of the unit; 1 is the scan as it was uploaded.")
    removed_count: int = Field(description="Points that are cropped, of an object, or loose.")
    geometry_key: str = Field(description="Part of the address of its geometry; changes with every crop and unit.")
    registration: ScanRegistration | None = None
    created_at: datetime
    created_by_name: str | None


class CollectionOut(BaseModel):
    """Scans that belong together."""

    model_config = ConfigDict(title="ScanCollection")

    name: str
    scans: int
    subjects: int
    subject_names: list[str] = Field(description="Whose hands they are, in the order of the alphabet.")
    registered: int
    failed: int


class ScanRefusal(BaseModel):
    """A file that is no scan, or none that can be used."""

    file: str
    detail: str


class ScansAdded(BaseModel):
    """What an upload brought."""

    added: list[ScanOut]
    known: list[ScanOut] = Field(description="Files that the collection held already, by their SHA-256.")
    refused: list[ScanRefusal]
    notes: list[str] = Field(description="What was noticed beside, such as lines of scans.json without a file.")


class ScanMeasure(BaseModel):
    """How large a file is, before it is stored."""

    file: str
    point_count: int
    size_units: list[float] = Field(
        description="Sides of a box that stands along the scan, in the file's unit, the longest first."
    )
    metres_per_unit: float | None = Field(description="As the `scans.json` beside it says; it wins.")
    guess: float | None = Field(description="A unit that makes a hand of it, m; null when no usual one does.")
    is_certain: bool = Field(description="No other usual unit makes a hand of it: it is taken when nobody says one.")
    picture: str = Field(description="A PNG as `data:` address: the longest way up, seen from the flat side.")
    picture_units: float = Field(description="Length of a side of the picture, in the file's unit.")


class ScansMeasured(BaseModel):
    """What files would be as scans. Nothing is stored."""

    files: list[ScanMeasure]
    refused: list[ScanRefusal]
    notes: list[str]
    hand_lengths_m: list[float] = Field(description="Shortest and longest longest side that a hand may have.")
    longest_scene_m: float = Field(description="Longest side of a scan with other things in it, to be cropped.")


class ScanUnit(BaseModel):
    """The unit of a scan's file."""

    model_config = ConfigDict(extra="forbid")

    metres_per_unit: UnitScale


class ScanPatch(BaseModel):
    """What can be changed of a scan; what is left out stays."""

    model_config = ConfigDict(extra="forbid")

    name: Name | None = None
    collection: Name | None = None
    subject: Label | None = None
    pose: Label | None = None


class PolygonStroke(BaseModel):
    """A line drawn around points on the screen."""

    model_config = ConfigDict(extra="forbid")

    kind: Literal["polygon"]
    corners: list[tuple[Finite, Finite]] = Field(
        min_length=3, max_length=MOST_CORNERS, description="In normalised device coordinates: x right, y up, -1 to 1."
    )
    view: list[Finite] = Field(
        min_length=16,
        max_length=16,
        description="4x4, row by row: scan coordinates (m) to clip coordinates. Points behind the camera stay.",
    )
    removes: Literal["inside", "outside"] = "inside"


class PlaneStroke(BaseModel):
    """Removes what lies beyond a plane."""

    model_config = ConfigDict(extra="forbid")

    kind: Literal["plane"]
    normal: tuple[Finite, Finite, Finite] = Field(description="Not zero.")
    offset: Finite = Field(description="m; points p with normal . p > offset are removed.")


Stroke = Annotated[PolygonStroke | PlaneStroke, Field(discriminator="kind")]


class ScanCrop(BaseModel):
    """What is left out of a scan. The scan itself stays as it is."""

    model_config = ConfigDict(extra="forbid")

    strokes: list[Stroke] = Field(
        max_length=MOST_STROKES, description="All of them; an empty list takes the crop back."
    )
    drops_objects: StrictBool = Field(
        default=True, description="Leave out points of an object painted green too: G > max(R, 20), [R17] 3.1."
    )


class ScanCropOut(BaseModel):
    """What is left out of a scan, as of one revision."""

    model_config = ConfigDict(title="ScanCropRevision")

    revision: int
    strokes: list[Stroke]
    drops_objects: bool
    removed_count: int
    metres_per_unit: float | None = Field(description="The unit of the file as of this revision; the strokes are m.")
    author_name: str | None
    created_at: datetime | None = Field(description="Null for the whole scan.")

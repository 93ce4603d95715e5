"""Camera calibrations as the API gives and takes them."""

from __future__ import annotations

import uuid
from datetime import datetime
from typing import Annotated, Any, Literal

from pydantic import BaseModel, ConfigDict, Field, StrictBool

from server.database.numbers import Number, Whole
from server.database.texts import Name
from tracker.calibration import Board

BoardKind = Literal["charuco", "apriltag", "checkerboard"]
Dictionary = Annotated[str, Field(max_length=40, pattern=r"^[A-Za-z0-9_]*$")]
ResultFile = Literal["cameras.toml", "cameras.yaml", "colmap.zip", "report.json", "report.txt", "board.toml"]


class BoardOptions(BaseModel):
    """A flat board whose corners are known; squares are counted with the outer ones."""

    model_config = ConfigDict(extra="forbid")

    kind: BoardKind = "charuco"
    columns: Whole = Field(default=5, ge=1, le=40, description="Squares across; tags of an AprilTag grid.")
    rows: Whole = Field(default=7, ge=1, le=40)
    square_mm: Number = Field(default=30.0, ge=1, le=1000, description="From one square, or one tag, to the next.")
    marker_mm: Number = Field(
        default=22.5,
        ge=0,
        le=1000,
        description="The side of a marker with its black border; nothing to a checkerboard.",
    )
    dictionary: Dictionary = Field(default="DICT_5X5_100", description="OpenCV's family; nothing to a checkerboard.")
    inverted: StrictBool = Field(default=False, description="Black and white are exchanged.")
    legacy: StrictBool = Field(default=False, description="A ChArUco board as OpenCV drew it before 4.6.")

    def make_board(self) -> Board:
        """The tracker's; raises its `CalibrationError` when there is no such board."""
        has_markers = self.kind != "checkerboard"
        return Board(
            kind=self.kind,
            columns=self.columns,
            rows=self.rows,
            square_m=self.square_mm / 1000,
            marker_m=self.marker_mm / 1000 if has_markers else 0.0,
            dictionary=self.dictionary if has_markers else "",
            is_inverted=self.inverted,
            is_legacy=self.legacy,
        )


class BoardQuery(BoardOptions):
    """The same in an address, where every value is a word."""

    columns: int = Field(default=5, ge=1, le=40)
    rows: int = Field(default=7, ge=1, le=40)
    square_mm: float = Field(default=30.0, ge=1, le=1000, allow_inf_nan=False)
    marker_mm: float = Field(default=22.5, ge=0, le=1000, allow_inf_nan=False)
    inverted: bool = False
    legacy: bool = False


class CalibrationOptions(BaseModel):
    """How cameras are to be calibrated."""

    model_config = ConfigDict(extra="forbid")

    board: BoardOptions = Field(default_factory=BoardOptions)
    find_offsets: StrictBool = Field(
        default=True, description="Look for time offsets; otherwise frames of one number show one moment."
    )
    max_offset_s: Number = Field(default=10.0, ge=0, le=600, description="How far videos may be out of step, s.")
    left_out: Number = Field(default=0.2, ge=0, le=0.5, description="Share of the time to judge by, not to fit to.")
    fps: Number | None = Field(
        default=None, ge=0.001, le=100_000, description="Frames a second of folders of images; null: not known."
    )


class FilmedCamera(BaseModel):
    """What a camera filmed, as its header and first frame say."""

    name: str
    kind: Literal["video", "images"]
    frames: int = Field(description="0: its header does not say.")
    fps: float = Field(description="0: nobody says it.")
    width: int = Field(description="px")
    height: int = Field(description="px")


class FilmReport(BaseModel):
    """What was found before the board is looked for."""

    board: str = Field(description="The board in words; empty when there is no such board.")
    cameras: list[FilmedCamera]
    lenses: list[str] = Field(description="Names of the known lenses.")
    problems: list[str] = Field(description="All that keeps the job from being started, sentences for people.")
    notes: list[str] = Field(description="What one should know.")


class CalibrationOut(BaseModel):
    """Films of a board, and what was found from them."""

    model_config = ConfigDict(title="Calibration", from_attributes=True)

    id: uuid.UUID
    name: str
    state: Literal["checked", "refused"] = Field(description="Of the films, with these options.")
    options: CalibrationOptions
    report: FilmReport
    result: dict[str, Any] | None = Field(
        description="As `report.json`, without its boards, and `files`: names of what can be downloaded. Null until "
        "the job has succeeded."
    )
    job_id: uuid.UUID | None = Field(description="The job that was started last.")
    file_count: int
    byte_count: int = Field(description="Of the upload.")
    created_at: datetime


class CalibrationCheck(BaseModel):
    """Look at the films again, with other options."""

    model_config = ConfigDict(extra="forbid")

    name: Name | None = None
    options: CalibrationOptions


class BoardChoice(BaseModel):
    """A kind of board with its usual measures."""

    label: str
    about: str = Field(description="When to take it, one sentence.")
    board: BoardOptions


class CalibrationForm(BaseModel):
    """What can be chosen."""

    boards: list[BoardChoice] = Field(description="One for each kind, the usual one first.")
    dictionaries: list[str] = Field(description="OpenCV's families of markers.")
    most_cameras: int
    defaults: CalibrationOptions

"""Snapshots, exports and imports of labels as the API gives and takes them."""

from __future__ import annotations

import uuid
from datetime import datetime
from typing import Literal

from pydantic import BaseModel, ConfigDict, Field

from server.annotations.schemas import Hand
from server.database.texts import Name


class LabelFormatOut(BaseModel):
    """A format that labels can be exported to and imported from."""

    model_config = ConfigDict(title="LabelFormat", from_attributes=True)

    name: str
    title: str
    holds: str = Field(description="What of the labels it takes.")
    loses: list[str] = Field(description="What it cannot take.")
    file: str = Field(description="Name of an export.")
    several: bool = Field(description="Whether one export can hold several recordings.")
    needs_3d: bool = Field(description="Whether it holds joints in space and nothing else.")
    carries_sources: bool = Field(description="Whether it says of each joint where it came from.")


class LabelFormats(BaseModel):
    """Every format, and the orders of joints that the option `joint_order` may name."""

    items: list[LabelFormatOut]
    joint_orders: list[str]


class ExportNotes(BaseModel):
    """What an export would hold."""

    format: str
    file: str
    items: int = Field(description="Hands in images.")
    joints: int
    bytes: int
    notes: list[str] = Field(description="What the format could not take, and where 3D positions came from.")


class SnapshotCreate(BaseModel):
    """Keep the labels as they are now."""

    model_config = ConfigDict(extra="forbid")

    name: Name


class SnapshotOut(BaseModel):
    """Labels as they were."""

    model_config = ConfigDict(title="Snapshot")

    id: uuid.UUID
    sequence_id: uuid.UUID
    version: int = Field(description="Counts the snapshots of a recording from 1.")
    name: str
    content_hash: str = Field(description="SHA-256 of the file.")
    item_count: int = Field(description="Hands in images.")
    joint_count: int
    created_at: datetime
    author: str | None


class SnapshotVerification(BaseModel):
    """Whether a snapshot's file is still what it was."""

    is_intact: bool
    expected: str = Field(description="SHA-256 that was noted when it was made.")
    found: str | None = Field(description="SHA-256 of the file now; null when it is gone.")


class HandChangeOut(BaseModel):
    """What became of one hand in one image."""

    model_config = ConfigDict(title="HandChange", from_attributes=True)

    frame: int
    camera: str
    hand: Hand
    kind: Literal["added", "removed", "changed"]
    joints_added: list[str]
    joints_removed: list[str]
    joints_moved: dict[str, float] = Field(description="px that each joint moved.")
    joints_restated: list[str] = Field(description="Joints whose state alone changed: visible, occluded or outside.")
    max_shift_px: float


class LabelComparison(BaseModel):
    """What is different between two states of the labels."""

    hands_added: int
    hands_removed: int
    hands_changed: int
    joints_added: int
    joints_removed: int
    joints_moved: int
    joints_restated: int
    mean_shift_px: float | None = Field(description="Of the joints that moved.")
    max_shift_px: float | None
    items: list[HandChangeOut] = Field(description="The first ones, by frame.")
    is_cut: bool = Field(description="There are more hands than are listed.")


class SnapshotRestored(BaseModel):
    """What a restore did; to undo it, restore `before`."""

    changed: int
    deleted: int
    before: SnapshotOut


class LabelImportOptions(BaseModel):
    """What files of labels may not say."""

    model_config = ConfigDict(extra="forbid")

    format: str | None = Field(default=None, max_length=40, description="Recognised when it is left out.")
    hand: Hand | None = Field(default=None, description="Of files that know one hand only.")
    camera: str | None = Field(default=None, max_length=64, description="Of files that don't name it.")
    pixel_centre: Literal[0, 0.5] | None = Field(  # pyright: ignore[reportInvalidTypeForm]
        default=None, description="Coordinate of the centre of the top-left pixel in the file."
    )
    joint_order: str | None = Field(default=None, max_length=40, description="Of files that number the joints.")


class RecordingImport(BaseModel):
    """What an import would do to one recording."""

    sequence_id: uuid.UUID
    name: str
    new: int = Field(description="Hands where there are no labels yet.")
    same: int = Field(description="Hands whose labels are those of the file already.")
    conflict_count: int
    conflicts: list[HandChangeOut] = Field(description="Hands with other labels, the first ones.")
    locked: int = Field(description="Hands that must not be changed now; they are left as they are.")
    reasons: list[str] = Field(description="Why not.")


class LabelImportReport(BaseModel):
    """What was found in files of labels. Nothing is stored."""

    format: str
    title: str
    problems: list[str] = Field(description="Reasons to refuse all of it.")
    warnings: list[str]
    recordings: list[RecordingImport]
    check: str | None = Field(description="Send it with the same files to import them; null when they are refused.")


class RecordingImported(BaseModel):
    """What an import did to one recording; to undo it, restore `before`."""

    sequence_id: uuid.UUID
    added: int
    replaced: int
    kept: int
    locked: int
    before: SnapshotOut | None


class LabelImportDone(BaseModel):
    """What an import did."""

    format: str
    recordings: list[RecordingImported]

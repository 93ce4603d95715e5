"""Viewer sessions as the API gives and takes them."""

from __future__ import annotations

import uuid

from pydantic import BaseModel, ConfigDict, Field


class Show(BaseModel):
    """Layers to show or hide; those not named stay as they are."""

    cloud: bool | None = None
    mesh: bool | None = None
    skeleton: bool | None = None
    correspondences: bool | dict[str, bool] | None = Field(None, description="All of them, or term by term.")
    dark: bool | None = Field(None, description="Dark ground.")


class ViewerSessionCreate(BaseModel):
    """What to look at."""

    track_id: uuid.UUID
    frame: int | None = Field(None, description="Frame to begin with; the track's first without it.")
    show: Show | None = None


class ViewerSessionChange(BaseModel):
    """Where to go and what to show."""

    frame: int | None = None
    show: Show | None = None


class Term(BaseModel):
    """Correspondences of one term in the frame that is shown."""

    name: str
    count: int
    color: str = Field(description="As in CSS.")


class ViewerSessionOut(BaseModel):
    """A session; its page is at `url`."""

    model_config = ConfigDict(title="ViewerSession")

    id: uuid.UUID
    track_id: uuid.UUID
    url: str
    frame: int
    terms: list[Term]
    milliseconds: float = Field(description="That the scene took.")

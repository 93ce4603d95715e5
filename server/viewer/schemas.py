"""Viewer sessions as the API gives and takes them."""

from __future__ import annotations

import uuid

from pydantic import BaseModel, ConfigDict, Field, StrictBool

from server.database.numbers import Whole


class Show(BaseModel):
    """Layers to show or hide; those not named stay as they are."""

    cloud: StrictBool | None = None
    mesh: StrictBool | None = None
    skeleton: StrictBool | None = None
    correspondences: StrictBool | dict[str, StrictBool] | None = Field(
        None, description="All of them, or term by term."
    )
    detections: StrictBool | None = Field(None, description="Fingertips found in the image.")
    collisions: StrictBool | None = Field(None, description="Crossing triangles and penetrating vertices.")
    contacts: StrictBool | None = Field(None, description="Finger parts that could hold the object.")
    unknown: StrictBool | None = Field(None, description="What is neither hand nor a model, in a colour of its own.")
    distances: StrictBool | None = Field(None, description="The meshes in colours of their distance to the data.")
    cameras: StrictBool | None = Field(
        None,
        description="All cameras, and the rays along which those saw joints that are tracked in together.",
    )
    dark: StrictBool | None = Field(None, description="Dark ground.")


class ViewerSessionCreate(BaseModel):
    """What to look at."""

    track_id: uuid.UUID
    frame: Whole | None = Field(None, description="Frame to begin with; the track's first without it.")
    show: Show | None = None


class ViewerSessionChange(BaseModel):
    """Where to go and what to show."""

    frame: Whole | None = None
    show: Show | None = None


class Term(BaseModel):
    """Correspondences of one term in the frame that is shown."""

    name: str
    label: str = Field(description="For people.")
    count: int
    color: str = Field(description="As in CSS, on the ground that is shown.")


class DetectionView(BaseModel):
    """A fingertip found in the image."""

    hand: str | None = Field(description="Of the fingertip it was assigned to; null for a false positive.")
    finger: str | None
    color: str = Field(description="As in CSS.")
    confidence: float = Field(description="From 3 on it counts.")
    distance_mm: float | None = Field(description="From that fingertip of the model.")


class DetectionsView(BaseModel):
    """Fingertips found in the frame that is shown."""

    is_of_run: bool = Field(description="Whether the run used such detections itself.")
    own_detector: str | None = Field(
        description="Name of the lab's own detector that found them; null for the one that comes with Handloom."
    )
    items: list[DetectionView]


class CollidingParts(BaseModel):
    """Two parts that stand in each other."""

    first: str
    second: str
    crossings: int = Field(description="Pairs of triangles that cross.")
    deepest_mm: float


class CollisionsView(BaseModel):
    """What stands in each other in the frame that is shown."""

    is_of_run: bool = Field(description="Whether the run had the collision term.")
    triangles: int = Field(description="That cross another.")
    vertices: int = Field(description="Inside a part that they may not enter.")
    deepest_mm: float
    full_mm: float = Field(description="Depth at which the colours of the vertices end.")
    pairs: list[CollidingParts] = Field(description="The deepest first.")


class ContactPart(BaseModel):
    """A finger part near the object."""

    hand: str
    part: str
    distance_mm: float = Field(description="To the object's surface, below 0 inside.")
    is_chosen: bool = Field(description="Whether physics would draw it into contact.")


class ContactsView(BaseModel):
    """Whether the object stays where it is when the frame's pose is simulated."""

    is_of_run: bool = Field(description="Whether the run had the physics term.")
    object: str | None = Field(description="Null where nothing was simulated.")
    fault: str | None = Field(description="Why nothing can be simulated on this machine; null where it can.")
    is_stable: bool
    displacement_mm: float = Field(description="Of the object's centroid.")
    held_displacement_mm: float = Field(description="With the chosen parts in contact.")
    simulated: int = Field(description="Combinations of parts tried.")
    parts: list[ContactPart] = Field(description="Those within 10 mm that were considered, nearest first.")


class UnknownView(BaseModel):
    """What the run left out near the hands, as neither hand nor a model, in the frame that is shown."""

    color: str = Field(description="As in CSS.")
    pixels: int = Field(description="Of the depth image.")
    before: int = Field(description="Those of them that hide the hand.")
    by_color: bool = Field(
        description="Whether colour told hand from other things; otherwise only what hides the hand is known."
    )


class ModelDistance(BaseModel):
    """How far a model's visible skin is from the data."""

    name: str
    visible_share: float = Field(description="Of its vertices that the camera sees.")
    median_mm: float | None
    p95_mm: float | None


class DistancesView(BaseModel):
    """How far visible skin is from the data in the frame that is shown."""

    full_mm: float = Field(description="Distance at which the colours end.")
    models: list[ModelDistance]


class ViewerSessionOut(BaseModel):
    """A session; its page is at `url`."""

    model_config = ConfigDict(title="ViewerSession")

    id: uuid.UUID
    track_id: uuid.UUID
    url: str
    frame: int
    terms: list[Term] = Field(description="Empty while correspondences are hidden.")
    detections: DetectionsView | None = Field(description="Null while hidden.")
    collisions: CollisionsView | None = Field(description="Null while hidden.")
    contacts: ContactsView | None = Field(description="Null while hidden.")
    unknown: UnknownView | None = Field(description="Null while hidden.")
    distances: DistancesView | None = Field(description="Null while hidden.")
    milliseconds: float = Field(description="That the scene took.")

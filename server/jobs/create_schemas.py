"""What a request to start a job may hold, whatever its kind."""

from __future__ import annotations

from typing import Annotated, Any

from pydantic import Discriminator, Tag

from server.jobs.calibrate_schemas import CalibrateJobCreate
from server.jobs.detect_schemas import DetectJobCreate
from server.jobs.loop_schemas import LoopJobCreate
from server.jobs.moving_schemas import RegisterMovingJobCreate
from server.jobs.register_schemas import RegisterJobCreate
from server.jobs.track_schemas import JobCreate
from server.jobs.train_schemas import TrainJobCreate


def _read_kind(body: Any) -> Any:
    """A body without a kind asks for tracking, as it did when there were no other kinds."""
    return body.get("kind", "track") if isinstance(body, dict) else getattr(body, "kind", "track")


AnyJobCreate = Annotated[
    Annotated[JobCreate, Tag("track")]
    | Annotated[DetectJobCreate, Tag("detect")]
    | Annotated[CalibrateJobCreate, Tag("calibrate")]
    | Annotated[RegisterJobCreate, Tag("register")]
    | Annotated[TrainJobCreate, Tag("train")]
    | Annotated[LoopJobCreate, Tag("loop")]
    | Annotated[RegisterMovingJobCreate, Tag("register_moving")],
    Discriminator(_read_kind),
]
"""What a job of any kind is to do."""

"""Jobs, logs and workers as the API gives and takes them."""

from __future__ import annotations

import uuid
from datetime import datetime
from typing import Annotated, Any, Literal

from pydantic import BaseModel, ConfigDict, Discriminator, Field, StrictBool, Tag, model_validator

from server.database.numbers import Whole
from server.database.texts import Label, Name
from server.jobs.moving_schemas import RegisterMovingJobCreate
from server.registrations.training_set_schemas import TrainingRule

JobKind = Literal["track", "detect", "register", "train", "loop", "calibrate", "register_moving"]
JobState = Literal["queued", "running", "succeeded", "failed", "cancelled"]


class JobCreate(BaseModel):
    """What to do."""

    kind: Literal["track"] = "track"
    sequence_id: uuid.UUID
    params: dict[str, Any] = Field(
        default_factory=dict, description="Options of the tracker; `GET /jobs/form` lists them."
    )


class DetectCreate(BaseModel):
    """A recording whose hands are to be found."""

    model_config = ConfigDict(extra="forbid")

    sequence_id: uuid.UUID


class CalibrateCreate(BaseModel):
    """Films of a board whose cameras are to be calibrated, with the options that were checked last."""

    model_config = ConfigDict(extra="forbid")

    calibration_id: uuid.UUID


class RegisterCreate(BaseModel):
    """Scans to register."""

    model_config = ConfigDict(extra="forbid")

    scan_ids: list[uuid.UUID] = Field(default_factory=list, max_length=5000, description="Empty: as the rest says.")
    collection: str | None = Field(default=None, max_length=200, description="Null: of all collections.")
    subject: str | None = Field(default=None, max_length=100)
    only: Literal["new", "not_accepted", "all"] = Field(
        default="new",
        description="`new`: those that this model has not registered as they are cropped now; `not_accepted`: those "
        "whose newest registration nobody accepted.",
    )
    model_id: uuid.UUID | None = Field(default=None, description="Null: the model that nobody has trained yet.")


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


class LoopCreate(BaseModel):
    """Register, choose, train, register again."""

    model_config = ConfigDict(extra="forbid")

    name: Name = Field(description="Of the models; the round is added.")
    collection: str | None = Field(default=None, max_length=200, description="Null: all scans.")
    model_id: uuid.UUID | None = Field(default=None, description="To begin with; null: the one not trained yet.")
    by: Literal["verdict", "decisions"] = Field(
        default="verdict",
        description="What is trained from. `verdict`: what the program calls good and nobody rejected; `decisions`: "
        "what people have accepted by now. Then one round is done, and its registrations wait for people.",
    )
    rounds: Whole = Field(default=1, ge=1, le=10, description="By decisions: 1.")
    leave_out_subjects: list[Label] = Field(default_factory=list, max_length=1000, description="Kept for testing.")
    options: TrainingParams = Field(default_factory=TrainingParams)
    evaluate: Evaluate = "no"


class DetectJobCreate(DetectCreate):
    """A job that finds the hands in every image of a recording; they are suggested to whoever annotates it."""

    kind: Literal["detect"]


class CalibrateJobCreate(CalibrateCreate):
    """A job that calibrates cameras from what they filmed of a board."""

    kind: Literal["calibrate"]


class RegisterJobCreate(RegisterCreate):
    """A job that registers scans; each can be curated as soon as it is done."""

    kind: Literal["register"]


class TrainJobCreate(TrainCreate):
    """A job that trains a hand model from a training set."""

    kind: Literal["train"]


class LoopJobCreate(LoopCreate):
    """A job that registers all scans, chooses, trains, and registers all with the new model."""

    kind: Literal["loop"]


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


class BatchCreate(BaseModel):
    """The same for several recordings."""

    kind: Literal["track"] = "track"
    sequence_ids: list[uuid.UUID] = Field(min_length=1, max_length=500, description="One job for each.")
    params: dict[str, Any] = Field(default_factory=dict, description="As of one job; the same for all.")


class JobCheck(BaseModel):
    """Whether a job can be started, asked before it is."""

    can_start: bool
    obstacles: list[str] = Field(description="Why not, sentences for people. The request for the job is refused so.")
    notes: list[str] = Field(description="What one should know, though the job can be started.")


class RestartCheck(BaseModel):
    """What can be done with a job that has ended without success, and what is kept of it."""

    resume: JobCheck
    retry: JobCheck
    kept: list[str] = Field(description="What it has done so far and need not do again, for people.")


class JobWorker(BaseModel):
    """The worker that runs a job, or ran it last."""

    id: uuid.UUID
    name: str
    host: str


class JobOut(BaseModel):
    """A job as it is now."""

    model_config = ConfigDict(title="Job")

    id: uuid.UUID
    kind: str
    state: JobState
    title: str = Field(description="The recording as it is called now, or what else it is about.")
    sequence_id: uuid.UUID | None = Field(description="The recording of a job that tracks or detects.")
    moving_scan_id: uuid.UUID | None = Field(description="The moving scan of a job that registers one.")
    track_id: uuid.UUID | None = Field(description="What a tracking job produced.")
    hand_model_id: uuid.UUID | None = Field(description="What training produced, the last model of a loop.")
    params: dict[str, Any]
    progress: float = Field(ge=0, le=1)
    stage: str = Field(description="What is being done, for people.")
    frames_done: int = Field(description="Or scans or cameras, see `unit`.")
    frames_total: int = Field(description="0 while not known.")
    unit: Literal["frames", "scans", "cameras"] = Field(description="What is counted.")
    seconds_left: float | None
    error: str | None = Field(description="What went wrong, for people.")
    attempt: int = Field(description="1, and one more for every resume.")
    retry_of: uuid.UUID | None
    batch_id: uuid.UUID | None = Field(description="Shared by the jobs that one request started.")
    created_by: uuid.UUID | None
    created_by_name: str | None = Field(description="Who started it; null for jobs of before there were accounts.")
    worker: JobWorker | None = Field(description="Who runs it, or ran it last.")
    version: int = Field(description="Grows with every change.")
    created_at: datetime
    started_at: datetime | None
    ended_at: datetime | None


class BatchOut(BaseModel):
    """Jobs that one request started, taken together. A job that was tried again is counted once, as its last try."""

    model_config = ConfigDict(title="Batch")

    id: uuid.UUID
    kind: str
    params: dict[str, Any]
    created_at: datetime
    created_by: uuid.UUID | None
    created_by_name: str | None
    ended_at: datetime | None = Field(description="When the last of them ended; null while one has not.")
    total: int
    states: dict[JobState, int] = Field(description="How many are in each state.")
    progress: float = Field(ge=0, le=1)
    seconds_left: float | None = Field(description="With as many workers as are at it now; null while not known.")


class BatchMade(BaseModel):
    """A batch and its jobs, in the order of the recordings."""

    batch: BatchOut
    jobs: list[JobOut]


class BulkAct(BaseModel):
    """One act on several jobs."""

    act: Literal["cancel", "retry", "resume"]
    job_ids: list[uuid.UUID] = Field(min_length=1, max_length=500)


class BulkRefusal(BaseModel):
    """One that it could not be done to."""

    id: uuid.UUID
    detail: str = Field(description="Why, for people.")


class BatchCheck(BaseModel):
    """Which of several recordings cannot be tracked so."""

    refused: list[BulkRefusal]


class BulkDone(BaseModel):
    """What became of each."""

    jobs: list[JobOut] = Field(description="Those it was done to; of `retry` the new ones.")
    refused: list[BulkRefusal]


class JobLogLine(BaseModel):
    """One line of a job's log."""

    n: int
    time: datetime
    level: Literal["info", "warning", "error"]
    text: str


class JobLog(BaseModel):
    """Lines of a job's log, in order."""

    lines: list[JobLogLine]


class JobFormField(BaseModel):
    """One option of the tracker."""

    name: str
    label: str
    type: Literal["integer", "number", "boolean", "text"]
    default: int | float | bool | str
    help: str
    choices: list[str] | None = Field(description="The only values there are; null when any will do.")
    choice_labels: list[str] | None = Field(description="The choices for people, in the same order.")
    low: float | None = Field(description="Smallest number allowed.")
    high: float | None = Field(description="Largest number allowed.")
    unit: str | None = Field(description="Of a number.")
    is_advanced: bool = Field(description="Few people ever set it.")
    about: Literal["recording", "method", "machine"] = Field(
        description="What is tracked, how, or with what; presets are about the method."
    )


class JobPreset(BaseModel):
    """Values of some options that go together."""

    model_config = ConfigDict(from_attributes=True)

    name: str
    label: str
    help: str = Field(description="One sentence.")
    one_hand_ms: float = Field(description="Measured median time of a frame with one hand, ms.")
    two_hands_and_object_ms: float = Field(description="The same with two hands and an object, ms.")
    values: dict[str, int | float | bool | str] = Field(description="As in `params`.")


class JobForm(BaseModel):
    """Options that a tracking job takes as `params`."""

    kind: str
    fields: list[JobFormField]
    presets: list[JobPreset] = Field(description="From the quickest to the most thorough.")
    usual_preset: str = Field(description="Name of the one that forms begin with; jobs without params take defaults.")


class WorkerOut(BaseModel):
    """A worker process."""

    model_config = ConfigDict(title="Worker")

    id: uuid.UUID
    name: str
    host: str
    pid: int
    state: Literal["running", "silent", "stopped", "lost"]
    job_id: uuid.UUID | None = Field(description="What it is doing.")
    started_at: datetime
    last_seen_at: datetime

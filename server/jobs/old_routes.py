"""`/jobs/<kind>`, an operation for each kind of job: `POST /jobs` and `POST /jobs/check` have taken their place."""

from __future__ import annotations

from fastapi import APIRouter

from server.access.service import ReviewerAccount
from server.database import SessionDep
from server.deprecation import deprecated
from server.errors import error_responses
from server.jobs.calibrate_schemas import CalibrateCreate
from server.jobs.describe import describe_job
from server.jobs.detect_schemas import DetectCreate
from server.jobs.job_kinds import OneKindCreate, find_obstacles, start_job
from server.jobs.loop_schemas import LoopCreate
from server.jobs.obstacles import make_check
from server.jobs.register_schemas import RegisterCreate
from server.jobs.schemas import JobCheck, JobOut
from server.jobs.train_schemas import TrainCreate
from server.storage import StorageDep

router = APIRouter(prefix="/jobs", tags=["jobs"], responses=error_responses())

KINDS: dict[str, type[OneKindCreate]] = {
    "detect": DetectCreate,
    "register": RegisterCreate,
    "train": TrainCreate,
    "loop": LoopCreate,
    "calibrate": CalibrateCreate,
}


def _add(kind: str, schema: type[OneKindCreate]) -> None:
    def check(body: OneKindCreate, session: SessionDep, storage: StorageDep, account: ReviewerAccount) -> JobCheck:
        return make_check(session, find_obstacles(session, storage, body))

    def create(body: OneKindCreate, session: SessionDep, storage: StorageDep, account: ReviewerAccount) -> JobOut:
        return describe_job(session, start_job(session, storage, body, account.id))

    for route in (check, create):
        route.__annotations__["body"] = schema
    shared = {"responses": error_responses(404)}
    router.post(
        f"/{kind}/check",
        name=f"check_{kind}_job",
        description=f"`POST /jobs/check` with `kind: {kind}`.",
        **shared,
        **deprecated("/jobs/check"),
    )(check)
    router.post(
        f"/{kind}",
        status_code=201,
        name=f"create_{kind}_job",
        description=f"`POST /jobs` with `kind: {kind}`.",
        **shared,
        **deprecated("/jobs"),
    )(create)


for _kind, _schema in KINDS.items():
    _add(_kind, _schema)

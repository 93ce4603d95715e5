"""Jobs that ended without success: what is kept of them, and whether they can go on or be tried again."""

from __future__ import annotations

import uuid

from sqlalchemy.orm import Session

from server.jobs.calibrating import KIND, find_calibrate_obstacles, read_calibration_id
from server.jobs.create_jobs import list_job_scans
from server.jobs.files import JobFiles
from server.jobs.loop_schemas import LoopCreate
from server.jobs.models import JobRow
from server.jobs.moving import KIND as MOVING
from server.jobs.moving import find_moving_obstacles, read_moving
from server.jobs.obstacles import find_detect_obstacles, find_model_obstacles, find_track_obstacles, make_check
from server.jobs.schemas import RestartCheck
from server.jobs.train_schemas import TrainCreate
from server.jobs.training_obstacles import find_loop_obstacles, find_train_obstacles
from server.storage import Storage
from tracker import say_count

ACTS = ("retry", "resume")


def check_restart(session: Session, storage: Storage, job: JobRow) -> RestartCheck:
    """What can be done with a job that has ended."""
    check = make_check(session, find_restart_obstacles(session, storage, job))
    return RestartCheck(resume=check, retry=check, kept=list_kept(storage, job))


def find_restart_obstacles(session: Session, storage: Storage, job: JobRow) -> list[str]:
    """Why a job would fail if it were done now: what was there when it was made may be gone."""
    if job.kind == "track":
        assert job.sequence_id is not None, "a tracking job has a recording"
        return find_track_obstacles(session, job.sequence_id, job.params)
    if job.kind == "detect":
        assert job.sequence_id is not None, "a detecting job has a recording"
        return find_detect_obstacles(session, job.sequence_id)
    if job.kind == MOVING:
        return find_moving_obstacles(session, storage, read_moving(job))
    if job.kind == KIND:
        return find_calibrate_obstacles(session, storage, read_calibration_id(job), again=True)
    if job.kind == "register":
        return find_model_obstacles(session, storage, uuid.UUID(job.params["model_id"]), deleted_too=True)
    if job.kind == "train":
        asked = {name: value for name, value in job.params.items() if name in TrainCreate.model_fields}
        return find_train_obstacles(session, storage, TrainCreate.model_validate(asked))
    return find_loop_obstacles(session, storage, read_loop(job), list_job_scans(session, job.id))


def read_loop(job: JobRow) -> LoopCreate:
    """What was asked of a loop."""
    return LoopCreate.model_validate({name: value for name, value in job.params.items() if name != "model"})


def list_kept(storage: Storage, job: JobRow) -> list[str]:
    """What a job has done so far, for people; a step that was broken off does not count."""
    if job.kind == "track":
        return _list_kept_of_tracking(storage, job)
    if job.kind == MOVING:
        return _list_kept_of_moving(storage, job)
    if job.kind == "detect":
        return _list_kept_frames(JobFiles(storage.folder("jobs", job.id), storage.remote_folder("jobs", job.id)))
    kept: list[str] = []
    if job.kind == KIND:
        cameras = len(list(storage.folder("jobs", job.id).glob("corners-*.json")))
        return [f"where the board was seen in {say_count(cameras, 'camera')}"] if cameras else []
    if job.frames_done > 0:
        kept.append("1 registration" if job.frames_done == 1 else f"{job.frames_done} registrations")
    if job.hand_model_id is not None:
        kept.append("the model that was trained")
    elif stages := len(list(storage.folder("jobs", job.id).glob("train-*.json"))):
        kept.append("1 stage of the training" if stages == 1 else f"{stages} stages of the training")
    return kept


def _list_kept_of_moving(storage: Storage, job: JobRow) -> list[str]:
    """The person's model, or frames of it, and the registered frames."""
    if job.frames_done > 0:
        return ["the person's own model", say_count(job.frames_done, "registered frame")]
    frames = len(list(storage.folder("jobs", job.id).glob("template-*.json")))
    return [f"{say_count(frames, 'frame')} of the person's own model"] if frames else []


def _list_kept_of_tracking(storage: Storage, job: JobRow) -> list[str]:
    files = JobFiles(storage.folder("jobs", job.id), storage.remote_folder("jobs", job.id))
    if not files.is_done("start"):
        return []
    start = "the fitted shape of the hands" if job.params.get("calibrate", True) else "the first pose"
    return [start, *_list_kept_frames(files)]


def _list_kept_frames(files: JobFiles) -> list[str]:
    manifest = files.read_manifest("start") or {"chunks": []}
    done = 0
    while done < len(manifest["chunks"]) and files.is_done(f"chunk-{done:04d}"):
        done += 1
    return [f"frames {manifest['chunks'][0][0]} to {manifest['chunks'][done - 1][1] - 1}"] if done else []

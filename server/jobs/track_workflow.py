"""The workflow of a tracking job: a step for each chunk of frames."""

from __future__ import annotations

import json
import uuid
from pathlib import Path
from typing import Any
from uuid import UUID

from dbos import DBOS
from sqlalchemy import select

from server.annotations.service import export_annotations
from server.detectors import service as detectors
from server.hand_models.service import get_hand_model
from server.hand_models.storing import find_file
from server.jobs.files import JobFiles
from server.jobs.models import JobRow
from server.jobs.run import JobRun, WorkerContext
from server.jobs.service import DETECTOR, HAND_MODEL
from server.jobs.tracking import TrackingJob
from server.sequences.service import get_sequence
from server.tracks.service import add_track

MOST_OTHERS = 5
"""Jobs, at most, whose start is looked at."""

TRACK_NAMESPACE = UUID("7a1d4c53-3a0f-4f0e-9a52-6f1d0c9b8e21")


def register_track_workflow(context: WorkerContext):
    """Make the workflow `track` known to DBOS."""

    @DBOS.step(name="snapshot")
    def snapshot(job_id: str) -> dict[str, Any]:
        return _TrackRun(context, UUID(job_id)).snapshot()

    @DBOS.step(name="start")
    def start(job_id: str, attempt: int) -> dict[str, Any]:
        run = _TrackRun(context, UUID(job_id))
        return run.job.start(run.progress(attempt), run.list_others())

    @DBOS.step(name="chunk")
    def chunk(job_id: str, attempt: int, begun: dict[str, Any], number: int) -> dict[str, Any]:
        run = _TrackRun(context, UUID(job_id))
        return run.job.track_chunk(begun, number, run.progress(attempt))

    @DBOS.step(name="finish")
    def finish(job_id: str, attempt: int, begun: dict[str, Any]) -> str:
        return str(_TrackRun(context, UUID(job_id)).finish(attempt, begun))

    @DBOS.workflow(name="track", max_recovery_attempts=1000)
    def track(job_id: str, attempt: int) -> str:
        run = _TrackRun(context, UUID(job_id))

        def work() -> None:
            run.files.check(snapshot(job_id)["files"])
            begun = start(job_id, attempt)
            run.files.check(begun["files"])
            for number in range(len(begun["chunks"])):
                run.files.check(chunk(job_id, attempt, begun, number)["files"])
            finish(job_id, attempt, begun)

        return run.attempt(attempt, work)

    return track


class _TrackRun(JobRun):
    """One tracking job in this worker."""

    @property
    def _sequence_id(self) -> UUID:
        assert self.row.sequence_id is not None, "a tracking job has a recording"
        return self.row.sequence_id

    @property
    def job(self) -> TrackingJob:
        recording = self.context.storage.refresh("sequences", self._sequence_id)
        with self.context.database.reading() as session:
            content_key = get_sequence(session, self._sequence_id, deleted_too=True).content_key
        files = (self._find_hand_model(), self._find_detector())
        return TrackingJob(recording, self.row.params, self.files, content_key, *files)

    def list_others(self) -> list[tuple[str, JobFiles]]:
        """Jobs of the recording that ended without success, the newest first: their files are kept."""
        storage = self.context.storage
        query = select(JobRow).where(
            JobRow.kind == "track",
            JobRow.sequence_id == self._sequence_id,
            JobRow.id != self.job_id,
            JobRow.state.in_(("cancelled", "failed")),
        )
        with self.context.database.reading() as session:
            rows = session.scalars(query.order_by(JobRow.ended_at.desc()).limit(MOST_OTHERS)).all()
        return [
            (
                f"the job that {'was cancelled' if row.state == 'cancelled' else 'failed'} before",
                JobFiles(storage.folder("jobs", row.id), storage.remote_folder("jobs", row.id)),
            )
            for row in rows
        ]

    def _find_hand_model(self) -> Path | None:
        from tracker import BUILT_IN_HANDS

        model_id = self.row.params.get(HAND_MODEL)
        if not model_id or model_id in BUILT_IN_HANDS:
            return None
        with self.context.database.reading() as session:
            return find_file(self.context.storage, get_hand_model(session, UUID(model_id), deleted_too=True))

    def _find_detector(self) -> tuple[str, Path] | None:
        detector_id = self.row.params.get(DETECTOR)
        if not detector_id:
            return None
        with self.context.database.reading() as session:
            row = detectors.get_detector(session, UUID(detector_id), deleted_too=True)
            return row.name, detectors.find_file(self.context.storage, row)

    def snapshot(self) -> dict[str, Any]:
        """Keep the annotations as they are now: doing a step again must not see later ones."""
        kept = self.files.read_manifest("snapshot")
        if kept is not None:
            return kept
        with self.context.database.reading() as session:
            document = export_annotations(session, self._sequence_id)
        self.files.write(self.files.annotations, lambda path: path.write_text(json.dumps(document)))
        return self.files.write_manifest("snapshot", [self.files.annotations], {})

    def finish(self, attempt: int, begun: dict[str, Any]) -> UUID:
        """Store the track and its row, and end the job, in one transaction."""
        track_id = uuid.uuid5(TRACK_NAMESPACE, str(self.job_id))
        folder = self.context.storage.folder("tracks", track_id)
        self.job.finish(begun, folder, self.progress(attempt))
        self.context.storage.publish("tracks", track_id)
        with self.context.database.writing() as session:
            add_track(session, folder, track_id, self._sequence_id, self.job_id)
            self.end(session, attempt, "succeeded", track_id=track_id, progress=1.0, frames_done=begun["frames"])
        self.context.on_track(track_id)
        return track_id

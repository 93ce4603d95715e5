"""The workflow of a job that finds the hands in a recording's images: a step for each chunk of frames.

What is found depends on the recording alone: what was seen in the last frame of a chunk goes through its manifest,
whether the next chunk is done in the same process or after a crash.
"""

from __future__ import annotations

import uuid
from collections.abc import Mapping
from itertools import pairwise
from typing import TYPE_CHECKING, Any
from uuid import UUID

import numpy as np
from dbos import DBOS

from server.jobs.detections import AREA
from server.jobs.progress import TRACKING_ENDS
from server.jobs.run import JobRun, WorkerContext

if TYPE_CHECKING:
    from tracker import Sequence as Recording
    from tracker.landmarks import DetectedHand

CHUNK_FRAMES = 20
"""Frames a step looks at; what a crash can cost."""

STAGE = "looking for hands"


def register_detect_workflow(context: WorkerContext):
    """Make the workflow `detect` known to DBOS."""

    @DBOS.step(name="plan detection")
    def plan(job_id: str) -> dict[str, Any]:
        return _DetectRun(context, UUID(job_id)).plan()

    @DBOS.step(name="detect chunk")
    def chunk(job_id: str, attempt: int, planned: dict[str, Any], number: int) -> dict[str, Any]:
        return _DetectRun(context, UUID(job_id)).detect_chunk(attempt, planned, number)

    @DBOS.step(name="finish detection")
    def finish(job_id: str, attempt: int, planned: dict[str, Any]) -> str:
        return _DetectRun(context, UUID(job_id)).finish(attempt, planned)

    @DBOS.workflow(name="detect", max_recovery_attempts=1000)
    def detect(job_id: str, attempt: int) -> str:
        run = _DetectRun(context, UUID(job_id))

        def work() -> None:
            planned = plan(job_id)
            for number in range(len(planned["chunks"])):
                run.files.check(chunk(job_id, attempt, planned, number)["files"])
            finish(job_id, attempt, planned)

        return run.attempt(attempt, work)

    return detect


class _DetectRun(JobRun):
    """One such job in this worker."""

    def load_recording(self) -> Recording:
        from tracker import load_sequence

        assert self.row.sequence_id is not None, "a detecting job has a recording"
        return load_sequence(self.context.storage.refresh("sequences", self.row.sequence_id))

    def plan(self) -> dict[str, Any]:
        """Which views are looked at, and the chunks of frames."""
        from tracker.detection import choose_views

        if (manifest := self.files.read_manifest("start")) is not None:
            return manifest
        recording = self.load_recording()
        borders = [*range(0, recording.frame_count, CHUNK_FRAMES), recording.frame_count]
        chunks = [list(pair) for pair in pairwise(borders)]
        return self.files.write_manifest("start", [], {"views": list(choose_views(recording)), "chunks": chunks})

    def detect_chunk(self, attempt: int, planned: dict[str, Any], number: int) -> dict[str, Any]:
        """Look at one chunk of frames; its hands and those of its last frame are kept."""
        from tracker.detection import detect_hands
        from tracker.landmarks import default_hand_detector

        progress, step = self.progress(attempt), f"chunk-{number:04d}"
        (first, end), total = planned["chunks"][number], planned["chunks"][-1][1]
        manifest = self.files.read_manifest(step)
        if manifest is None:
            before = self.files.read_manifest(f"chunk-{number - 1:04d}") if number else None
            found, last = detect_hands(
                self.load_recording(),
                default_hand_detector(),
                planned["views"],
                range(first, end),
                {} if before is None else _read_hands(before["last"]),
                lambda frame: progress.frames(frame + 1, total, 0.0, STAGE),
            )
            path = self.files.folder / f"{step}-hands.json"
            self.files.write(path, found.save)
            manifest = self.files.write_manifest(step, [path], {"last": _write_hands(last)})
        progress.chunk_done(end, total, 0.0, f"looked at frames {first} to {end - 1}", STAGE)
        return manifest

    def finish(self, attempt: int, planned: dict[str, Any]) -> str:
        """Keep what was found, and end the job."""
        from tracker import say_count
        from tracker.detection import join_recorded_hands, load_recorded_hands

        progress = self.progress(attempt)
        progress.part((TRACKING_ENDS, 1.0), "writing what was found", 0.0)
        parts = [
            load_recorded_hands(self.files.folder / f"chunk-{number:04d}-hands.json")
            for number in range(len(planned["chunks"]))
        ]
        found = join_recorded_hands(parts)
        path = self.files.folder / f".{uuid.uuid4().hex}.json"
        path.parent.mkdir(parents=True, exist_ok=True)
        found.save(path)
        storage = self.context.storage
        if not storage.document(AREA, self.job_id).exists():  # a step done twice finds it there
            storage.add_document(AREA, self.job_id, path.read_bytes())
        path.unlink()
        total = len(found.frames)
        for side, count in found.count_frames().items():
            if count:
                progress.log("info", f"the {side} hand was found in {count} of {say_count(total, 'frame')}")
        if not found.hands.items:
            progress.log("warning", "no hand was found in any image")
        with self.context.database.writing() as session:
            self.end(session, attempt, "succeeded", progress=1.0, frames_done=total)
        return str(self.job_id)


def _write_hands(last: Mapping[str, Mapping[str, DetectedHand]]) -> dict[str, dict[str, list[float]]]:
    return {view: {side: hand.to_row().tolist() for side, hand in hands.items()} for view, hands in last.items()}


def _read_hands(written: dict[str, dict[str, list[float]]]) -> dict[str, dict[str, DetectedHand]]:
    from tracker.landmarks import DetectedHand

    return {
        view: {side: DetectedHand.from_row(np.array(row)) for side, row in hands.items()}
        for view, hands in written.items()
    }

"""Frames of a moving scan among the working files of its job: what `tracker.bodies.chunks` goes through."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from server.jobs.failure import hide_paths
from server.moving_scans import registrations
from server.moving_scans.service import find_scan_file
from server.moving_scans.storing import AREA, BODY, write_frame

if TYPE_CHECKING:
    from server.jobs.moving_run import MovingRun
    from tracker import Scan, TrackerError
    from tracker.bodies import BodyFollower, BodyRegistration


class MovingFrames:
    """What one chunk, or the seam behind it, reads and keeps.

    Args:
        run: The job.
        attempt: Of the job.
        begins: Share of the progress bar at the first frame.
    """

    def __init__(self, run: MovingRun, attempt: int, begins: float = 0.0) -> None:
        self._run, self._begins, self._progress = run, begins, run.progress(attempt)
        self._scan: tuple[int, Scan] | None = None

    def read(self, frame: int) -> Scan:
        from tracker.bodies import load_body_scan

        if self._scan is None or self._scan[0] != frame:
            path = find_scan_file(self._run.context.storage, self._run.scan_row, frame)
            self._scan = frame, load_body_scan(path, self._run.scan_row.metres_per_unit)[0]
        return self._scan[1]

    def find(self, frame: int) -> Path | None:
        """The folder of a frame: as it is behind a seam, else as its chunk made it."""
        files = self._run.files
        steps = (f"joined-{frame:06d}", f"frame-{frame:06d}")
        return next((files.folder / step for step in steps if files.read_manifest(step) is not None), None)

    def load(self, frame: int) -> BodyRegistration | None:
        from tracker.bodies import load_body_registration

        folder = self.find(frame)
        if folder is None:  # a job that was begun before frames were working files has them stored
            with self._run.context.database.reading() as session:
                row = registrations.find_frame(session, self._run.registration_id, frame)
            folder = None if row is None else self._run.context.storage.folder(AREA, row.id)
        return None if folder is None else load_body_registration(folder / BODY)

    def keep(self, frame: int, registration: BodyRegistration) -> None:
        from dataclasses import replace

        from tracker.bodies import CHAIN

        run, described = self._run, self._run.scan_row.frames[frame]
        found, scan = replace(registration, scan=described["name"]), (self.read(frame), described["digest"])
        is_joined = CHAIN in registration.measures
        self._progress.check()
        step = f"{'joined' if is_joined else 'frame'}-{frame:06d}"
        folder = run.files.folder / step
        run.files.write(folder, lambda path: write_frame(path, found, run.follower.model, scan))
        run.files.write_manifest(step, [folder], {})
        if not is_joined:
            self._progress.frame_done(run.total, self._begins)

    def leave_out(self, frame: int, error: TrackerError) -> None:
        text = hide_paths(str(error), self._run.context.storage.root)
        self._progress.log("warning", f"frame {frame}: {text}")
        self._progress.frame_done(self._run.total, self._begins)

    def begin(self, follower: BodyFollower, frame: int, scan: Scan) -> BodyRegistration:
        """On from the registration that this one goes on from, where it is the first frame of all; else from what the
        person's model was made of, else without a start."""
        from tracker.bodies import find_start, load_body_registration

        run, before = self._run, None
        if frame in run.chunks[0]:
            with run.context.database.reading() as session:
                before = registrations.find_before(session, run.asked.parent_id, frame)
        if before is None:
            return follower.begin(scan, find_start(run.load_template_frame(frame)))
        return follower.follow(scan, load_body_registration(run.context.storage.folder(AREA, before.id) / BODY))

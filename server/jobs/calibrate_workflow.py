"""The workflow of a job that calibrates cameras: a step looks for the board in each camera's film, one does the rest.

Corners are kept camera by camera: who goes on with a job does not look for them again.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any
from uuid import UUID

from dbos import DBOS

from server.calibrations.films import find_films
from server.calibrations.models import CalibrationRow
from server.calibrations.service import GONE
from server.calibrations.storing import store_result
from server.errors import ConflictError
from server.jobs.calibrating import read_calibrate_options, read_calibration_id
from server.jobs.run import JobRun, WorkerContext
from tracker import say_count

if TYPE_CHECKING:
    from tracker.calibration import CameraSource, FilmFolder, Sightings

LOOKING = 0.8
"""Share of the bar that looking for the board takes."""

STAGES = (
    "finding the lenses",
    "placing the boards",
    "relating the cameras",
    "adjusting cameras and boards",
    "judging the cameras on what was left out",
)
"""What the tracker says while it calibrates, in this order."""

STORING = 0.98


def register_calibrate_workflow(context: WorkerContext):
    """Make the workflow `calibrate` known to DBOS."""

    @DBOS.step(name="list cameras")
    def list_cameras(job_id: str) -> list[str]:
        return [source.id for source in _CalibrateRun(context, UUID(job_id)).open_sources()]

    @DBOS.step(name="look for the board")
    def look(job_id: str, attempt: int, number: int) -> dict[str, Any]:
        return _CalibrateRun(context, UUID(job_id)).look(attempt, number)

    @DBOS.step(name="calibrate cameras")
    def solve(job_id: str, attempt: int, count: int) -> str:
        return _CalibrateRun(context, UUID(job_id)).solve(attempt, count)

    @DBOS.workflow(name="calibrate", max_recovery_attempts=1000)
    def calibrate(job_id: str, attempt: int) -> str:
        run = _CalibrateRun(context, UUID(job_id))

        def work() -> None:
            cameras = list_cameras(job_id)
            for number in range(len(cameras)):
                run.files.check(look(job_id, attempt, number)["files"])
            solve(job_id, attempt, len(cameras))

        return run.attempt(attempt, work)

    return calibrate


class _CalibrateRun(JobRun):
    """One such job in this worker."""

    def list_films(self) -> FilmFolder:
        """What was filmed, as it was uploaded."""
        from tracker.calibration import list_films

        with self.context.database.reading() as session:
            row = session.get(CalibrationRow, read_calibration_id(self.row))
        folder = None if row is None else find_films(self.context.storage, row.films_id)
        if folder is None:
            raise ConflictError(GONE)
        return list_films(folder)

    def open_sources(self) -> list[CameraSource]:
        """The cameras in their order; the first one's frame is to be the world."""
        from tracker.calibration import open_source

        fps = read_calibrate_options(self.row).fps
        return [open_source(name, path, fps) for name, path in self.list_films().cameras.items()]

    def look(self, attempt: int, number: int) -> dict[str, Any]:
        """Look for the board in every frame of a camera; its corners are kept."""
        from tracker.calibration import find_sightings
        from tracker.training import pack_arrays

        progress, step = self.progress(attempt), f"corners-{number:04d}"
        sources = self.open_sources()
        source, total, span = sources[number], len(sources), (0.0, LOOKING)
        manifest = self.files.read_manifest(step)
        if manifest is None:
            board = read_calibrate_options(self.row).board.make_board()
            seen = find_sightings(
                source, board, lambda what, share: progress.scans(number, total, span, what, min(share, 0.999))
            )
            arrays = {"times": seen.times, "frames": seen.frames, "corners": seen.corners}
            path = self.files.folder / f"{step}.npz"
            self.files.write(path, lambda temporary: temporary.write_bytes(pack_arrays(arrays)))
            described = {"camera": seen.camera, "width": seen.width, "height": seen.height, "fps": seen.fps}
            manifest = self.files.write_manifest(step, [path], described)
            found, frames = len(seen.frames), say_count(len(seen.times), "frame")
            progress.log("info", f"{source.id}: the board was found in {found} of {frames}")
        progress.scans_done(number + 1, total, span)
        return manifest

    def solve(self, attempt: int, count: int) -> str:
        """Calibrate the cameras from their corners, keep what was found, and end the job."""
        from tracker.calibration import CalibrationOptions, calibrate_cameras, load_lenses

        progress, options, films = self.progress(attempt), read_calibrate_options(self.row), self.list_films()
        sources = self.open_sources()
        is_still = any(source.images for source in sources) and options.fps is None
        result = calibrate_cameras(
            [self._read_sightings(number) for number in range(count)],
            options.board.make_board(),
            CalibrationOptions(
                find_offsets=options.find_offsets and not is_still,
                max_offset_s=options.max_offset_s,
                lenses=None if films.lenses is None else load_lenses(films.lenses),
                left_out=options.left_out,
            ),
            lambda what, share: progress.part(_find_span(what), what, share),
        )
        progress.part((STORING, 1.0), "writing what was found", 0.0)
        calibration_id = read_calibration_id(self.row)
        told = store_result(self.context.storage, calibration_id, result)
        with self.context.database.writing() as session:
            row = session.get(CalibrationRow, calibration_id)
            if row is None:
                raise ConflictError("The calibration was deleted for good while its cameras were calibrated.")
            if self.end(session, attempt, "succeeded", progress=1.0, frames_done=count):
                row = session.get_one(CalibrationRow, calibration_id)
                row.result, row.options = told, options.model_dump()
        return str(calibration_id)

    def _read_sightings(self, number: int) -> Sightings:
        from tracker.calibration import Sightings
        from tracker.training import unpack_arrays

        manifest = self.files.read_manifest(f"corners-{number:04d}")
        assert manifest is not None, "the steps before have written it"
        arrays = unpack_arrays((self.files.folder / f"corners-{number:04d}.npz").read_bytes())
        described = {name: manifest[name] for name in ("camera", "width", "height", "fps")}
        return Sightings(**described, times=arrays["times"], frames=arrays["frames"], corners=arrays["corners"])


def _find_span(stage: str) -> tuple[float, float]:
    """Part of the bar of a stage of calibrating."""
    number = STAGES.index(stage) if stage in STAGES else len(STAGES) - 1
    width = (STORING - LOOKING) / len(STAGES)
    return LOOKING + number * width, LOOKING + (number + 1) * width

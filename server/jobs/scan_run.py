"""What jobs on scans do, step by step. A step done twice changes nothing: ids follow from the job and its subject."""

from __future__ import annotations

import logging
import os
import shutil
import uuid
from collections import Counter, OrderedDict
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any
from uuid import UUID

import numpy as np
from scipy.spatial import KDTree
from sqlalchemy import select, update
from sqlalchemy.orm import Session

from server.hand_models import storing
from server.hand_models.models import HandModelRow
from server.hand_models.service import get_hand_model
from server.jobs import create_jobs, service
from server.jobs.checkpoints import JobCheckpoints
from server.jobs.failure import hide_paths
from server.jobs.held_out import make_rule
from server.jobs.restarting import read_loop
from server.jobs.run import JobRun, WorkerContext
from server.jobs.train_schemas import TrainingParams
from server.registrations import service as registrations
from server.registrations import training_sets
from server.registrations.models import RegistrationRow
from server.scans import service as scans
from server.scans.cropping import find_cropped
from server.scans.models import ScanRow
from server.scans.schemas import ScanCrop
from server.storage.digest import compute_digest
from tracker import say_count

if TYPE_CHECKING:
    from tracker import BlendModel, Registrar, Registration, RegistrationStart, Scan
    from tracker.training import Training, TrainingSet

log = logging.getLogger(__name__)

Span = tuple[float, float]
"""Part of the progress bar, 0 to 1."""

NAMESPACE = UUID("3b7f2f0e-6c8a-4b57-9d55-0a2f4cf1e7d3")
FAILED = "not read"


class ModelCache:
    """Models that were used lately, and what registers with them."""

    def __init__(self, context: WorkerContext, most: int = 2) -> None:
        self._context, self._most = context, most
        self._models: OrderedDict[UUID, tuple[HandModelRow, BlendModel]] = OrderedDict()
        self._registrars: dict[UUID, Registrar] = {}

    def get(self, model_id: UUID) -> tuple[HandModelRow, BlendModel]:
        if model_id not in self._models:
            with self._context.database.reading() as session:
                row = get_hand_model(session, model_id, deleted_too=True)
            self._models[model_id] = row, storing.open_model(self._context.storage, row)
            while len(self._models) > self._most:
                self._registrars.pop(self._models.popitem(last=False)[0], None)
        return self._models[model_id]

    def get_registrar(self, model_id: UUID) -> Registrar:
        """Its search trees and factorisations are prepared once."""
        from tracker import Registrar

        _, model = self.get(model_id)
        if model_id not in self._registrars:
            self._registrars[model_id] = Registrar(model)
        return self._registrars[model_id]


class ScanRun(JobRun):
    """One job on scans in this worker."""

    def __init__(self, context: WorkerContext, job_id: UUID, cache: ModelCache) -> None:
        super().__init__(context, job_id)
        self.cache = cache

    def list_scans(self) -> list[str]:
        """Scans of the job, in order."""
        with self.context.database.reading() as session:
            return [str(id_) for id_ in create_jobs.list_job_scans(session, self.job_id)]

    def register_one(self, attempt: int, scan_id: UUID, model_id: UUID, place: tuple[int, int], span: Span) -> str:
        """Register one scan; gives the verdict. One whose file cannot be used is noted, and the others go on."""
        from tracker import TrackerError

        number, total = place
        progress = self.progress(attempt)
        registration_id = uuid.uuid5(NAMESPACE, f"{self.job_id}/{scan_id}/{model_id}")
        with self.context.database.reading() as session:
            done = session.get(RegistrationRow, registration_id)
            row = scans.get_scan(session, scan_id, deleted_too=True)
            crop = scans.read_crop(scans.get_crop(session, scan_id, row.revision))
            start = self._find_start(session, scan_id, model_id)
        if done is not None:
            return done.verdict
        progress.scans(number, total, span, f"registering {row.name}", 0.0)
        try:
            verdict = self._register(
                registration_id,
                row,
                crop,
                model_id,
                start,
                lambda stage, share: progress.scans(number, total, span, f"registering {row.name}", share),
            )
        except TrackerError as error:
            with self.context.database.writing() as session:
                problem = hide_paths(str(error), self.context.storage.root)
                session.execute(update(ScanRow).where(ScanRow.id == scan_id).values(state="failed", problem=problem))
            progress.log("warning", f"{row.name}: {problem}")
            verdict = FAILED
        progress.scans_done(number + 1, total, span)
        return verdict

    def _find_start(self, session: Session, scan_id: UUID, model_id: UUID) -> RegistrationStart | None:
        """Where to begin: at the newest registration of the scan, when it seems right and people do not reject it."""
        from tracker import TrackerError, load_registration

        newest = select(RegistrationRow).where(RegistrationRow.scan_id == scan_id, RegistrationRow.is_current)
        row = session.scalars(newest).one_or_none()
        if row is None or row.verdict != "good" or row.decision == "reject" or row.model_id == model_id:
            return None
        try:
            path = self.context.storage.folder(registrations.AREA, row.id) / registrations.FILE
            return load_registration(path).as_start()
        except TrackerError as error:
            log.warning("registration %s is no start: %s", row.id, error)
            return None

    def _register(
        self, id_: UUID, row: ScanRow, crop: ScanCrop, model_id: UUID, start: RegistrationStart | None, progress: Any
    ) -> str:
        from tracker import RegistrationOptions, save_registration

        model_row, registrar = self.cache.get(model_id)[0], self.cache.get_registrar(model_id)
        whole = scans.open_scan(self.context.storage, row)
        kept = ~find_cropped(whole, crop)
        options = RegistrationOptions(side=row.side, use_colors=crop.drops_objects)
        scan = replace(whole.select(kept), name=row.name)
        found = registrar.register(scan, options, start, progress)
        found = replace(found, subject=row.subject, pose_name=row.pose)
        folder = self.context.storage.folder(registrations.AREA, id_)
        save_registration(found, folder)
        vertex_error, point_error = measure_errors(found, scan, kept)
        np.savez_compressed(
            folder / registrations.ERRORS,
            vertex_error_mm=vertex_error.astype(np.float32),
            point_error_mm=point_error.astype(np.float16),
        )
        self.context.storage.publish(registrations.AREA, id_)
        distances = {name: value if np.isfinite(value) else None for name, value in found.scan_to_mesh_mm.items()}
        with self.context.database.writing() as session:
            made = RegistrationRow(
                id=id_,
                scan_id=row.id,
                model_id=model_id,
                job_id=self.job_id,
                round=model_row.round + 1,
                crop_revision=row.revision,
                digest=compute_digest(folder / registrations.FILE),
                side=found.side,
                verdict=found.verdict,
                score=float(found.score),
                reasons=list(found.reasons),
                scan_to_mesh_mm=distances,
                seconds=found.seconds,
                decision=None,
            )
            registrations.add_registration(session, made)
        return found.verdict

    def choose(self, attempt: int, model_id: UUID, number: int) -> str:
        """Keep what a round of a loop trains from; gives the id of the training set."""
        asked = read_loop(self.row)
        rule = make_rule(asked, model_id if asked.by == "verdict" else None)
        with self.context.database.writing() as session:
            row, _ = training_sets.create_training_set(
                session, self.context.storage, f"{asked.name}, round {number}"[:200], rule, self.row.created_by
            )
        self.progress(attempt).log(
            "info", f"{row.registration_count} registrations of {row.subject_count} people chosen"
        )
        return str(row.id)

    def train(self, attempt: int, set_id: UUID, parent_id: UUID, name: str, number: int, span: Span) -> str:
        """Train a model; gives its id."""
        from tracker.training import TrainingOptions, train_model

        progress = self.progress(attempt)
        model_id = uuid.uuid5(NAMESPACE, f"{self.job_id}/model/{number}")
        with self.context.database.reading() as session:
            if session.get(HandModelRow, model_id) is not None:
                return str(model_id)
        progress.part(span, "gathering registrations", 0.0)
        params = TrainingParams.model_validate(self.row.params["options"])
        parent_row, parent = self.cache.get(parent_id)
        chosen = self.load_training_set(set_id, number)
        options = TrainingOptions(name=name, threads=os.cpu_count() or 1, **params.model_dump())
        kept = JobCheckpoints(
            self.files,
            f"train-{number}",
            lambda stage: progress.kept(),
            lambda stage: progress.log("info", f"{stage.replace('-', ' ')} is kept from before"),
        )
        trained = train_model(chosen, parent, options, lambda stage, share: progress.part(span, stage, share), kept)
        digest = storing.write_model(self.context.storage, model_id, trained.model)
        with self.context.database.writing() as session:
            session.add(
                HandModelRow(
                    id=model_id,
                    name=name,
                    kind="trained",
                    side=trained.model.side,
                    digest=digest,
                    facts=storing.describe_model(trained.model),
                    round=parent_row.round + 1,
                    parent_id=parent_id,
                    training_set_id=set_id,
                    job_id=self.job_id,
                    report=trained.report | {"study": study_people(trained)},
                    created_by=self.row.created_by,
                )
            )
            service.append_log(session, self.job_id, "info", f"{name} is trained")
            service.update_running(
                session, self.job_id, attempt, self.context.worker_id, hand_model_id=model_id, crashes=0
            )
        return str(model_id)

    def load_training_set(self, set_id: UUID, number: int) -> TrainingSet:
        """The registrations of a set, each checked."""
        from tracker.training import load_training_set

        with self.context.database.reading() as session:
            row = training_sets.get_training_set(session, set_id)
        folder = self.files.folder / f"set-{number}"
        _gather(training_sets.list_files(self.context.storage, row), folder)
        return load_training_set(folder, verdicts=("good", "doubtful", "bad"))  # people or the rule chose them

    def finish(self, attempt: int, model_id: UUID | None, outcomes: list[str]) -> None:
        """End the job, and say what came of it."""
        counts = Counter(outcomes)
        told = ", ".join(f"{counts[kind]} {kind}" for kind in ("good", "doubtful", "bad", FAILED) if counts[kind])
        with self.context.database.writing() as session:
            if told:
                service.append_log(session, self.job_id, "info", f"{say_count(len(outcomes), 'scan')}: {told}")
            values = {"frames_done": len(outcomes), "frames_total": len(outcomes)} if outcomes else {}
            self.end(session, attempt, "succeeded", progress=1.0, hand_model_id=model_id, **values)


def study_people(trained: Training) -> dict[str, Any]:
    """How well the shape space holds people that it was not made from, each left out in turn: [R17] Fig. 14."""
    from tracker.evaluation import generalize_shapes

    people = np.array([hand.removesuffix(" (left)") for hand in trained.report["by_hand"]])
    most = min(20, len(np.unique(people)) - 2)
    if most < 1 or len(people) != len(trained.templates):
        return {}
    counts = sorted({*range(min(10, most) + 1), most})
    return {"shape_generalisation": generalize_shapes(trained.templates, people, counts)}


def _gather(files: list[tuple[str, Path]], folder: Path) -> None:
    """A folder of registrations as training takes it, without copying where the disk allows it."""
    shutil.rmtree(folder, ignore_errors=True)
    for name, path in files:
        (folder / name).parent.mkdir(parents=True)
        try:
            os.link(path, folder / name)
        except OSError:
            shutil.copyfile(path, folder / name)


def measure_errors(found: Registration, scan: Scan, kept: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Distances of a scan from its registration, by vertex and by point of the whole scan, mm.

    Args:
        found: Of the scan without what is cropped.
        scan: That scan.
        kept: (M,) which points of the whole scan are in it.

    Returns:
        (V,) mean over the points that are nearest to a vertex, NaN where there are none; and (M,), NaN where a point
        was left out.
    """
    distances = 1e3 * found.scan_to_mesh
    counted = np.isfinite(distances)
    errors = np.full(len(found.vertices), np.nan)
    if counted.any():
        nearest = KDTree(found.vertices).query(scan.points[counted])[1]
        counts = np.bincount(nearest, minlength=len(errors))
        sums = np.bincount(nearest, distances[counted], minlength=len(errors))
        errors = np.where(counts > 0, sums / np.maximum(counts, 1), np.nan)
    of_points = np.full(len(kept), np.nan)
    of_points[kept] = distances
    return errors, of_points

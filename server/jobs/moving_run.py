"""What a job does that registers a moving scan, frame by frame. A step done twice changes nothing: ids follow from
the job and the frame, and each frame follows from the one before as it lies on the disk."""

from __future__ import annotations

import logging
import uuid
from collections import Counter, OrderedDict
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any
from uuid import UUID

from server.jobs import service
from server.jobs.failure import hide_paths
from server.jobs.moving import read_moving
from server.jobs.run import JobRun, WorkerContext
from server.moving_scans import registrations
from server.moving_scans.models import FrameRegistrationRow, MovingRegistrationRow
from server.moving_scans.service import find_scan_file, get_moving_scan, list_usable
from server.moving_scans.storing import AREA, BODY, TEMPLATE, TEMPLATES, name_frame, store_frame
from tracker import say_count

if TYPE_CHECKING:
    from tracker import Scan
    from tracker.bodies import BodyFollower, BodyRegistration

log = logging.getLogger(__name__)

NAMESPACE = UUID("0d2c3c1e-2f0a-4d0f-8a57-3b2f7f5c9b64")
FAILED = "not registered"
TEMPLATE_ENDS = 0.1
"""Share of the progress bar that making the person's model takes."""

TemplateKey = tuple[UUID, str, bool, bool]


class FollowerCache:
    """Who follows people: its search trees are prepared once, not for every frame."""

    def __init__(self, context: WorkerContext, most: int = 2) -> None:
        self._context, self._most = context, most
        self._followers: OrderedDict[TemplateKey, BodyFollower] = OrderedDict()

    def get(self, row: MovingRegistrationRow) -> BodyFollower:
        from tracker import load_blend_model
        from tracker.bodies import BodyFollower, FollowOptions

        key = row.template_id, row.prior, row.holds_hands, row.has_velocity
        if key not in self._followers:
            model = load_blend_model(self._context.storage.folder(TEMPLATES, row.template_id) / TEMPLATE)
            options = FollowOptions(row.prior, row.holds_hands, row.has_velocity)  # type: ignore[arg-type]
            self._followers[key] = BodyFollower(model, options)
            while len(self._followers) > self._most:
                self._followers.popitem(last=False)
        return self._followers[key]


class MovingRun(JobRun):
    """One such job in this worker."""

    def __init__(self, context: WorkerContext, job_id: UUID, cache: FollowerCache) -> None:
        super().__init__(context, job_id)
        self.cache = cache
        self.asked = read_moving(self.row)
        with context.database.reading() as session:
            self.scan_row = get_moving_scan(session, self.asked.moving_scan_id, deleted_too=True)
        self.registration_id = uuid.uuid5(NAMESPACE, str(job_id))

    def plan(self) -> dict[str, Any]:
        """Note the registration, and which frames it is of."""
        from tracker.bodies import choose_template_frames

        asked = self.asked
        assert asked.last_frame is not None, "it was settled when the job was made"
        frames = list_usable(self.scan_row, asked.first_frame, asked.last_frame)
        with self.context.database.writing() as session:
            parent = None if asked.parent_id is None else registrations.get_registration(session, asked.parent_id)
            if session.get(MovingRegistrationRow, self.registration_id) is None:
                session.add(
                    MovingRegistrationRow(
                        id=self.registration_id,
                        moving_scan_id=asked.moving_scan_id,
                        job_id=self.job_id,
                        parent_id=asked.parent_id,
                        template_id=self.registration_id if parent is None else parent.template_id,
                        prior=asked.prior,
                        holds_hands=asked.holds_hands,
                        has_velocity=asked.has_velocity,
                        population=asked.population,
                        first_frame=asked.first_frame,
                        last_frame=asked.last_frame,
                        created_by=self.row.created_by,
                    )
                )
        template = [] if parent is not None else choose_template_frames(frames, asked.template_frames)
        return {"frames": frames, "template": template}

    def register_template_frame(self, attempt: int, planned: dict[str, Any], number: int) -> None:
        """Register one of the frames that the person's own model is made from, as a single scan."""
        from tracker.bodies import Registrar, body_model, register_for_template, save_body_registration

        frame, total = planned["template"][number], len(planned["template"])
        progress, step = self.progress(attempt), f"template-{frame:06d}"
        span = TEMPLATE_ENDS * number / total, TEMPLATE_ENDS * (number + 1) / total
        if self._has_template() or self.files.read_manifest(step) is not None:
            return
        before = self._load_template_frame(planned["template"][number - 1]) if number else None
        told = f"the person's own model, frame {frame}"
        progress.part(span, told, 0.0)
        model = body_model(self.asked.population)
        registrar = Registrar(model)
        found = register_for_template(registrar, self._read_scan(frame), before)
        folder = self.files.folder / step
        self.files.write(folder, lambda path: save_body_registration(found, model.faces, path))
        self.files.write_manifest(step, [folder], {})
        progress.kept()

    def make_template(self, planned: dict[str, Any]) -> None:
        """Make the person's own model from them."""
        from tracker import save_blend_model
        from tracker.bodies import body_model, make_own_model

        if self._has_template():
            return
        found = [self._load_template_frame(frame) for frame in planned["template"]]
        own = make_own_model(body_model(self.asked.population), found)
        storage = self.context.storage
        folder = storage.folder(TEMPLATES, self.registration_id)
        folder.mkdir(parents=True, exist_ok=True)
        self.files.write(folder / TEMPLATE, lambda path: save_blend_model(own, path))
        storage.publish(TEMPLATES, self.registration_id)

    def register_frame(self, attempt: int, planned: dict[str, Any], number: int) -> str:
        """Register one frame from where the one before ended; gives the verdict."""
        from tracker import TrackerError

        frame, total = planned["frames"][number], len(planned["frames"])
        begins = TEMPLATE_ENDS if planned["template"] else 0.0
        progress = self.progress(attempt)
        progress.frames(number, total, begins, f"registering frame {frame}")
        with self.context.database.reading() as session:
            row = session.get_one(MovingRegistrationRow, self.registration_id)
            done = session.get(FrameRegistrationRow, name_frame(self.registration_id, frame))
            before = registrations.find_before(session, row, frame)
        if done is not None:
            return done.verdict
        try:
            scan = self._read_scan(frame)
            follower = self.cache.get(row)
            found = self._begin(follower, scan, planned) if before is None else self._follow(follower, scan, before)
            found = replace(found, scan=self.scan_row.frames[frame]["name"])
            digest = self.scan_row.frames[frame]["digest"]
            place = self.registration_id, frame
            store_frame(
                self.context.database, self.context.storage, place, found, follower.registrar.model, (scan, digest)
            )
            verdict = found.verdict
        except TrackerError as error:
            progress.log("warning", f"frame {frame}: {hide_paths(str(error), self.context.storage.root)}")
            verdict = FAILED
        progress.frames(number + 1, total, begins, f"registering frame {frame}")
        progress.kept()
        return verdict

    def finish(self, attempt: int, planned: dict[str, Any], outcomes: list[str]) -> None:
        """End the job, and say what came of it."""
        counts = Counter(outcomes)
        told = ", ".join(f"{counts[kind]} {kind}" for kind in ("good", "doubtful", "bad", FAILED) if counts[kind])
        total = len(outcomes)
        asked = self.asked
        assert asked.last_frame is not None, "it was settled when the job was made"
        unusable = asked.last_frame - asked.first_frame + 1 - total
        with self.context.database.writing() as session:
            service.append_log(session, self.job_id, "info", f"{say_count(total, 'frame')}: {told}")
            if unusable:
                told = f"{say_count(unusable, 'frame')} left out, whose file cannot be used"
                service.append_log(session, self.job_id, "warning", told)
            self.end(session, attempt, "succeeded", progress=1.0, frames_done=total, frames_total=total)

    def _begin(self, follower: BodyFollower, scan: Scan, planned: dict[str, Any]) -> BodyRegistration:
        """The first frame of all: from what the person's model was made of, else without a start."""
        from tracker.bodies import without_shape

        if not planned["template"]:
            return follower.begin(scan)
        known = self._load_template_frame(planned["template"][0])
        return follower.begin(scan, None if known.verdict == "bad" else without_shape(known))

    def _follow(self, follower: BodyFollower, scan: Scan, before: FrameRegistrationRow) -> BodyRegistration:
        from tracker.bodies import load_body_registration

        return follower.follow(scan, load_body_registration(self.context.storage.folder(AREA, before.id) / BODY))

    def _read_scan(self, frame: int) -> Scan:
        from tracker.bodies import load_body_scan

        path: Path = find_scan_file(self.context.storage, self.scan_row, frame)
        return load_body_scan(path, self.scan_row.metres_per_unit)[0]

    def _has_template(self) -> bool:
        return (self.context.storage.folder(TEMPLATES, self.registration_id) / TEMPLATE).is_file()

    def _load_template_frame(self, frame: int) -> BodyRegistration:
        from tracker.bodies import load_body_registration

        step = f"template-{frame:06d}"
        manifest = self.files.read_manifest(step)
        assert manifest is not None, "that step was done before"
        return load_body_registration(self.files.folder / step)

"""What a job does that registers a moving scan: the person's own model, chunks of frames in whatever workers are free,
and their seams. A step done twice changes nothing: ids follow from job and frame, and whoever goes on finds each frame
among the working files. A frame is given to people when no seam can change it any more."""

from __future__ import annotations

import uuid
from collections import Counter
from collections.abc import Sequence
from functools import cached_property
from typing import TYPE_CHECKING
from uuid import UUID

from sqlalchemy import select

from server.jobs import service
from server.jobs.moving import read_moving
from server.jobs.moving_frames import MovingFrames
from server.jobs.run import JobRun, WorkerContext
from server.moving_scans import registrations
from server.moving_scans.models import FrameRegistrationRow, MovingRegistrationRow
from server.moving_scans.service import get_moving_scan, list_usable
from server.moving_scans.storing import TEMPLATE, TEMPLATES, store_frame
from tracker import say_count

if TYPE_CHECKING:
    from tracker.bodies import BodyFollower, BodyRegistration

NAMESPACE = UUID("0d2c3c1e-2f0a-4d0f-8a57-3b2f7f5c9b64")
FAILED = "not registered"
TEMPLATE_ENDS = 0.1
"""Share of the progress bar that making the person's model takes."""


class MovingRun(JobRun):
    """One such job, or a chunk of it, in this worker."""

    def __init__(self, context: WorkerContext, job_id: UUID) -> None:
        from tracker.bodies import choose_template_frames, cut_chunks

        super().__init__(context, job_id)
        self.asked = asked = read_moving(self.row)
        assert asked.last_frame is not None, "it was settled when the job was made"
        with context.database.reading() as session:
            self.scan_row = get_moving_scan(session, asked.moving_scan_id, deleted_too=True)
        self.registration_id = uuid.uuid5(NAMESPACE, str(job_id))
        self.asked_count = asked.last_frame - asked.first_frame + 1
        stretches = cut_chunks(asked.first_frame, self.asked_count, asked.chunk_frames)
        usable = [list_usable(self.scan_row, stretch[0], stretch[-1]) for stretch in stretches]
        self.chunks = [frames for frames in usable if frames]
        self.total = sum(map(len, self.chunks))
        frames = [frame for chunk in self.chunks for frame in chunk]
        has_model = asked.parent_id is not None or asked.person_model_id is not None
        self.template = [] if has_model else choose_template_frames(frames, asked.template_frames)

    @cached_property
    def follower(self) -> BodyFollower:
        """Made ready once for a chunk and once for all seams."""
        from tracker import load_blend_model
        from tracker.bodies import BodyFollower, FollowOptions

        with self.context.database.reading() as session:
            row = registrations.get_registration(session, self.registration_id)
        model = load_blend_model(self.context.storage.folder(TEMPLATES, row.template_id) / TEMPLATE)
        options = FollowOptions(row.prior, row.holds_hands, row.has_velocity)  # type: ignore[arg-type]
        return BodyFollower(model, options)

    def plan(self) -> None:
        """Note the registration."""
        asked = self.asked
        with self.context.database.writing() as session:
            parent = None if asked.parent_id is None else registrations.get_registration(session, asked.parent_id)
            if session.get(MovingRegistrationRow, self.registration_id) is None:
                session.add(
                    MovingRegistrationRow(
                        id=self.registration_id,
                        moving_scan_id=asked.moving_scan_id,
                        job_id=self.job_id,
                        parent_id=asked.parent_id,
                        template_id=asked.person_model_id or (parent.template_id if parent else self.registration_id),
                        prior=asked.prior,
                        holds_hands=asked.holds_hands,
                        has_velocity=asked.has_velocity,
                        population=asked.population,
                        first_frame=asked.first_frame,
                        last_frame=asked.last_frame,
                        created_by=self.row.created_by,
                    )
                )

    def register_template_frame(self, attempt: int, number: int) -> None:
        """Register one of the frames that the person's own model is made from, as a single scan."""
        from tracker.bodies import Registrar, body_model, register_for_template, save_body_registration

        frame, total = self.template[number], len(self.template)
        progress, step = self.progress(attempt), name_template_step(frame)
        span = TEMPLATE_ENDS * number / total, TEMPLATE_ENDS * (number + 1) / total
        if self._has_template() or self.files.read_manifest(step) is not None:
            return
        before = self.load_template_frame(self.template[number - 1]) if number else None
        progress.part(span, f"the person's own model, frame {frame}", 0.0)
        model = body_model(self.asked.population)
        found = register_for_template(Registrar(model), MovingFrames(self, attempt).read(frame), before)
        folder = self.files.folder / step
        self.files.write(folder, lambda path: save_body_registration(found, model.faces, path))
        self.files.write_manifest(step, [folder], {})
        progress.kept()

    def make_template(self) -> None:
        """Make the person's own model from them."""
        from tracker import save_blend_model
        from tracker.bodies import body_model, make_own_model

        if self._has_template():
            return
        found = [each for frame in self.template if (each := self.load_template_frame(frame))]
        assert len(found) == len(self.template), "those steps were done before"
        own = make_own_model(body_model(self.asked.population), found)
        storage = self.context.storage
        folder = storage.folder(TEMPLATES, self.registration_id)
        folder.mkdir(parents=True, exist_ok=True)
        self.files.write(folder / TEMPLATE, lambda path: save_blend_model(own, path))
        storage.publish(TEMPLATES, self.registration_id)

    def register_chunk(self, attempt: int, number: int) -> None:
        """Register the frames of a chunk, each from where the one before ended."""
        from tracker.bodies import follow_chunk

        begins, chunk = TEMPLATE_ENDS if self.template else 0.0, self.chunks[number]
        self.progress(attempt).part((begins, begins), f"registering frames {chunk[0]} to {chunk[-1]}", 0.0)
        for frame in follow_chunk(MovingFrames(self, attempt, begins), self.follower, chunk):
            if number == 0:
                self._give([frame])

    def join_chunk(self, attempt: int, number: int) -> None:
        """Go on into a chunk from the one before until there is no seam, and give its frames to people."""
        from tracker.bodies import join_chunk

        if number > 0:
            frames = MovingFrames(self, attempt)
            count = join_chunk(frames, self.follower, self.chunks, number)
            first = self.chunks[number][0]
            told = f"frame {first} joined to the one before; {say_count(count, 'frame')} registered again for it"
            self.progress(attempt).log("info", told)
        self._give(self.chunks[number])

    def finish(self, attempt: int) -> None:
        """End the job, and say what came of it."""
        of_it = FrameRegistrationRow.registration_id == self.registration_id
        verdict, total = FrameRegistrationRow.verdict, self.total
        with self.context.database.writing() as session:
            counts = Counter(session.scalars(select(verdict).where(of_it)))
            counts[FAILED] = total - counts.total()
            told = ", ".join(f"{counts[kind]} {kind}" for kind in ("good", "doubtful", "bad", FAILED) if counts[kind])
            service.append_log(session, self.job_id, "info", f"{say_count(total, 'frame')}: {told}")
            if unusable := self.asked_count - total:
                told = f"{say_count(unusable, 'frame')} left out, whose file cannot be used"
                service.append_log(session, self.job_id, "warning", told)
            self.end(session, attempt, "succeeded", progress=1.0, frames_done=total, frames_total=total)

    def _give(self, frames: Sequence[int]) -> None:
        """Store frames for good: they can be looked at and decided about from now on."""
        kept = MovingFrames(self, 0)
        for frame in frames:
            if (folder := kept.find(frame)) is not None:
                store_frame(self.context.database, self.context.storage, (self.registration_id, frame), folder)

    def _has_template(self) -> bool:
        return (self.context.storage.folder(TEMPLATES, self.registration_id) / TEMPLATE).is_file()

    def load_template_frame(self, frame: int) -> BodyRegistration | None:
        """What the person's own model was made of, where it was this frame."""
        from tracker.bodies import load_body_registration

        step = name_template_step(frame)
        known = frame in self.template and self.files.read_manifest(step) is not None
        return load_body_registration(self.files.folder / step) if known else None


def name_template_step(frame: int) -> str:
    """Among the working files."""
    return f"template-{frame:06d}"

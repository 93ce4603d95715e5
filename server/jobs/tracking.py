"""What a tracking job does, step by step. Every step reads files and writes files, so doing one twice changes nothing.

The result depends on the recording, the options, the models and the annotations of the first frame only: the tracker's
state always goes through its file, whether the next chunk runs in the same process or after a crash. Timing is the
exception.
"""

from __future__ import annotations

import hashlib
import json
import logging
import shutil
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path
from typing import TYPE_CHECKING, Any

from server.errors import StudioError
from server.jobs.files import JobFiles
from server.jobs.progress import TRACKING_ENDS, JobProgress
from server.jobs.service import HAND_MODEL, STUDIO_PARAMS

if TYPE_CHECKING:
    from tracker import ArticulatedModel, TrackOptions
    from tracker import Sequence as Recording

log = logging.getLogger(__name__)

CHUNK_FRAMES = 20
"""Frames a step tracks; what a crash can cost."""


@dataclass(frozen=True)
class TrackingJob:
    """Inputs of a tracking job and the folder it works in."""

    recording: Path
    params: dict[str, Any]
    files: JobFiles
    content_key: str
    """Of the recording: changes with any byte of it."""
    hand_model: Path | None = None
    """File of the hand model to track with; None for a hand that comes with Handloom."""
    detector: tuple[str, Path] | None = None
    """Name and file of the lab's own fingertip detector; None for the one that comes with Handloom."""

    @property
    def options(self) -> TrackOptions:
        from tracker import TrackOptions

        return TrackOptions.from_json({name: value for name, value in self.params.items() if name not in STUDIO_PARAMS})

    def load_recording(self) -> Recording:
        from tracker import load_sequence

        return load_sequence(self.recording)

    def load_hands(self) -> dict[str, ArticulatedModel] | None:
        """Both hands of the chosen model."""
        from tracker import BUILT_IN_HANDS, articulated_of, load_blend_model, mirror_blend

        if self.hand_model is not None:
            model = load_blend_model(self.hand_model)
        elif (name := self.params.get(HAND_MODEL)) in BUILT_IN_HANDS:
            model = BUILT_IN_HANDS[name].load("right")
        else:
            return None
        return {hand.side: articulated_of(hand) for hand in (model, mirror_blend(model))}

    def start(self, progress: JobProgress, others: Sequence[tuple[str, JobFiles]] = ()) -> dict[str, Any]:
        """Find the first pose and the shape; write the setup and the first state.

        Args:
            progress: Is told.
            others: Jobs that may have done just this before: what each is called, and its files.
        """
        from tracker import load_annotations, plan_start, start_tracking
        from tracker.detection import load_detector

        manifest = self.files.read_manifest("start")
        if manifest is not None:
            return manifest
        recording = self.load_recording()
        options = self.options
        key = self._find_start_key(recording)
        if (taken := self._take_over(key, others, progress)) is not None:
            return taken
        annotations = load_annotations(self.files.annotations) if self.files.annotations.exists() else None
        frames = options.frame_range(recording.frame_count)
        cost = plan_start(recording, options).frames
        begins = TRACKING_ENDS * cost / (cost + len(frames))
        setup, state = start_tracking(
            recording,
            options,
            self.load_hands(),
            annotations,
            lambda stage, share: progress.part((0.0, begins), stage, share),
            None if self.detector is None else load_detector(self.detector[1], self.detector[0]),
        )
        self.files.write(self.files.setup, setup.save)
        self.files.write(self.files.state(0), state.save)
        first, end = frames.start, frames.stop
        borders = [*range(first, end, CHUNK_FRAMES), end]
        return self.files.write_manifest(
            "start",
            [self.files.setup, self.files.state(0)],
            {
                "first": first,
                "frames": end - first,
                "chunks": [list(pair) for pair in pairwise(borders)],
                "begins": begins,
                "key": key,
            },
        )

    def _find_start_key(self, recording: Recording) -> str:
        """Names all that the start depends on: two jobs of one key have the same, bit for bit."""
        options = self.options
        items = json.loads(self.files.annotations.read_text())["items"] if self.files.annotations.exists() else []
        parts = {
            "recording": self.content_key,
            "hands": list(recording.hands),
            "params": self.params,
            "first_frame": [item for item in items if item["frame"] == options.first_frame],
        }
        return hashlib.sha256(json.dumps(parts, sort_keys=True).encode()).hexdigest()

    def _take_over(
        self, key: str, others: Sequence[tuple[str, JobFiles]], progress: JobProgress
    ) -> dict[str, Any] | None:
        """What another job has found from just the same, as one's own; None when none has."""
        for name, files in others:
            try:
                manifest = files.read_manifest("start")
                if manifest is None or manifest.get("key") != key:
                    continue
                setup, state = files.setup, files.state(0)
                self.files.write(self.files.setup, lambda path, source=setup: shutil.copytree(source, path))
                self.files.write(self.files.state(0), lambda path, source=state: shutil.copyfile(source, path))
            except (OSError, StudioError):  # that job goes on meanwhile, and its files went with its end
                continue
            progress.log(
                "info", f"the start and the hands' shape are reused from {name}, which has the same parameters"
            )
            described = {name: value for name, value in manifest.items() if name != "files"}
            return self.files.write_manifest("start", [self.files.setup, self.files.state(0)], described)
        return None

    def track_chunk(self, start: dict[str, Any], chunk: int, progress: JobProgress) -> dict[str, Any]:
        """Track one chunk of frames; write its results and the state after it."""
        from tracker import TrackSetup, TrackState, track_frames

        step = f"chunk-{chunk:04d}"
        manifest = self.files.read_manifest(step)
        first, end = start["chunks"][chunk]
        if manifest is None:
            sequence = self.load_recording()
            setup, state = TrackSetup.load(self.files.setup), TrackState.load(self.files.state(chunk))
            done, begins = first - start["first"], _find_beginning(start)
            state, results = track_frames(
                sequence,
                setup,
                state,
                range(first, end),
                lambda frame, _: progress.frames(done + frame - first + 1, start["frames"], begins),
            )
            self.files.write(self.files.chunk(chunk), results.save)
            self.files.write(self.files.state(chunk + 1), state.save)
            manifest = self.files.write_manifest(step, [self.files.chunk(chunk), self.files.state(chunk + 1)], {})
        message = f"frames {first} to {end - 1} tracked"
        progress.chunk_done(end - start["first"], start["frames"], _find_beginning(start), message)
        return manifest

    def finish(self, start: dict[str, Any], destination: Path, progress: JobProgress) -> None:
        """Join the chunks and write the track to `destination`."""
        from tracker import TrackChunk, TrackSetup, join_chunks

        progress.finishing("writing the track")
        if destination.exists():
            return
        setup = TrackSetup.load(self.files.setup)
        chunks = [TrackChunk.load(self.files.chunk(number)) for number in range(len(start["chunks"]))]
        self.files.write(destination, join_chunks(self.load_recording(), setup, chunks).save)


def _find_beginning(start: dict[str, Any]) -> float:
    """Share of the bar when tracking begins; jobs from before it was recorded have 0.1."""
    return start.get("begins", 0.1)

"""What a tracking job does, step by step. Every step reads files and writes files, so doing one twice changes nothing.

The result depends on the recording, the options, the models and the annotations of the first frame only: the tracker's
state always goes through its file, whether the next chunk runs in the same process or after a crash. Timing is the
exception.
"""

from __future__ import annotations

import logging
from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path
from typing import TYPE_CHECKING, Any

from server.jobs.files import JobFiles
from server.jobs.progress import JobProgress
from server.jobs.service import HAND_MODEL, TRAINED_HAND

if TYPE_CHECKING:
    from tracker import ArticulatedModel, Sequence, TrackOptions

log = logging.getLogger(__name__)

CHUNK_FRAMES = 20
"""Frames a step tracks; what a crash can cost."""


@dataclass(frozen=True)
class TrackingJob:
    """Inputs of a tracking job and the folder it works in."""

    recording: Path
    params: dict[str, Any]
    files: JobFiles
    hand_model: Path | None = None
    """File of the hand model to track with; None for a hand that comes with Handloom."""

    @property
    def options(self) -> TrackOptions:
        from tracker import TrackOptions

        return TrackOptions.from_json({name: value for name, value in self.params.items() if name != HAND_MODEL})

    def load_recording(self) -> Sequence:
        from tracker import load_sequence

        return load_sequence(self.recording)

    def load_hands(self) -> dict[str, ArticulatedModel] | None:
        """Both hands of the chosen model."""
        from tracker import articulated_of, load_blend_model, mirror_blend, trained_hand

        if self.hand_model is not None:
            model = load_blend_model(self.hand_model)
        elif self.params.get(HAND_MODEL) == TRAINED_HAND:
            model = trained_hand("right")
        else:
            return None
        return {hand.side: articulated_of(hand) for hand in (model, mirror_blend(model))}

    def start(self, progress: JobProgress) -> dict[str, Any]:
        """Find the first pose and the shape; write the setup and the first state."""
        from tracker import load_annotations, start_tracking

        manifest = self.files.read_manifest("start")
        if manifest is not None:
            return manifest
        sequence = self.load_recording()
        options = self.options
        annotations = load_annotations(self.files.annotations) if self.files.annotations.exists() else None
        setup, state = start_tracking(sequence, options, self.load_hands(), annotations, progress.stage)
        self.files.write(self.files.setup, setup.save)
        self.files.write(self.files.state(0), state.save)
        frames = options.frame_range(sequence.frame_count)
        first, end = frames.start, frames.stop
        borders = [*range(first, end, CHUNK_FRAMES), end]
        return self.files.write_manifest(
            "start",
            [self.files.setup, self.files.state(0)],
            {"first": first, "frames": end - first, "chunks": [list(pair) for pair in pairwise(borders)]},
        )

    def track_chunk(self, start: dict[str, Any], chunk: int, progress: JobProgress) -> dict[str, Any]:
        """Track one chunk of frames; write its results and the state after it."""
        from tracker import TrackSetup, TrackState, track_frames

        step = f"chunk-{chunk:04d}"
        manifest = self.files.read_manifest(step)
        first, end = start["chunks"][chunk]
        if manifest is None:
            sequence = self.load_recording()
            setup, state = TrackSetup.load(self.files.setup), TrackState.load(self.files.state(chunk))
            done = first - start["first"]
            state, results = track_frames(
                sequence,
                setup,
                state,
                range(first, end),
                lambda frame, _: progress.frames(done + frame - first + 1, start["frames"]),
            )
            self.files.write(self.files.chunk(chunk), results.save)
            self.files.write(self.files.state(chunk + 1), state.save)
            manifest = self.files.write_manifest(step, [self.files.chunk(chunk), self.files.state(chunk + 1)], {})
        progress.chunk_done(end - start["first"], start["frames"], f"frames {first} to {end - 1} tracked")
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

"""One tracking run on a twin and what is measured of it; every study is made of such runs.

Errors are means over the 21 joints of every hand. An object's error is that of its centroid if it is rigid and the mean
over the origins of its bones if it is articulated; beside it stands the mean distance of its surface to the true one,
because nothing in a depth image tells how far a plain rope has slid along itself or a ball has turned.
"""

from __future__ import annotations

from contextlib import suppress
from dataclasses import asdict, dataclass
from functools import lru_cache
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np

from tracker.capture.annotations import load_annotations
from tracker.capture.sequence import Sequence, load_sequence
from tracker.capture.truth import Truth, load_truth
from tracker.evaluation import compute_surface_distances, evaluate_against_truth
from tracker.fitting.options import TrackOptions
from tracker.fitting.setup import TrackSetup
from tracker.model import save_model
from tracker.synthesis.performance import Performance
from tracker.synthesis.recording import RecordingOptions, write_recording
from tracker.synthesis.twin import load_twin
from tracker.terms.penetration import measure_penetration
from tracker.tracking.follow import track_frames
from tracker.tracking.start import start_tracking
from tracker.tracking.state import TrackState
from tracker.tracking.track import Track, join_chunks

SEQUENCES = ("01", "04", "09", "12", "15", "17", "18", "20")
"""The eight public ones: 01, 04 two hands; 09, 12 one; 15 with a ball, 20 a cube; 17 two with a pipe, 18 a rope."""

FACES = 1500
SAMPLED = 400
"""Vertices of an object whose distance to the true surface is measured, in one of SPARSE frames."""
SPARSE = 5


STILL = 1e-6
"""Nothing moves where no joint moves by more, m."""


@dataclass(frozen=True)
class Twin:
    """A rendered twin.

    Attributes:
        performance: Who moved how.
        sequence: The recording.
        truth: What is exactly known.
    """

    performance: Performance
    sequence: Sequence
    truth: Truth


@lru_cache(maxsize=4)
def render_twin(
    data: Path, cache: Path, name: str, frames: int | None, step: int, seed: int, faces: int | None = FACES
) -> Twin:
    """A twin from the cache, or rendered into it; `data` is the authors' folder, None `faces` their full meshes."""
    performance = load_twin(data, name, faces)
    last = performance.num_moments if frames is None else min(frames, performance.num_moments)
    folder = cache / (f"{name}_{last}_{step}_{seed}" + ("" if faces == FACES else f"_{faces or 'full'}"))
    if not folder.exists():
        render_into(folder, performance, RecordingOptions(range(0, last, step), seed=seed))
    return Twin(performance, load_sequence(folder), load_truth(folder / "truth.npz"))


def render_into(folder: Path, performance: Performance, options: RecordingOptions) -> None:
    """Write a recording beside `folder` and move it there whole: two processes may want the same one at a time."""
    folder.parent.mkdir(parents=True, exist_ok=True)
    with TemporaryDirectory(dir=folder.parent, prefix=f".{folder.name}.") as temporary:
        written = Path(temporary) / folder.name
        write_recording(performance, written, options, save_model)
        with suppress(OSError):  # the other one was first; both would be the same
            written.rename(folder)
    assert folder.is_dir()


def start_twin(twin: Twin, options: TrackOptions, own_hand: bool = False) -> tuple[TrackSetup, TrackState]:
    """Start from the annotation of the first frame, with the rendered models or with our own hand, calibrated."""
    models = {actor.name: actor.model for actor in twin.performance.objects}
    if not own_hand:
        models |= {actor.name: actor.model for actor in twin.performance.hands}
    annotations = load_annotations(twin.sequence.folder / "annotations.json")
    return start_tracking(twin.sequence, options, models, annotations)


def find_first_motion(twin: Twin) -> int:
    """The frame before the first in which anything moves; 0 where nothing ever does.

    In the authors' file the hand of sequence 12 stands still for its first 419 frames of 727: whoever stays put there
    is right, and a mean over them tells little of tracking.
    """
    joints = twin.truth.joints_3d
    moves = np.abs(np.diff(joints, axis=0)).reshape(len(joints) - 1, -1).max(axis=1) > STILL
    return int(twin.truth.frame[np.argmax(moves)]) if moves.any() else 0


def run_twin(twin: Twin, setup: TrackSetup, state: TrackState) -> Track:
    """Track all frames from a state on."""
    frames = setup.options.frame_range(twin.sequence.frame_count)
    _, chunk = track_frames(twin.sequence, setup, state, frames)
    return join_chunks(twin.sequence, setup, [chunk])


def measure(twin: Twin, track: Track, penetration: bool = False) -> dict[str, Any]:
    """The figures of a run; `penetration` adds the deepest of any frame, which takes some milliseconds a frame."""
    error = evaluate_against_truth(track, twin.truth)
    px, mm = error.error_px, 1e3 * error.error
    hands = 1e3 * error.hand_mean
    is_moving = error.frame > find_first_motion(twin)
    found = {
        "frames": len(error.frame),
        "hands": len(error.hands),
        "px": float(np.nanmean(px)),
        "px_std": float(np.nanstd(px)),
        "px_max": float(np.nanmax(px)),
        "mm": float(mm.mean()),
        "moving_frames": int(np.count_nonzero(is_moving)),
        "moving_px": float(np.nanmean(px[is_moving])) if is_moving.any() else float(np.nanmean(px)),
        "worst_mm": float(hands.max()),
        "worst_frame": int(error.frame[np.argmax(hands.max(axis=1))]),
        "lost": int(error.is_lost.sum()),
        "silent": int(error.is_silently_lost.sum()),
        "said_lost": int(np.count_nonzero(track.status == "lost")),
        "recovered": int(np.count_nonzero(track.status == "recovered")),
        "median_ms": 1e3 * float(np.median(track.seconds)),
        "p95_ms": 1e3 * float(np.percentile(track.seconds, 95)),
        "objects": _measure_objects(twin, track),
    }
    if penetration:
        depths = [1e3 * measure_penetration(track.setup.scene.pose_at(pose)) for pose in track.pose]
        found |= {"deepest_mm": max(depths), "mean_deepest_mm": float(np.mean(depths))}
    return found


def _measure_objects(twin: Twin, track: Track) -> dict[str, dict[str, float]]:
    found = {}
    for actor in twin.performance.objects:
        place = track.setup.names.index(actor.name)
        where = track.setup.scene.vertex_slices[place]
        mesh = actor.model.faces
        chosen = np.linspace(0, len(actor.model.vertices) - 1, SAMPLED).astype(int)
        bones, surface = [], []
        for row, (frame, pose) in enumerate(zip(track.frame, track.pose, strict=True)):
            moment = int(twin.truth.source_frame[np.searchsorted(twin.truth.frame, frame)])
            true = actor.vertices(moment)
            posed = track.setup.scene.pose_at(pose)
            own = posed.vertices[where]
            if actor.joint_names:
                off = np.linalg.norm(posed.landmarks(place) - actor.joints(moment, true), axis=1)
            else:
                off = np.atleast_1d(np.linalg.norm(own.mean(axis=0) - true.mean(axis=0)))
            bones.append(1e3 * float(off.mean()))
            if row % SPARSE == 0:
                surface.append(1e3 * compute_surface_distances(own[chosen], true, mesh).mean())
        found[actor.name] = {
            "mm": float(np.mean(bones)),
            "worst_mm": float(np.max(bones)),
            "surface_mm": float(np.mean(surface)),
        }
    return found


@dataclass(frozen=True)
class Run:
    """What to run: a sequence, how fast, with which terms and hand, by the tracker as it comes."""

    sequence: str
    step: int = 1
    frames: int | None = None
    terms: str = "LO"
    iterations: int = 10
    own_hand: bool = False
    seed: int = 0
    stop_below_mm: float = 0.0
    threads: int = 1
    penetration: bool = False
    method: str = "handloom"

    def __call__(self, data: Path, cache: Path, penetration: bool = False) -> dict[str, Any]:
        """Render, track, measure."""
        faces = None if self.method == "t16" else FACES
        twin = render_twin(data, cache, self.sequence, self.frames, self.step, self.seed, faces)
        options = TrackOptions(
            method=self.method,
            terms=self.terms,
            iterations=self.iterations,
            calibrate=self.own_hand,
            stop_below_mm=self.stop_below_mm,
            threads=self.threads,
        )
        track = run_twin(twin, *start_twin(twin, options, self.own_hand))
        return {**asdict(self), **measure(twin, track, penetration or self.penetration)}

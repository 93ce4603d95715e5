"""Does optical flow help on real recordings? `python -m benchmarks.real_marks.flow DATA [--weights 0.05 0.2]`.

The tracks of `benchmarks.real_marks.views` again, with the O of [T16] §3.3 in every frame and without; distances of the
marked joints from both, paired, with an interval by a bootstrap over marked frames.
"""

from __future__ import annotations

import argparse
import os
from dataclasses import replace
from pathlib import Path
from time import perf_counter
from unittest.mock import patch

for name in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "NUMBA_NUM_THREADS"):
    os.environ.setdefault(name, "1")  # before numpy: one thread is measured

import numpy as np  # noqa: E402
import numpy.typing as npt  # noqa: E402

from benchmarks.real_marks.marked import MarkedRecording  # noqa: E402
from benchmarks.real_marks.views import ROOT, follow, read_infrared, read_two_cameras  # noqa: E402
from tracker.capture.frame import CameraFrame, Frame  # noqa: E402
from tracker.fitting.frame_fit import Fit  # noqa: E402
from tracker.fitting.objective import Objective  # noqa: E402
from tracker.fitting.setup import TrackSetup  # noqa: E402
from tracker.fitting.view_hands import ViewHands  # noqa: E402
from tracker.observation.image_flow import find_image_flow  # noqa: E402
from tracker.terms.flow import follow_surface, join_flows  # noqa: E402
from tracker.tracking import follow_views  # noqa: E402
from tracker.tracking.fit_views import fit_views  # noqa: E402
from tracker.tracking.track import Track  # noqa: E402
from tracker.tracking.view_edges import EDGE_MARGIN, find_place  # noqa: E402

Array = npt.NDArray[np.float64]
RESAMPLES, SEED = 2000, 20160508


class WithFlow:
    """`fit_views` with the flow since the frame before."""

    def __init__(self, weight: float) -> None:
        self.weight = weight
        self.before: tuple[list[Frame], Array] | None = None
        self.seconds: list[float] = []

    def __call__(
        self,
        setup: TrackSetup,
        objective: Objective,
        seen: ViewHands,
        views: list[CameraFrame],
        pose: Array,
        iterations: int,
    ) -> Fit:
        frames = [view.frame for view in views]
        if self.before is not None and frames[0].index == self.before[0][0].index + 1:
            started = perf_counter()
            objective = self._add(setup, objective, seen, frames)
            self.seconds.append(perf_counter() - started)
        fit = fit_views(setup, objective, seen, views, pose, iterations)
        self.before = frames, fit.pose
        return fit

    def _add(self, setup: TrackSetup, objective: Objective, seen: ViewHands, frames: list[Frame]) -> Objective:
        assert self.before is not None
        posed, parts = setup.scene.pose_at(self.before[1]), []
        for camera, first, second in zip(seen.cameras, self.before[0], frames, strict=True):
            assert first.color is not None and second.color is not None
            points, margin = find_place(posed.vertices, camera, EDGE_MARGIN)
            flow = find_image_flow(first.color, second.color, camera, points, margin) if len(points) else None
            if flow is not None:
                parts.append(follow_surface(posed, flow))
        return (
            replace(objective, terms={**objective.terms, "flow": join_flows(parts, self.weight)})
            if parts
            else objective
        )


def measure(recording: MarkedRecording, track: Track, camera: str) -> Array:
    """(M, 21) px, distance of each marked joint of each marked frame from the track; NaN where none is marked."""
    view, rows = track.camera_ids.index(camera), {int(frame): row for row, frame in enumerate(track.frame)}
    return np.array(
        [np.linalg.norm(track.joints_2d[rows[f]][view, :21] - m, axis=1) for f, m in recording.marks.items()]
    )


def compare(without: list[Array], with_it: list[Array]) -> tuple[float, float, float]:
    """Mean difference, px, each joint's distance counted at most as 40 px, and its 95 % interval over marked frames."""
    pairs = [(np.minimum(a, 40.0), np.minimum(b, 40.0)) for a, b in zip(without, with_it, strict=True)]
    sums = np.concatenate([np.nansum(b - a, axis=1) for a, b in pairs])
    counts = np.concatenate([np.isfinite(b - a).sum(axis=1) for a, b in pairs])
    drawn = np.random.default_rng(SEED).integers(len(sums), size=(RESAMPLES, len(sums)))
    low, high = np.percentile(sums[drawn].sum(axis=1) / np.maximum(counts[drawn].sum(axis=1), 1), [2.5, 97.5])
    return float(sums.sum() / counts.sum()), float(low), float(high)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("data", type=Path)
    parser.add_argument("--work", type=Path, default=ROOT / "out" / "real_views")
    parser.add_argument("--left-out", action="store_true", help="also in two of three cameras, judged in the third")
    parser.add_argument("--weights", type=float, nargs="+", default=[0.05])
    given = parser.parse_args()
    given.work.mkdir(parents=True, exist_ok=True)
    folder = Path(__file__).parent / "recordings"
    print("| recording | tracked in | flow | followed | median px in each camera | difference px | 95 % | flow ms |")
    for sequence in (read_two_cameras(given.data, given.work), read_infrared(given.data, given.work)):
        ids = tuple(camera.id for camera in sequence.cameras)
        for cameras in (
            ids,
            *(tuple(c for c in ids if c != left_out) for left_out in ids if given.left_out and len(ids) > 2),
        ):
            judged = ids if cameras == ids else tuple(set(ids) - set(cameras))
            marks = [MarkedRecording.load(folder / f"{sequence.name}_{camera}") for camera in judged]
            base: list[Array] = []
            for weight in (0.0, *given.weights):
                switched = WithFlow(weight)
                with patch.object(follow_views, "fit_views", switched if weight else fit_views):
                    track = follow(sequence, cameras)
                found = [measure(one, track, camera) for one, camera in zip(marks, judged, strict=True)]
                base = base or found
                mean, low, high = compare(base, found)
                medians = ", ".join(f"{np.nanmedian(each):.1f}" for each in found)
                print(
                    f"| {sequence.name} | {', '.join(cameras)} | {weight or 'none'} | "
                    f"{np.count_nonzero(track.status != 'lost')} of {len(track.frame)} | {medians} | {mean:+.2f} | "
                    f"{low:+.2f} to {high:+.2f} | {1000 * np.median(switched.seconds or [0.0]):.0f} |",
                    flush=True,
                )


if __name__ == "__main__":
    main()

"""Do finger nails help in colour views? `python -m benchmarks.rendered_views.nails NAILS.npz [--write]`.

NAILS.npz is what `handloom train-detector --what nails` wrote. Rendered hands with nails are tracked without depth and
without annotation, with the very hands that were drawn, by the hand detector and contours, with nails and without;
errors are of all joints, and of fingertips, against the truth, in the frames that were not called lost. `--write`
writes `benchmarks/results/nails.md`.
"""

from __future__ import annotations

import argparse
import os
import tempfile
from pathlib import Path

for name in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "NUMBA_NUM_THREADS"):
    os.environ.setdefault(name, "1")  # before numpy: one thread is measured

import numpy as np  # noqa: E402

from benchmarks.rendered_views.errors import find_interval  # noqa: E402
from benchmarks.rendered_views.setting import TIPS  # noqa: E402
from benchmarks.result_page import write_result  # noqa: E402
from tracker.capture.sequence import Sequence, load_sequence  # noqa: E402
from tracker.capture.truth import load_truth  # noqa: E402
from tracker.detection import OwnDetector, load_detector  # noqa: E402
from tracker.fitting.options import TrackOptions  # noqa: E402
from tracker.model.default_hand import default_hand  # noqa: E402
from tracker.model.npz_files import save_npz_model  # noqa: E402
from tracker.synthesis.motion import perform  # noqa: E402
from tracker.synthesis.nail_paint import NailPaint  # noqa: E402
from tracker.synthesis.recording import RecordingOptions, write_recording  # noqa: E402
from tracker.synthesis.texture import Texture  # noqa: E402
from tracker.tracking.follow import track_frames  # noqa: E402
from tracker.tracking.start import start_tracking  # noqa: E402
from tracker.tracking.track import join_chunks  # noqa: E402

MOTIONS = ("count", "pinch")
"""The term's weight was chosen on open-close."""

FRAMES, WHOLE, SIZE, MOST = 20, 60, (960, 720), 4


def render(motion: str, folder: Path) -> Sequence:
    """A right hand with nails before four cameras."""
    if (folder / motion).exists():
        return load_sequence(folder / motion)
    performance = perform({"right": default_hand("right")}, motion, WHOLE, MOST, SIZE)
    texture = Texture(seed=20, nails=NailPaint())
    options = RecordingOptions(range(0, WHOLE, WHOLE // FRAMES), sensor=None, texture=texture)
    return write_recording(performance, folder / motion, options, save_npz_model)


def follow(sequence: Sequence, cameras: int, detector: OwnDetector | None) -> tuple[np.ndarray, float]:
    """(T, 21) distances of all joints from the truth, mm, NaN in lost frames, and median ms a frame."""
    ids = ",".join(camera.id for camera in sequence.cameras[:cameras])
    options = TrackOptions(calibrate=False, cameras=ids, use_depth=False)
    setup, state = start_tracking(sequence, options, {"right": default_hand("right")}, detector=detector)
    _, chunk = track_frames(sequence, setup, state, range(sequence.frame_count))
    track = join_chunks(sequence, setup, [chunk])
    truth = load_truth(sequence.folder / "truth.npz").joints_3d
    apart = 1000.0 * np.linalg.norm(track.joints_3d - truth, axis=2)
    apart[track.status == "lost"] = np.nan
    return apart, 1000.0 * float(np.median(track.seconds[1:]))


def compare(motion: str, recording: Sequence, cameras: int, nails: OwnDetector) -> list[str]:
    """Two rows: without nails and with them, and what they change."""
    rows, before = [], np.zeros((0, 21))
    for detector in (None, nails):
        apart, ms = follow(recording, cameras, detector)
        rows.append(
            f"| {motion} | {cameras} | {'no' if detector is None else 'yes'} | {describe(apart)} | {ms:.0f} | "
            f"{'' if detector is None else describe_change(before, apart)} |"
        )
        before = apart
    return rows


def describe(apart: np.ndarray) -> str:
    """Cells of a row: lost frames, mean and largest error of joints and of tips (T, 21), mm, in the other frames."""
    is_held = np.isfinite(apart).all(axis=1)
    cells = [f"{np.count_nonzero(~is_held)} of {len(apart)}"]
    for own in (apart[is_held], apart[is_held][:, list(TIPS)]):
        cells.append(f"{own.mean():.2f} ({own.max():.0f})" if own.size else "-")
    return " | ".join(cells)


def describe_change(before: np.ndarray, after: np.ndarray) -> str:
    """By how much the mean of the joints (T, 21), mm, changes, over the frames that neither lost, and its interval."""
    change = after.mean(axis=1) - before.mean(axis=1)
    change = change[np.isfinite(change)]
    if not len(change):
        return "-"
    low, high = find_interval(change)
    return f"{np.mean(change):+.2f} ({low:+.2f} to {high:+.2f})"


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("nails", type=Path)
    parser.add_argument("--cameras", type=int, nargs="+", default=[2, 4])
    parser.add_argument("--motions", nargs="+", default=list(MOTIONS))
    parser.add_argument("--folder", type=Path, help="keep what was rendered here, or take it from here")
    parser.add_argument("--write", action="store_true", help="write benchmarks/results/nails.md")
    given = parser.parse_args()
    nails = load_detector(given.nails)
    rows = [
        "| motion | cameras | nails | lost | joints, mean mm (largest) | tips, mean mm (largest) | median ms | "
        "change, 95 % interval |",
        "|---|---|---|---|---|---|---|---|",
    ]
    with tempfile.TemporaryDirectory() as temporary:
        for motion in given.motions:
            recording = render(motion, given.folder or Path(temporary))
            for cameras in given.cameras:
                rows += compare(motion, recording, cameras, nails)
                print(*rows[-2:], sep="\n", flush=True)
    if given.write:
        command = "python -m benchmarks.rendered_views.nails NAILS.npz --write"
        rows.append(
            "\nErrors and changes are of frames that were not called lost. NAILS.npz is of `handloom train-detector "
            "--what nails --rendered 300 --trees 6 --tests 600 --patches 8000`."
        )
        write_result("nails", "Finger nails in colour views", command, "\n".join(rows))


if __name__ == "__main__":
    main()

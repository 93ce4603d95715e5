"""Number of colour cameras against error: `python -m benchmarks.rendered_views.own_detector [--cameras 1 2 3 4 8]`.

A rendered hand opens and closes before up to eight cameras of 640x480 px; it is tracked without depth and without
annotation, with the very hand that was drawn, with contours and without. Errors are of all joints against the truth.
"""

from __future__ import annotations

import argparse
import tempfile
from contextlib import nullcontext
from dataclasses import replace
from pathlib import Path
from unittest.mock import patch

import numpy as np

import tracker.tracking.fit_views as fit_views
from tracker.capture.truth import load_truth
from tracker.fitting.options import TrackOptions
from tracker.fitting.view_hands import ViewHands
from tracker.fitting.view_hold import ViewHold, choose_hold
from tracker.model.default_hand import default_hand
from tracker.model.npz_files import save_npz_model
from tracker.synthesis.motion import perform
from tracker.synthesis.recording import RecordingOptions, write_recording
from tracker.tracking.follow import track_frames
from tracker.tracking.start import start_tracking
from tracker.tracking.track import join_chunks

FRAMES = 24


def hold_by_joints(seen: ViewHands) -> ViewHold:
    """As the tracker chooses, without the iterations with contours."""
    return replace(choose_hold(seen), iterations=0)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--cameras", type=int, nargs="+", default=[1, 2, 3, 4, 8])
    given = parser.parse_args()
    print("| cameras | contours | lost | mean mm | worst mm |\n|---|---|---|---|---|")
    with tempfile.TemporaryDirectory() as folder:
        performance = perform({"right": default_hand("right")}, "open-close", 60, 8, (640, 480))
        out = Path(folder) / "hand"
        sequence = write_recording(performance, out, RecordingOptions(range(FRAMES)), save_npz_model)
        truth = load_truth(out / "truth.npz").joints_3d[:FRAMES]
        for count in given.cameras:
            ids = ",".join(camera.id for camera in sequence.cameras[:count])
            for has_contours in (False, True):
                options = TrackOptions(calibrate=False, cameras=ids, use_depth=False)
                with nullcontext() if has_contours else patch.object(fit_views, "choose_hold", hold_by_joints):
                    setup, state = start_tracking(sequence, options)
                    _, chunk = track_frames(sequence, setup, state, range(FRAMES))
                track = join_chunks(sequence, setup, [chunk])
                held = track.status != "lost"
                apart = 1000.0 * np.linalg.norm(track.joints_3d[held] - truth[held], axis=2)
                worst = apart.max(initial=0.0)
                print(
                    f"| {count} | {'yes' if has_contours else 'no'} | {np.count_nonzero(~held)} of {FRAMES} | "
                    f"{apart.mean():.1f} | {worst:.0f} |",
                    flush=True,
                )


if __name__ == "__main__":
    main()

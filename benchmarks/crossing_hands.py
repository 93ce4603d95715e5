"""Two hands that cross, started without annotation: in how many frames the tracker holds each for the other.

    python -m benchmarks.crossing_hands FOLDER_OF_T16_DATA [--sequences 01 04]

Twins of T16's hand-hand sequences, every second frame, with and without the hand detector, the default hand. Hands are
swapped in a frame where both together lie nearer to each other's truth than to their own.
"""

from __future__ import annotations

import argparse
import tempfile
from itertools import groupby
from pathlib import Path

import numpy as np
import numpy.typing as npt

from tracker.capture.sequence import Sequence
from tracker.capture.truth import Truth, load_truth
from tracker.fitting.options import TrackOptions
from tracker.model.npz_files import save_npz_model
from tracker.synthesis.recording import RecordingOptions, write_recording
from tracker.synthesis.twin import load_twin
from tracker.tracking.follow import track_frames
from tracker.tracking.start import start_tracking
from tracker.tracking.track import Track, join_chunks

HANDS = ("right", "left")


def follow(sequence: Sequence, use_detector: bool) -> Track:
    """A track from an automatic start."""
    options = TrackOptions(use_detector=use_detector, calibrate=False)
    setup, state = start_tracking(sequence, options)
    _, chunk = track_frames(sequence, setup, state, options.frame_range(sequence.frame_count))
    return join_chunks(sequence, setup, [chunk])


def measure_distances(track: Track, truth: Truth) -> npt.NDArray[np.float64]:
    """(T, 2, 2) mean distance of the joints of each tracked hand from the truth of each hand, mm."""
    columns = [[n for n, joint in enumerate(truth.joint_names) if joint.startswith(f"{hand}/")] for hand in HANDS]
    found = np.stack([[track.setup.scene.pose_at(pose).landmarks(n) for n in range(2)] for pose in track.pose])
    true = np.stack([truth.joints_3d[:, each] for each in columns], axis=1)
    return 1e3 * np.linalg.norm(found[:, :, None] - true[:, None], axis=-1).mean(axis=-1)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("data", type=Path)
    parser.add_argument("--sequences", nargs="+", default=["01", "04"])
    given = parser.parse_args()
    for name in given.sequences:
        performance = load_twin(given.data, name, 1500)
        frames = RecordingOptions(range(0, len(performance.actors[0].Ms), 2))
        with tempfile.TemporaryDirectory() as folder:
            sequence = write_recording(performance, Path(folder) / name, frames, save_npz_model)
            truth = load_truth(Path(folder) / name / "truth.npz")
            for use_detector in (True, False):
                track = follow(sequence, use_detector)
                assert tuple(track.setup.names[:2]) == HANDS
                d = measure_distances(track, truth)
                swapped = d[:, 0, 0] + d[:, 1, 1] > d[:, 0, 1] + d[:, 1, 0]
                longest = max((len(list(run)) for is_swapped, run in groupby(swapped) if is_swapped), default=0)
                own = np.diagonal(d, axis1=1, axis2=2)
                print(
                    f"{name} {'with' if use_detector else 'without'} detector: {len(d)} frames, "
                    f"{np.count_nonzero(track.status == 'lost')} lost, {np.count_nonzero(swapped)} swapped, "
                    f"{longest} at a time; mm {own.mean():.1f}, most {own.max():.1f}",
                    flush=True,
                )


if __name__ == "__main__":
    main()

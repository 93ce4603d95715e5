"""How far a held object moves when the simulation is let go at tracked poses, by terms; [T16] §4.2.1.

    python -m benchmarks.studies.displacement FOLDER_OF_T16_DATA --cache FOLDER

Frames count in which the truth moves at most 3 mm under SD-obman (under SD-seed it falls in all of
them). Tracked are the rendered hand, and our own hand calibrated from the first second, which is what a real recording
is like: T16 reports 9.26 mm without and 9.05 mm with P on its recordings.
"""

from __future__ import annotations

import argparse
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import numpy.typing as npt

from benchmarks.studies.held import HELD, pose_truth
from benchmarks.studies.paper import DISPLACEMENT_MM
from benchmarks.studies.twin_runs import Twin, measure, render_twin, run_twin, start_twin
from tracker.physics import SD_OBMAN, SD_SEED, SEARCH, PhysicsWorld, Protocol, find_down, simulate
from tracker.tracking.options import TrackOptions
from tracker.tracking.setup import TrackSetup

Array = npt.NDArray[np.float64]

NAMES = ("15", "20")
TERMS = ("LO", "LO+P", "LO+C", "LO+CP")
PROTOCOLS = (SD_SEED, SD_OBMAN, SEARCH)


@dataclass(frozen=True)
class Displacements:
    """Of the object in the frames that count.

    Attributes:
        who: "truth" or the terms.
        px: Mean error of the joints over all frames; NaN for the truth.
        mm: The same, mm.
        moved_mm: (3, N) under each of `PROTOCOLS`.
    """

    who: str
    px: float
    mm: float
    moved_mm: Array

    def row(self, sequence: str, hand: str) -> str:
        """One line of the table."""
        cells = [sequence, hand, self.who, f"{self.px:.3f}", f"{self.mm:.3f}"]
        for moved in self.moved_mm:
            cells.append(f"{moved.mean():.2f} / {np.median(moved):.2f} / {np.count_nonzero(moved <= 1e3 * HELD)}")
        return "| " + " | ".join([*cells, str(self.moved_mm.shape[1])]) + " |"


def measure_sequence(twin: Twin, own_hand: bool) -> Iterator[Displacements]:
    """The truth, then tracks with each of `TERMS`."""
    true_setup, _ = start_twin(twin, TrackOptions(calibrate=False))
    down = find_down(twin.sequence.camera(true_setup.camera_id).T_world_camera)
    with PhysicsWorld(true_setup.scene, down=down) as world:
        every = [pose_truth(twin, true_setup, frame) for frame in range(twin.sequence.frame_count)]
        frames = [frame for frame, posed in enumerate(every) if simulate(world, posed, SD_OBMAN) <= HELD]
        moved = [[1e3 * simulate(world, every[frame], p) for frame in frames] for p in PROTOCOLS]
    yield Displacements("truth", float("nan"), float("nan"), np.array(moved))
    for terms in TERMS:
        setup, state = start_twin(twin, TrackOptions(terms=terms, calibrate=own_hand), own_hand)
        track = run_twin(twin, setup, state)
        error = measure(twin, track)
        poses = [track.pose[np.searchsorted(track.frame, frame)] for frame in frames]
        yield Displacements(terms, error["px"], error["mm"], _let_go(setup, poses, down, PROTOCOLS))


def _let_go(
    setup: TrackSetup, poses: list[Array], down: tuple[float, float, float], protocols: tuple[Protocol, ...]
) -> Array:
    with PhysicsWorld(setup.scene, down=down) as world:
        return np.array(
            [[1e3 * simulate(world, setup.scene.pose_at(p), protocol) for p in poses] for protocol in protocols]
        )


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("data", type=Path, help="the authors' folder")
    parser.add_argument("--cache", type=Path, default=Path("twins"), help="where twins are rendered to")
    parser.add_argument("--frames", type=int, help="first frames only")
    arguments = parser.parse_args()
    heads = [
        "sequence",
        "hand",
        "terms",
        "px",
        "mm",
        *(f"{p.name}: mean / median mm / stable" for p in PROTOCOLS),
        "of",
    ]
    print("| " + " | ".join(heads) + " |\n|" + "---|" * len(heads), flush=True)
    for name in NAMES:
        twin = render_twin(arguments.data, arguments.cache, name, arguments.frames, 1, 0)
        for hand, own in (("rendered", False), ("own", True)):
            for found in measure_sequence(twin, own):
                print(found.row(name, hand), flush=True)
    print(f"\nT16, its recordings: {', '.join(f'{terms} {mm} mm' for terms, mm in DISPLACEMENT_MM.items())}.")


if __name__ == "__main__":
    main()

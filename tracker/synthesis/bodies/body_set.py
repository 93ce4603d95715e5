"""Folders of generated scans of people: `NAME.ply` and `truth/NAME.npz`."""

from __future__ import annotations

import io
from collections.abc import Callable
from pathlib import Path

import numpy as np

from tracker.capture.atomic_file import write_atomically
from tracker.capture.scan import save_scan
from tracker.synthesis.bodies.generate import BodyScanOptions, GeneratedBody, generate_body
from tracker.synthesis.bodies.moving import MovingPerson
from tracker.synthesis.scans.scanner import Scanner

TRUTH = "truth"
Progress = Callable[[float, str], None]


def write_people(
    numbers: list[int], folder: Path, seed: int, options: BodyScanOptions, progress: Progress | None = None
) -> list[Path]:
    """Write a scan of each person that is not there yet; what `progress` raises ends the work.

    Args:
        numbers: Of the people.
        folder: Gets `personNNN_SEED.ply` and its truth.
        seed: Of pose and holes.
        options: How people are scanned.
        progress: Is told the share that is done and the file.
    """
    paths = []
    for count, number in enumerate(numbers):
        path = folder / f"person{number:03d}_{seed}.ply"
        if not truth_of(path).exists():
            _write(generate_body(number, seed, options), path)
        paths.append(path)
        if progress is not None:
            progress((count + 1) / len(numbers), path.name)
    return paths


def write_motion(moving: MovingPerson, folder: Path, scanner: Scanner, progress: Progress | None = None) -> list[Path]:
    """Write the frames of a motion that are not there yet, `NNNNNN.ply`; what `progress` raises ends the work."""
    paths = []
    for t in range(len(moving)):
        path = folder / f"{t:06d}.ply"
        if not truth_of(path).exists():
            _write(moving.scan(t, scanner), path)
        paths.append(path)
        if progress is not None:
            progress((t + 1) / len(moving), path.name)
    return paths


def truth_of(path: Path) -> Path:
    """Where the truth of a scan lies: `vertices` (V, 3), `joints` (52, 3), m; `pose` (52, 3), rad; `is_seen` (V,);
    `shows_hands`, left and right; `person`."""
    return path.parent / TRUTH / f"{path.stem}.npz"


def _write(made: GeneratedBody, path: Path) -> None:
    """The truth is written last: where it is, the scan is."""
    truth_of(path).parent.mkdir(parents=True, exist_ok=True)
    save_scan(made.scan, path)
    buffer = io.BytesIO()
    np.savez_compressed(
        buffer,
        vertices=made.true_vertices,
        joints=made.joints,
        pose=made.pose,
        is_seen=made.is_seen,
        shows_hands=np.array([made.shows_hand["left"], made.shows_hand["right"]]),
        person=np.array(made.person),
    )
    write_atomically(truth_of(path), buffer.getvalue())

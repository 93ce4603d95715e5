"""Folders of generated scans: `scans/*.ply`, `truth/*.npz`, and `scans.json` that lists them."""

from __future__ import annotations

import io
import json
from collections.abc import Callable, Iterator
from dataclasses import asdict, dataclass, field, replace
from itertools import product
from pathlib import Path
from typing import Any

import numpy as np

from tracker.capture.atomic_file import write_atomically
from tracker.capture.scan import save_scan
from tracker.errors import TrackerError, reading
from tracker.synthesis.scans.generate import ScanOptions, generate_scan, scan_name
from tracker.synthesis.scans.generated_scan import GeneratedScan
from tracker.synthesis.scans.motions import load_motion_angles

LIST = "scans.json"


@dataclass(frozen=True)
class ScanSet:
    """Which scans to generate: every subject in every pose with every side, `repeats` times.

    Attributes:
        subjects, poses, sides: See `generate_scan`; poses by name, or as "09-60" frame 60 of a motion of T16.
        repeats: Times, with the seeds `seed`, `seed` + 1 and so on.
        seed: See repeats.
        options: Of all scans.
        every_second_without_forearm: Whether half of the scans end at the wrist.
        motions: T16's folder, for frames of its motions.
        has_surfaces: Whether the truth holds the scanned surface too (330 kB a scan).
    """

    subjects: tuple[int, ...]
    poses: tuple[str, ...]
    sides: tuple[str, ...] = ("right", "left")
    repeats: int = 1
    seed: int = 0
    options: ScanOptions = field(default_factory=ScanOptions)
    every_second_without_forearm: bool = False
    has_surfaces: bool = False
    motions: str = ""

    def items(self) -> Iterator[tuple[int, str, str, int, ScanOptions]]:
        """Subject, pose, side, seed and options of each scan."""
        rounds = range(self.seed, self.seed + self.repeats)
        for number, (subject, pose, side, seed) in enumerate(product(self.subjects, self.poses, self.sides, rounds)):
            is_cut = self.every_second_without_forearm and number % 2 == 1
            yield subject, pose, side, seed, replace(self.options, has_forearm=self.options.has_forearm and not is_cut)

    def __len__(self) -> int:
        return len(self.subjects) * len(self.poses) * len(self.sides) * self.repeats


def write_scan_set(
    wanted: ScanSet, folder: Path, progress: Callable[[float, str], None] | None = None
) -> list[dict[str, Any]]:
    """Write the scans that are not there yet and `scans.json` with all of them; what `progress` raises ends the work.

    Returns:
        The list that `scans.json` holds: for each scan its file, truth, subject, pose, side, seed and forearm; the
        studio reads it when the folder is uploaded.

    Raises:
        TrackerError: The folder holds scans that were made otherwise.
    """
    settings = describe(wanted)
    listed = folder / LIST
    if listed.exists():
        if _read_settings(listed) != settings:
            raise TrackerError(f"{folder} holds scans made with other settings; choose another folder.")
    elif folder.exists() and any(folder.iterdir()):
        raise TrackerError(f"{folder} is not empty and holds no {LIST}; choose another folder.")
    (folder / "scans").mkdir(parents=True, exist_ok=True)
    (folder / "truth").mkdir(exist_ok=True)
    items = list(wanted.items())
    rows = [_row(subject, pose, side, seed, options) for subject, pose, side, seed, options in items]
    _write_list(listed, settings, rows)
    for number, (row, (subject, pose, side, seed, options)) in enumerate(zip(rows, items, strict=True)):
        scan, truth = folder / row["file"], folder / row["truth"]
        # The truth is written last: where it is, the scan is.
        if not truth.exists():
            made = _generate(wanted.motions, subject, pose, side, seed, options)
            save_scan(made.scan, scan)
            write_atomically(truth, pack_truth(made, wanted.has_surfaces))
        if progress is not None:
            progress((number + 1) / len(items), row["file"])
    return rows


def _read_settings(path: Path) -> Any:
    with reading(TrackerError, path, "a list of generated scans; choose another folder"):
        return json.loads(path.read_text())["settings"]


def _generate(motions: str, subject: int, pose: str, side: str, seed: int, options: ScanOptions) -> GeneratedScan:
    sequence, dash, moment = pose.partition("-")
    if not dash:
        return generate_scan(subject, pose, side, seed, options)
    angles = load_motion_angles(Path(motions), sequence, side, int(moment), subject)
    made = generate_scan(subject, angles, side, seed, options)
    named = replace(made.scan, name=scan_name(subject, pose, side, seed))
    return replace(made, scan=named, pose_name=pose)


def describe(wanted: ScanSet) -> dict[str, Any]:
    """The settings as JSON."""
    return json.loads(json.dumps(asdict(wanted)))


def _row(subject: int, pose: str, side: str, seed: int, options: ScanOptions) -> dict[str, Any]:
    name = scan_name(subject, pose, side, seed)
    return {
        "name": name,
        "file": f"scans/{name}.ply",
        "truth": f"truth/{name}.npz",
        "subject": str(subject),
        "pose": pose,
        "side": side,
        "seed": seed,
        "has_forearm": options.has_forearm,
    }


def _write_list(path: Path, settings: dict[str, Any], rows: list[dict[str, Any]]) -> None:
    text = json.dumps({"version": 1, "settings": settings, "scans": rows}, indent=1)
    write_atomically(path, text.encode())


def pack_truth(made: GeneratedScan, has_surface: bool) -> bytes:
    """The npz that lies beside a scan: `vertices`, `joints`, `is_hand`, `subject`, `pose_name`, `side` and perhaps
    `surface_vertices` and `surface_faces`; metres, the scan's coordinates."""
    arrays: dict[str, Any] = {
        "vertices": made.true_vertices,
        "joints": made.joints,
        "is_hand": made.is_hand,
        "subject": np.array(made.subject),
        "pose_name": np.array(made.pose_name),
        "side": np.array(made.side),
    }
    if has_surface:
        arrays["surface_vertices"] = made.true_surface[0].astype(np.float32)
        arrays["surface_faces"] = made.true_surface[1].astype(np.int32)
    buffer = io.BytesIO()
    np.savez_compressed(buffer, allow_pickle=False, **arrays)
    return buffer.getvalue()

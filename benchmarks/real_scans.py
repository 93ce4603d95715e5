"""Register the real scans beside the project, print distances, and draw the registered meshes from four sides.

    python -m benchmarks.real_scans FOLDER [--write]
    python -m benchmarks.real_scans FOLDER --rotations 8 [--out FILE]

The second registers each scan in so many rotations, with others beside them (`scan_rotations`).
FOLDER holds 2_spread.obj, 4_rest.obj and 5_fist.obj, 28.5 mm a unit. The pictures for docs/pictures show our meshes
only: above by finger, below by the mean distance of the scan from each triangle (dark 0, yellow 1 mm and more, grey
no scan).
"""

from __future__ import annotations

import argparse
from pathlib import Path

import cv2
import numpy as np

from benchmarks.hand_pictures import color_fingers, color_shares, draw_four
from benchmarks.scan_rotations import METRES_PER_UNIT, study
from tracker.capture.scan import Scan, load_scan
from tracker.model.untrained_hand import untrained_hand
from tracker.registration.register import Registrar
from tracker.registration.registration import Registration
from tracker.registration.surface_search import Matches, SurfaceSearch

SCANS = ("2_spread", "4_rest", "5_fist")
PICTURES = Path("docs/pictures")


def draw_registration(registration: Registration, matches: Matches) -> np.ndarray:
    faces = np.asarray(registration.faces, dtype=np.int32)
    beside = ~matches.on_rim
    number = np.bincount(matches.faces[beside], minlength=len(faces))
    total = np.bincount(matches.faces[beside], np.abs(matches.offsets[beside]) * 1e3, minlength=len(faces))
    errors = color_shares(np.where(number > 0, total / np.maximum(number, 1), np.nan))
    return np.concatenate(
        [draw_four(registration.vertices, faces, colors) for colors in (color_fingers(faces), errors)]
    )


def match_scan(scan: Scan, vertices: np.ndarray, faces: np.ndarray) -> Matches:
    return SurfaceSearch(vertices, faces).match(vertices, scan.points, np.zeros_like(scan.points), reach=1.0)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("folder", type=Path)
    parser.add_argument("--write", action="store_true", help="write the pictures of docs/scans.md")
    parser.add_argument("--rotations", type=int, default=0, metavar="N", help="register each scan in N rotations")
    parser.add_argument("--out", type=Path, metavar="FILE", help="keeps every rotation's figures as JSON")
    args = parser.parse_args()
    if args.rotations:
        study(args.folder, args.rotations, args.out)
        return
    registrar = Registrar(untrained_hand())
    for name in SCANS:
        scan = load_scan(args.folder / f"{name}.obj", METRES_PER_UNIT)
        registration = registrar.register(scan)
        model = match_scan(scan, registration.model_vertices, registration.faces)
        own = 1e3 * float(np.median(np.abs(model.offsets[~model.on_rim])))
        free = registration.scan_to_mesh_mm
        print(
            f"{name}: {registration.side}, {registration.verdict}; model median {own:.2f} mm; "
            f"free median {free['median']:.2f}, mean {free['mean']:.2f}, p95 {free['p95']:.2f} mm; "
            f"{registration.reasons}"
        )
        if args.write:
            matches = match_scan(scan, registration.vertices, registration.faces)
            path = PICTURES / f"registration_{name.split('_')[1]}.png"
            cv2.imwrite(str(path), draw_registration(registration, matches))


if __name__ == "__main__":
    main()

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

from benchmarks.scan_rotations import METRES_PER_UNIT, study
from tracker.capture.scan import Scan, load_scan
from tracker.model.untrained_hand import untrained_hand
from tracker.registration.register import register_scan
from tracker.registration.registration import Registration
from tracker.registration.surface_search import Matches, SurfaceSearch
from tracker.registration.vertex_normals import find_unit_normals
from tracker.rendering.zbuffer import render_depth

SCANS = ("2_spread", "4_rest", "5_fist")
PICTURES = Path("docs/pictures")
SIZE, FOCAL = 420, 1500.0
PALM, FINGERS = (200, 200, 200), ((90, 90, 230), (90, 200, 90), (220, 180, 60), (220, 90, 160), (60, 170, 240))


def draw(vertices: np.ndarray, faces: np.ndarray, colors: np.ndarray, T: np.ndarray) -> np.ndarray:
    """One view: vertices turned by T (3, 3) about their middle, 1 m away, faces in colours (F, 3) BGR."""
    placed = (vertices - vertices.mean(axis=0)) @ T.T + [0.0, 0.0, 1.0]
    K = np.array([[FOCAL, 0.0, SIZE / 2], [0.0, FOCAL, SIZE / 2], [0.0, 0.0, 1.0]])
    face = render_depth(placed, faces, K, SIZE, SIZE).face
    normals = find_unit_normals(placed, faces)[faces].mean(axis=1)
    light = 0.2 + 0.8 * np.clip(-normals[:, 2], 0.0, 1.0)
    image = np.full((SIZE, SIZE, 3), 255, dtype=np.uint8)
    shown = face >= 0
    image[shown] = np.clip(colors[face[shown]] * light[face[shown], None], 0, 255).astype(np.uint8)
    return image


def draw_four(vertices: np.ndarray, faces: np.ndarray, colors: np.ndarray) -> np.ndarray:
    """Four views a quarter turn apart, the longest axis upright, fingers up."""
    offsets = vertices - vertices.mean(axis=0)
    axes = np.linalg.eigh(offsets.T @ offsets)[1]
    up = axes[:, 2] * np.sign(axes[:, 2] @ (vertices[untrained_hand().tips].mean(axis=0) - vertices.mean(axis=0)))
    side = np.cross(up, axes[:, 0])
    upright = np.stack([side, -up, np.cross(side, -up)])
    views = []
    for angle in np.radians([0.0, 90.0, 180.0, 270.0]):
        c, s = np.cos(angle), np.sin(angle)
        views.append(draw(vertices, faces, colors, np.array([[c, 0, s], [0, 1, 0], [-s, 0, c]]) @ upright))
    return np.concatenate(views, axis=1)


def draw_registration(registration: Registration, matches: Matches) -> np.ndarray:
    faces = np.asarray(registration.faces, dtype=np.int32)
    part = np.argmax(untrained_hand().skinning_weights, axis=1)
    palette = np.array([PALM, *(np.array(finger) * share for finger in FINGERS for share in (1.0, 0.85, 0.7))])
    beside = ~matches.on_rim
    number = np.bincount(matches.faces[beside], minlength=len(faces))
    total = np.bincount(matches.faces[beside], np.abs(matches.offsets[beside]) * 1e3, minlength=len(faces))
    shares = np.clip(total / np.maximum(number, 1), 0.0, 1.0)
    errors = cv2.applyColorMap((255 * shares).astype(np.uint8)[:, None], cv2.COLORMAP_VIRIDIS)[:, 0].astype(np.float64)
    errors[number == 0] = 225.0
    rows = [draw_four(registration.vertices, faces, colors) for colors in (palette[part][faces].mean(axis=1), errors)]
    return np.concatenate(rows)


def match_scan(scan: Scan, vertices: np.ndarray, faces: np.ndarray) -> Matches:
    return SurfaceSearch(vertices, faces).match(vertices, scan.points, np.zeros_like(scan.points), reach=1.0)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("folder", type=Path)
    parser.add_argument("--write", action="store_true", help="write the pictures of docs/registration.md")
    parser.add_argument("--rotations", type=int, default=0, metavar="N", help="register each scan in N rotations")
    parser.add_argument("--out", type=Path, metavar="FILE", help="keeps every rotation's figures as JSON")
    args = parser.parse_args()
    if args.rotations:
        study(args.folder, args.rotations, args.out)
        return
    for name in SCANS:
        scan = load_scan(args.folder / f"{name}.obj", METRES_PER_UNIT)
        registration = register_scan(scan, untrained_hand())
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

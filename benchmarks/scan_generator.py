"""What generated scans are like: `python -m benchmarks.scan_generator`; `--write` writes page and picture."""

from __future__ import annotations

import argparse
import os
import time
from pathlib import Path

for variable in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "NUMBA_NUM_THREADS"):
    os.environ.setdefault(variable, "1")

import cv2  # noqa: E402
import numpy as np  # noqa: E402
import numpy.typing as npt  # noqa: E402
from scipy.spatial import KDTree  # noqa: E402

from benchmarks.result_page import write_result  # noqa: E402
from tracker.cli.progress import ProgressLine  # noqa: E402
from tracker.model.blend_model import BlendModel  # noqa: E402
from tracker.model.untrained_hand import untrained_hand  # noqa: E402
from tracker.rendering.zbuffer import render_depth  # noqa: E402
from tracker.synthesis.scans.arrange import arrange  # noqa: E402
from tracker.synthesis.scans.contact import find_depths  # noqa: E402
from tracker.synthesis.scans.deform import closed_volume, deform  # noqa: E402
from tracker.synthesis.scans.generate import ScanOptions, generate_scan, generate_truth  # noqa: E402
from tracker.synthesis.scans.pose_list import FISTS, POSE_NAMES, POSES  # noqa: E402
from tracker.synthesis.scans.subject import TEST_SUBJECTS, TRAIN_SUBJECTS, load_subject, load_surface  # noqa: E402
from tracker.synthesis.scans.ties import load_ties  # noqa: E402
from tracker.synthesis.scans.tissue import vertex_normals  # noqa: E402
from tracker.training.options import TrainingOptions  # noqa: E402
from tracker.training.train import train_model  # noqa: E402
from tracker.training.training_set import make_training_set  # noqa: E402

Array = npt.NDArray[np.float64]

DOCS = Path(__file__).resolve().parents[1] / "docs"
PEOPLE = (1, 8, 20, 33, 36)
FLAT = ("flat_together", "flat_spread", "thumb_out", "relaxed")
TILE, COLUMNS = 84, 9


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--write", action="store_true")
    args = parser.parse_args()
    rows = [*describe_times(), *describe_scans(), *describe_bodies(), *describe_model_class()]
    table = "\n".join(["| what | measured |", "|---|---|", *(f"| {what} | {value} |" for what, value in rows)])
    print(table)
    if args.write:
        write_result("scan_generator", "Generated scans", "python -m benchmarks.scan_generator --write", table)
        cv2.imwrite(str(DOCS / "pictures" / "scan_poses.png"), draw_poses(20), [cv2.IMWRITE_PNG_COMPRESSION, 9])


def describe_times() -> list[tuple[str, str]]:
    generate_scan(1, 0)
    scans, truths = [], []
    for number in range(20):
        began = time.process_time()
        generate_scan(1 + number % 5, number)
        scans.append(time.process_time() - began)
        began = time.process_time()
        generate_truth(1 + number % 5, number + 20)
        truths.append(time.process_time() - began)
    return [
        ("a scan of 50,000 points, processor time, median", f"{np.median(scans):.2f} s"),
        ("true vertices only, median", f"{1e3 * np.median(truths):.0f} ms"),
    ]


def describe_scans() -> list[tuple[str, str]]:
    """Noise, and how much of the hand has no points."""
    errors, rows = [], []
    groups = {"flat hands": FLAT, "fists": FISTS, "all poses": POSE_NAMES[::3]}
    for name, poses in groups.items():
        missing = {False: [], True: []}
        for holds in (False, True) if name == "all poses" else (False,):
            for number, pose in enumerate(poses):
                made = generate_scan(PEOPLE[number % len(PEOPLE)], pose, options=ScanOptions(holds_object=holds))
                points = made.scan.points[made.is_hand]
                far = np.asarray(KDTree(points).query(made.true_vertices)[0])
                missing[holds].append(np.mean(far > 2e-3))
                vertices, faces = made.true_surface
                nearest = KDTree(vertices).query(points)[1]
                height = np.einsum("nx,nx->n", points - vertices[nearest], vertex_normals(vertices, faces)[nearest])
                errors.append(np.std(height[np.abs(height) < 1.2e-3]))
        rows.append((f"hand without a point within 2 mm, {name}", f"{100 * np.mean(missing[False]):.1f} %"))
        if missing[True]:
            rows.append(("the same with objects in grasps", f"{100 * np.mean(missing[True]):.1f} %"))
    return [("noise along the normal (asked for: 0.200 mm)", f"{1e3 * np.mean(errors):.3f} mm"), *rows]


def describe_bodies() -> list[tuple[str, str]]:
    """Volumes, and parts inside other parts."""
    surface = load_surface()
    rows, inside, worst = [], [], 0
    for strength in (0.0, 1.0, 2.5):
        changes: dict[str, list[float]] = {"index_bent": [], "fist": []}
        for number in PEOPLE:
            subject = load_subject(number)
            rest = closed_volume(subject.vertices, surface.faces, surface.border)
            for name, kept in changes.items():
                posed = deform(subject, arrange(number, name)[2], strength)
                kept.append(closed_volume(posed.vertices, surface.faces, surface.border) / rest - 1.0)
        text = ", ".join(f"{name} {100 * np.mean(kept):+.1f} %" for name, kept in changes.items())
        rows.append((f"volume against the rest pose, strength {strength:g}", text))
    for number in PEOPLE:
        subject = load_subject(number)
        for pose in POSE_NAMES:
            vertices = deform(subject, arrange(number, pose)[2]).vertices
            depth = find_depths(vertices, vertex_normals(vertices, surface.faces), subject.vertices)
            inside.append(bool(np.any(depth > 1e-3)))
            worst = max(worst, int(np.sum(depth > 1e-3)))
    rows.append(
        (
            f"hands of {len(inside)} with any skin deeper than 1 mm inside other skin; vertices of 6,873 in the worst",
            f"{sum(inside)}; {worst}",
        )
    )
    return rows


def describe_model_class() -> list[tuple[str, str]]:
    """How far the models that are fitted can explain the truth."""
    ties = load_ties()
    mean, p95, most = 1e3 * ties.distances.mean(), 1e3 * np.percentile(ties.distances, 95), 1e3 * ties.distances.max()
    ties_mm = f"{mean:.2f}, {p95:.2f}, {most:.2f} mm"
    rows = [("untrained hand to the mean subject's surface: mean, 95th percentile, most", ties_mm)]
    model = untrained_hand("right")
    left = [fit_at_rest(model, ties.matrix @ load_subject(k).vertices) for k in TEST_SUBJECTS]
    what = "untrained hand fitted to the true vertices of the test subjects at rest, mean left"
    rows.append((what, f"{1e3 * np.mean(left):.2f} mm"))
    for strength in (1.0, 2.5):
        options = ScanOptions(strength=strength)
        who = [(k, pose) for k in TRAIN_SUBJECTS[::4] for pose in range(0, len(POSES), 2)]
        vertices = [generate_truth(k, pose, options=options).vertices for k, pose in who]
        names = [POSE_NAMES[pose] for _, pose in who]
        chosen = make_training_set(vertices, [str(k) for k, _ in who], names, [False] * len(who))
        left_over = []
        for with_pose_shapes in (False, True):
            line = ProgressLine(f"training, strength {strength:g}, pose blend shapes {with_pose_shapes}")
            trained = train_model(
                chosen,
                model,
                TrainingOptions(with_pose_shapes=with_pose_shapes),
                lambda stage, share, line=line: line.show(share, stage),
            )
            left_over.append(trained.report["residual_mm"])
        rows.append(
            (
                f"linear skinning trained on {len(who)} true hands and fitted to the same ones, root mean square left, "
                f"strength {strength:g}; with pose blend shapes",
                f"{left_over[0]:.2f} mm; {left_over[1]:.2f} mm",
            )
        )
    return rows


def fit_at_rest(model: BlendModel, vertices: Array) -> float:
    """Mean distance that is left between a model and vertices (V, 3) near its zero pose, m."""
    pose, shape = np.zeros((model.num_bones, 3)), np.zeros(model.num_shape)
    translation = np.zeros(3)
    for _ in range(20):
        posed = model.pose_at(pose, shape, translation)
        J = posed.vertex_jacobian().reshape(-1, model.num_parameters)
        JtJ = J.T @ J + 1e-8 * np.eye(model.num_parameters)
        step: Array = np.asarray(-np.linalg.solve(JtJ, J.T @ (posed.vertices - vertices).ravel()), dtype=np.float64)
        pose, shape, translation = model.retract(pose, shape, translation, step)
    return float(np.linalg.norm(model.pose_at(pose, shape, translation).vertices - vertices, axis=1).mean())


def draw_poses(number: int) -> npt.NDArray[np.uint8]:
    """All poses of a subject, each from the palm and from the thumb's side."""
    views = np.array([[[0, 1, 0], [-1, 0, 0], [0, 0, 1]], [[0, 0, 1], [-1, 0, 0], [0, -1, 0]]], dtype=np.float64)
    subject, surface = load_subject(number), load_surface()
    tiles = []
    for pose in POSE_NAMES:
        posed = deform(subject, arrange(number, pose)[2])
        pair = [draw(surface.fine @ posed.vertices, surface.fine_faces, R) for R in views]
        tiles.append(np.hstack(pair))
    tiles += [np.full_like(tiles[0], 255)] * (-len(tiles) % COLUMNS)
    return np.vstack([np.hstack(tiles[k : k + COLUMNS]) for k in range(0, len(tiles), COLUMNS)])


def draw(vertices: Array, faces: npt.NDArray[np.int64], R: Array) -> npt.NDArray[np.uint8]:
    """(TILE, TILE) grey picture of a surface, seen along the third row of R from 1 m away, white behind."""
    local = (vertices - [0.075, 0.0, -0.01]) @ R.T + [0.0, 0.0, 1.0]
    focal, middle = TILE / 0.25, 0.5 * (TILE - 1)
    K = np.array([[focal, 0.0, middle], [0.0, focal, middle], [0.0, 0.0, 1.0]])
    seen = render_depth(local, faces.astype(np.int32), K, TILE, TILE).face
    light = vertex_normals(local, faces)[faces].mean(axis=1) @ np.array([-0.35, -0.45, -0.82])
    # Sixteen shades: small files.
    shades = np.round(15 * (0.2 + 0.75 * np.clip(light, 0.0, 1.0))) * 17
    return np.where(seen >= 0, shades[np.maximum(seen, 0)], 255).astype(np.uint8)


if __name__ == "__main__":
    main()

"""What a blend model costs, and what its derivatives by way of the pose blend shapes are worth.

    python -m benchmarks.blend_model [MODEL.npz] [--write]

Without a MODEL a hand of the same size with random, dense pose blend shapes is taken: the most that they can cost.
Process time, medians, one thread. `--write` writes `benchmarks/results/blend_model.md`.
"""

from __future__ import annotations

import argparse
import os
import sys
import time
from collections.abc import Callable
from pathlib import Path

for name in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "NUMBA_NUM_THREADS"):
    os.environ.setdefault(name, "1")  # before numpy

import numpy as np  # noqa: E402

from benchmarks.result_page import write_result  # noqa: E402
from tracker.model.blend_articulated import articulated_of  # noqa: E402
from tracker.model.blend_files import load_blend_model  # noqa: E402
from tracker.model.blend_limits import blend_limits  # noqa: E402
from tracker.model.blend_model import BlendModel  # noqa: E402
from tracker.model.default_hand import default_hand  # noqa: E402
from tracker.model.scene import Scene  # noqa: E402


def median_ms(work: Callable[[], object], repeats: int = 200) -> float:
    """Median process time of a call, ms, after two that are not counted."""
    work()
    work()
    times = []
    for _ in range(repeats):
        began = time.process_time_ns()
        work()
        times.append(time.process_time_ns() - began)
    return float(np.median(times)) / 1e6


def costs(model: BlendModel) -> list[tuple[str, float]]:
    """What is done and its ms."""
    rng = np.random.default_rng(0)
    pose, shape = 0.4 * rng.standard_normal((model.num_bones, 3)), rng.standard_normal(model.num_shape)
    posed = model.pose_at(pose, shape)
    size = f"{len(model.template)} vertices"
    rows = [
        (f"forward, {size}", median_ms(lambda: model.pose_at(pose, shape))),
        (f"exact vertex Jacobian, {model.num_parameters} parameters", median_ms(posed.vertex_jacobian)),
        (
            "the same without what the pose does through blend shapes",
            median_ms(lambda: posed.vertex_jacobian(with_blend=False)),
        ),
    ]
    for name, hand in (
        ("this hand in the tracker", articulated_of(model)),
        ("the default hand", default_hand("right")),
    ):
        scene = Scene((hand,))
        at = scene.rest_pose() + 0.1
        rows.append((f"a pose of {name}, {scene.num_dofs} degrees", median_ms(lambda s=scene, p=at: s.pose_at(p))))
    return rows


def convergence(model: BlendModel, with_blend: bool, noise: float, fits: int = 20) -> list[float]:
    """RMS distance of vertices to the truth after each Gauss-Newton step of fits to noisy vertices, mm, the mean."""
    limits = blend_limits(model)
    errors = []
    for seed in range(fits):
        rng = np.random.default_rng(seed)
        angles = limits.mean + limits.deviation * rng.standard_normal(limits.mean.shape)
        truth = model.pose_at(limits.clamped(limits.pose_at(angles)), rng.standard_normal(model.num_shape))
        target = truth.vertices + noise * rng.standard_normal(truth.vertices.shape)
        found = (np.zeros_like(truth.pose), np.zeros(model.num_shape), np.zeros(3))
        own = []
        for _ in range(8):
            posed = model.pose_at(*found)
            jacobian = posed.vertex_jacobian(with_blend=with_blend).reshape(-1, model.num_parameters)
            JtJ, Jtr = jacobian.T @ jacobian, jacobian.T @ (posed.vertices - target).ravel()
            JtJ[np.diag_indices_from(JtJ)] += 1e-6
            found = model.retract(*found, -np.linalg.solve(JtJ, Jtr))
            apart = model.pose_at(*found).vertices - truth.vertices
            own.append(1e3 * float(np.sqrt(np.mean(np.sum(apart**2, axis=1)))))
        errors.append(own)
    return np.mean(errors, axis=0).tolist()


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("model", nargs="?", type=Path, help="a blend model of Handloom, .npz")
    parser.add_argument("--write", action="store_true", help="write benchmarks/results/blend_model.md")
    arguments = parser.parse_args()
    if arguments.model is None:
        from tests.tracker.random_blend import random_blend

        model = random_blend()
    else:
        model = load_blend_model(arguments.model)
    lines = ["| what | ms |", "|---|---|", *(f"| {what} | {ms:.3f} |" for what, ms in costs(model)), ""]
    lines += ["| Gauss-Newton step | 1 | 2 | 3 | 4 | 5 | 6 | 7 | 8 |", "|---|---|---|---|---|---|---|---|---|"]
    for noise in (0.0, 0.001):
        for with_blend in (True, False):
            cells = " | ".join(f"{error:.4f}" for error in convergence(model, with_blend, noise))
            kind = "exact" if with_blend else "skinning only"
            lines.append(f"| {kind}, noise {1e3 * noise:g} mm | {cells} |")
    text = "\n".join(lines)
    print(text)
    if arguments.write:
        write_result("blend_model", "What a blend model costs", "python -m benchmarks.blend_model --write", text)
    return 0


if __name__ == "__main__":
    sys.exit(main())

"""What a frame would cost if nothing but its kernels ran."""

from __future__ import annotations

from collections.abc import Callable
from time import perf_counter
from typing import TypeVar

import numpy as np

from tracker.capture.sequence import Sequence
from tracker.fitting.frame_fit import FitOptions, draw, label_scene
from tracker.fitting.region import region_around
from tracker.observation import observe
from tracker.physics import find_support
from tracker.search.tools import Tools, make_tools
from tracker.solver.damped_step import compute_damped_step
from tracker.terms.residual import FrameContext
from tracker.tracking.track import Track

REPEATS = 7
"""Of a kernel; the quickest counts."""

T = TypeVar("T")


def measure_floor(sequence: Sequence, track: Track, num_frames: int = 5) -> dict[str, float]:
    """Milliseconds a frame of each stage, run alone on the inputs it had: the best of several runs, median over frames.

    A stage that runs once per iteration counts as often as the track's options say, coarse and fine iterations apart.
    The names are those of the track's own stages, so the two can be laid side by side; the difference is what lies
    between the kernels.

    Args:
        sequence: The recording.
        track: Its track; some frames of it that are `ok` are taken, evenly.
        num_frames: How many.
    """
    good = np.flatnonzero(track.status == "ok")
    assert len(good), "no frame was tracked"
    with make_tools(track.setup, sequence.camera(track.setup.camera_id).T_world_camera) as tools:
        rows = [
            _measure_frame(sequence, track, tools, int(place))
            for place in good[np.linspace(0, len(good) - 1, num_frames).astype(int)]
        ]
    return {name: float(np.median([row[name] for row in rows])) for name in rows[0]}


def _measure_frame(sequence: Sequence, track: Track, tools: Tools, place: int) -> dict[str, float]:
    setup, scene = track.setup, track.setup.scene
    frame, camera = setup.read(sequence, int(track.frame[place]))
    pose = track.pose[place]
    region = region_around(scene.pose_at(pose).vertices, camera)
    assert region is not None, "a frame that is ok is in sight"
    observing, seen = _best_of(lambda: observe(frame, camera, region, setup.preprocessing))
    posing, posed = _best_of(lambda: scene.pose_at(pose))
    rendering, view = _best_of(lambda: draw(posed, seen))
    context = FrameContext(view, seen, *label_scene(scene))
    options, iterations = FitOptions(), setup.options.iterations
    limits = np.full(scene.num_dofs, options.max_turn)
    fine = min(options.fine, iterations)
    stages = {"observing": observing, "posing": iterations * posing, "rendering": iterations * rendering}
    for times, objective in ((fine, tools.objective), (iterations - fine, tools.objective.coarse())):
        residuals = {}
        for name, term in objective.terms.items():
            finding, residuals[name] = _best_of(lambda term=term: term.find(posed, context))
            stages[name] = stages.get(name, 0.0) + times * finding

        def solve(objective=objective, residuals=residuals) -> np.ndarray:
            JtJ, Jtr, _ = objective.linearize(posed, residuals, pose)
            return scene.retract(pose, compute_damped_step(JtJ, Jtr, options.damping, limits))

        solving, _ = _best_of(solve)
        stages["solving"] = stages.get("solving", 0.0) + times * solving
    if tools.world is not None:
        world = tools.world
        stages["physics"], _ = _best_of(lambda: find_support(world, posed))
    return stages


def _best_of(work: Callable[[], T]) -> tuple[float, T]:
    """Milliseconds of the quickest of `REPEATS` runs, and what the last one returned."""
    best, result = np.inf, work()
    for _ in range(REPEATS):
        began = perf_counter()
        result = work()
        best = min(best, perf_counter() - began)
    return 1e3 * float(best), result

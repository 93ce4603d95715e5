"""T16's Algorithm 1 alone, on a twin: no second try, no search of the image, so that only the objective tells.

Every frame starts where the roots would be if they went on as before; correspondences and Gauss-Newton steps take
turns; with physics the contacts are asked for once, after the fit, and some more iterations hold them.
"""

from __future__ import annotations

from contextlib import ExitStack
from dataclasses import dataclass, replace
from pathlib import Path
from time import perf_counter
from typing import Any

import cv2
import numpy as np

from benchmarks.studies.twin_runs import find_first_motion, measure, render_twin, start_twin
from benchmarks.studies.variants import AsPoints, CorrespondingVertices, SalientInEveryFrame
from tracker.capture.sequence import Sequence
from tracker.detection.default_detector import default_detector
from tracker.fitting.attempt import attempt_fit, look
from tracker.fitting.frame_fit import FitOptions
from tracker.fitting.objective import Objective
from tracker.fitting.options import TrackOptions
from tracker.fitting.setup import TrackSetup
from tracker.physics import PhysicsWorld, find_down, find_support
from tracker.physics.protocol import SEARCH
from tracker.physics.support import SupportOptions
from tracker.search.start_annotated import with_marks
from tracker.terms.collision import Collision
from tracker.terms.data_to_model import DataToModel
from tracker.terms.model_to_data import ModelToData
from tracker.terms.physics import Physics
from tracker.terms.residual import Term
from tracker.terms.salient import Salient
from tracker.tracking.chunk import TrackChunk
from tracker.tracking.frame_result import FrameResult
from tracker.tracking.state import TrackState
from tracker.tracking.track import join_chunks

PAPER_REACH = 40
"""px; more than the 30 mm of [T16] §3.2.3 are at the distances of these recordings, so only those limit contours."""

HOLDING = 5
"""Iterations with contacts, after the others."""

DATA = ("ours", "m2d", "d2m", "paper")
"""Data terms: ours; Eq. 7 alone; Eq. 8 alone at depth discontinuities; both of these, T16's LO."""


@dataclass(frozen=True)
class PlainRun:
    """An objective made of parts, and where to follow it: from where something begins to move, to the end.

    Attributes:
        sequence: Of the public ones.
        step: Every so many frames of it.
        frames: The first so many of it; None is all.
        data: One of DATA.
        to_plane: Eq. 7, or Eq. 6.
        iterations: Gauss-Newton iterations.
        stop_below_mm: Stop below this mean joint displacement; 0 never.
        collision: Weight of the cones; 0 leaves them out.
        corresponding: Corresponding vertices in place of cones, with the same weight.
        salient: λ, m; 0 leaves fingertips out.
        use_confidence: w_s = c_s / c_thr in place of 1.
        physics: γ_ph; 0 leaves contacts out.
        friction: Of hands and object in the search for contacts.
        seed: Of the noise.
    """

    sequence: str
    step: int
    frames: int | None = None
    data: str = "ours"
    to_plane: bool = True
    iterations: int = 10
    stop_below_mm: float = 0.0
    collision: float = 0.0
    corresponding: bool = False
    salient: float = 0.0
    use_confidence: bool = False
    physics: float = 0.0
    friction: float = SEARCH.friction
    seed: int = 0

    def __call__(self, data: Path, twins: Path) -> dict[str, Any]:
        """Render, follow, measure."""
        twin = render_twin(data, twins, self.sequence, self.frames, self.step, self.seed)
        options = TrackOptions(
            terms="LO",
            iterations=self.iterations,
            calibrate=False,
            stop_below_mm=self.stop_below_mm,
            first_frame=find_first_motion(twin),
        )
        setup, state = start_twin(twin, options)
        chunk = follow_plainly(self, twin.sequence, setup, state)
        found = measure(twin, join_chunks(twin.sequence, setup, [chunk]), penetration=True)
        return found | {"iterations": chunk.iterations.tolist()}

    def objective(self) -> Objective:
        """The terms, contacts apart."""
        ours, contours = dict(Objective().terms), DataToModel(weight=1.0, max_pixels=PAPER_REACH)
        terms: dict[str, Term] = {
            "ours": ours,
            "m2d": {"model_to_data": ModelToData()},
            "d2m": {"data_to_model": contours},
            "paper": {"model_to_data": ModelToData(), "data_to_model": contours},
        }[self.data]
        if not self.to_plane:
            terms = {name: AsPoints(term) for name, term in terms.items()}
        if self.collision > 0.0:
            kind = CorrespondingVertices if self.corresponding else Collision
            terms["collision"] = kind(weight=self.collision)
        if self.salient > 0.0:
            own = Salient(rejection=self.salient, use_confidence=self.use_confidence)
            terms["salient"] = SalientInEveryFrame(default_detector(), own)
        return Objective(terms=terms)


def follow_plainly(run: PlainRun, sequence: Sequence, setup: TrackSetup, state: TrackState) -> TrackChunk:
    """Algorithm 1 over all frames; a frame without hand pixels keeps the pose and is called lost."""
    cv2.setNumThreads(1)
    results: list[FrameResult] = []
    with ExitStack() as stack:
        world = None
        if run.physics > 0.0:
            down = find_down(sequence.camera(setup.camera_id).T_world_camera)
            world = stack.enter_context(PhysicsWorld(setup.scene, down=down))
        objective = run.objective()
        for index in setup.options.frame_range(sequence.frame_count):
            result = _follow(run, sequence, setup, state, objective, world, index)
            state = TrackState(index + 1, result.pose, state.pose)
            results.append(result)
    return TrackChunk.of(results)


def _follow(
    run: PlainRun,
    sequence: Sequence,
    setup: TrackSetup,
    state: TrackState,
    objective: Objective,
    world: PhysicsWorld | None,
    index: int,
) -> FrameResult:
    frame, camera = setup.read(sequence, index)
    began = perf_counter()
    is_first = index == setup.options.first_frame
    predicted = state.predict(setup.scene)
    seen = look(frame, camera, setup, predicted)
    if seen is None:
        return FrameResult(index, state.pose, "lost", perf_counter() - began, None, (), {})
    options = FitOptions(
        iterations=setup.options.first_iterations if is_first else run.iterations,
        stop_below=0.001 * run.stop_below_mm,
    )
    if is_first:
        objective = with_marks(objective, setup.scene, setup.names, setup.marks, camera)
    best = attempt_fit(setup, seen, predicted, state.pose, objective, options)
    costs = best.fit.costs
    if world is not None:
        protocol = replace(SEARCH, friction=run.friction)
        support = find_support(world, setup.scene.pose_at(best.pose), SupportOptions(protocol=protocol))
        if support.contacts and not support.is_stable:
            holding = Physics(support.contacts, weight=run.physics)
            held = replace(objective, terms={**objective.terms, "physics": holding})
            best = attempt_fit(setup, seen, best.pose, state.pose, held, replace(options, iterations=HOLDING))
            costs = (*costs, *best.fit.costs)
    pose = best.pose if np.all(np.isfinite(best.pose)) else state.pose
    return FrameResult(index, pose, "ok", perf_counter() - began, best.quality, costs, {})


def pool(results: list[dict[str, Any]]) -> dict[str, float]:
    """Runs on several sequences as one: over all joints of all frames, as T16 reports.

    Returns:
        px, px_std, px_max, mm, worst_mm, lost frames, failed sequences (in which a hand was ever lost), and the deepest
        penetration where it was measured, mm.
    """
    counts = np.array([result["frames"] * result["hands"] for result in results], dtype=np.float64)
    share = counts / counts.sum()
    px = np.array([result["px"] for result in results])
    std = np.array([result["px_std"] for result in results])
    mean = float(share @ px)
    pooled = {
        "sequences": len(results),
        "frames": int(sum(result["frames"] for result in results)),
        "px": mean,
        "px_std": float(np.sqrt(max(share @ (std**2 + px**2) - mean**2, 0.0))),
        "px_max": max(result["px_max"] for result in results),
        "mm": float(share @ np.array([result["mm"] for result in results])),
        "worst_mm": max(result["worst_mm"] for result in results),
        "lost": sum(result["lost"] for result in results),
        "failed": sum(result["lost"] > 0 for result in results),
    }
    if all("deepest_mm" in result for result in results):
        pooled["deepest_mm"] = max(result["deepest_mm"] for result in results)
        pooled["mean_deepest_mm"] = float(share @ np.array([result["mean_deepest_mm"] for result in results]))
    return pooled

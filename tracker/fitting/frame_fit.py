"""Fit a scene to one observation: the loop of [T16] Algorithm 1."""

from __future__ import annotations

from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from functools import cache
from time import perf_counter

import numpy as np
import numpy.typing as npt

from tracker.fitting.objective import Objective
from tracker.model.scene import PosedScene, Scene
from tracker.observation import HAND, OTHER, Observation
from tracker.rendering import View, render_view
from tracker.solver.damped_step import compute_damped_step
from tracker.terms.normal_equations import NormalEquations
from tracker.terms.residual import FrameContext, Residual, Term

Array = npt.NDArray[np.float64]


@dataclass(frozen=True)
class FitOptions:
    """How the objective is minimised.

    Attributes:
        iterations: Gauss-Newton iterations, each with new correspondences.
        damping: Levenberg-Marquardt share of the diagonal.
        max_turn: Largest change of an angle in one iteration, rad.
        max_shift: Largest change of a root's position in one iteration, m.
        fine: So many last iterations use every match, those before about every fourth.
        threads: 1, or 2 to look for every other term's correspondences in a second thread.
        stop_below: Stop when the mean joint moves less, m; 0 never stops early ([T16] §4.1.1 uses 0.2 mm).
    """

    iterations: int = 10
    damping: float = 1e-3
    max_turn: float = 0.4
    max_shift: float = 0.05
    stop_below: float = 0.0
    fine: int = 4
    threads: int = 1


@dataclass(frozen=True)
class Fit:
    """A fitted pose.

    Attributes:
        pose: (D,).
        costs: One per iteration, cost of each term, mm².
        stages: Seconds by stage: "posing", "rendering", each term's name, "solving"; of two threads together.
    """

    pose: Array
    costs: tuple[dict[str, float], ...]
    stages: dict[str, float]


def label_scene(scene: Scene) -> tuple[npt.NDArray[np.uint8], npt.NDArray[np.uint8]]:
    """Label bits that vertices (V,) and faces (F,) may match: hands skin, objects the rest, [T16] §3.2.1."""
    bits = np.array([HAND if model.hand else OTHER for model in scene.models], dtype=np.uint8)
    return bits[scene.vertex_models], bits[scene.face_models]


def draw(posed: PosedScene, observation: Observation) -> View:
    """The scene as the observation's camera sees it in the observation's region."""
    height, width = observation.labels.shape
    return render_view(posed, observation.K, observation.T_world_camera, height, width)


def look_at(posed: PosedScene, observation: Observation) -> FrameContext:
    """The scene drawn beside what was seen."""
    return FrameContext(draw(posed, observation), observation, *label_scene(posed.scene))


def find_residuals(posed: PosedScene, observation: Observation | None, objective: Objective) -> dict[str, Residual]:
    """Correspondences of every term at a posed scene."""
    return objective.find(posed, None if observation is None else look_at(posed, observation))


def fit_frame(
    scene: Scene,
    observation: Observation | None,
    start: Array,
    previous: Array,
    objective: Objective,
    options: FitOptions,
) -> Fit:
    """Alternate between finding correspondences and one Gauss-Newton step, [T16] §3.2.9.

    Args:
        scene: What to fit.
        observation: What was seen; None where all terms bring what they have seen, as those of colour cameras do.
        start: (D,) pose to start at.
        previous: (D,) pose of the previous frame, for the regularisation.
        objective: Terms and weights.
        options: Iterations and damping.
    """
    labels = label_scene(scene)
    limits = np.full(scene.num_dofs, options.max_turn)
    for where in scene.pose_slices:
        limits[where.start : where.start + 3] = options.max_shift
    pose, history = start, []
    stages = dict.fromkeys(("posing", "rendering", *objective.terms, "solving"), 0.0)
    joints = None
    coarse = objective.coarse()
    for iteration in range(options.iterations):
        current = coarse if iteration < options.iterations - options.fine else objective
        t0 = perf_counter()
        posed = scene.pose_at(pose)
        t1 = perf_counter()
        context = None if observation is None else FrameContext(draw(posed, observation), observation, *labels)
        t2 = perf_counter()
        stages["posing"] += t1 - t0
        stages["rendering"] += t2 - t1
        equations, costs = _gather(posed, context, current.terms, stages, options.threads)
        t0 = perf_counter()
        JtJ, Jtr, costs = current.complete(equations, costs, previous)
        history.append(costs)
        pose = scene.retract(pose, compute_damped_step(JtJ, Jtr, options.damping, limits))
        stages["solving"] += perf_counter() - t0
        if options.stop_below > 0.0:
            moved = scene.pose_at(pose).vertices[scene.landmark_slices[0].start :]
            if joints is not None and np.mean(np.linalg.norm(moved - joints, axis=1)) < options.stop_below:
                break
            joints = moved
    return Fit(pose, tuple(history), stages)


def fit_from_afar(scene: Scene, observation: Observation, pose: Array, objective: Objective, iterations: int) -> Array:
    """The pose (D,) after damped iterations in small steps from one that is far off."""
    options = FitOptions(iterations, damping=3e-2, max_turn=0.25, max_shift=0.02)
    return fit_frame(scene, observation, pose, pose, objective, options).pose


def _gather(
    posed: PosedScene, context: FrameContext | None, terms: dict[str, Term], stages: dict[str, float], threads: int
) -> tuple[NormalEquations, dict[str, float]]:
    """Sum of all terms' correspondences and the cost of each; bit by bit the same for the same number of threads."""
    names = list(terms)
    if threads == 1 or len(names) < 2:
        return _gather_some(posed, context, terms, names, stages)
    beside = dict.fromkeys(stages, 0.0)
    second = _second_thread().submit(_gather_some, posed, context, terms, names[1::2], beside)
    equations, costs = _gather_some(posed, context, terms, names[::2], stages)
    others, other_costs = second.result()
    equations.add(others)
    for name, seconds in beside.items():
        stages[name] += seconds
    return equations, {name: {**costs, **other_costs}[name] for name in names}


def _gather_some(
    posed: PosedScene, context: FrameContext | None, terms: dict[str, Term], names: list[str], stages: dict[str, float]
) -> tuple[NormalEquations, dict[str, float]]:
    equations = NormalEquations.at(posed)
    costs: dict[str, float] = {}
    for name in names:
        t0 = perf_counter()
        residual = terms[name].find(posed, context)
        t1 = perf_counter()
        before = equations.cost
        residual.add_to(equations)
        costs[name] = equations.cost - before
        stages[name] += t1 - t0
        stages["solving"] += perf_counter() - t1
    return equations, costs


@cache
def _second_thread() -> ThreadPoolExecutor:
    return ThreadPoolExecutor(1, "terms")

"""Fit the shapes of the hands of a scene to a few frames of depth and the marks of one, together with all poses."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field, replace

import numpy as np
import numpy.typing as npt

from tracker.fitting.frame_fit import FitOptions, fit_frame
from tracker.fitting.objective import Objective
from tracker.fitting.shape_equations import SceneDirections, ShapeEquations, reduce_equations
from tracker.model.articulated import ArticulatedModel
from tracker.model.hand_directions import HandDirections
from tracker.model.joints import HAND_JOINTS
from tracker.model.local_directions import local_directions, mark_directions
from tracker.model.scene import PosedScene, Scene
from tracker.observation import Observation
from tracker.solver.elimination import solve_definite
from tracker.terms.marked_joints import MarkedJoints
from tracker.terms.normal_equations import MILLIMETRES

Array = npt.NDArray[np.float64]

FEW = 4
"""With fewer frames than this the prior grows: pose and shape of one frame explain each other away."""

COARSE = (
    *("size", "finger_length", "finger_thickness", "palm_thickness", "palm_width", "thumb_length", "forearm_length"),
    *("shape_1", "shape_2", "shape_3", "shape_4", "shape_5"),
)
"""What is fitted first; the rest says too little in depth while these are wrong."""

MARK_DEVIATIONS = {"wrist": (0.012, 0.004), "thumb_cmc": (0.006, 0.005), "tip": (0.0015, 0.0015), "": (0.003, 0.002)}
"""How far from the model's joint a lab may put its own, along the bone and square to it, standard deviation, m: where a
finger ends there is no doubt, where a forearm does there is."""


@dataclass(frozen=True)
class CalibrationOptions:
    """How shapes are fitted.

    Attributes:
        rounds: Shape steps.
        coarse_rounds: The first of them, with `COARSE` alone.
        iterations: Of the refit of every pose before each shape step.
        prior: Weight of a direction's squared value against the cost that is left in a frame: the worse depth fits, the
            less the shape moves.
        mark_share: Share of that weight for where the marks are; small, so that marks do not bend the pose.
        mark_noise_px: An annotator's standard deviation; four of them differed by 1.46 px, [T16] §4.1.
        longest_step: Of a value in one round.
        largest: Values are kept within this.
    """

    rounds: int = 10
    coarse_rounds: int = 3
    iterations: int = 2
    prior: float = 0.2
    mark_share: float = 0.1
    mark_noise_px: float = 1.5
    longest_step: float = 0.7
    largest: float = 4.0


@dataclass(frozen=True)
class CalibrationFrame:
    """What is known of one frame.

    Attributes:
        observation: What was seen; None where all terms of the objective bring what they have seen.
        pose: (D,) of the whole scene, near the truth.
        marks: The marked joints of hands that somebody marked here, by index of the model; their weight is not used.
        objective: Terms of the fit.
    """

    observation: Observation | None
    pose: Array
    marks: dict[int, MarkedJoints] = field(default_factory=dict)
    objective: Objective = field(default_factory=Objective)


@dataclass(frozen=True)
class Calibrated:
    """Fitted shapes.

    Attributes:
        models: Of the scene, fitted ones with their shape baked in.
        values: Name of each direction and its value, for each model; empty for one whose shape is fixed.
        poses: (D,) of each frame, of those models.
    """

    models: tuple[ArticulatedModel, ...]
    values: tuple[dict[str, float], ...]
    poses: list[Array]


def calibrate_shapes(
    scene: Scene,
    frames: list[CalibrationFrame],
    options: CalibrationOptions | None = None,
    progress: Callable[[float], None] | None = None,
) -> Calibrated:
    """Gauss-Newton on shapes and poses together; the poses are eliminated by their Schur complement.

    Every hand with a shape basis is fitted: along that basis, along the directions of its parts
    (`model/local_directions.py`) and, where it is marked, along the offsets of its marks. A direction's value of 1 is
    about a standard deviation, so that one weight serves as prior for all.

    Args:
        scene: Hands and objects as they were followed.
        frames: At least one.
        options: How.
        progress: Told the share done.
    """
    options, tell = options or CalibrationOptions(), progress or (lambda share: None)
    marked = {model for frame in frames for model in frame.marks}
    own = tuple(_directions(model, index in marked) for index, model in enumerate(scene.models))
    directions = SceneDirections.stack(scene, own)
    names = [name for part in own if part is not None for name in part.names]
    is_coarse = np.array([name in COARSE for name in names])
    is_mark = np.array([name.startswith("mark") for name in names])
    values, poses, weight = np.zeros(len(names)), [frame.pose for frame in frames], 0.0
    current = scene
    for turn in range(options.rounds):
        current = _shaped(scene, own, directions, values)
        poses = _refit(current, frames, poses, options.iterations)
        equations = _reduce(current, directions, frames, poses, options, weight * options.mark_share)
        mean_cost = sum(each.cost for each in equations) / len(frames)
        weight = options.prior * mean_cost * max(1.0, FEW / len(frames)) ** 2
        free = is_coarse | (turn >= options.coarse_rounds)
        step = _step(equations, np.where(is_mark, options.mark_share * weight, weight), values, free, options)
        values = np.clip(values + step, -options.largest, options.largest)
        poses = [
            current.retract(pose, np.clip(each.settle - each.follow @ step, -0.1, 0.1))
            for pose, each in zip(poses, equations, strict=True)
        ]
        tell((turn + 1) / options.rounds)
    current = _shaped(scene, own, directions, values)
    poses = _refit(current, frames, poses, 4 * options.iterations)
    found = [dict(zip(names[where], values[where].tolist(), strict=True)) for where in directions.slices]
    return Calibrated(current.models, tuple(found), poses)


def _reduce(
    scene: Scene,
    directions: SceneDirections,
    frames: list[CalibrationFrame],
    poses: list[Array],
    options: CalibrationOptions,
    mark_weight: float,
) -> list[ShapeEquations]:
    """The equations of the shape in each frame, its pose (D,) eliminated."""
    pairs = list(zip(frames, poses, strict=True))
    objectives = [_with_marks(scene.pose_at(pose), frame, options, mark_weight) for frame, pose in pairs]
    return [
        reduce_equations(scene, directions, frame.observation, pose, objective)
        for (frame, pose), objective in zip(pairs, objectives, strict=True)
    ]


def _refit(scene: Scene, frames: list[CalibrationFrame], poses: list[Array], iterations: int) -> list[Array]:
    """The poses (D,) after some iterations in their frames."""
    options = FitOptions(iterations)
    pairs = zip(frames, poses, strict=True)
    return [fit_frame(scene, one.observation, pose, pose, one.objective, options).pose for one, pose in pairs]


def _directions(model: ArticulatedModel, is_marked: bool) -> HandDirections | None:
    """In which directions a model is fitted."""
    if model.hand is None or model.shape is None:
        return None
    parts = [HandDirections.of_shape(model), local_directions(model)]
    if is_marked:
        parts.append(mark_directions(model, *_mark_deviations()))
    return HandDirections.join(parts)


def _mark_deviations() -> Array:
    """(2, 21) along and across, of `MARK_DEVIATIONS` by the joint's name, or "tip", or "" for any other."""
    usual = {joint: MARK_DEVIATIONS["tip" if joint.endswith("tip") else ""] for joint in HAND_JOINTS}
    return np.array([MARK_DEVIATIONS.get(joint, usual[joint]) for joint in HAND_JOINTS]).T.copy()


def _shaped(scene: Scene, own: tuple[HandDirections | None, ...], directions: SceneDirections, values: Array) -> Scene:
    """The scene with the values applied."""
    parts = zip(scene.models, own, directions.slices, strict=True)
    return Scene(tuple(model if part is None else part.apply(model, values[where]) for model, part, where in parts))


def _with_marks(posed: PosedScene, frame: CalibrationFrame, options: CalibrationOptions, weight: float) -> Objective:
    """The objective of a frame; a mark that is off by its noise costs `weight`."""
    terms = dict(frame.objective.terms)
    if weight > 0.0 and frame.observation is not None:
        T_camera_world = np.linalg.inv(frame.observation.T_world_camera)
        for model, joints in frame.marks.items():
            depth = float(np.mean(posed.landmarks(model) @ T_camera_world[2, :3] + T_camera_world[2, 3]))
            noise_mm = MILLIMETRES * options.mark_noise_px * depth / frame.observation.K[0, 0]
            terms[f"marks_{model}"] = replace(joints, weight=weight / noise_mm**2)
    return Objective(terms=terms)


def _step(
    equations: list[ShapeEquations],
    weights: Array,
    values: Array,
    free: npt.NDArray[np.bool_],
    options: CalibrationOptions,
) -> Array:
    """(S,) step of the values that are free, with the prior's weights (S,)."""
    A = np.sum([each.A for each in equations], axis=0)
    b = np.sum([each.b for each in equations], axis=0) + weights * values
    A[np.diag_indices_from(A)] += weights
    step = np.zeros_like(values)
    step[free] = -solve_definite(A[np.ix_(free, free)], b[free, None])[:, 0]
    return np.clip(step, -options.longest_step, options.longest_step)


def propose_shapes(base: ArticulatedModel) -> list[Array]:
    """Shape coefficients (S,) to try beside the mean hand: smaller and larger ones."""
    assert base.shape is not None
    place = base.shape.names.index("size")
    shapes = []
    for size in (-1.0, 1.0):
        shape = np.zeros(len(base.shape.names))
        shape[place] = np.clip(size, base.shape.lower[place], base.shape.upper[place])
        shapes.append(shape)
    return shapes

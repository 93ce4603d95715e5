"""A hand model from accepted registrations, [R17] section 3.3."""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import numpy.typing as npt

from tracker.errors import TrainingError
from tracker.model.blend_model import BlendModel
from tracker.training.checkpoints import Checkpoints, NoCheckpoints, compute_key
from tracker.training.learn import Data, Learnt, begin, improve_joints, improve_surface
from tracker.training.local_shapes import find_local_shapes
from tracker.training.options import TrainingOptions
from tracker.training.pose_fit import Hands, fit_poses
from tracker.training.report import describe_training
from tracker.training.spaces import compute_rotation_vectors, find_shape_space, find_space
from tracker.training.stages import Stage, find_last, list_stages, pack_stage, unpack_stage
from tracker.training.training_faults import FEWEST_OF_A_HAND, TrainingHand, find_bend_fault, find_training_faults
from tracker.training.training_set import TrainingSet

Array = npt.NDArray[np.float64]
Progress = Callable[[str, float], None]


@dataclass(frozen=True)
class Training:
    """A trained model.

    Attributes:
        model: The hand.
        report: What it was learnt from and how well it fits, for people and as JSON.
        templates: (S, V, 3) of each hand that was learnt from, m; owners (N,) whose each registration is.
        poses: (N, 3B) axis-angle of each registration, the root's first.
    """

    model: BlendModel
    report: dict[str, Any]
    templates: Array
    owners: npt.NDArray[np.int64]
    poses: Array


def train_model(
    training_set: TrainingSet,
    initial: BlendModel,
    options: TrainingOptions | None = None,
    progress: Progress | None = None,
    checkpoints: Checkpoints | None = None,
) -> Training:
    """Learn template, shape space, blend weights, joint regressor, pose blend shapes and pose space.

    The same registrations, model and options give the same model, bit for bit on one machine, whatever the threads, and
    however often the training was interrupted.

    Args:
        training_set: Registrations of the initial model's template.
        initial: A right hand, crude or trained before: its zero pose, bones and first blend weights.
        options: See there.
        progress: Told what is under way and the share of all that is done, 0 to 1; may raise to cancel.
        checkpoints: Where each stage is kept when it is done; stages of just this training that are there are not done
            again.

    Raises:
        TrainingError: Too few people, registrations or poses, another template, or a left model.
    """
    options = options or TrainingOptions()
    chosen, owners, left_out = _choose(training_set, initial, options)
    used = training_set.select(chosen)
    # far from the origin half of the digits would go into where a hand is
    targets = used.vertices - used.vertices.mean(1)[:, None]
    data = Data(targets, owners)
    clock = _Clock(progress or (lambda stage, share: None), options.rounds)
    stage = _learn(data, initial, options, clock, checkpoints or NoCheckpoints(), compute_key(used, initial, options))
    clock.say("spaces", 1.0)
    model, shape_space, pose_space, turns = _assemble(stage.learnt, initial, training_set, options)
    report = describe_training(
        used, owners, left_out, stage.learnt, shape_space, pose_space, [*stage.errors], options, clock.seconds()
    )
    clock.end()
    return Training(model, report, stage.learnt.templates, owners, turns)


def _learn(
    data: Data, initial: BlendModel, options: TrainingOptions, clock: _Clock, kept: Checkpoints, key: str
) -> Stage:
    """All stages that are not kept yet, one after the other; what stands after the last one."""
    names = list_stages(options.rounds)
    done, stage = find_last(kept, names, key)
    if stage is not None:
        clock.resume(stage.seconds)
    for number in range(done, len(names)):
        learnt = None if stage is None else stage.learnt
        learnt = _do_stage(number, len(names), learnt, data, initial, options, clock)
        errors = () if stage is None else stage.errors
        if number % 2 == 0 or number == len(names) - 1:
            errors = (*errors, float(np.sqrt(np.mean(learnt.poses.errors**2))))
        arrays = pack_stage(Stage(learnt, errors, clock.seconds()), key)
        kept.save(names[number], arrays)
        stage = unpack_stage(arrays)  # as whoever goes on after an interruption has it
    assert stage is not None, "there is at least one stage"
    clock.begin_round(options.rounds)
    return stage


def _do_stage(
    number: int,
    count: int,
    learnt: Learnt | None,
    data: Data,
    initial: BlendModel,
    options: TrainingOptions,
    clock: _Clock,
) -> Learnt:
    """One stage: first poses; then by turns the two halves of each round; last poses."""
    clock.begin_round((number - 1) // 2)
    if learnt is None:
        learnt = begin(
            data,
            np.asarray(initial.template),
            np.ascontiguousarray(initial.parents, dtype=np.int64),
            np.asarray(initial.skinning_weights),
            initial.joint_regressor,
            options,
            lambda share: clock.say("first poses", share),
        )
        _check_poses(learnt)
        return learnt
    if number == count - 1:
        return _fit_last_poses(learnt, data, options, clock)
    if number % 2 == 1:
        return improve_joints(learnt, data, options, clock.say)
    return improve_surface(learnt, data, options, number == count - 2, clock.say)


def _fit_last_poses(learnt: Learnt, data: Data, options: TrainingOptions, clock: _Clock) -> Learnt:
    """Poses under the joints that the regressor gives, as those who use the model have them."""
    joints = np.stack([learnt.regressor @ own for own in learnt.templates])
    poses = fit_poses(
        learnt.poses,
        Hands(data.targets, data.owners, learnt.templates, joints, learnt.rig),
        4,
        options.threads,
        lambda share: clock.say("last poses", share),
    )
    return replace(learnt, poses=poses, joints=joints)


def _choose(
    training_set: TrainingSet, initial: BlendModel, options: TrainingOptions
) -> tuple[npt.NDArray[np.int64], npt.NDArray[np.int64], dict[str, int]]:
    """The registrations to learn from, whose they are, and the hands that are left out.

    A person's left hand is not the mirror image of the right: each hand has its own template.
    """
    mirrored = [bool(one) for one in training_set.mirrored]
    vertices = [training_set.vertices.shape[1]] * len(training_set)
    hands = [
        TrainingHand(str(who), *each) for who, *each in zip(training_set.subjects, mirrored, vertices, strict=True)
    ]
    faults = find_training_faults(hands, initial.name, initial.side, len(initial.template), options.with_mirrored)
    if faults:
        raise TrainingError(" ".join(faults))
    usable = np.ones(len(training_set), dtype=bool) if options.with_mirrored else ~training_set.mirrored
    hands = training_set.hands
    names, counts = np.unique(hands[usable], return_counts=True)
    kept = names[counts >= FEWEST_OF_A_HAND]
    chosen = np.flatnonzero(usable & np.isin(hands, kept))
    left_out = {str(n): int(c) for n, c in zip(names, counts, strict=True) if c < FEWEST_OF_A_HAND}
    return chosen, np.searchsorted(kept, hands[chosen]), left_out


def _check_poses(learnt: Learnt) -> None:
    B = learnt.poses.rotations.shape[1]
    turns = compute_rotation_vectors(learnt.poses.rotations[:, 1:].reshape(-1, 3, 3)).reshape(-1, B - 1, 3)
    if fault := find_bend_fault(turns):
        raise TrainingError(fault)


def _assemble(learnt: Learnt, initial: BlendModel, training_set: TrainingSet, options: TrainingOptions):
    N, B = learnt.poses.rotations.shape[:2]
    turns = compute_rotation_vectors(learnt.poses.rotations.reshape(-1, 3, 3)).reshape(N, 3 * B)
    pose_space = find_space(turns[:, 3:])
    template, shape_directions, shape_space = find_shape_space(learnt.templates, options.num_shapes)
    if options.num_local_shapes:
        whole = shape_space.components[: shape_directions.shape[2]]
        local = find_local_shapes(learnt.templates, whole, options.num_local_shapes)
        shape_directions = np.concatenate([shape_directions, local], axis=2)
    V = len(template)
    directions = learnt.rig.directions if options.with_pose_shapes else np.zeros((V, 3, 9 * (B - 1)))
    model = replace(
        initial,
        name=options.name,
        template=template,
        shape_directions=shape_directions,
        pose_directions=directions,
        skinning_weights=learnt.rig.skinning_weights,
        joint_regressor=learnt.regressor,
        pose_mean=pose_space.mean,
        pose_components=pose_space.components,
        provenance={
            "method": "[R17] section 3.3, trained by Handloom",
            "training_set": training_set.digest,
            "registrations": str(N),
            "hands": str(len(learnt.templates)),
            "initial": initial.name,
        },
    )
    return model, shape_space, pose_space, turns


class _Clock:
    """Says how far the whole training is, and remembers how long each part took."""

    def __init__(self, say: Progress, rounds: int) -> None:
        self._say, self._rounds, self._round = say, rounds, -1
        self._part, self._began = "", time.monotonic()
        self._seconds: dict[str, float] = {}

    def resume(self, seconds: Mapping[str, float]) -> None:
        """Count on from what an interrupted training took."""
        self._seconds = dict(seconds)

    def begin_round(self, number: int) -> None:
        self._round = number

    def say(self, part: str, share: float) -> None:
        self._take(part)
        weights = {"poses and joints": (0.0, 0.6), "poses": (0.65, 0.25), "pose blend shapes": (0.9, 0.0)}
        start, length = weights.get(part, (0.6, 0.05)) if 0 <= self._round < self._rounds else (0.0, 1.0)
        done = (self._round + 1 + start + length * share) / (self._rounds + 2)
        name = f"round {self._round + 1}: {part}" if 0 <= self._round < self._rounds else part
        self._say(name, done)

    def end(self) -> None:
        self._say("done", 1.0)

    def seconds(self) -> dict[str, float]:
        """By part, s."""
        self._take("")
        return {part: round(value, 2) for part, value in self._seconds.items()}

    def _take(self, part: str) -> None:
        now = time.monotonic()
        if self._part:
            self._seconds[self._part] = self._seconds.get(self._part, 0.0) + now - self._began
        self._part, self._began = part, now

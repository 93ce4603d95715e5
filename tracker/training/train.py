"""A hand model from accepted registrations, [R17] section 3.3."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import numpy.typing as npt

from tracker.errors import TrainingError
from tracker.model.blend_model import BlendModel
from tracker.training.learn import Data, Learnt, begin, improve
from tracker.training.motion import fill_skinning
from tracker.training.options import TrainingOptions
from tracker.training.pose_fit import fit_poses
from tracker.training.report import describe_training
from tracker.training.spaces import compute_rotation_vectors, find_shape_space, find_space
from tracker.training.training_set import TrainingSet

Array = npt.NDArray[np.float64]
Progress = Callable[[str, float], None]

FEWEST_PEOPLE, FEWEST_OF_A_PERSON, FEWEST = 2, 3, 20
LEAST_BEND = np.radians(15.0)
"""Standard deviation of the angle that the most active joint must have over all registrations."""


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
) -> Training:
    """Learn template, shape space, blend weights, joint regressor, pose blend shapes and pose space.

    The same registrations, model and options give the same model, bit for bit on one machine, whatever the threads.

    Args:
        training_set: Registrations of the initial model's template.
        initial: A right hand, crude or trained before: its zero pose, bones and first blend weights.
        options: See there.
        progress: Told what is under way and the share of all that is done, 0 to 1; may raise to cancel.

    Raises:
        TrainingError: Too few people, registrations or poses, another template, or a left model.
    """
    options = options or TrainingOptions()
    say = progress or (lambda stage, share: None)
    chosen, owners, left_out = _choose(training_set, initial, options)
    targets = training_set.vertices[chosen]
    clock = _Clock(say, options.rounds)
    clock.say("first poses", 0.0)
    parents = np.ascontiguousarray(initial.parents, dtype=np.int64)
    # far from the origin half of the digits would go into where a hand is
    centres = targets.mean(1)
    targets = targets - centres[:, None]
    people = np.unique(training_set.subjects[chosen], return_inverse=True)[1]
    data = Data(targets, owners, people, np.asarray(initial.faces, dtype=np.int64))
    learnt = begin(
        data,
        np.asarray(initial.template),
        parents,
        np.asarray(initial.skinning_weights),
        initial.joint_regressor,
        options,
        lambda share: clock.say("first poses", share),
    )
    _check_poses(learnt)
    errors = [float(np.sqrt(np.mean(learnt.poses.errors**2)))]
    for number in range(options.rounds):
        clock.begin_round(number)
        is_last = number == options.rounds - 1
        learnt = improve(learnt, data, options, is_last, clock.say)
        errors.append(float(np.sqrt(np.mean(learnt.poses.errors**2))))
    clock.begin_round(options.rounds)
    joints = np.stack([learnt.regressor @ own for own in learnt.templates])
    poses = fit_poses(
        learnt.poses,
        targets,
        learnt.templates,
        owners,
        joints,
        learnt.rig,
        4,
        options.threads,
        lambda share: clock.say("last poses", share),
    )
    learnt = replace(learnt, poses=poses, joints=joints)
    clock.say("spaces", 1.0)
    errors.append(float(np.sqrt(np.mean(poses.errors**2))))
    model, shape_space, pose_space, turns = _assemble(learnt, initial, training_set, options)
    report = describe_training(
        training_set.select(chosen), owners, left_out, learnt, shape_space, pose_space, errors, options, clock.seconds()
    )
    say("done", 1.0)
    return Training(model, report, learnt.templates, owners, turns)


def _choose(
    training_set: TrainingSet, initial: BlendModel, options: TrainingOptions
) -> tuple[npt.NDArray[np.int64], npt.NDArray[np.int64], dict[str, int]]:
    """The registrations to learn from, whose they are, and the hands that are left out.

    A person's left hand is not the mirror image of the right: each hand has its own template.
    """
    if initial.side != "right":
        raise TrainingError(f"{initial.name}: is a {initial.side} hand; training starts from a right one.")
    if len(training_set) and training_set.vertices.shape[1] != len(initial.template):
        raise TrainingError(
            f"Registrations have {training_set.vertices.shape[1]} vertices, the model {initial.name} has "
            f"{len(initial.template)}; start from the model they were registered with, or one trained from it."
        )
    usable = np.ones(len(training_set), dtype=bool) if options.with_mirrored else ~training_set.mirrored
    hands = training_set.hands
    names, counts = np.unique(hands[usable], return_counts=True)
    kept = names[counts >= FEWEST_OF_A_PERSON]
    chosen = np.flatnonzero(usable & np.isin(hands, kept))
    people = np.unique(training_set.subjects[chosen])
    if len(people) < FEWEST_PEOPLE or len(chosen) < FEWEST:
        raise TrainingError(
            f"{len(training_set)} registrations, of which {len(chosen)} of {len(people)} people count (hands with at "
            f"least {FEWEST_OF_A_PERSON} registrations{'' if options.with_mirrored else ', right hands only'}); a "
            f"model needs at least {FEWEST} of at least {FEWEST_PEOPLE} people. Register and accept more scans."
        )
    left_out = {str(n): int(c) for n, c in zip(names, counts, strict=True) if c < FEWEST_OF_A_PERSON}
    return chosen, np.searchsorted(kept, hands[chosen]), left_out


def _check_poses(learnt: Learnt) -> None:
    B = learnt.poses.rotations.shape[1]
    turns = compute_rotation_vectors(learnt.poses.rotations[:, 1:].reshape(-1, 3, 3)).reshape(-1, B - 1, 3)
    spread = np.sqrt(((turns - turns.mean(0)) ** 2).sum(2).mean(0))
    if spread.max() < LEAST_BEND:
        raise TrainingError(
            f"The hands hardly move: no joint's angle varies by more than {np.degrees(spread.max()):.0f} degrees over "
            f"the registrations; poses in which fingers bend are needed to learn how they bend."
        )


def _assemble(learnt: Learnt, initial: BlendModel, training_set: TrainingSet, options: TrainingOptions):
    N, B = learnt.poses.rotations.shape[:2]
    turns = compute_rotation_vectors(learnt.poses.rotations.reshape(-1, 3, 3)).reshape(N, 3 * B)
    pose_space = find_space(turns[:, 3:])
    template, shape_directions, shape_space = find_shape_space(learnt.templates, options.num_shapes)
    V = len(template)
    directions = learnt.rig.directions if options.with_pose_shapes else np.zeros((V, 3, 9 * (B - 1)))
    model = replace(
        initial,
        name=options.name,
        template=template,
        shape_directions=shape_directions,
        pose_directions=directions,
        skinning_weights=fill_skinning(learnt.rig.skinning, B),
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
    """Says how far the whole training is, and remembers how long each stage took."""

    def __init__(self, say: Progress, rounds: int) -> None:
        self._say, self._rounds, self._round = say, rounds, -1
        self._stage, self._began = "", time.monotonic()
        self._seconds: dict[str, float] = {}

    def begin_round(self, number: int) -> None:
        self._round = number

    def say(self, stage: str, share: float) -> None:
        self._take(stage)
        weights = {"poses and joints": (0.0, 0.6), "poses": (0.65, 0.25), "pose blend shapes": (0.9, 0.0)}
        start, length = weights.get(stage, (0.6, 0.05)) if 0 <= self._round < self._rounds else (0.0, 1.0)
        done = (self._round + 1 + start + length * share) / (self._rounds + 2)
        name = f"round {self._round + 1}: {stage}" if 0 <= self._round < self._rounds else stage
        self._say(name, done)

    def seconds(self) -> dict[str, float]:
        """By stage, s."""
        self._take("")
        return {stage: round(value, 2) for stage, value in self._seconds.items()}

    def _take(self, stage: str) -> None:
        now = time.monotonic()
        if self._stage:
            self._seconds[self._stage] = self._seconds.get(self._stage, 0.0) + now - self._began
        self._stage, self._began = stage, now

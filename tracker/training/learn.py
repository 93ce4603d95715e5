"""The parameters of a hand model in turn, each against all the others, [R17] section 3.3."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
import numpy.typing as npt
from scipy.sparse import csr_array

from tracker.model.skinning import keep_heaviest
from tracker.training.blend_weights import fit_blend_weights
from tracker.training.joints import fit_joints
from tracker.training.options import TrainingOptions
from tracker.training.pose_fit import Hands, Poses, fit_poses, start_poses
from tracker.training.pose_shapes import compute_costs, fit_pose_shapes, measure_from_joints
from tracker.training.regressor import fit_joint_regressor
from tracker.training.rig import Rig, find_features
from tracker.training.spaces import align_rigidly
from tracker.training.templates import fit_templates, unpose, weigh_by_pose

Array = npt.NDArray[np.float64]
Integers = npt.NDArray[np.int64]


@dataclass(frozen=True)
class Data:
    """targets (N, V, 3) registrations, m; owners (N,) which template they are of."""

    targets: Array
    owners: Integers


@dataclass(frozen=True)
class Learnt:
    """What is known about N registrations of S people's hands, and about hands.

    Attributes:
        templates: (S, V, 3) m; joints: (S, B, 3) m.
        poses: Of the registrations.
        rig: Skinning and pose blend shapes.
        regressor: (B, V).
    """

    templates: Array
    joints: Array
    poses: Poses
    rig: Rig
    regressor: csr_array


def begin(
    data: Data,
    template: Array,
    parents: Integers,
    skinning_weights: Array,
    regressor: csr_array,
    options: TrainingOptions,
    progress: Callable[[float], None],
) -> Learnt:
    """First poses and templates, from a crude model and without blend shapes; templates weighted by Eq. 11.

    Args:
        data: Registrations.
        template, parents, skinning_weights, regressor: Of the crude model.
        progress: Told the share done.
    """
    targets, owners = data.targets, data.owners
    S = int(owners.max()) + 1
    rig = Rig(parents, keep_heaviest(skinning_weights), np.zeros((*template.shape, 0)))
    templates = np.tile(template, (S, 1, 1))
    joints = np.tile(regressor @ template, (S, 1, 1))
    poses = start_poses(Hands(targets, owners, templates, joints, rig))
    for turn in range(2):
        hands = Hands(targets, owners, templates, joints, rig)
        poses = fit_poses(poses, hands, 6, options.threads, lambda s, t=turn: progress((t + s) / 2))
        templates = fit_templates(poses, targets, owners, weigh_by_pose(poses, owners), joints, rig)
        joints = np.stack([regressor @ own for own in templates])
    return Learnt(templates, joints, poses, rig, regressor)


def improve_joints(
    learnt: Learnt, data: Data, options: TrainingOptions, progress: Callable[[str, float], None]
) -> Learnt:
    """The first and longer half of a round: poses with joints."""
    progress("poses and joints", 0.0)
    poses, joints = fit_joints(
        learnt.poses,
        Hands(data.targets, data.owners, learnt.templates, learnt.joints, learnt.rig),
        np.stack([learnt.regressor @ own for own in learnt.templates]),
        options.joint_stiffness,
        4,
        options.threads,
        lambda share: progress("poses and joints", share),
    )
    return replace(learnt, poses=poses, joints=joints)


def improve_surface(
    learnt: Learnt,
    data: Data,
    options: TrainingOptions,
    is_last: bool,
    progress: Callable[[str, float], None],
) -> Learnt:
    """The second half: templates, blend weights, joint regressor, poses, blend shapes.

    In the last round the joints are those that the regressor gives, so that all the rest fits to them.
    """
    targets, owners, rig, poses, joints = data.targets, data.owners, learnt.rig, learnt.poses, learnt.joints
    even = np.ones(len(targets))
    progress("templates", 0.0)
    templates = fit_templates(poses, targets, owners, even, joints, rig)
    roots = joints[:, 0]
    palm = rig.skinning_weights[:, 0]
    templates, joints, turned = align_rigidly(templates, joints, palm)
    poses = _turn_poses(poses, owners, turned, roots, joints[:, 0])
    progress("blend weights", 0.0)
    weights = fit_blend_weights(poses, targets, templates, owners, joints, rig, options.weight_stiffness)
    rig = replace(rig, skinning_weights=weights)
    progress("joint regressor", 0.0)
    regressor = fit_joint_regressor(templates, joints, rig.skinning_weights, rig.parents)
    if is_last:
        joints = np.stack([regressor @ own for own in templates])
    hands = Hands(targets, owners, templates, joints, rig)
    poses = fit_poses(poses, hands, 3, options.threads, lambda share: progress("poses", share))
    if options.with_pose_shapes:
        progress("pose blend shapes", 0.0)
        costs = compute_costs(measure_from_joints(templates.mean(0), regressor))
        rest, features = unpose(poses, targets, owners, joints, rig), find_features(poses.rotations)
        rig = replace(rig, directions=fit_pose_shapes(features, rest, owners, costs, options.ridge))
    templates = fit_templates(poses, targets, owners, even, joints, rig)
    return Learnt(templates, joints, poses, rig, regressor)


def _turn_poses(poses: Poses, owners: Integers, turned: Array, before: Array, after: Array) -> Poses:
    """Poses of templates that were turned as a whole: the posed vertices stay where they are.

    Args:
        turned: (S, 3, 3) rotations of the templates; before, after: (S, 3) their roots, m.
    """
    R = turned[owners]
    rotations = poses.rotations.copy()
    rotations[:, 0] = rotations[:, 0] @ np.swapaxes(R, 1, 2)
    rotations[:, 1:] = R[:, None] @ rotations[:, 1:] @ np.swapaxes(R, 1, 2)[:, None]
    return replace(poses, rotations=rotations, translations=poses.translations + (before - after)[owners])

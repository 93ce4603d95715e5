"""A model with another person's shape."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from tracker.model.articulated import ArticulatedModel
from tracker.model.skeleton import Array


def with_shape(model: ArticulatedModel, betas: Array) -> ArticulatedModel:
    """The model at rest with the shape basis applied; the basis is kept, and counts on from the new shape.

    Vertices and joints move; joint axes, limits and weights stay.

    Args:
        model: A model with a shape basis.
        betas: (S,) one for each of `model.shape.names`, in units of about one standard deviation.
    """
    assert model.shape is not None, f"{model.name} has no shape basis"
    assert betas.shape == (len(model.shape.names),)
    return move_at_rest(model, betas, model.shape.vertices, model.shape.joints)


def move_at_rest(model: ArticulatedModel, values: Array, vertices: Array, joints: Array) -> ArticulatedModel:
    """The model with its vertices and joints at rest moved by values (S,) times (S, V, 3) and (S, B, 3), m."""
    Ts = model.skeleton.Ts_model_bone.copy()
    Ts[:, :3, 3] += np.einsum("s,sbx->bx", values, joints)
    return replace(
        model,
        vertices=model.vertices + np.einsum("s,svx->vx", values, vertices),
        skeleton=replace(model.skeleton, Ts_model_bone=Ts),
    )

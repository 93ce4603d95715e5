"""The same object in another size."""

from __future__ import annotations

from dataclasses import replace

from tracker.model.articulated import ArticulatedModel


def with_scale(model: ArticulatedModel, scale: float) -> ArticulatedModel:
    """The model with all its lengths times `scale`, about the origin of its file's coordinates."""
    assert model.hand is None, "hands have a shape, not a scale"
    assert scale > 0.0
    Ts = model.skeleton.Ts_model_bone.copy()
    Ts[:, :3, 3] *= scale
    return replace(
        model,
        vertices=model.vertices * scale,
        skeleton=replace(model.skeleton, Ts_model_bone=Ts),
        provenance={**model.provenance, "scale": f"{scale:.4g}"},
    )

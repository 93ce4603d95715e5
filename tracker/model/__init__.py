"""Hands, objects and their files; how a pose moves them. Knows no cameras.

Names are loaded when they are first asked for: the list of joints must not cost the time that kernels take to load. The
default hand is `tracker.model.default_hand.default_hand`, the untrained one `untrained_hand.untrained_hand`: their
modules have their names, so they cannot be offered here.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from tracker.model.articulated import MAX_WEIGHTS, ArticulatedModel, HandParts, ShapeBasis
    from tracker.model.blend_files import load_blend_model, save_blend_model
    from tracker.model.blend_mirroring import mirror_blend, mirror_blend_pose
    from tracker.model.blend_model import BlendModel, PosedBlend
    from tracker.model.decimation import decimate
    from tracker.model.files import load_model, measure_model, save_model
    from tracker.model.joints import FINGERS, HAND_EDGES, HAND_JOINTS
    from tracker.model.mirroring import mirror, mirror_pose
    from tracker.model.scene import PosedScene, Scene
    from tracker.model.shape import with_shape
    from tracker.model.skeleton import Skeleton
    from tracker.model.t16_files import load_t16_model, load_t16_motion

_HOMES = {
    "ArticulatedModel": "tracker.model.articulated",
    "BlendModel": "tracker.model.blend_model",
    "FINGERS": "tracker.model.joints",
    "HAND_EDGES": "tracker.model.joints",
    "HAND_JOINTS": "tracker.model.joints",
    "HandParts": "tracker.model.articulated",
    "MAX_WEIGHTS": "tracker.model.articulated",
    "PosedBlend": "tracker.model.blend_model",
    "PosedScene": "tracker.model.scene",
    "Scene": "tracker.model.scene",
    "ShapeBasis": "tracker.model.articulated",
    "Skeleton": "tracker.model.skeleton",
    "decimate": "tracker.model.decimation",
    "load_blend_model": "tracker.model.blend_files",
    "load_model": "tracker.model.files",
    "load_t16_model": "tracker.model.t16_files",
    "load_t16_motion": "tracker.model.t16_files",
    "measure_model": "tracker.model.files",
    "mirror": "tracker.model.mirroring",
    "mirror_blend": "tracker.model.blend_mirroring",
    "mirror_blend_pose": "tracker.model.blend_mirroring",
    "mirror_pose": "tracker.model.mirroring",
    "save_blend_model": "tracker.model.blend_files",
    "save_model": "tracker.model.files",
    "with_shape": "tracker.model.shape",
}

__all__ = [
    "FINGERS",
    "HAND_EDGES",
    "HAND_JOINTS",
    "MAX_WEIGHTS",
    "ArticulatedModel",
    "BlendModel",
    "HandParts",
    "PosedBlend",
    "PosedScene",
    "Scene",
    "ShapeBasis",
    "Skeleton",
    "decimate",
    "load_blend_model",
    "load_model",
    "load_t16_model",
    "load_t16_motion",
    "measure_model",
    "mirror",
    "mirror_blend",
    "mirror_blend_pose",
    "mirror_pose",
    "save_blend_model",
    "save_model",
    "with_shape",
]


def __getattr__(name: str) -> Any:
    if name not in _HOMES:
        raise AttributeError(f"module 'tracker.model' has no attribute {name!r}")
    value = globals()[name] = getattr(import_module(_HOMES[name]), name)
    return value

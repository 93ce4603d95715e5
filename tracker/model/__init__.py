"""Hands, objects and their files; how a pose moves them. Knows no cameras."""

from tracker.model.articulated import MAX_WEIGHTS, ArticulatedModel, HandParts, ShapeBasis
from tracker.model.decimation import decimate
from tracker.model.default_hand import default_hand
from tracker.model.files import load_model, save_model
from tracker.model.joints import FINGERS, HAND_EDGES, HAND_JOINTS
from tracker.model.mirroring import mirror, mirror_pose
from tracker.model.scene import PosedScene, Scene
from tracker.model.shape import with_shape
from tracker.model.skeleton import Skeleton
from tracker.model.t16_files import load_t16_model, load_t16_motion

__all__ = [
    "FINGERS",
    "HAND_EDGES",
    "HAND_JOINTS",
    "MAX_WEIGHTS",
    "ArticulatedModel",
    "HandParts",
    "PosedScene",
    "Scene",
    "ShapeBasis",
    "Skeleton",
    "decimate",
    "default_hand",
    "load_model",
    "load_t16_model",
    "load_t16_motion",
    "mirror",
    "mirror_pose",
    "save_model",
    "with_shape",
]

"""Hands, objects and their files; how a pose moves them. Knows no cameras.

Names are loaded when they are first asked for: the list of joints must not cost the time that kernels take to load. The
default hand is `tracker.model.default_hand.default_hand`, the untrained one `untrained_hand.untrained_hand`: their
modules have their names, so they cannot be offered here.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from tracker.lazy_names import offer

if TYPE_CHECKING:
    from tracker.model.articulated import ArticulatedModel, HandParts, ShapeBasis
    from tracker.model.blend_files import load_blend_model, save_blend_model
    from tracker.model.blend_mirroring import mirror_blend
    from tracker.model.blend_model import BlendModel, PosedBlend
    from tracker.model.decimation import decimate
    from tracker.model.files import load_model, measure_model, save_model
    from tracker.model.joints import FINGERS, HAND_EDGES, HAND_JOINTS
    from tracker.model.mirroring import mirror
    from tracker.model.scene import PosedScene, Scene
    from tracker.model.shape import with_shape
    from tracker.model.skeleton import Skeleton
    from tracker.model.skinning import MAX_WEIGHTS
    from tracker.model.t16_files import load_t16_model, load_t16_motion

__getattr__, __dir__ = offer(__name__)

"""Tracks as files for other programs: npz, CSV, glTF animation, MANO-style parameters."""

from __future__ import annotations

from typing import TYPE_CHECKING

from tracker.lazy_names import offer

if TYPE_CHECKING:
    from tracker.export.body_files import check_shape, pose_frames, write_body_glb, write_meshes

__getattr__, __dir__ = offer(__name__)

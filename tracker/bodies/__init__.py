"""Scans of whole people with their hands, still and moving: [R17] section 4. And the body with hands itself."""

from __future__ import annotations

from typing import TYPE_CHECKING

from tracker.lazy_names import offer

if TYPE_CHECKING:
    from tracker.model.body_hands import body_pose
    from tracker.model.body_model import body_model
    from tracker.model.body_motion import BodyMotion, load_body_motion
    from tracker.model.mano_writer import smplx_vertex_ids

__getattr__, __dir__ = offer(__name__)

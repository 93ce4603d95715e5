"""Scans of whole people with their hands, still and moving: [R17] section 4. And the body with hands itself."""

from __future__ import annotations

from typing import TYPE_CHECKING

from tracker.lazy_names import offer

if TYPE_CHECKING:
    from tracker.bodies.body_registration import (
        BodyRegistration,
        load_body_registration,
        save_body_registration,
    )
    from tracker.bodies.body_scan_file import find_body_unit, load_body_scan
    from tracker.bodies.chunks import CHAIN, cut_chunks, find_start, follow_chunk, join_chunk
    from tracker.bodies.follow_body import BodyFollower, FollowOptions
    from tracker.bodies.register_body import Registrar
    from tracker.bodies.template import (
        choose_template_frames,
        find_shape,
        make_own_model,
        make_template,
        register_for_template,
    )
    from tracker.model.body_hands import body_hand, body_pose
    from tracker.model.body_model import body_model
    from tracker.model.body_motion import BodyMotion, load_body_motion, save_body_motion
    from tracker.model.mano_writer import smplx_vertex_ids

__getattr__, __dir__ = offer(__name__)

"""What is shown of a tracked frame: the fit, contacts, collisions, detections, errors."""

from __future__ import annotations

from typing import TYPE_CHECKING

from tracker.lazy_names import offer

if TYPE_CHECKING:
    from tracker.inspection.frame_view import (
        UNKNOWN_COLOR,
        FrameView,
        ModelView,
        describe_frame,
        render_overlay,
        render_unknown,
    )
    from tracker.inspection.term_looks import find_term_look
    from tracker.inspection.view_aids import ViewAids
    from tracker.terms.look import TermLook

__getattr__, __dir__ = offer(__name__)

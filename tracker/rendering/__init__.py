"""Z-buffer rendering of posed models."""

from tracker.rendering.view import View, render_view
from tracker.rendering.zbuffer import Rendering, render_depth

__all__ = ["Rendering", "View", "render_depth", "render_view"]

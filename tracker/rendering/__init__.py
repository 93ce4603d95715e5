"""Z-buffer rendering of posed models."""

from tracker.rendering.zbuffer import Rendering, render_depth

__all__ = ["Rendering", "render_depth"]

"""How fine a model's mesh may be; apart from `files`, whose imports take their time."""

from __future__ import annotations

MAX_FACES = 1500
"""Meshes with more faces are decimated to this number when they are loaded for tracking."""

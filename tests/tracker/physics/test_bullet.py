"""Bullet is there or a sentence says that it is not."""

from __future__ import annotations

import platform
import sys

import pytest

from tests.tracker.grips import PINCH, gripped
from tracker.errors import TrackingError
from tracker.physics import PhysicsWorld
from tracker.physics.bullet import find_physics_fault, load_bullet


def test_where_bullet_is_installed_nothing_keeps_physics_from_being_used():
    pytest.importorskip("pybullet")
    assert find_physics_fault() is None
    assert load_bullet().__name__ == "pybullet"


def test_a_world_without_bullet_is_refused_with_the_version_of_python(monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setitem(sys.modules, "pybullet", None)
    load_bullet.cache_clear()
    try:
        with pytest.raises(TrackingError, match=f"needs pybullet.*{platform.python_version()}"):
            PhysicsWorld(gripped(PINCH, (0.0, 0.0)).scene)
    finally:
        load_bullet.cache_clear()

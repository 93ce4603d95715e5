"""The one place that imports Bullet. Everything but the physics term works without it."""

from __future__ import annotations

import os
import platform
import sys
from functools import cache
from importlib.util import find_spec
from typing import Any

from tracker.errors import TrackingError


def find_physics_fault() -> str | None:
    """Why the physics term cannot be used with this Python, in a sentence for people; None when it can."""
    try:
        is_installed = find_spec("pybullet") is not None
    except ValueError:  # something has put another thing in its place
        is_installed = False
    if is_installed:
        return None
    return (
        f"The physics term (P) needs pybullet, which is not installed for this Python {platform.python_version()}; "
        "use Python 3.11, for which it is available, or terms without P, such as LO+SC."
    )


@cache
def load_bullet() -> Any:
    """The pybullet module; its greeting on stderr is kept from whoever reads ours.

    Raises:
        TrackingError: It is not installed.
    """
    if fault := find_physics_fault():
        raise TrackingError(fault)
    sys.stderr.flush()
    kept, nowhere = os.dup(2), os.open(os.devnull, os.O_WRONLY)
    try:
        os.dup2(nowhere, 2)
        import pybullet
    finally:
        os.dup2(kept, 2)
        os.close(kept)
        os.close(nowhere)
    return pybullet

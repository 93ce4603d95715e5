"""The one place that imports Bullet."""

from __future__ import annotations

import os
import sys
from functools import cache
from typing import Any


@cache
def load_bullet() -> Any:
    """The pybullet module; its greeting on stderr is kept from whoever reads ours."""
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

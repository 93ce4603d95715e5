"""The only place that configures logging."""

from __future__ import annotations

import logging
import sys
import time


def configure_logging(level: str) -> None:
    """Log to stderr, one line each, with the time in UTC; replaces what was configured before."""
    formatter = logging.Formatter("%(asctime)s.%(msecs)03dZ %(levelname)s %(name)s: %(message)s", "%Y-%m-%dT%H:%M:%S")
    formatter.converter = time.gmtime
    handler = logging.StreamHandler(sys.stderr)
    handler.setFormatter(formatter)
    logging.basicConfig(level=level, handlers=[handler], force=True)
    logging.getLogger("alembic").setLevel(max(logging.getLogger().level, logging.WARNING))

"""One line on stderr that says how far something is."""

from __future__ import annotations

import sys
import time
from typing import TextIO


class ProgressLine:
    """Rewrites its line on a terminal; elsewhere says something every tenth of the way only.

    Args:
        what: What is under way.
        stream: Where to write.
    """

    def __init__(self, what: str, stream: TextIO | None = None) -> None:
        self._what = what
        self._stream = stream or sys.stderr
        self._is_terminal = self._stream.isatty()
        self._began = time.monotonic()
        self._shown = -1

    def show(self, share: float, detail: str = "") -> None:
        """Say that `share`, 0 to 1, is done."""
        elapsed = time.monotonic() - self._began
        left = f", {elapsed * (1.0 - share) / share:.0f} s left" if 0.02 < share < 1.0 else ""
        line = f"{self._what}: {100 * share:.0f} %{left}{', ' + detail if detail else ''}"
        if self._is_terminal:
            self._stream.write(f"\r\x1b[2K{line}" + ("\n" if share >= 1.0 else ""))
        elif int(10 * share) > self._shown:
            self._shown = int(10 * share)
            self._stream.write(line + "\n")
        self._stream.flush()

"""How long to wait before a failed search is repeated."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Patience:
    """Frames to wait before the next search; the wait doubles with each search that fails.

    Attributes:
        wait: Frames until the next search.
        last: The last wait that was begun; 0 after a search that found something.
    """

    wait: int = 0
    last: int = 0

    @property
    def is_over(self) -> bool:
        """Whether it is time to search."""
        return self.wait == 0

    def pass_frame(self) -> Patience:
        """A frame later."""
        return Patience(max(0, self.wait - 1), self.last)

    def after_search(self, has_found: bool, least: int, most: int) -> Patience:
        """After a search: none if it found something, else a wait of `least` to `most` frames."""
        wait = 0 if has_found else min(max(least, 2 * self.last), most)
        return Patience(wait, wait)

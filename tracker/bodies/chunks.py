"""Scans of a moving person in chunks that are registered side by side, and then joined without a seam."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace
from typing import Protocol

import numpy as np

from tracker.bodies.body_registration import BodyRegistration
from tracker.bodies.body_state import BodyState
from tracker.bodies.follow_body import BodyFollower
from tracker.bodies.template import without_shape
from tracker.capture.scan import Scan
from tracker.errors import TrackerError

AGREES_MM, AGREED = 0.5, 2
"""Two chains of frames have met when this many frames in a row differ by less than this, over all vertices' mean."""

CHAIN, APART = "chain", "chain_apart_mm"
"""Measures of a frame that was registered on from the chunk before: that chunk, and how far the chunk's own was."""


class KeptFrames(Protocol):
    """Scans by frame, and what was made of them so far; whoever goes on with a chunk finds it here."""

    def read(self, frame: int) -> Scan:
        """The scan of a frame; raises a TrackerError where it cannot be read."""
        ...

    def load(self, frame: int) -> BodyRegistration | None:
        """The registration of a frame; none where there is none yet."""
        ...

    def keep(self, frame: int, registration: BodyRegistration) -> None:
        """Have it found by `load` from now on, also after a crash."""
        ...

    def leave_out(self, frame: int, error: TrackerError) -> None:
        """Say why a frame has no registration."""
        ...

    def begin(self, follower: BodyFollower, frame: int, scan: Scan) -> BodyRegistration:
        """Register the first frame of a chunk."""
        ...


def cut_chunks(first: int, count: int, size: int) -> list[range]:
    """Frames from `first` on in stretches of `size`; all in one when that is 0."""
    size = size or max(count, 1)
    return [range(at, min(at + size, first + count)) for at in range(first, first + count, size)]


def find_start(known: BodyRegistration | None) -> BodyState | None:
    """Where a chunk begins with the person's own model whose first frame helped to make it."""
    return None if known is None or known.verdict == "bad" else without_shape(known)


def follow_chunk(frames: KeptFrames, follower: BodyFollower, chunk: Sequence[int]) -> Iterator[int]:
    """Register the frames of a chunk that are not there yet, each from the one before; gives each frame."""
    before: BodyRegistration | None = None
    for frame in chunk:
        done = frames.load(frame)
        if done is None:
            try:
                scan = frames.read(frame)
                done = frames.begin(follower, frame, scan) if before is None else follower.follow(scan, before)
            except TrackerError as error:
                frames.leave_out(frame, error)
            else:
                frames.keep(frame, done)
        before = done or before
        yield frame


def join_chunk(frames: KeptFrames, follower: BodyFollower, chunks: Sequence[Sequence[int]], number: int) -> int:
    """Go on from the chunk before into this one until both chains of frames have met, so that no seam is left.

    Done again, it finds the frames that it has registered, and goes on behind them.

    Args:
        frames: All chunks up to this one are registered, those before it joined.
        follower: Of the person.
        chunks: In order.
        number: Of the chunk, not the first.

    Returns:
        How many of its frames are now of the chain before.
    """
    earlier = (frame for chunk in reversed(chunks[:number]) for frame in reversed(chunk))
    before = next((done for frame in earlier if (done := frames.load(frame))), None)
    count = met = 0
    for frame in chunks[number] if before is not None else ():
        stored = frames.load(frame)
        if stored is None:
            continue
        if CHAIN not in stored.measures:
            stored = _continue(frames, follower, frame, before, stored, number)
        apart = stored.measures.get(APART, np.inf)
        met = met + 1 if apart < AGREES_MM else 0
        count += CHAIN in stored.measures
        before = stored
        if met == AGREED:
            break
    return count


def _continue(
    frames: KeptFrames,
    follower: BodyFollower,
    frame: int,
    before: BodyRegistration | None,
    stored: BodyRegistration,
    number: int,
) -> BodyRegistration:
    """A frame registered from the chain before in place of its chunk's own; that stays where this fails."""
    assert before is not None
    try:
        done = follower.follow(frames.read(frame), before)
    except TrackerError:
        return stored
    apart = 1e3 * float(np.linalg.norm(done.vertices - stored.vertices, axis=1).mean())
    done = replace(done, measures={**done.measures, CHAIN: float(number - 1), APART: apart})
    frames.keep(frame, done)
    return done

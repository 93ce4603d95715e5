"""Chunks are all frames, and where two meet the chain of the first goes on until it is the second's."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.tracker.bodies.posed_bodies import A_POSE, MODEL, registration_of, stand
from tracker.bodies.body_registration import BodyRegistration
from tracker.bodies.chunks import AGREES_MM, APART, CHAIN, cut_chunks, find_start, follow_chunk, join_chunk
from tracker.bodies.follow_body import BodyFollower
from tracker.capture.scan import Scan
from tracker.errors import ScanError, TrackerError

GOOD = registration_of(stand(A_POSE))
CHUNKS = [range(3), range(3, 12)]


def place(registration: BodyRegistration | None) -> float:
    """Along x, mm."""
    assert registration is not None
    return 1e3 * float(registration.state.translation[0])


def at(x_mm: float) -> BodyRegistration:
    """A body so far along x."""
    moved = np.array([1e-3 * x_mm, 0.0, 0.0])
    return replace(GOOD, vertices=GOOD.vertices + moved, state=replace(GOOD.state, translation=moved))


class Halving(BodyFollower):
    """Finds every frame at 0, but keeps half of the error of the frame before: chains meet as they go on."""

    def follow(self, scan: Scan, before: BodyRegistration) -> BodyRegistration:
        return at(place(before) / 2.0)


class Memory:
    """Frames in memory; the `broken` cannot be read, and chunks begin `off_mm` beside the truth."""

    def __init__(self, broken: frozenset[int] = frozenset(), off_mm: float = 16.0) -> None:
        self.broken, self.off_mm = broken, off_mm
        self.found: dict[int, BodyRegistration] = {}
        self.left_out: dict[int, str] = {}
        self.kept: list[int] = []
        self.ends_after = -1

    def read(self, frame: int) -> Scan:
        if frame in self.broken:
            raise ScanError(Path(f"{frame}.ply"), "nothing", "a scan")
        return Scan(np.zeros((1, 3)), np.zeros((1, 3)), name=str(frame))

    def load(self, frame: int) -> BodyRegistration | None:
        return self.found.get(frame)

    def keep(self, frame: int, registration: BodyRegistration) -> None:
        self.found[frame] = registration
        self.kept.append(frame)
        if len(self.kept) == self.ends_after:
            raise KeyboardInterrupt

    def leave_out(self, frame: int, error: TrackerError) -> None:
        self.left_out[frame] = str(error)

    def begin(self, follower: BodyFollower, frame: int, scan: Scan) -> BodyRegistration:
        return at(self.off_mm)

    def places(self) -> dict[int, float]:
        return {frame: round(place(each), 6) for frame, each in sorted(self.found.items())}


def register(frames: Memory) -> int:
    """Both chunks, and their seam; gives how many frames were joined."""
    for chunk in CHUNKS:
        assert list(follow_chunk(frames, Halving(MODEL), chunk)) == list(chunk)
    return join_chunk(frames, Halving(MODEL), CHUNKS, 1)


@given(st.integers(0, 9), st.integers(1, 60), st.integers(0, 70))
def test_chunks_are_all_frames_in_order_and_none_is_longer_than_asked(first: int, count: int, size: int) -> None:
    chunks = cut_chunks(first, count, size)
    assert [frame for part in chunks for frame in part] == list(range(first, first + count))
    assert max(map(len, chunks)) <= (size or count) and min(map(len, chunks)) > 0


def test_a_seam_is_gone_when_both_chains_agree_twice_in_a_row_and_the_rest_of_the_chunk_stays() -> None:
    frames = Memory()
    assert register(frames) == 7, "14, 7, 3.5, 1.75, 0.875, 0.4375 and 0.21875 mm apart"
    joined = [frame for frame, each in frames.found.items() if CHAIN in each.measures]
    assert joined == list(range(3, 10))
    assert [frames.found[frame].measures[APART] < AGREES_MM for frame in joined] == [False] * 5 + [True] * 2
    assert frames.places()[3] == 2.0 and frames.places()[10] == 0.125, "half of frame 2; its own chunk's"


def test_chunks_that_never_meet_are_one_chain_to_the_end() -> None:
    frames = Memory(off_mm=1000.0)
    assert register(frames) == 9
    assert frames.places() == {frame: round(1000.0 / 2**frame, 6) for frame in range(12)}


def test_a_frame_that_cannot_be_read_at_the_head_of_a_chunk_is_left_out_and_the_next_one_begins() -> None:
    frames = Memory(broken=frozenset({3}))
    register(frames)
    assert set(frames.left_out) == {3} and 3 not in frames.found
    assert frames.places()[4] == 2.0, "on from frame 2"


def test_without_a_frame_before_there_is_nothing_to_join() -> None:
    frames = Memory(broken=frozenset({0, 1, 2}))
    assert register(frames) == 0 and frames.places()[3] == frames.off_mm


@pytest.mark.parametrize("ends_after", range(1, 20))
def test_wherever_it_is_broken_off_it_ends_as_if_it_had_not_been(ends_after: int) -> None:
    whole, broken = Memory(), Memory()
    register(whole)
    assert len(whole.kept) == 3 + 9 + 7
    broken.ends_after = ends_after
    with pytest.raises(KeyboardInterrupt):
        register(broken)
    register(broken)
    assert broken.places() == whole.places() and len(broken.kept) == len(whole.kept)
    register(broken)
    assert len(broken.kept) == len(whole.kept), "done again it changes nothing"


def test_a_chunk_does_not_begin_where_the_template_was_registered_badly() -> None:
    assert find_start(None) is find_start(registration_of(stand(A_POSE), "bad")) is None
    start = find_start(GOOD)
    assert start is not None and len(start.shape) == 0

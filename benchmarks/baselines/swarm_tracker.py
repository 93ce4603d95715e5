"""Follow a scene with a particle swarm, as Oikonomidis et al. 2011 do, for comparison: [T16] §4.1.5."""

from __future__ import annotations

from collections.abc import Callable
from time import perf_counter

import cv2
import numpy as np
import numpy.typing as npt

from benchmarks.baselines.discrepancy import Discrepancy
from benchmarks.baselines.pose_search import search_pose
from benchmarks.baselines.swarm_options import SwarmOptions
from tracker.capture.sequence import Sequence
from tracker.fitting.frame_fit import draw
from tracker.fitting.measure_quality import measure_quality
from tracker.fitting.quality import Quality
from tracker.fitting.region import region_around
from tracker.fitting.setup import TrackSetup
from tracker.observation import Observation, observe
from tracker.tracking.chunk import TrackChunk
from tracker.tracking.frame_result import FrameResult

Array = npt.NDArray[np.float64]

MIN_PIXELS = 60
"""With fewer pixels than this near the expected place there is nothing to search for, as in our tracker."""


def track_with_swarm(
    sequence: Sequence,
    setup: TrackSetup,
    start_pose: Array,
    frames: range,
    options: SwarmOptions | None = None,
    on_frame: Callable[[int, FrameResult], None] | None = None,
) -> TrackChunk:
    """Track consecutive frames, each searched around the pose of the one before.

    Same input and seed, without a time limit: the same result to the last bit, in one piece or in chunks, times apart.
    The swarm does not know when it is lost: a frame is `lost` only where nothing was in sight.

    Args:
        sequence: The recording.
        setup: Models, camera and preparation of the images; its iterations and terms mean nothing here.
        start_pose: (D,) around which the first frame is searched.
        frames: Which, at least one.
        options: Of the swarm.
        on_frame: Called after every frame; an exception from it ends the run there.
    """
    assert start_pose.shape == (setup.scene.num_dofs,)
    assert len(frames), "at least one frame"
    how = options or SwarmOptions()
    cv2.setNumThreads(setup.options.threads)
    results: list[FrameResult] = []
    pose = start_pose
    for index in frames:
        result = _follow_frame(sequence, setup, pose, index, how)
        pose = result.pose
        results.append(result)
        if on_frame:
            on_frame(index, result)
    return TrackChunk.of(results)


def thin_to(seen: Observation, side: int) -> Observation:
    """The observation with at most `side` pixels along its longer side."""
    return seen.thin(max(1, -(-max(seen.labels.shape) // side)))


def _follow_frame(sequence: Sequence, setup: TrackSetup, pose: Array, index: int, options: SwarmOptions) -> FrameResult:
    read_at = perf_counter()
    frame, camera = setup.read(sequence, index)
    started = perf_counter()
    stages = {"reading": started - read_at}
    region = region_around(setup.scene.pose_at(pose).vertices, camera)
    seen = None if region is None else observe(frame, camera, region, setup.preprocessing)
    stages["observing"] = perf_counter() - started
    if seen is None or np.count_nonzero(seen.labels) < MIN_PIXELS:
        return FrameResult(index, pose, "lost", perf_counter() - started, None, (), stages)
    deadline = None if options.seconds_per_frame is None else started + options.seconds_per_frame
    rng = np.random.default_rng((options.seed, index))
    searched_at = perf_counter()
    cost = Discrepancy(setup.scene, thin_to(seen, options.side))
    pose, found = search_pose(setup.scene, cost, pose, options, rng, deadline)
    ended = perf_counter()
    stages["searching"] = ended - searched_at
    costs = tuple({"swarm": cost} for cost in found.history)
    return FrameResult(index, pose, "ok", ended - started, _measure(setup, pose, seen), costs, stages)


def _measure(setup: TrackSetup, pose: Array, seen: Observation) -> Quality | None:
    """Of the hand that is worst explained; None without hands."""
    view = draw(setup.scene.pose_at(pose), seen)
    hands = [measure_quality(view, seen, index) for index, model in enumerate(setup.models) if model.hand]
    return min(hands, key=lambda quality: quality.score, default=None)

"""Fit a scene to what several colour views saw at one moment, and judge each hand."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np
import numpy.typing as npt

from tracker.capture.camera import Camera
from tracker.capture.frame import Frame
from tracker.detection.image_hands import name_hands
from tracker.fitting.frame_fit import Fit, FitOptions, fit_frame
from tracker.fitting.objective import Objective
from tracker.fitting.setup import TrackSetup
from tracker.fitting.view_hands import HOLDS, REACH, ViewHands
from tracker.landmarks import DetectedHand, HandDetector
from tracker.model.scene import PosedScene
from tracker.tracking.recovery import list_hands

Array = npt.NDArray[np.float64]

FAR_REACH = 4.0 * REACH
"""mm; the first iterations of a frame hear joints from farther off, where a hand moved fast."""

ALL_TURNS = (0, 1, 2, 3)

MOST = 11
"""So many of the 21 joints are most of a hand."""


def see_hands(
    setup: TrackSetup, cameras: tuple[Camera, ...], frames: Sequence[Frame], posed: PosedScene, gone: set[int]
) -> ViewHands:
    """The hands in all views of a moment, looked for where the pose has them, and in whole images where that fails.

    While two views see every hand, one view a frame is looked through for what it does not see, in turn.

    Args:
        setup: Models and options.
        cameras: Of the views.
        frames: Of the views.
        posed: Where the hands are expected.
        gone: Hands that nobody knows the place of.
    """
    detector = setup.hand_detector
    assert detector is not None, "find_tracking_faults has seen to it"
    names = setup.hand_names
    known = [hand for hand in list_hands(setup) if hand not in gone]
    seen = []
    for camera, frame in zip(cameras, frames, strict=True):
        expected = {setup.names[hand]: _expect(posed, hand, setup.names[hand], camera) for hand in known}
        places = {name: hand for name, hand in expected.items() if hand is not None}
        seen.append(_find(detector, frame, names, places, ()) if places else {})
    for view, frame in enumerate(frames):
        is_scarce = any(sum(name in hands for hands in seen) < min(2, len(cameras)) for name in names)
        if len(seen[view]) < len(names) and (is_scarce or frame.index % len(frames) == view):
            turns = ALL_TURNS if gone else (0, 1 + frame.index % 3)
            seen[view] = _find(detector, frame, names, seen[view], turns)
    return ViewHands(cameras, tuple(seen))


def fit_views(setup: TrackSetup, objective: Objective, seen: ViewHands, pose: Array, iterations: int) -> Fit:
    """Fit the scene from a pose (D,) to what the views saw: first with far joints, then without."""
    options = FitOptions(iterations=max(1, iterations // 2), fine=0)
    far = seen.add_to(objective, setup.scene, setup.names, FAR_REACH)
    first = fit_frame(setup.scene, None, pose, pose, far, options)
    near = seen.add_to(objective, setup.scene, setup.names)
    last = fit_frame(setup.scene, None, first.pose, pose, near, replace(options, iterations=iterations))
    stages = {name: seconds + first.stages[name] for name, seconds in last.stages.items()}
    return Fit(last.pose, (*first.costs, *last.costs), stages)


def is_held(setup: TrackSetup, seen: ViewHands, posed: PosedScene, hand: int) -> bool:
    """Whether two views agree with a fitted hand, or one where the hand is outside of all other images."""
    apart = seen.measure(posed, hand, setup.names[hand])
    inside = sum(_is_inside(posed, hand, camera) for camera in seen.cameras)
    return int(np.count_nonzero(apart < HOLDS)) >= min(2, max(1, inside))


def _find(
    detector: HandDetector,
    frame: Frame,
    names: tuple[str, ...],
    before: Mapping[str, DetectedHand],
    turns: tuple[int, ...],
) -> dict[str, DetectedHand]:
    assert frame.color is not None
    found = detector.find(frame.color, len(names), [before[name] for name in names if name in before], turns)
    return name_hands(found, names)


def _expect(posed: PosedScene, hand: int, name: str, camera: Camera) -> DetectedHand | None:
    """A hand as its pose says that an image shows it; None where most of it is outside."""
    if not _is_inside(posed, hand, camera):
        return None
    right = 1.0 if name == "right" else 0.0
    return DetectedHand(camera.project(posed.landmarks(hand)), np.zeros((21, 3)), 1.0, right)


def _is_inside(posed: PosedScene, hand: int, camera: Camera) -> bool:
    """Whether most of a hand is in an image."""
    return int(np.count_nonzero(camera.can_see(posed.landmarks(hand)))) >= MOST

"""What the hand detector sees in the colour image of a frame, checked against its depth."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import partial

import numpy as np
import numpy.typing as npt

from tracker.capture.camera import Camera
from tracker.capture.frame import Frame
from tracker.capture.grey import is_grey
from tracker.detection.image_hands import name_hands
from tracker.fitting.objective import Objective
from tracker.landmarks import DetectedHand, HandDetector
from tracker.model.scene import Scene
from tracker.observation.islands import Island, find_islands
from tracker.observation.own_color import find_own_color
from tracker.terms.marked_joints import mark_joints

Array = npt.NDArray[np.float64]

SMALLEST, LARGEST = 0.5, 1.9
"""Depth that the detected hand's size tells, times the depth that is seen at its joints. On 400 real frames of two
recordings it lies between 0.75 and 1.5, seen edge-on 12 cm before a camera it comes to 1.8; where a thumb was taken for
a whole hand it is above 2."""

SEEN, NO_DEPTH, COVERED = 1.0, 0.3, 0.05
"""Weight of a joint where hand is seen, where no depth is, and where something else is seen."""

FEW = 3
"""So many joints before which something else is seen mean that a thing hides part of the hand."""

TIP_ROOM = 0.015
"""A fingertip that shows is of the joint that is expected so near to it, m."""

REACH = 15.0
"""mm; a joint that far from the detector's place has a quarter of its pull."""

WEIGHT = 1.0
"""γ of a joint. 0.3, 1 and 3 put 80, 90 and 90 % of the marked fingertips of `uvr_cube_white` within 8 px."""


@dataclass(frozen=True)
class Sighting:
    """One hand in one frame.

    Attributes:
        hand: As it was detected.
        beliefs: (21,) 0 to 1, how much each joint is believed.
        is_led: Whether it was seen only because the fit told where to look. Its joints help the next fit, but are no
            witness of it: the detector agreed so with hands that were inside out.
    """

    hand: DetectedHand
    beliefs: Array
    is_led: bool = False

    @property
    def points(self) -> Array:
        """(21, 3) px and v: 2 where the hand is seen at the joint, 1 elsewhere."""
        return np.column_stack([self.hand.points, np.where(self.beliefs >= SEEN, 2.0, 1.0)])

    def measure(self, joints: Array) -> tuple[float, float]:
        """Mean distance of joints (21, 2) px from these, in quarters of the palm's length: of all, of the worst finger.

        Each joint counts as it is believed, and at most 1. A finger of which less than two joints are believed is none
        to judge by.
        """
        apart = np.linalg.norm(joints - self.hand.points, axis=1)
        cut = 0.25 * float(np.linalg.norm(self.hand.points[9] - self.hand.points[0]))
        apart = self.beliefs * np.minimum(apart / max(cut, 1e-9), 1.0)
        fingers, beliefs = apart[1:].reshape(5, 4).sum(axis=1), self.beliefs[1:].reshape(5, 4).sum(axis=1)
        worst = np.max(fingers[beliefs >= 2.0] / beliefs[beliefs >= 2.0], initial=0.0)
        return float(apart.sum() / self.beliefs.sum()), float(worst)

    def with_tips(self, islands: tuple[Island, ...], expected: Array | None, focal: float) -> Sighting:
        """This with fingertips that the detector overlooks where they show beyond a thing and were expected.

        Where a thing hides a finger but for its tip, the network bends that finger to what shows of its root.
        """
        if expected is None:
            return self
        points, beliefs = self.hand.points.copy(), self.beliefs.copy()
        for island in islands:
            room = TIP_ROOM * focal / island.depth
            if np.min(np.linalg.norm(points - island.middle, axis=1)) < room:
                continue
            apart = np.linalg.norm(expected[4::4] - island.middle, axis=1)
            tip = 4 + 4 * int(np.argmin(apart))
            if apart.min() < room:
                points[tip], beliefs[tip] = island.middle, SEEN
                beliefs[tip - 2 : tip] = COVERED
        return replace(self, hand=replace(self.hand, points=points), beliefs=beliefs)


@dataclass(frozen=True)
class Sightings:
    """What was seen in a frame.

    Attributes:
        frame: The frame, with the pixels that have the hands' own colour if every hand was seen.
        camera: Its camera, undistorted.
        hands: By the name of the hand; those that were not seen are missing.
        is_looked_at: Whether a detector looked at the frame; without colour or without a detector none does.
        tells_color: Whether the pixels of the hands are told by their colour, and not by where their bones are.
        islands: Pieces of hand that show beyond a thing.
    """

    frame: Frame
    camera: Camera
    hands: Mapping[str, Sighting]
    is_looked_at: bool = True
    tells_color: bool = False
    islands: tuple[Island, ...] = ()

    @property
    def followed(self) -> dict[str, DetectedHand]:
        """The hands that the detector follows on by itself, by name."""
        return {name: sighting.hand for name, sighting in self.hands.items() if not sighting.is_led}

    @property
    def is_covered(self) -> bool:
        """Whether something stands before a hand."""
        return any(np.count_nonzero(hand.beliefs == COVERED) >= FEW for hand in self.hands.values())

    def with_tips(self, expected: Mapping[str, Array]) -> Sightings:
        """These with the fingertips that show where joints (21, 2) px are expected."""
        focal = float(self.camera.K[0, 0])
        hands = {name: hand.with_tips(self.islands, expected.get(name), focal) for name, hand in self.hands.items()}
        return replace(self, hands=hands)

    def add_to(self, objective: Objective, scene: Scene, names: tuple[str, ...]) -> Objective:
        """The objective with the joints that were seen, the S of [T16] Eq. 5.

        Differs from the paper: joints in place of fingertips, from a network in place of a forest, on viewing rays in
        place of points, and each knows which hand and finger it is of.
        """
        terms = dict(objective.terms)
        for model, name in enumerate(names):
            if name in self.hands:
                sighting = self.hands[name]
                joints = mark_joints(scene, model, sighting.points, self.camera, sighting.beliefs, REACH)
                terms[f"joints_{name}"] = replace(joints, weight=WEIGHT)
        return replace(objective, terms=terms)


def find_sightings(
    detector: HandDetector | None,
    frame: Frame,
    camera: Camera,
    names: tuple[str, ...],
    before: Mapping[str, DetectedHand],
    expected: Mapping[str, Array] | None = None,
    turns: tuple[int, ...] = (0, 1, 2, 3),
) -> Sightings:
    """Look for the hands of a recording in the colour image of a frame; without colour or detector nothing is seen.

    Args:
        detector: Finds hands in images.
        frame: Undistorted.
        camera: Its camera.
        names: Of the hands, `right` or `left`.
        before: The hands that were seen in the frame before.
        expected: Joints (21, 2) px of hands that are followed, where they should be now. They tell the pixels of a hand
            that the detector does not see; the only hand of a recording is looked for there, too.
        turns: In which the image is looked through for palms, quarters.
    """
    color, depth = frame.color, frame.depth
    if detector is None or color is None or depth is None or not names:
        return Sightings(frame, camera, {}, is_looked_at=False)
    expected = expected or {}
    hands, is_led = _find_hands(detector, frame, camera, names, before, expected, turns)
    joints = {**expected, **{name: hand.points for name, hand in hands.items()}}
    if not joints:
        return Sightings(frame, camera, {})
    is_hand = find_hand_pixels(frame, camera, joints)
    if len(joints) == len(names):  # of a hand that nobody knows where to look for nobody knows the pixels
        frame = replace(frame, is_hand=is_hand)
    tells_color = not is_grey(color)
    islands = tuple(find_islands(is_hand, depth, camera.K)) if tells_color else ()
    sightings = {name: Sighting(hand, _believe(hand, depth, is_hand), is_led) for name, hand in hands.items()}
    return Sightings(frame, camera, sightings, tells_color=tells_color, islands=islands).with_tips(expected)


def _find_hands(
    detector: HandDetector,
    frame: Frame,
    camera: Camera,
    names: tuple[str, ...],
    before: Mapping[str, DetectedHand],
    expected: Mapping[str, Array],
    turns: tuple[int, ...],
) -> tuple[dict[str, DetectedHand], bool]:
    """The hands that the detector sees, by name, and whether it had to be told where to look."""
    assert frame.color is not None and frame.depth is not None
    followed = [before[name] for name in names if name in before]
    has_size = partial(_has_size_of, depth=frame.depth, camera=camera)
    hands = name_hands(detector.find(frame.color, len(names), followed, turns, has_size), names)
    if hands or len(names) > 1 or not expected:
        return hands, False
    name, joints = next(iter(expected.items()))
    there = DetectedHand.expected(joints, name)
    found = detector.find(frame.color, 1, [there], (), lambda hand: has_size(hand) and hand.is_same(there))
    return name_hands(found, names), True


def find_hand_pixels(frame: Frame, camera: Camera, hands: Mapping[str, Array]) -> npt.NDArray[np.bool_]:
    """(H, W) pixels with depth that have the own colour of some of the hands whose joints (21, 2) px these are."""
    assert frame.color is not None and frame.depth is not None
    focal = float(camera.K[0, 0])
    return np.logical_or.reduce([find_own_color(frame.color, frame.depth, joints, focal) for joints in hands.values()])


def _has_size_of(hand: DetectedHand, depth: npt.NDArray[np.float32], camera: Camera) -> bool:
    """Whether the hand looks as large as one does at the depth that is seen there."""
    columns, rows = np.rint(hand.points).astype(int).T
    inside = (rows >= 0) & (rows < depth.shape[0]) & (columns >= 0) & (columns < depth.shape[1])
    seen = depth[rows[inside], columns[inside]]
    seen = seen[seen > 0]
    if not seen.size:
        return False
    scale = hand.pixels_per_metre
    return scale > 0.0 and SMALLEST < float(camera.K[0, 0]) / scale / float(np.median(seen)) < LARGEST


def _believe(hand: DetectedHand, depth: npt.NDArray[np.float32], is_hand: npt.NDArray[np.bool_]) -> Array:
    """(21,) how much each joint is believed: one in front of which something else is seen is invented."""
    height, width = depth.shape
    beliefs = np.full(21, NO_DEPTH)
    for joint, (column, row) in enumerate(np.rint(hand.points).astype(int)):
        if 0 <= column < width and 0 <= row < height:
            around = slice(max(0, row - 1), row + 2), slice(max(0, column - 1), column + 2)
            if is_hand[around].any():
                beliefs[joint] = SEEN
            elif (depth[around] > 0).any():
                beliefs[joint] = COVERED
    return beliefs

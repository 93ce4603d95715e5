"""The hands in all views of a moment, by the hand detector."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from tracker.capture.camera import Camera
from tracker.capture.frame import CameraFrame
from tracker.detection.image_hands import name_hands
from tracker.fitting.choose_views import choose_views
from tracker.fitting.map_views import map_views
from tracker.fitting.setup import TrackSetup
from tracker.fitting.view_hands import ViewHands
from tracker.landmarks import DetectedHand, HandDetector, default_hand_detector
from tracker.model.scene import PosedScene
from tracker.search.place_in_views import place_in_views

MOST = 11
"""So many of the 21 joints are most of a hand."""


def see_hands(setup: TrackSetup, views: Sequence[CameraFrame], posed: PosedScene, gone: set[int]) -> ViewHands:
    """The hands in all colour images of a moment, looked for where the pose has them, else in whole images.

    A lost hand that one view alone shows is looked for in the others where that one tells it to be, by its size. While
    two views see every hand, one view a frame is looked through for what it does not see, in turn. Of many views
    only half look at all (`choose_views`), while none is gone.

    Args:
        setup: Models and options.
        views: All.
        posed: Where the hands are expected.
        gone: Hands that nobody knows the place of.
    """
    looked_at = [view for view in views if view.frame.color is not None]
    look = Look(setup, looked_at, posed, [hand for hand in setup.hands if hand not in gone])
    turn = range(len(looked_at)) if gone or not looked_at else choose_views(len(looked_at), looked_at[0].frame.index)
    look.follow(turn)
    if look.is_scarce():
        look.follow(sorted(set(range(len(looked_at))) - set(turn)))
        turn = range(len(looked_at))
    for number in turn:
        index = looked_at[number].frame.index
        if look.lacks_hands(number) and (look.is_scarce() or index % len(looked_at) == number):
            look.search(number, (0, 1, 2, 3) if gone else (0, 1 + index % 3))
    look.confirm(gone)
    return look.hands


class Look:
    """What the detector finds in the colour images of a moment, as they are looked at one after the other.

    Args:
        setup: Models and options.
        views: With colour.
        posed: Where the hands are expected.
        known: Those of which that is known.
    """

    def __init__(
        self, setup: TrackSetup, views: Sequence[CameraFrame], posed: PosedScene, known: Sequence[int]
    ) -> None:
        self._setup, self._views, self._posed, self._known = setup, views, posed, known
        self._seen: list[dict[str, DetectedHand]] = [{} for _ in views]

    @property
    def hands(self) -> ViewHands:
        """What was found so far."""
        return ViewHands(tuple(view.camera for view in self._views), tuple(self._seen))

    def follow(self, numbers: Sequence[int]) -> None:
        """Look into views where the pose has the hands; each detector looks at one image at a time."""
        threads = self._setup.options.threads
        idle = [default_hand_detector(number) for number in range(threads)]

        def follow_in(number: int) -> dict[str, DetectedHand]:
            places = self._expect(self._views[number].camera)
            if not places:
                return {}
            detector = idle.pop()
            found = self._find(detector, number, list(places.values()), ())
            idle.append(detector)
            return found

        for number, hands in zip(numbers, map_views(follow_in, numbers, threads), strict=True):
            self._seen[number] = hands

    def search(self, number: int, turns: tuple[int, ...]) -> None:
        """Look through a whole image for the hands that were not seen in it."""
        frame, before = self._views[number].frame, self._seen[number]
        detector = default_hand_detector()
        found = self._find(detector, number, self._order(before), turns)
        if frame.color is not None and len(self._seen) == 1:  # no other view can contradict
            followed = list(before.values())
            found = {
                name: hand
                for name, hand in found.items()
                if any(hand.is_same(other) for other in followed) or detector.sees_wider(frame.color, hand)
            }
        self._seen[number] = found

    def confirm(self, gone: set[int]) -> None:
        """Look in the other views for lost hands that one alone shows, where it tells them to be."""
        setup, pose = self._setup, self._posed.pose.copy()
        seen, placed = self.hands, list[int]()
        for hand in sorted(gone) if len(self._views) > 1 else ():
            name = setup.names[hand]
            own = place_in_views(setup.models[hand], name, seen) if seen.count(name) == 1 else None
            if own is not None:
                pose[setup.scene.pose_slices[hand]] = own
                placed.append(hand)
        self._posed, self._known = setup.scene.pose_at(pose), placed
        for number, view in enumerate(self._views):
            there = self._order(self._seen[number])
            expected = [hand for name, hand in self._expect(view.camera).items() if name not in self._seen[number]]
            if expected:
                self._seen[number] = self._find(default_hand_detector(), number, [*there, *expected], ())

    def lacks_hands(self, number: int) -> bool:
        return len(self._seen[number]) < len(self._setup.hand_names)

    def is_scarce(self) -> bool:
        """Whether two views, or the only one, do not see every hand."""
        enough = min(2, len(self._seen))
        return any(sum(name in hands for hands in self._seen) < enough for name in self._setup.hand_names)

    def _find(
        self, detector: HandDetector, number: int, before: list[DetectedHand], turns: tuple[int, ...]
    ) -> dict[str, DetectedHand]:
        color, names = self._views[number].frame.color, self._setup.hand_names
        found = [] if color is None else detector.find(color, len(names), before, turns)
        return name_hands([hand.with_finger_ends() for hand in found], names)

    def _order(self, hands: Mapping[str, DetectedHand]) -> list[DetectedHand]:
        return [hands[name] for name in self._setup.hand_names if name in hands]

    def _expect(self, camera: Camera) -> dict[str, DetectedHand]:
        """By name the known hands that an image shows, as their pose says."""
        return {
            name: DetectedHand.expected(camera.project(self._posed.landmarks(hand)), name)
            for hand, name in ((hand, self._setup.names[hand]) for hand in self._known)
            if is_inside(self._posed, hand, camera)
        }


def is_inside(posed: PosedScene, hand: int, camera: Camera) -> bool:
    """Whether most of a hand is in an image."""
    return int(np.count_nonzero(camera.can_see(posed.landmarks(hand)))) >= MOST

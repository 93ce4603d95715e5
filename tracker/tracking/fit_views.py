"""Fit a scene to what several views saw at one moment, and judge each hand."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from time import perf_counter

import numpy as np
import numpy.typing as npt

from tracker.capture.camera import Camera
from tracker.capture.frame import CameraFrame, Frame
from tracker.detection.image_hands import name_hands
from tracker.fitting.attempt import UNSETTLED
from tracker.fitting.choose_views import choose_views
from tracker.fitting.depth_view import DepthView
from tracker.fitting.frame_fit import Fit, FitOptions, draw, fit_frame
from tracker.fitting.map_views import map_views
from tracker.fitting.measure_quality import measure_quality
from tracker.fitting.objective import Objective
from tracker.fitting.region import choose_stride, region_around
from tracker.fitting.setup import TrackSetup
from tracker.fitting.sighting import find_hand_pixels
from tracker.fitting.view_contours import ViewContours
from tracker.fitting.view_hands import FOLLOWS, HOLDS, REACH, ViewHands
from tracker.fitting.view_hold import choose_hold
from tracker.landmarks import DetectedHand, HandDetector, default_hand_detector
from tracker.model.scene import PosedScene
from tracker.observation import observe
from tracker.terms.contours import Contours
from tracker.terms.joint_prior import Regularization
from tracker.terms.marked_joints import MarkedJoints
from tracker.terms.residual import Term
from tracker.tracking.view_edges import EDGE_MARGIN, find_edges
from tracker.tracking.view_objects import find_object_contours

Array = npt.NDArray[np.float64]

FAR_REACH = 4.0 * REACH
"""mm; the first iterations of a frame hear joints from farther off, where a hand moved fast."""

ALL_TURNS = (0, 1, 2, 3)

BESIDE_JOINTS = 0.2
"""Share of their weights that the terms of depth have beside detected joints. Of 0.2, 1 and 10 this one follows
`d405_take001` farthest (112, 105 and 93 of 126 frames, depth by stereo matching) and nearest to its marks."""

MOST = 11
"""So many of the 21 joints are most of a hand."""


def see_hands(setup: TrackSetup, views: Sequence[CameraFrame], posed: PosedScene, gone: set[int]) -> ViewHands:
    """The hands in all colour images of a moment, looked for where the pose has them, else in whole images.

    While two views see every hand, one view a frame is looked through for what it does not see, in turn. Of many views
    only half look at all (`choose_views`), while none is gone.

    Args:
        setup: Models and options.
        views: All.
        posed: Where the hands are expected.
        gone: Hands that nobody knows the place of.
    """
    looked_at = [view for view in views if view.frame.color is not None]
    look = _Look(setup, looked_at, posed, [hand for hand in setup.hands if hand not in gone])
    turn = range(len(looked_at)) if gone or not looked_at else choose_views(len(looked_at), looked_at[0].frame.index)
    look.follow(turn)
    if look.is_scarce():
        look.follow(sorted(set(range(len(looked_at))) - set(turn)))
        turn = range(len(looked_at))
    for number in turn:
        index = looked_at[number].frame.index
        if look.lacks_hands(number) and (look.is_scarce() or index % len(looked_at) == number):
            look.search(number, ALL_TURNS if gone else (0, 1 + index % 3))
    return ViewHands(tuple(view.camera for view in looked_at), tuple(look.seen))


class _Look:
    """What the detector finds in the colour images of a moment, as they are looked at one after the other.

    Attributes:
        seen: Of each view the hands by name.
    """

    def __init__(
        self, setup: TrackSetup, views: Sequence[CameraFrame], posed: PosedScene, known: Sequence[int]
    ) -> None:
        self._setup, self._views, self._posed, self._known = setup, views, posed, known
        self.seen: list[dict[str, DetectedHand]] = [{} for _ in views]

    def follow(self, numbers: Sequence[int]) -> None:
        """Look into views where the pose has the hands; each detector looks at one image at a time."""
        threads = self._setup.options.threads
        idle = [default_hand_detector(number) for number in range(threads)]

        def follow_in(number: int) -> dict[str, DetectedHand]:
            places = self._expect(self._views[number].camera)
            if not places:
                return {}
            detector = idle.pop()
            found = _find(detector, self._views[number].frame, self._setup.hand_names, places, ())
            idle.append(detector)
            return found

        for number, hands in zip(numbers, map_views(follow_in, numbers, threads), strict=True):
            self.seen[number] = hands

    def search(self, number: int, turns: tuple[int, ...]) -> None:
        """Look through a whole image for the hands that were not seen in it."""
        frame, before = self._views[number].frame, self.seen[number]
        detector = default_hand_detector()
        found = _find(detector, frame, self._setup.hand_names, before, turns)
        if frame.color is not None and len(self.seen) == 1:  # no other view can contradict
            followed = list(before.values())
            found = {
                name: hand
                for name, hand in found.items()
                if any(hand.is_same(other) for other in followed) or detector.sees_wider(frame.color, hand)
            }
        self.seen[number] = found

    def lacks_hands(self, number: int) -> bool:
        return len(self.seen[number]) < len(self._setup.hand_names)

    def is_scarce(self) -> bool:
        """Whether two views, or the only one, do not see every hand."""
        enough = min(2, len(self.seen))
        return any(sum(name in hands for hands in self.seen) < enough for name in self._setup.hand_names)

    def _expect(self, camera: Camera) -> dict[str, DetectedHand]:
        names = {hand: self._setup.names[hand] for hand in self._known}
        expected = {name: _expect(self._posed, hand, name, camera) for hand, name in names.items()}
        return {name: hand for name, hand in expected.items() if hand is not None}


def fit_views(
    setup: TrackSetup, objective: Objective, seen: ViewHands, views: Sequence[CameraFrame], pose: Array, iterations: int
) -> Fit:
    """Fit the scene from a pose (D,) to what the views saw.

    First far joints alone count, then near ones with depth images, the contours of objects and what the run's terms
    add, at last all contours in colour images.
    """
    scene, names = setup.scene, setup.names
    hold = choose_hold(seen)
    objective = replace(objective, regularization=Regularization(weight=hold.regularization))
    far = seen.add_to(replace(objective, terms={}), scene, names, FAR_REACH)
    first = fit_frame(scene, None, pose, pose, far, FitOptions(iterations=max(1, iterations // 2), fine=0))
    started = perf_counter()
    near = compose_near(objective, setup, seen, views, scene.pose_at(first.pose))
    stages = {"preparing depth": perf_counter() - started}
    objects = find_object_contours(setup, views, scene.pose_at(first.pose))
    held = near if objects is None else replace(near, terms=near.terms | {"objects": objects})
    second = fit_frame(scene, None, first.pose, pose, held, FitOptions(iterations=iterations))
    started = perf_counter()
    last = seen.add_to(near, scene, names, hold.reach)
    drawn = add_contours(last, scene.pose_at(second.pose), views, setup.options.threads)
    stages["finding edges"] = perf_counter() - started
    count = FitOptions(iterations=hold.iterations)
    third = fit_frame(scene, None, second.pose, pose, drawn, count)
    settled = leave_to_depth(drawn, scene.pose_at(third.pose))
    if settled is not None:
        third = fit_frame(scene, None, third.pose, pose, settled, count)
    for fit in (first, second, third):
        for name, seconds in fit.stages.items():
            stages[name] = stages.get(name, 0.0) + seconds
    return Fit(third.pose, (*first.costs, *second.costs, *third.costs), stages)


def add_contours(objective: Objective, posed: PosedScene, views: Sequence[CameraFrame], threads: int = 1) -> Objective:
    """The objective with the edges of each image near the scene."""
    edges = find_edges(posed.vertices, views, EDGE_MARGIN, threads)
    own = ViewContours({camera_id: Contours(seen) for camera_id, seen in edges.items()}, threads)
    return replace(objective, terms=objective.terms | {"contours": own})


def compose_near(
    objective: Objective, setup: TrackSetup, seen: ViewHands, views: Sequence[CameraFrame], posed: PosedScene
) -> Objective:
    """The objective with the joints of all views and the depth images of those that have some, around the scene."""
    depths: dict[str, Term] = {}
    for camera, frame in ((view.camera, view.frame) for view in views):
        region = None if frame.depth is None else region_around(posed.vertices, camera)
        if region is None:
            continue
        hands = seen.of_camera(camera.id)
        if len(hands) == len(setup.hand_names):
            frame = replace(
                frame, is_hand=find_hand_pixels(frame, camera, {name: hand.points for name, hand in hands.items()})
            )
        observation = observe(frame, camera, region, setup.preprocessing, choose_stride(region, camera))
        depths[f"depth_{camera.id}"] = DepthView.of(observation, BESIDE_JOINTS)
    near = seen.add_to(objective, setup.scene, setup.names)
    return replace(near, terms=near.terms | depths)


def leave_to_depth(objective: Objective, posed: PosedScene) -> Objective | None:
    """The objective without detected joints where depth images settle all hands; None where they do not, or are none.

    A joint that the detector tells is some pixels off: a hand that the depth shows wherever it is drawn needs none.
    """
    depths = {name: term for name, term in objective.terms.items() if isinstance(term, DepthView)}
    hands = [index for index, model in enumerate(posed.scene.models) if model.hand]
    for depth in depths.values():
        drawn = draw(posed, depth.observation)
        if any(measure_quality(drawn, depth.observation, hand).misfit > UNSETTLED for hand in hands):
            return None
    if not depths:
        return None
    terms = {name: term for name, term in objective.terms.items() if not isinstance(term, MarkedJoints)}
    whole = {name: DepthView.of(depth.observation, 1.0) for name, depth in depths.items()}
    return replace(objective, terms=terms | whole)


def judge_hand(setup: TrackSetup, seen: ViewHands, posed: PosedScene, hand: int) -> tuple[bool, bool]:
    """Whether a fitted hand is to be believed, and whether it is to be followed from where it is.

    Two views must agree with it to be believed, or one where it is outside of all other images. A hand that is outside
    of all of them is not.
    """
    apart = seen.measure(posed, hand, setup.names[hand])
    inside = sum(_is_inside(posed, hand, camera) for camera in seen.cameras)
    is_held = inside > 0 and int(np.count_nonzero(apart < HOLDS)) >= min(2, inside)
    return is_held, is_held or bool(np.any(apart < FOLLOWS))


def _find(
    detector: HandDetector,
    frame: Frame,
    names: tuple[str, ...],
    before: Mapping[str, DetectedHand],
    turns: tuple[int, ...],
) -> dict[str, DetectedHand]:
    if frame.color is None:
        return {}
    found = detector.find(frame.color, len(names), [before[name] for name in names if name in before], turns)
    return name_hands(found, names)


def _expect(posed: PosedScene, hand: int, name: str, camera: Camera) -> DetectedHand | None:
    """A hand as its pose says that an image shows it; None where most of it is outside."""
    if not _is_inside(posed, hand, camera):
        return None
    return DetectedHand.expected(camera.project(posed.landmarks(hand)), name)


def _is_inside(posed: PosedScene, hand: int, camera: Camera) -> bool:
    """Whether most of a hand is in an image."""
    return int(np.count_nonzero(camera.can_see(posed.landmarks(hand)))) >= MOST

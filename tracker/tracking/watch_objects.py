"""Judge the objects of a followed frame, and look for those that are lost."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from tracker.capture.camera import Camera
from tracker.capture.frame import Frame
from tracker.fitting.contour_quality import ContourQuality
from tracker.fitting.frame_fit import draw
from tracker.fitting.object_quality import ObjectQuality, measure_object_quality
from tracker.fitting.region import region_around
from tracker.fitting.setup import TrackSetup
from tracker.observation import observe
from tracker.search.find_object import FoundObject, ObjectSearch, find_object
from tracker.search.leave_out import is_in_forearm
from tracker.search.part import Part

Array = npt.NDArray[np.float64]

OBJECT_STATUSES = ("ok", "lost", "recovered", "hidden")

NEAR_EVERY, FAR_EVERY = 2, 10
"""A lost object is looked for near its last place in frames whose number these divide, and in the whole image."""

NEARBY = ObjectSearch(places=8, rotations=24, hypotheses=120, rough=8, fine=2)

GAIN = 0.05
"""A pose that was found must have a merit higher by this than the one that was followed."""


@dataclass(frozen=True)
class WatchedObject:
    """An object in one frame.

    Attributes:
        status: One of OBJECT_STATUSES; the pose of a lost or hidden object is a guess.
        quality: How well its pose explains the frame: its depth image, or the edges of its colour views.
    """

    status: str
    quality: ObjectQuality | ContourQuality


def watch_objects(
    frame: Frame, camera: Camera, setup: TrackSetup, pose: Array, known: dict[int, ObjectQuality] | None, recover: bool
) -> tuple[Array, list[WatchedObject]]:
    """The pose (D,) with lost objects put where they were found again, and its objects, in order.

    Sleeves and cuffs are no skin and look like many an object. So forearms are left out of the search, also those of
    hands that are lost, where they were last; and an object that is in a forearm is lost, however well it fits.

    Args:
        frame: Undistorted.
        camera: Its camera.
        setup: Models and options.
        pose: (D,) after the fit.
        known: Of each object at that pose; None where the hands are lost, so that their part of the pose means nothing.
        recover: Look for what is lost.
    """
    if not setup.objects or frame.depth is None:
        return pose, []
    pose, watched = pose.copy(), []
    hands = [index for index in setup.hands if np.any(pose[setup.scene.pose_slices[index]])]
    for index in setup.objects:
        quality = _measure(frame, camera, setup, pose, index) if known is None else known[index]
        is_arm = known is not None and _is_in_forearm(setup, pose, index, hands)
        status = "lost" if is_arm else quality.status
        if status != "ok" and recover and frame.index % NEAR_EVERY == 0:
            found = _look_for(frame, camera, setup, pose, index, hands)
            least = 0.0 if is_arm else quality.score + GAIN
            if found is not None and found.merit > least:
                pose[setup.scene.pose_slices[index]] = found.pose
                status, quality = "recovered", found.quality
        watched.append(WatchedObject(status, quality))
    return pose, watched


def _look_for(
    frame: Frame, camera: Camera, setup: TrackSetup, pose: Array, index: int, hands: list[int]
) -> FoundObject | None:
    """An object where it is to be believed: near its last place, or now and then in the whole image."""
    search = ObjectSearch() if frame.index % FAR_EVERY == 0 else NEARBY
    slices = setup.scene.pose_slices
    others = [(setup.models[i], pose[slices[i]]) for i in (*hands, *setup.objects) if i != index]
    found = find_object(setup.models[index], frame, camera, setup.preprocessing, others, pose[slices[index]], search)
    return found if found is not None and found.is_believable else None


def _is_in_forearm(setup: TrackSetup, pose: Array, index: int, hands: list[int]) -> bool:
    """Whether an object has been mistaken for a sleeve."""
    posed = setup.scene.pose_at(pose)
    middle = posed.vertices[setup.scene.vertex_slices[index]].mean(axis=0)
    return is_in_forearm(middle, [posed.landmarks(hand) for hand in hands])


def stop_unseen(setup: TrackSetup, pose: Array, earlier: Array, watched: Sequence[WatchedObject]) -> Array:
    """The pose before (D,), to predict from, with objects that were not followed from there at rest."""
    earlier = earlier.copy()
    for index, one in zip(setup.objects, watched, strict=False):
        if one.status != "ok":
            earlier[setup.scene.pose_slices[index]] = pose[setup.scene.pose_slices[index]]
    return earlier


def _measure(frame: Frame, camera: Camera, setup: TrackSetup, pose: Array, index: int) -> ObjectQuality:
    """Quality of an object in a scene without hands."""
    part = Part.without(setup, setup.hands)
    scene, place = part.setup.scene, setup.objects.index(index)
    posed = scene.pose_at(part.take(pose))
    region = region_around(posed.vertices[scene.vertex_slices[place]], camera)
    if region is None:
        return ObjectQuality.of_nothing()
    seen = observe(frame, camera, region, setup.preprocessing)
    return measure_object_quality(draw(posed, seen), seen, place)

"""The hands of an image as the hand detector sees them: found by a job before, or on the spot."""

from __future__ import annotations

import uuid
from typing import TYPE_CHECKING

from server.access.places import Place
from server.compute import ComputeContext
from server.suggestions.cache import RecordingCache
from server.suggestions.schemas import SuggestedJoint, Suggestion
from server.suggestions.service import Recorded

if TYPE_CHECKING:
    from tracker import Annotation

OCCLUDED = 1


def suggest_detected(
    context: ComputeContext, recorded: Recorded, job_id: uuid.UUID | None, place: Place
) -> list[Suggestion]:
    """The hands of an image; `place.hand` is ignored. None where the camera has depth alone, or none is seen.

    Args:
        context: Keeps recordings and what was found.
        recorded: The recording.
        job_id: The job that has looked at the whole recording, where one has.
        place: The image.
    """
    from tracker.detection import DETECTOR_LABEL

    cache = context.keep(RecordingCache)
    found = None if job_id is None else cache.detections(job_id)
    if found is not None and found.covers(place.frame, place.camera):
        hands = found.at(place.frame, place.camera)
    else:
        hands = _look(cache, recorded, place)
    return [
        Suggestion(
            source="detector",
            label=DETECTOR_LABEL,
            camera=hand.camera,
            frame=hand.frame,
            hand="right" if hand.hand == "right" else "left",
            track_id=None,
            model="",
            joints=[
                SuggestedJoint(px=(x, y), guess="occluded" if v == OCCLUDED else "visible") if v else None
                for x, y, v in hand.points.tolist()
            ],
        )
        for hand in hands
    ]


def _look(cache: RecordingCache, recorded: Recorded, place: Place) -> tuple[Annotation, ...]:
    """Look at one image, without the images before it."""
    from tracker.detection import find_image_hands
    from tracker.landmarks import default_hand_detector

    recording = cache.recording(recorded.id, recorded.content_key)
    camera = recording.camera(place.camera)
    if not camera.has_color:
        return ()
    frame = cache.frame(recorded.id, recorded.content_key, place.camera, place.frame)
    found = find_image_hands(default_hand_detector(), frame, float(camera.K[0, 0]), recording.hands)
    return tuple(hand.annotate(frame) for hand in found)

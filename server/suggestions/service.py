"""Where a track, or a model fitted to the joints placed so far, would have the joints of a hand."""

from __future__ import annotations

import uuid
from collections.abc import Sequence as Many
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from sqlalchemy.orm import Session

from server.access.places import Place
from server.compute import ComputeContext
from server.errors import InvalidError, NotFoundError
from server.sequences.models import SequenceRow
from server.suggestions.cache import RecordingCache
from server.suggestions.schemas import SuggestedJoint, Suggestion
from server.tracks.best_tracks import find_best_tracks
from server.tracks.models import TrackRow
from server.tracks.service import get_track
from tracker import say_count

if TYPE_CHECKING:
    from tracker import ArticulatedModel, QuickFit


@dataclass(frozen=True)
class Recorded:
    """The recording that is annotated, as suggestions need it."""

    id: uuid.UUID
    content_key: str

    @classmethod
    def of(cls, row: SequenceRow) -> Recorded:
        return cls(row.id, row.content_key)


@dataclass(frozen=True)
class ChosenTrack:
    """The track that suggestions come from."""

    id: uuid.UUID
    name: str


def choose_track(session: Session, sequence_id: uuid.UUID, track_id: uuid.UUID | None) -> ChosenTrack | None:
    """The track asked for, or the best of the recording, if it has any."""
    if track_id is None:
        best = find_best_tracks(session, [sequence_id]).get(sequence_id)
        if best is None:
            return None
        track_id = uuid.UUID(str(best["best_track"]["id"]))
    row: TrackRow = get_track(session, track_id)
    if row.sequence_id != sequence_id:
        raise NotFoundError(f"The track {track_id} is of another recording.")
    return ChosenTrack(row.id, row.name)


def suggest_from_track(
    context: ComputeContext, recorded: Recorded, chosen: ChosenTrack, place: Place
) -> list[Suggestion]:
    """The hands of a track in one image; none where the track was lost or does not reach. `place.hand` is ignored."""
    from tracker import view_track_hands

    cache = context.keep(RecordingCache)
    track, rows = cache.track(chosen.id)
    row = rows.get(place.frame)
    if row is None or track.status[row] == "lost":
        return []
    camera = cache.recording(recorded.id, recorded.content_key).camera(place.camera)
    found = view_track_hands(track, row, camera)
    return [
        Suggestion(
            source="track",
            label=chosen.name,
            camera=place.camera,
            frame=place.frame,
            hand="right" if hand == "right" else "left",
            track_id=chosen.id,
            model=next(m.name for n, m in zip(track.setup.names, track.setup.models, strict=True) if n == hand),
            joints=_describe(view, camera.width, camera.height),
        )
        for hand, view in found.items()
    ]


def suggest_by_fit(
    context: ComputeContext,
    recorded: Recorded,
    chosen: ChosenTrack | None,
    place: Place,
    points: Many[Many[float]],
) -> Suggestion:
    """A hand fitted to its placed joints; of the recording's own size where a track found that out."""
    from tracker import MIN_FIT_JOINTS, fit_marked

    placed = sum(1 for _, _, v in points if v)
    if placed < MIN_FIT_JOINTS:
        raise InvalidError(
            f"{say_count(placed, 'joint is', 'joints are')} placed; a model fit needs {MIN_FIT_JOINTS} or more. "
            "Place some more."
        )
    cache = context.keep(RecordingCache)
    camera = cache.recording(recorded.id, recorded.content_key).camera(place.camera)
    frame = cache.frame(recorded.id, recorded.content_key, place.camera, place.frame) if camera.has_depth else None
    model = _find_model(cache, chosen, place.hand)
    fit = fit_marked(model, np.array(points, dtype=np.float64), camera, frame)
    return Suggestion(
        source="fit",
        label=f"model fit of {say_count(placed, 'joint')}",
        camera=place.camera,
        frame=place.frame,
        hand="right" if place.hand == "right" else "left",
        track_id=None,
        model=model.name,
        joints=_describe(fit, camera.width, camera.height),
    )


def warm_up(_context: ComputeContext) -> None:
    """Fit a hand and look at an image that nobody asked for: kernels and networks are loaded when somebody waits."""
    from tracker import Camera, Frame, default_hand, fit_marked
    from tracker.detection import find_image_hands
    from tracker.landmarks import default_hand_detector

    width, height, focal = 640, 480, 600.0
    K = np.array([[focal, 0, width / 2], [0, focal, height / 2], [0, 0, 1]])
    step = height / 40
    points = [[width / 2 + step * (joint % 5), height / 2 - step * (joint // 5), 2.0] for joint in range(21)]
    fit_marked(default_hand("right"), np.array(points), Camera("warm-up", width, height, K))
    image = Frame(0, "warm-up", np.zeros((height, width, 3), dtype=np.uint8), None)
    find_image_hands(default_hand_detector(), image, focal, ("right",))


def _find_model(cache: RecordingCache, chosen: ChosenTrack | None, hand: str) -> ArticulatedModel:
    from tracker import default_hand

    if chosen is not None:
        setup = cache.track(chosen.id)[0].setup
        if hand in setup.names:
            return setup.models[setup.names.index(hand)]
    return default_hand(hand)


def _describe(view: QuickFit, width: int, height: int) -> list[SuggestedJoint | None]:
    return [
        SuggestedJoint(px=(round(float(x), 2), round(float(y), 2)), guess="occluded" if hidden else "visible")
        if -0.5 <= x < width - 0.5 and -0.5 <= y < height - 0.5
        else None
        for (x, y), hidden in zip(view.joints, view.is_hidden, strict=True)
    ]

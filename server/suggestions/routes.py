"""`/sequences/{sequence_id}/suggestions`: where a machine would have the joints."""

from __future__ import annotations

import uuid
from collections.abc import Sequence
from dataclasses import replace
from typing import Annotated

from fastapi import APIRouter, Query
from sqlalchemy.orm import Session

from server.access.places import HiddenPlaces, Place
from server.access.policy import check_read, find_hidden
from server.access.service import CurrentAccount
from server.annotations.routes import CameraPath, get_annotated_sequence
from server.annotations.schemas import Hand
from server.annotations.service import check_place, check_points
from server.compute import ComputeDep
from server.database import AdmissionDep
from server.database.frames import FramePath
from server.database.paging import Page
from server.errors import error_responses
from server.jobs.detections import find_detections
from server.suggestions import service
from server.suggestions.detector import suggest_detected
from server.suggestions.schemas import FitRequest, Suggestion

router = APIRouter(
    prefix="/sequences/{sequence_id}/suggestions/{camera}/{frame}",
    tags=["suggestions"],
    responses=error_responses(404),
)

TrackQuery = Annotated[
    uuid.UUID | None, Query(description="The track to look at; the recording's best one when not given.")
]


@router.get("")
async def list_suggestions(
    sequence_id: uuid.UUID,
    camera: CameraPath,
    frame: FramePath,
    admission: AdmissionDep,
    compute: ComputeDep,
    account: CurrentAccount,
    track_id: TrackQuery = None,
) -> Page[Suggestion]:
    """The hands of an image as a track has them; empty where it was lost, where there is none, or one marks blindly."""

    def look(session: Session) -> tuple[Place, service.Recorded, service.ChosenTrack | None, list[HiddenPlaces]]:
        sequence = get_annotated_sequence(sequence_id, session)
        place = check_place(sequence, camera, frame, "right")
        chosen = service.choose_track(session, sequence_id, track_id)
        return place, service.Recorded.of(sequence), chosen, find_hidden(session, account, sequence_id)

    place, recorded, chosen, hidden = await admission.read(look)
    items = [] if chosen is None else await compute.run(service.suggest_from_track, recorded, chosen, place)
    return _show(items, place, hidden)


@router.get("/detector")
async def list_detected(
    sequence_id: uuid.UUID,
    camera: CameraPath,
    frame: FramePath,
    admission: AdmissionDep,
    compute: ComputeDep,
    account: CurrentAccount,
) -> Page[Suggestion]:
    """The hands of an image as the hand detector sees them; empty where it sees none, or where one marks blindly.

    They come from the last job that looked at the whole recording; where there is none the image is looked at now.
    """

    def look(session: Session) -> tuple[Place, service.Recorded, uuid.UUID | None, list[HiddenPlaces]]:
        sequence = get_annotated_sequence(sequence_id, session)
        place = check_place(sequence, camera, frame, "right")
        job_id = find_detections(session, sequence_id)
        return place, service.Recorded.of(sequence), job_id, find_hidden(session, account, sequence_id)

    place, recorded, job_id, hidden = await admission.read(look)
    return _show(await compute.run(suggest_detected, recorded, job_id, place), place, hidden)


def _show(items: Sequence[Suggestion], place: Place, hidden: Sequence[HiddenPlaces]) -> Page[Suggestion]:
    """Those that whoever asks may see."""
    seen = [item for item in items if not any(replace(place, hand=item.hand) in places for places in hidden)]
    return Page(items=seen, next_cursor=None)


@router.post("/{hand}/fit")
async def fit_suggestion(
    sequence_id: uuid.UUID,
    camera: CameraPath,
    frame: FramePath,
    hand: Hand,
    body: FitRequest,
    admission: AdmissionDep,
    compute: ComputeDep,
    account: CurrentAccount,
) -> Suggestion:
    """A hand model fitted to the joints placed so far (at least 4), and to the depth image where there is one.

    Nothing is stored.
    """

    def look(session: Session) -> tuple[service.Recorded, service.ChosenTrack | None, Place, list[list[float]]]:
        sequence = get_annotated_sequence(sequence_id, session)
        place = check_place(sequence, camera, frame, hand)
        check_read(session, account, place)
        points = check_points(sequence, place, body.points)
        return service.Recorded.of(sequence), service.choose_track(session, sequence_id, None), place, points

    return await compute.run(service.suggest_by_fit, *await admission.read(look))

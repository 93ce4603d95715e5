"""`/tracks`."""

from __future__ import annotations

import uuid
from pathlib import PurePosixPath
from typing import Annotated, Literal

from fastapi import APIRouter, Depends
from fastapi.responses import FileResponse
from sqlalchemy import select
from sqlalchemy.orm import Session
from starlette.requests import HTTPConnection

from server.access.audit import record_act
from server.access.service import LeadAccount
from server.compute import ComputeDep
from server.database import Base, SessionDep
from server.database.frames import FramePath
from server.database.paging import Cursor, Limit, Page
from server.deprecation import deprecated
from server.download import name_download
from server.errors import NotFoundError, error_responses
from server.storage import StorageDep
from server.tracks import service
from server.tracks.cameras import describe_tracks
from server.tracks.exports import MEDIA_TYPES, find_export
from server.tracks.models import TrackRow
from server.tracks.overlay import Overlays
from server.tracks.schemas import FrameEnergy, TrackFrames, TrackJoints, TrackOut
from server.tracks.seen_track import SeenTrack

router = APIRouter(tags=["tracks"], responses=error_responses())

IMMUTABLE = "private, max-age=31536000, immutable"


async def get_overlays(connection: HTTPConnection) -> Overlays:
    """The app's cache of overlays."""
    state = connection.app.state
    if not hasattr(state, "overlays"):
        state.overlays = Overlays()
    return state.overlays


OverlaysDep = Annotated[Overlays, Depends(get_overlays)]


@router.get("/tracks")
def list_tracks(
    session: SessionDep,
    sequence_id: uuid.UUID | None = None,
    cursor: Cursor = None,
    limit: Limit = 100,
) -> Page[TrackOut]:
    """Tracks, the newest first."""
    rows, next_cursor = service.list_tracks(session, sequence_id, cursor, limit)
    return Page(items=describe_tracks(session, rows), next_cursor=next_cursor)


@router.get("/tracks/{track_id}", responses=error_responses(404))
def get_track(track_id: uuid.UUID, session: SessionDep) -> TrackOut:
    """One track."""
    return describe_tracks(session, [service.get_track(session, track_id)])[0]


@router.delete("/tracks/{track_id}", responses=error_responses(404))
def delete_track(track_id: uuid.UUID, session: SessionDep, lead: LeadAccount) -> TrackOut:
    """Delete a track; it can be restored."""
    record_act(session, lead.id, "track.delete", "track", track_id)
    return describe_tracks(session, [service.delete_track(session, track_id)])[0]


@router.post(
    "/tracks/{track_id}/restore", responses=error_responses(404, 409), **deprecated("/bin/track/{track_id}/restore")
)
def restore_track(track_id: uuid.UUID, session: SessionDep, lead: LeadAccount) -> TrackOut:
    """Restore a deleted track."""
    record_act(session, lead.id, "track.restore", "track", track_id)
    return describe_tracks(session, [service.restore_track(session, track_id)])[0]


@router.get("/tracks/{track_id}/frames", responses=error_responses(404))
def get_track_frames(track: SeenTrack, storage: StorageDep) -> TrackFrames:
    """Status, timing and quality of every frame, as columns."""
    return TrackFrames.model_validate(service.read_columns(storage.folder("tracks", track.id)))


@router.get("/tracks/{track_id}/frames/{frame}/energy", responses=error_responses(404))
def get_frame_energy(track: SeenTrack, frame: FramePath, storage: StorageDep) -> FrameEnergy:
    """Energy of one frame's fit by term and iteration."""
    return FrameEnergy.model_validate(service.read_energy(storage.folder("tracks", track.id), frame))


@router.get("/tracks/{track_id}/joints", responses=error_responses(404))
def get_track_joints(track: SeenTrack, storage: StorageDep, camera: str | None = None) -> TrackJoints:
    """Joints of every frame as seen by one camera, the first if none is named."""
    from tracker import load_sequence

    cameras = [c.id for c in load_sequence(storage.folder("sequences", track.sequence_id)).cameras]
    if camera is not None and camera not in cameras:
        raise NotFoundError(f"The recording has no camera {camera!r}; it has {', '.join(cameras)}.")
    index = 0 if camera is None else cameras.index(camera)
    names, frames, points = service.read_joints(storage.folder("tracks", track.id), index)
    return TrackJoints(joint_names=names, frames=frames, points=points)


@router.get(
    "/tracks/{track_id}/cameras/{camera}/frames/{frame}/overlay.png",
    response_class=FileResponse,
    responses={200: {"content": {"image/png": {}}}} | error_responses(404),
)
def get_track_overlay(
    track: SeenTrack, camera: str, frame: FramePath, storage: StorageDep, overlays: OverlaysDep
) -> FileResponse:
    """The meshes of one frame as the camera sees them, on transparent ground. It never changes."""
    folder = storage.folder("tracks", track.id)
    path = overlays.find(folder, storage.folder("sequences", track.sequence_id), frame, camera)
    return FileResponse(path, media_type="image/png", headers={"Cache-Control": IMMUTABLE})


@router.get(
    "/tracks/{track_id}/cameras/{camera}/frames/{frame}/unknown.png",
    response_class=FileResponse,
    responses={200: {"content": {"image/png": {}}}} | error_responses(404),
)
def get_track_unknown(
    track: SeenTrack, camera: str, frame: FramePath, storage: StorageDep, overlays: OverlaysDep
) -> FileResponse:
    """What the run left out near the hands as neither hand nor a model, in one colour on transparent ground.

    Only the depth camera that was tracked in shows any.
    """
    folder = storage.folder("tracks", track.id)
    path = overlays.find(folder, storage.folder("sequences", track.sequence_id), frame, camera, "unknown")
    return FileResponse(path, media_type="image/png", headers={"Cache-Control": IMMUTABLE})


@router.get(
    "/tracks/{track_id}/files/{name}",
    response_class=FileResponse,
    responses={200: {"content": {"application/octet-stream": {}}}} | error_responses(404),
)
def download_track_file(
    track: SeenTrack, name: Literal["track.npz", "summary.json"], session: SessionDep, storage: StorageDep
) -> FileResponse:
    """A file of the track."""
    path = storage.folder("tracks", track.id) / name
    if not path.is_file():
        raise NotFoundError(f"The file {name} of this track is missing in the data folder.")
    headers = _name_file(session, track, name)
    return FileResponse(path, media_type="application/octet-stream", headers=headers)


@router.get(
    "/tracks/{track_id}/export/{kind}",
    response_class=FileResponse,
    responses={200: {"content": {kind: {} for kind in sorted(set(MEDIA_TYPES.values()))}}} | error_responses(404),
)
def export_track(
    track: SeenTrack,
    kind: Literal["npz", "csv", "glb", "mano"],
    session: SessionDep,
    storage: StorageDep,
    compute: ComputeDep,
) -> FileResponse:
    """The track for other programs: npz, CSV of its joints, glTF animation (GLB) or MANO-style parameters (npz)."""
    folder = storage.folder("tracks", track.id)
    path = compute.ask(find_export, folder, storage.folder("sequences", track.sequence_id), kind)
    headers = _name_file(session, track, path.name.partition("-")[2])
    return FileResponse(path, media_type=MEDIA_TYPES[kind], headers=headers)


def _name_file(session: Session, track: TrackRow, name: str) -> dict[str, str]:
    """A file of a track is called after its recording and the track."""
    sequences = Base.metadata.tables["sequences"]  # a table of a room that this one does not see
    recording = session.scalars(select(sequences.c.name).where(sequences.c.id == track.sequence_id)).one()
    own = () if recording in track.name else (recording,)
    return name_download(*own, track.name, PurePosixPath(name).stem, suffix=PurePosixPath(name).suffix)

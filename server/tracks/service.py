"""What can be done with tracks."""

from __future__ import annotations

import json
import uuid
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
from sqlalchemy import func, select
from sqlalchemy.orm import Session

from server.database import utc_now
from server.database.paging import fetch_page
from server.errors import ConflictError, NotFoundError
from server.tracks.cameras import find_digests
from server.tracks.models import TrackRow

AREA = "tracks"


class TrackNotFoundError(NotFoundError):
    """There is no track of this id, or it was deleted."""


def get_track(session: Session, track_id: uuid.UUID, *, deleted: bool = False) -> TrackRow:
    """A track that is there; with `deleted` also one that was deleted."""
    track = session.get(TrackRow, track_id)
    if track is None or (track.deleted_at is not None and not deleted):
        raise TrackNotFoundError(f"There is no track {track_id}." if track is None else "This track was deleted.")
    return track


def list_tracks(
    session: Session, sequence_id: uuid.UUID | None, cursor: str | None, limit: int
) -> tuple[Sequence[TrackRow], str | None]:
    """Newest first, of one recording if so asked."""
    query = select(TrackRow).where(TrackRow.deleted_at.is_(None))
    if sequence_id is not None:
        query = query.where(TrackRow.sequence_id == sequence_id)
    return fetch_page(session, query, (TrackRow.created_at, TrackRow.id), cursor, limit)


def add_track(
    session: Session, folder: Path, track_id: uuid.UUID, sequence_id: uuid.UUID, job_id: uuid.UUID | None
) -> TrackRow:
    """Make the row of a track whose files are in `folder`; the row that is there when this was done before."""
    row = session.get(TrackRow, track_id)
    if row is not None:
        return row
    summary = json.loads((folder / "summary.json").read_text())
    with np.load(folder / "track.npz", allow_pickle=False) as arrays:
        frames = arrays["frame"]
        joint_names = [str(name) for name in arrays["joint_names"]]
    hands = [side for side in ("right", "left") if any(name.startswith(f"{side}/") for name in joint_names)]
    count = session.scalar(select(func.count()).select_from(TrackRow).where(TrackRow.sequence_id == sequence_id)) or 0
    row = TrackRow(
        id=track_id,
        sequence_id=sequence_id,
        job_id=job_id,
        name=f"Track {count + 1}",
        frame_first=int(frames[0]) if len(frames) else 0,
        frame_count=len(frames),
        hands=hands,
        summary=summary,
        cameras_digest=find_digests(session, [sequence_id]).get(sequence_id),
    )
    session.add(row)
    session.flush()
    return row


def delete_track(session: Session, track_id: uuid.UUID) -> TrackRow:
    """Hide a track; `restore_track` brings it back."""
    track = get_track(session, track_id)
    track.deleted_at = utc_now()
    session.flush()
    return track


def restore_track(session: Session, track_id: uuid.UUID) -> TrackRow:
    """Restore a deleted track."""
    track = get_track(session, track_id, deleted=True)
    if track.deleted_at is None:
        raise ConflictError("The track is not deleted.")
    track.deleted_at = None
    session.flush()
    return track


def read_columns(folder: Path) -> dict[str, Any]:
    """What is known of every frame, as columns of equal length. What was not measured is None."""
    from tracker import TrackChunk
    from tracker.inspection import find_term_look

    chunk = TrackChunk.load(folder / "frames.npz")
    with np.load(folder / "track.npz", allow_pickle=False) as arrays:
        status = arrays["status"].tolist()
    costs = chunk.costs
    if chunk.iteration_costs.shape[1]:
        costs = np.where(np.isfinite(chunk.iteration_costs).any(axis=1), costs, np.nan)
    return {
        "frame": chunk.frame.tolist(),
        "status": status,
        "seconds": _as_list(chunk.seconds),
        "depth_residual_mm": _as_list(chunk.depth_residual_mm),
        "silhouette_iou": _as_list(chunk.silhouette_iou),
        "iterations": chunk.iterations.tolist(),
        "costs": {str(name): _as_list(costs[:, place]) for place, name in enumerate(chunk.cost_names)},
        "terms": [find_term_look(str(name)) for name in chunk.cost_names],
        "stages": {str(name): _as_list(chunk.stages[:, place]) for place, name in enumerate(chunk.stage_names)},
        "views": _read_views(folder / "views.npz"),
    }


def _read_views(path: Path) -> list[dict[str, Any]]:
    """How well each camera agrees, of the worse hand of every frame; nothing where one camera was tracked in."""
    if not path.is_file():
        return []
    with np.load(path, allow_pickle=False) as arrays:
        far = {name: np.fmax.reduce(arrays[name], axis=2) for name in ("fit_px", "left_out_px")}
        worse = far | {"weight": np.fmin.reduce(arrays["weight"], axis=2)}
        names = arrays["camera_ids"].tolist()
    return [
        {"camera": camera, **{name: _as_list(np.round(values[:, place], 3)) for name, values in worse.items()}}
        for place, camera in enumerate(names)
    ]


def read_energy(folder: Path, frame: int) -> dict[str, Any]:
    """Energy of one frame by term and iteration; terms that had no part in it are left out."""
    from tracker import TrackChunk

    chunk = TrackChunk.load(folder / "frames.npz")
    rows = np.flatnonzero(chunk.frame == frame)
    if len(rows) == 0:
        raise NotFoundError(f"The track has no frame {frame}; it has {chunk.frame[0]} to {chunk.frame[-1]}.")
    table = chunk.iteration_costs
    costs = table[rows[0]] if table.shape[1] else np.zeros((0, len(chunk.cost_names)), dtype=np.float32)
    done = int(np.isfinite(costs).any(axis=1).sum())
    return {
        "frame": frame,
        "is_recorded": table.shape[1] > 0,
        "iterations": done,
        "costs": {
            str(name): _as_list(costs[:done, place])
            for place, name in enumerate(chunk.cost_names)
            if np.isfinite(costs[:, place]).any()
        },
    }


def read_joints(folder: Path, camera_index: int) -> tuple[list[str], list[int], list[list[list[float | None]]]]:
    """Names, frames and (T, J, 2) px of the joints in one camera; None where a joint is behind it."""
    with np.load(folder / "track.npz", allow_pickle=False) as arrays:
        points = np.round(arrays["joints_2d"][:, camera_index].astype(np.float64), 3)
        names = [str(name) for name in arrays["joint_names"]]
        frames = arrays["frame"].tolist()
    as_objects = points.astype(object)
    as_objects[~np.isfinite(points)] = None
    return names, frames, as_objects.tolist()


def _as_list(column: np.ndarray) -> list[float | None]:
    return [float(value) if np.isfinite(value) else None for value in column]

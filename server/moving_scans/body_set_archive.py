"""A set of accepted frames as one zip: a motion, registrations, meshes, the person's model, and the lineage."""

from __future__ import annotations

import json
import tempfile
import uuid
import zipfile
from pathlib import Path
from typing import Any

import numpy as np

from server.compute import ComputeContext
from server.errors import StudioError
from server.moving_scans.accepted import Accepted
from server.moving_scans.body_sets import describe_body_sets, get_body_set, read_members
from server.moving_scans.models import MovingRegistrationRow, MovingScanRow
from server.moving_scans.storing import AREA, BODY, TEMPLATE, TEMPLATES
from server.storage import Storage
from server.storage.digest import compute_digest

MESH = "body.ply"
README = """motion.npz    poses as AMASS keeps them, 156 numbers a frame; `handloom body pose` makes meshes
frames/       of each frame body.npz: the registered surface, pose and distances
meshes/       of each frame the registered surface as PLY, m, coordinates of the scan
models/       the person's own model, by the registration that made it
lineage.json  of each frame the scan's file, the registration, its job and prior, the decision and who made it
"""


class DamagedFrameError(StudioError):
    """A registered frame is missing or is not what was accepted."""

    status_code = 409


def write_archive(context: ComputeContext, set_id: uuid.UUID, path: Path) -> None:
    """Write the zip of a set to a file."""
    from tracker.bodies import BodyMotion, load_body_registration, save_body_motion

    with context.database.reading() as session:
        row = get_body_set(session, set_id)
        scan = session.get_one(MovingScanRow, row.moving_scan_id)
        members = read_members(session, row)
        told = describe_body_sets(session, [row])[0].model_dump(mode="json")
        registrations = {
            id_: session.get_one(MovingRegistrationRow, id_) for id_ in {each.registration_id for each in members}
        }
    poses, places = [], []
    with zipfile.ZipFile(path, "w", zipfile.ZIP_STORED) as archive:
        archive.writestr("README.txt", README)
        for each in members:
            folder = check_member(context.storage, row.name, each)
            found = load_body_registration(folder / BODY)
            poses.append(found.state.pose)
            places.append(found.state.translation)
            archive.write(folder / BODY, f"frames/{each.frame:06d}/{BODY}")
            archive.write(folder / MESH, f"meshes/{each.frame:06d}.ply")
        templates = {each.template_id: each.population for each in registrations.values()}
        first = registrations[members[0].registration_id]
        shape = _find_shape(context.storage, first)
        motion = BodyMotion(np.array(poses), np.array(places), shape, scan.fps, first.population)
        with tempfile.TemporaryDirectory() as folder:
            save_body_motion(motion, Path(folder) / "motion.npz")
            archive.write(Path(folder) / "motion.npz", "motion.npz")
        for id_ in templates:
            archive.write(context.storage.folder(TEMPLATES, id_) / TEMPLATE, f"models/{id_}.npz")
        lineage = describe_lineage(told, scan, members, registrations)
        archive.writestr("lineage.json", json.dumps(lineage, indent=1))


def describe_lineage(
    told: dict[str, Any],
    scan: MovingScanRow,
    members: list[Accepted],
    registrations: dict[uuid.UUID, MovingRegistrationRow],
) -> dict[str, Any]:
    """From the scans to the set, ready for JSON.

    Args:
        told: The set as the API gives it.
        scan: What it is of.
        members: Its frames.
        registrations: Those that its frames are of, by id.
    """
    return {
        "version": 1,
        "set": told,
        "moving_scan": {"id": str(scan.id), "name": scan.name, "subject": scan.subject, "sha256": scan.digest}
        | {"fps": scan.fps, "metres_per_unit": scan.metres_per_unit},
        "registrations": [
            {
                "id": str(row.id),
                "job": str(row.job_id),
                "parent": None if row.parent_id is None else str(row.parent_id),
                "model": f"models/{row.template_id}.npz",
                "prior": row.prior,
                "holds_hands": row.holds_hands,
                "has_velocity": row.has_velocity,
                "population": row.population,
                "frames": [row.first_frame, row.last_frame],
            }
            for row in sorted(registrations.values(), key=lambda row: row.created_at)
        ],
        "frames": [
            {
                "row": number,
                "frame": each.frame,
                "scan": scan.frames[each.frame]["name"],
                "scan_sha256": scan.frames[each.frame]["digest"],
                "registration": str(each.registration_id),
                "body_sha256": each.digest,
                "decision": str(each.decision_id),
            }
            for number, each in enumerate(members)
        ],
    }


def check_member(storage: Storage, name: str, member: Accepted) -> Path:
    """The folder of a frame, whose file must be what was accepted."""
    folder = storage.folder(AREA, member.frame_registration_id)
    if not (folder / BODY).is_file() or compute_digest(folder / BODY) != member.digest:
        raise DamagedFrameError(
            f"Frame {member.frame} of “{name}” was changed after it was accepted. Restore "
            f"{AREA}/{member.frame_registration_id} from a backup; nothing was written."
        )
    return folder


def _find_shape(storage: Storage, row: MovingRegistrationRow) -> np.ndarray:
    """Coefficients that come nearest to the person's own model."""
    from tracker import load_blend_model
    from tracker.bodies import body_model, find_shape

    own = load_blend_model(storage.folder(TEMPLATES, row.template_id) / TEMPLATE)
    return find_shape(body_model(row.population), own)  # type: ignore[arg-type]  # as the schema lets it pass

"""Cameras of a kept calibration, laid beside the videos of an upload as if they had come with them."""

from __future__ import annotations

import os
import uuid

from sqlalchemy import update

from server.calibrations.service import find_file, get_calibration
from server.errors import ConflictError
from server.imports import service
from server.imports.models import ImportRow
from server.imports.service import ImportContext

NAME = "handloom-cameras.toml"
"""Of the file among the upload's own."""


def take_cameras(context: ImportContext, import_id: uuid.UUID, calibration_id: uuid.UUID | None) -> ImportRow:
    """Take the cameras of a calibration, or with None those that came along again, and check the upload."""
    row = service.get_open(context, import_id)
    path = context.source(import_id) / NAME
    if row.calibration_id is None and path.exists():
        raise ConflictError(f"The upload has a file {NAME} of its own. Upload the videos without it.")
    if calibration_id is None:
        path.unlink(missing_ok=True)
    else:
        with context.database.reading() as session:
            found = find_file(context.storage, get_calibration(session, calibration_id), "cameras.toml")
        beside = context.folder(import_id) / f".{uuid.uuid4().hex}"
        beside.write_bytes(found.read_bytes())
        os.replace(beside, path)
    with context.database.writing() as session:
        query = update(ImportRow).where(ImportRow.id == import_id, ImportRow.state != "confirmed")
        session.execute(query.values(calibration_id=calibration_id))
    return service.check_again(context, import_id, row.options)

"""`/sequences`."""

from __future__ import annotations

import uuid
from typing import Annotated

from fastapi import APIRouter, Query, Response

from server.access.audit import record_act
from server.access.service import LeadAccount
from server.database import SessionDep
from server.database.paging import Cursor, Limit, Page
from server.database.revision import IfMatch, read_if_match, write_etag
from server.deprecation import deprecated
from server.errors import ConflictError, error_responses
from server.sequences import service
from server.sequences.schemas import SequenceOut, SequencePatch
from server.sequences.summaries import SummariesDep, describe_sequences
from server.storage import StorageDep

router = APIRouter(prefix="/sequences", tags=["sequences"], responses=error_responses(404))


@router.get("")
def list_sequences(
    session: SessionDep,
    summaries: SummariesDep,
    search: Annotated[str | None, Query(max_length=200, description="Words of the name.")] = None,
    cursor: Cursor = None,
    limit: Limit = 100,
) -> Page[SequenceOut]:
    """Recordings, newest first."""
    rows, next_cursor = service.list_sequences(session, search, cursor, limit)
    return Page(items=describe_sequences(session, rows, summaries), next_cursor=next_cursor)


@router.get("/{sequence_id}")
def get_sequence(
    sequence_id: uuid.UUID, session: SessionDep, summaries: SummariesDep, response: Response
) -> SequenceOut:
    """One recording."""
    row = service.get_sequence(session, sequence_id)
    response.headers["ETag"] = write_etag(row.revision)
    return describe_sequences(session, [row], summaries)[0]


@router.patch("/{sequence_id}", responses=error_responses(409, 428))
def update_sequence(
    sequence_id: uuid.UUID,
    patch: SequencePatch,
    session: SessionDep,
    storage: StorageDep,
    summaries: SummariesDep,
    lead: LeadAccount,
    response: Response,
    if_match: IfMatch = None,
) -> SequenceOut:
    """Change the name or the hands. 409 carries the recording as it is now in `theirs`."""
    row = service.get_sequence(session, sequence_id)
    try:
        row = service.update_sequence(session, storage, row, patch, read_if_match(if_match))
    except service.StaleSequenceError as stale:
        theirs = describe_sequences(session, [stale.row], summaries)[0].model_dump(mode="json")
        raise ConflictError(stale.detail, headers={"ETag": write_etag(stale.row.revision)}, theirs=theirs) from None
    record_act(session, lead.id, "recording.change", "recording", row.id)
    response.headers["ETag"] = write_etag(row.revision)
    return describe_sequences(session, [row], summaries)[0]


@router.delete("/{sequence_id}", status_code=204)
def delete_sequence(sequence_id: uuid.UUID, session: SessionDep, lead: LeadAccount) -> None:
    """Hide a recording. Nothing of it is lost: `restore` brings it back."""
    service.delete_sequence(session, service.get_sequence(session, sequence_id))
    record_act(session, lead.id, "recording.delete", "recording", sequence_id)


@router.post("/{sequence_id}/restore", **deprecated("/bin/recording/{sequence_id}/restore"))
def restore_sequence(
    sequence_id: uuid.UUID, session: SessionDep, summaries: SummariesDep, lead: LeadAccount
) -> SequenceOut:
    """Undo a deletion."""
    row = service.get_sequence(session, sequence_id, deleted_too=True)
    service.restore_sequence(session, row)
    record_act(session, lead.id, "recording.restore", "recording", row.id)
    return describe_sequences(session, [row], summaries)[0]

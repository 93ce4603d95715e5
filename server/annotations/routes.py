"""`/sequences/{sequence_id}/annotations`."""

from __future__ import annotations

import uuid
from collections.abc import Sequence
from dataclasses import replace
from typing import Annotated, Any

from fastapi import APIRouter, Depends, Path, Query, Response
from fastapi.responses import JSONResponse
from sqlalchemy.orm import Session

from server.access import policy
from server.access.models import Account
from server.access.places import HiddenPlaces, Place
from server.access.service import CurrentAccount, find_names
from server.annotations import key_frames, service
from server.annotations.annotation_page import AnnotationQuestion, make_annotation_page
from server.annotations.changes import Change, Marked, StaleAnnotationError, change_annotation, look_up
from server.annotations.models import AnnotationRevisionRow
from server.annotations.schemas import (
    AnnotationConflict,
    AnnotationFile,
    AnnotationOut,
    AnnotationPut,
    AnnotationRestore,
    AnnotationRevision,
    Hand,
    KeyFrame,
    KeyFrames,
)
from server.compute import ComputeDep
from server.database import AdmissionDep, SessionDep
from server.database.frames import FramePath
from server.database.paging import Cursor, Page
from server.database.revision import IfMatch, IfNoneMatch, read_if_match, write_etag
from server.download import name_download
from server.errors import ConflictError, InvalidError, NotFoundError, error_responses
from server.sequences.models import SequenceRow
from server.sequences.service import get_sequence

router = APIRouter(prefix="/sequences/{sequence_id}", tags=["annotations"], responses=error_responses(404))

CONFLICTS: dict[int | str, dict[str, Any]] = {409: {"model": AnnotationConflict}, **error_responses(428)}
CameraPath = Annotated[str, Path(max_length=64)]
FrameQuery = Annotated[int | None, Query(ge=0, le=10**9)]
ReplicaQuery = Annotated[
    uuid.UUID | None, Query(description="The assignment of a blind replica; none for the annotations of everybody.")
]


def get_annotated_sequence(sequence_id: uuid.UUID, session: SessionDep) -> SequenceRow:
    """The recording of the address."""
    return get_sequence(session, sequence_id)


SequenceDep = Annotated[SequenceRow, Depends(get_annotated_sequence)]


async def name_replica(replica: ReplicaQuery = None) -> str:
    """Where the annotations of a request lie: empty for those of everybody."""
    return "" if replica is None else str(replica)


ReplicaDep = Annotated[str, Depends(name_replica)]


async def get_address(
    camera: CameraPath, frame: FramePath, hand: Hand, sequence_id: uuid.UUID, replica: ReplicaQuery = None
) -> Place:
    """The place of the address, whether there is such a one or not."""
    return Place(sequence_id, camera, frame, hand, await name_replica(replica))


AddressDep = Annotated[Place, Depends(get_address)]


async def get_place(address: AddressDep, sequence: SequenceDep) -> Place:
    """The place of the address."""
    return service.check_place(sequence, address.camera, address.frame, address.hand, address.replica)


PlaceDep = Annotated[Place, Depends(get_place)]


def get_readable_place(place: PlaceDep, session: SessionDep, account: CurrentAccount) -> Place:
    """The place of the address, if whoever asks may read it."""
    policy.check_read(session, account, place)
    return place


ReadablePlaceDep = Annotated[Place, Depends(get_readable_place)]


@router.get("/annotations", response_model=Page[AnnotationOut])
async def list_annotations(
    sequence_id: uuid.UUID,
    admission: AdmissionDep,
    compute: ComputeDep,
    account: CurrentAccount,
    replica: ReplicaQuery = None,
    camera: Annotated[str | None, Query(max_length=64)] = None,
    from_: Annotated[FrameQuery, Query(alias="from", description="First frame.")] = None,
    to: Annotated[FrameQuery, Query(description="Last frame.")] = None,
    cursor: Cursor = None,
    limit: Annotated[int, Query(ge=1, le=10_000, description="Most items of a page.")] = 2_000,
) -> Response:
    """Annotations of a recording by frame, camera and hand."""
    name = await name_replica(replica)

    def look(session: Session) -> Sequence[HiddenPlaces]:
        get_sequence(session, sequence_id)
        return policy.find_hidden(session, account, sequence_id, name)

    hidden = await admission.read(look)
    asked = AnnotationQuestion(sequence_id, hidden, name, camera, (from_, to), cursor, limit)
    return Response(await compute.run(make_annotation_page, asked), media_type="application/json")


@router.get("/annotations.json", response_model=AnnotationFile)
def get_annotation_file(
    sequence: SequenceDep,
    session: SessionDep,
    account: CurrentAccount,
    replica: ReplicaDep,
) -> JSONResponse:
    """All annotations as the file `annotations.json` of a recording folder."""
    hidden = policy.find_hidden(session, account, sequence.id, replica)
    headers = name_download(sequence.name, "annotations", suffix=".json")
    return JSONResponse(service.export_annotations(session, sequence.id, replica, hidden), headers=headers)


@router.get("/annotations/{camera}/{frame}/{hand}", response_model=AnnotationOut)
async def get_annotation(place: AddressDep, admission: AdmissionDep, account: CurrentAccount) -> Response:
    """One annotation; its `ETag` is what a change must send as `If-Match`."""

    def read(session: Session) -> Marked:
        now = look_up(session, place).now
        policy.check_read(session, account, place)
        if now is None or now.points is None:
            raise NotFoundError(f"There is no annotation of {place}.")
        return now

    return _answer(place, await admission.read(read))


@router.put("/annotations/{camera}/{frame}/{hand}", response_model=AnnotationOut, responses=CONFLICTS)
async def put_annotation(
    place: AddressDep,
    body: AnnotationPut,
    admission: AdmissionDep,
    account: CurrentAccount,
    if_match: IfMatch = None,
    if_none_match: IfNoneMatch = None,
) -> Response:
    """Store an annotation: the first one with `If-None-Match: *`, a change with `If-Match`.

    A request that is sent again with its `operation_id` changes nothing and is answered as the first time.
    """
    expected = _read_expected(if_match, if_none_match)
    sources = None
    if body.sources is not None:
        sources = [source and source.model_dump(mode="json", exclude_defaults=True) for source in body.sources]
    change = Change("put", body.points, expected, body.operation_id, account.id, sources)
    made = await admission.write(lambda session: _change(session, account, place, change))
    return _answer(place, made)


@router.delete("/annotations/{camera}/{frame}/{hand}", status_code=204, responses=CONFLICTS)
def delete_annotation(
    place: PlaceDep,
    session: SessionDep,
    account: CurrentAccount,
    response: Response,
    if_match: IfMatch = None,
    operation_id: Annotated[uuid.UUID | None, Query(description="As in PUT.")] = None,
) -> None:
    """Delete an annotation; its history stays, and every revision of it can be restored."""
    expected = read_if_match(if_match)
    change = Change("delete", None, expected, operation_id or uuid.uuid4(), account.id)
    response.headers["ETag"] = write_etag(_change(session, account, place, change).revision)


@router.get("/annotations/{camera}/{frame}/{hand}/history")
def list_annotation_history(
    place: ReadablePlaceDep, session: SessionDep, response: Response
) -> Page[AnnotationRevision]:
    """Every revision, newest first, of a deleted annotation too; none of a hand that nobody ever marked."""
    row = service.find_annotation(session, place)
    if row is None:
        return Page(items=[], next_cursor=None)
    history = service.list_history(session, row)
    names = find_names(session, [item.author_id for item in history])
    response.headers["ETag"] = write_etag(row.revision)
    return Page(items=[_describe_revision(item, names) for item in history], next_cursor=None)


@router.post(
    "/annotations/{camera}/{frame}/{hand}/history/{revision}/restore", response_model=AnnotationOut, responses=CONFLICTS
)
def restore_annotation(
    place: ReadablePlaceDep,
    revision: Annotated[int, Path(ge=1, le=10**9)],
    body: AnnotationRestore,
    session: SessionDep,
    account: CurrentAccount,
    if_match: IfMatch = None,
) -> Response:
    """Make an earlier revision the current one again, as a new revision."""
    row = service.get_annotation(session, place, deleted_too=True)
    past = service.get_past(session, row, revision)
    expected = read_if_match(if_match)
    change = Change("restore", past.points, expected, body.operation_id, account.id, past.sources)
    return _answer(place, _change(session, account, place, change))


@router.get("/key-frames")
def list_key_frames(
    sequence: SequenceDep, session: SessionDep, account: CurrentAccount, replica: ReplicaDep
) -> KeyFrames:
    """Hands that people made key frames: between two of them the annotator proposes the rest."""
    hidden = policy.find_hidden(session, account, sequence.id, replica)
    rows = key_frames.list_key_frames(session, sequence.id, replica, hidden)
    return KeyFrames(items=[KeyFrame.model_validate(row) for row in rows])


@router.put("/key-frames/{camera}/{frame}/{hand}", status_code=204)
def add_key_frame(place: PlaceDep, session: SessionDep, account: CurrentAccount) -> None:
    """Make the hand a key frame; whoever may mark it may do this. Repeating this is harmless."""
    policy.check_change(session, account, place)
    key_frames.add_key_frame(session, place, account.id)


@router.delete("/key-frames/{camera}/{frame}/{hand}", status_code=204)
def remove_key_frame(place: PlaceDep, session: SessionDep, account: CurrentAccount) -> None:
    """Remove a key frame; its joints stay. Repeating this is harmless."""
    policy.check_change(session, account, place)
    key_frames.remove_key_frame(session, place)


def _read_expected(if_match: str | None, if_none_match: str | None) -> int | None:
    if if_none_match is None:
        return read_if_match(if_match)
    if if_match is not None or if_none_match.strip() != "*":
        raise InvalidError("Send either If-None-Match: * (there is none yet) or If-Match with one revision.")
    return None


def _change(session: Session, account: Account, place: Place, change: Change) -> Marked:
    """Do it; when somebody else was first, the answer carries theirs."""
    try:
        made = change_annotation(session, place, change, lambda: policy.check_change(session, account, place))
    except StaleAnnotationError as stale:
        now = stale.now
        theirs = None if now is None or now.points is None else _describe_marked(place, now).model_dump(mode="json")
        headers = None if now is None else {"ETag": write_etag(now.revision)}
        raise ConflictError(stale.detail, headers=headers, theirs=theirs) from None
    return replace(made, author=account.name) if made.author_id == account.id else made


def _answer(place: Place, marked: Marked) -> Response:
    """The answer in full: FastAPI would check once more what was just made, and on another thread."""
    body = _describe_marked(place, marked).model_dump_json()
    return Response(body, media_type="application/json", headers={"ETag": write_etag(marked.revision)})


def _describe_marked(place: Place, marked: Marked) -> AnnotationOut:
    return AnnotationOut.model_validate(
        {
            "frame": place.frame,
            "camera": place.camera,
            "hand": place.hand,
            "points": marked.points,
            "sources": marked.sources,
            "revision": marked.revision,
            "updated_at": marked.updated_at,
            "author": marked.author,
        }
    )


def _describe_revision(item: AnnotationRevisionRow, names: dict[uuid.UUID | None, str]) -> AnnotationRevision:
    return AnnotationRevision.model_validate(
        {
            "revision": item.revision,
            "act": item.act,
            "points": item.points,
            "sources": item.sources,
            "created_at": item.created_at,
            "author": names.get(item.author_id),
            "operation_id": item.operation_id,
        }
    )

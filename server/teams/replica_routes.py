"""`/replica-sets` and their agreement."""

from __future__ import annotations

import uuid
from typing import Annotated

from fastapi import APIRouter, Depends, Query, Response

from server.access.policy import check_sees_set
from server.access.service import CurrentAccount, LeadAccount, ReviewerAccount
from server.annotations.schemas import SOURCES_HELP, SourceChoice
from server.database import SessionDep
from server.database.paging import Cursor, Limit, Page
from server.deprecation import deprecated
from server.download import name_download
from server.errors import error_responses
from server.teams import projects, replicas
from server.teams.agreement_report import AgreementReport, make_report, write_csv, write_html
from server.teams.assignments import describe_assignments
from server.teams.schemas import AssignmentOut, ReplicaAnnotator, ReplicaSetMake, ReplicaSetOut

router = APIRouter(tags=["replica sets"], responses=error_responses(404))
PAGE_POLICY = "default-src 'none'; style-src 'unsafe-inline'; sandbox"


@router.get("/projects/{project_id}/replica-sets")
def list_replica_sets(
    project_id: uuid.UUID, session: SessionDep, account: CurrentAccount, cursor: Cursor = None, limit: Limit = 100
) -> Page[ReplicaSetOut]:
    """Replica sets of a project, the newest first."""
    project = projects.get_project(session, project_id)
    rows, next_cursor = replicas.list_replica_sets(session, project, cursor, limit)
    return Page(items=replicas.describe_replica_sets(session, rows), next_cursor=next_cursor)


@router.post("/projects/{project_id}/replica-sets", status_code=201, responses=error_responses(409))
def make_replica_set(
    project_id: uuid.UUID, body: ReplicaSetMake, session: SessionDep, account: LeadAccount
) -> ReplicaSetOut:
    """Give the same frames to several people who mark them blindly. Each gets an assignment."""
    row = replicas.make_replica_set(session, account, project_id, body)
    return replicas.describe_replica_sets(session, [row])[0]


@router.get("/replica-sets/{replica_set_id}")
def get_replica_set(replica_set_id: uuid.UUID, session: SessionDep, account: CurrentAccount) -> ReplicaSetOut:
    """One replica set."""
    return replicas.describe_replica_sets(session, [replicas.get_replica_set(session, replica_set_id)])[0]


@router.delete("/replica-sets/{replica_set_id}", status_code=204)
def withdraw_replica_set(replica_set_id: uuid.UUID, session: SessionDep, account: LeadAccount) -> None:
    """Take a replica set back with its assignments; `restore` undoes it. What was marked stays stored."""
    row = replicas.get_replica_set(session, replica_set_id, hold=True, deleted_too=True)
    replicas.withdraw_replica_set(session, account, row, is_withdrawn=True)


@router.post("/replica-sets/{replica_set_id}/restore", **deprecated("/bin/replica_set/{replica_set_id}/restore"))
def restore_replica_set(replica_set_id: uuid.UUID, session: SessionDep, account: LeadAccount) -> ReplicaSetOut:
    """Undo a withdrawal."""
    row = replicas.get_replica_set(session, replica_set_id, hold=True, deleted_too=True)
    replicas.withdraw_replica_set(session, account, row, is_withdrawn=False)
    return replicas.describe_replica_sets(session, [row])[0]


@router.post("/replica-sets/{replica_set_id}/annotators", status_code=201, responses=error_responses(409))
def add_replica_annotator(
    replica_set_id: uuid.UUID, body: ReplicaAnnotator, session: SessionDep, account: LeadAccount
) -> AssignmentOut:
    """Give a replica set to one more person."""
    row = replicas.get_replica_set(session, replica_set_id, hold=True)
    return describe_assignments(session, [replicas.add_annotator(session, account, row, body.account_id)])[0]


SourceQuery = Annotated[list[SourceChoice], Query(min_length=1, max_length=10, description=SOURCES_HELP)]
JUDGING: list[SourceChoice] = ["independent"]


def get_report(
    replica_set_id: uuid.UUID, session: SessionDep, account: ReviewerAccount, source: SourceQuery = JUDGING
) -> AgreementReport:
    """The agreement of those who have submitted, for reviewers who don't mark the set themselves."""
    row = replicas.get_replica_set(session, replica_set_id)
    check_sees_set(session, account, row)
    return make_report(session, row, source)


ReportDep = Annotated[AgreementReport, Depends(get_report)]


@router.get("/replica-sets/{replica_set_id}/agreement")
def get_agreement(report: ReportDep) -> AgreementReport:
    """How well the annotators agree: standard deviations in px, OKS, states; those who have submitted count."""
    return report


@router.get(
    "/replica-sets/{replica_set_id}/agreement.csv",
    response_class=Response,
    responses={200: {"content": {"text/csv": {}}}},
)
def get_agreement_csv(report: ReportDep) -> Response:
    """The agreement as a table."""
    headers = name_download(report.recording, report.name, "agreement", suffix=".csv")
    return Response(write_csv(report), media_type="text/csv; charset=utf-8", headers=headers)


@router.get(
    "/replica-sets/{replica_set_id}/agreement.html",
    response_class=Response,
    responses={200: {"content": {"text/html": {}}}},
)
def get_agreement_page(report: ReportDep) -> Response:
    """The agreement as a page that stands alone, to be kept or sent."""
    name = name_download(report.recording, report.name, "agreement", suffix=".html")
    headers = name | {"Content-Security-Policy": PAGE_POLICY}
    return Response(write_html(report), media_type="text/html; charset=utf-8", headers=headers)

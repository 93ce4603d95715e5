"""Projects and blind replicas in the bin."""

from __future__ import annotations

from server.bin.kinds import BinKind
from server.teams import projects, replicas
from server.teams.models import ProjectRow, ReplicaSetRow

PROJECTS = BinKind(
    kind="project",
    word="project",
    row=ProjectRow,
    deleted_at=ProjectRow.archived_at,
    restore=lambda session, account, id_: projects.archive_project(session, account, id_, is_archived=False),
)

REPLICA_SETS = BinKind(
    kind="replica_set",
    word="blind replica",
    row=ReplicaSetRow,
    deleted_at=ReplicaSetRow.deleted_at,
    restore=lambda session, account, id_: replicas.withdraw_replica_set(
        session, account, replicas.get_replica_set(session, id_, hold=True, deleted_too=True), is_withdrawn=False
    ),
    parent=("project", ReplicaSetRow.project_id),
)

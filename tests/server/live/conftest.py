"""People and a project, as for teams."""

from __future__ import annotations

from tests.server.teams.conftest import ann, bob, join, lead, project, reviewer  # noqa: F401

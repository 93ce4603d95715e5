"""The routers of this package."""

from __future__ import annotations

from server.teams import assignment_routes, project_routes, replica_routes

ROUTERS = (project_routes.router, assignment_routes.router, replica_routes.router)

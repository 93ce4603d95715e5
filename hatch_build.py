"""What a wheel holds beside the Python packages: the built browser app and the migrations, inside `server`."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from hatchling.builders.hooks.plugin.interface import BuildHookInterface


class WheelContents(BuildHookInterface):
    """Adds `web/dist` as `server/app/static`, and `migrations` as `server/migrations`."""

    def initialize(self, version: str, build_data: dict[str, Any]) -> None:
        """Refuse a wheel without the app. An editable install takes both from where they are."""
        if version == "editable":
            return
        app = Path(self.root) / "web" / "dist"
        if not (app / "index.html").is_file():
            raise RuntimeError(
                f"A wheel of Handloom holds the built browser app, and there is none at {app}. "
                "Build both with `make wheel`, or build the app with `cd web && npm ci && npm run build` first."
            )
        build_data["force_include"][str(app)] = "server/app/static"
        build_data["force_include"][str(Path(self.root) / "migrations")] = "server/migrations"

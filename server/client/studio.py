"""A studio, seen from a script."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from types import TracebackType
from typing import Any

from server.client.annotations import Annotations
from server.client.curation import Curation
from server.client.jobs import Jobs
from server.client.link import Link


class Studio:
    """Recordings, annotations, jobs, tracks, scans and hand models of a studio, as the dictionaries of `docs/api.md`.

    Args:
        url: Such as `http://127.0.0.1:8000`.
        token: From the account's page; needed unless the studio is on this machine and asks for no login.
        timeout: s that an answer may take.
    """

    def __init__(self, url: str = "http://127.0.0.1:8000", token: str | None = None, timeout: float = 60.0) -> None:
        self.link = Link(url, token, timeout)
        self.jobs = Jobs(self.link)
        self.curation = Curation(self.link)

    def __enter__(self) -> Studio:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.link.close()

    def account(self) -> dict[str, Any]:
        """Who I am."""
        return self.link.get("/account")

    def recordings(self, search: str | None = None) -> Iterator[dict[str, Any]]:
        """Recordings, newest first; with `search`, those whose name holds its words."""
        return self.link.pages("/sequences", search=search)

    def recording(self, name_or_id: str) -> dict[str, Any]:
        """The one recording of this id or exact name."""
        found = [item for item in self.recordings() if name_or_id in (item["id"], item["name"])]
        if len(found) != 1:
            raise LookupError(f"{len(found)} recordings are called {name_or_id!r}; needed one. Give the id instead.")
        return found[0]

    def import_archive(self, archive: Path | str, name: str | None = None) -> dict[str, Any]:
        """Import a zip of a recording; refused with the report's problems when it is none."""
        path = Path(archive)
        with path.open("rb") as file:
            made = self.link.send("POST", "/imports", files={"files": (path.name, file)}).json()
        if made["state"] != "checked":
            raise ValueError(f"{path.name} is refused: {' '.join(made['report']['problems'])}")
        body = {} if name is None else {"name": name}
        return self.link.send("POST", f"/imports/{made['id']}/confirm", json=body, is_repeatable=True).json()

    def annotations(self, sequence_id: str) -> Annotations:
        """Annotations of a recording."""
        return Annotations(self.link, sequence_id)

    def tracks(self, sequence_id: str | None = None) -> Iterator[dict[str, Any]]:
        """Tracks, newest first."""
        return self.link.pages("/tracks", sequence_id=sequence_id)

    def download_track(self, track_id: str, folder: Path | str) -> Path:
        """`track.npz` and `summary.json` of a track, into a folder."""
        for name in ("track.npz", "summary.json"):
            self.link.download(f"/tracks/{track_id}/files/{name}", Path(folder) / name)
        return Path(folder)

    def export_track(self, track_id: str, kind: str, to: Path | str) -> Path:
        """A track as `npz`, `csv`, `glb` or `mano`."""
        return self.link.download(f"/tracks/{track_id}/export/{kind}", Path(to))

    def evaluation(self, track_id: str) -> dict[str, Any]:
        """Errors of a track against the annotations as they are now, px."""
        return self.link.get(f"/tracks/{track_id}/evaluation")

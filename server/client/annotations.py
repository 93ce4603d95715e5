"""Annotations: each change has an operation id, so that one that is sent twice is done once."""

from __future__ import annotations

import uuid
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

from server.client.answers import StudioRefusal
from server.client.link import Link

Points = Sequence[Sequence[float]]
"""21 times x, y (px) and v: 0 absent, 1 occluded, 2 visible."""


class Annotations:
    """Of one recording."""

    def __init__(self, link: Link, sequence_id: str) -> None:
        self._link, self._path = link, f"/sequences/{sequence_id}/annotations"

    def __iter__(self) -> Iterator[dict[str, Any]]:
        return self._link.pages(self._path)

    def get(self, camera: str, frame: int, hand: str) -> dict[str, Any] | None:
        """One annotation; None when there is none."""
        try:
            return self._link.get(self._place(camera, frame, hand))
        except StudioRefusal as refusal:
            if refusal.status == 404:
                return None
            raise

    def put(self, camera: str, frame: int, hand: str, points: Points, revision: int | None = None) -> dict[str, Any]:
        """Store an annotation.

        Args:
            camera: Its id.
            frame: Its number.
            hand: `right` or `left`.
            points: As `Points`.
            revision: The one that is changed; None for the first.

        Raises:
            StaleError: Somebody changed it meanwhile; `theirs` is how it is now.
        """
        condition = {"If-None-Match": "*"} if revision is None else {"If-Match": f'"{revision}"'}
        body = {"points": [[float(x), float(y), int(v)] for x, y, v in points], "operation_id": str(uuid.uuid4())}
        place = self._place(camera, frame, hand)
        return self._link.send("PUT", place, json=body, headers=condition, is_repeatable=True).json()

    def export(self, to: Path | str) -> Path:
        """All of them as the file `annotations.json` that `handloom evaluate` reads."""
        return self._link.download(f"{self._path}.json", Path(to))

    def _place(self, camera: str, frame: int, hand: str) -> str:
        return f"{self._path}/{camera}/{frame}/{hand}"

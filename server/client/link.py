"""The connection to a studio: requests are made again when none came through, if doing one twice does no harm."""

from __future__ import annotations

import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import httpx

from server.client.answers import StudioUnreachable, check

PAUSES = (0.2, 0.5, 1.0, 2.0, 4.0)
"""s before a request that was not answered is made again."""

AWAY = frozenset({502, 503, 504})


class Link:
    """Sends requests to `/api/v1`."""

    def __init__(self, url: str, token: str | None, timeout: float) -> None:
        headers = {"Authorization": f"Bearer {token}"} if token else {}
        self.url = url.rstrip("/")
        self._client = httpx.Client(base_url=f"{self.url}/api/v1", headers=headers, timeout=timeout)

    def close(self) -> None:
        self._client.close()

    def send(self, method: str, path: str, *, is_repeatable: bool | None = None, **options: Any) -> httpx.Response:
        """One request. Those that are `is_repeatable` (without a word, those that read) are made again if need be."""
        if is_repeatable is None:
            is_repeatable = method in ("GET", "HEAD")
        failure = ""
        for pause in (*PAUSES, None) if is_repeatable else (None,):
            try:
                answer = self._client.request(method, path, **options)
                if answer.status_code not in AWAY or pause is None:
                    return check(answer)
                failure = f"status {answer.status_code}"
            except httpx.TransportError as error:
                failure = f"{type(error).__name__}: {error}"
            if pause is not None:
                time.sleep(pause)
        raise StudioUnreachable(f"The studio at {self.url} does not answer ({failure}). Is `handloom serve` running?")

    def get(self, path: str, **query: Any) -> Any:
        """The JSON at a path."""
        return self.send("GET", path, params={name: value for name, value in query.items() if value is not None}).json()

    def pages(self, path: str, **query: Any) -> Iterator[dict[str, Any]]:
        """Every item of a list, page after page."""
        cursor = None
        while True:
            page = self.get(path, **query, cursor=cursor)
            yield from page["items"]
            cursor = page["next_cursor"]
            if cursor is None:
                return

    def download(self, path: str, to: Path) -> Path:
        """A file, which has its name when it is whole."""
        to.parent.mkdir(parents=True, exist_ok=True)
        partial = to.with_name(f".{to.name}.part")
        try:
            with self._client.stream("GET", path) as answer:
                if not answer.is_success:
                    answer.read()
                    check(answer)
                with partial.open("wb") as file:
                    for piece in answer.iter_bytes():
                        file.write(piece)
            return partial.replace(to)
        except httpx.TransportError as error:
            raise StudioUnreachable(
                f"The download from {self.url} was interrupted: {error}. Start it again."
            ) from error
        finally:
            partial.unlink(missing_ok=True)

"""A place beyond this machine where finished files are kept: an S3-compatible store, or a folder that all reach.

Below `<prefix>/<area>/<id>/` lie `blobs/<sha256>`, each file under its own hash, and `<name>.json`, small documents
that name blobs. A document is written after all that it names, so nobody finds half of anything; a file under its hash
can be sent again, and what is read is held against the hash.
"""

from __future__ import annotations

import contextlib
import json
import logging
import os
import threading
import time
import uuid
from collections.abc import Callable, Iterable, Mapping
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import Any, TypeVar

import fsspec
from fsspec import AbstractFileSystem

from server.errors import StudioError
from server.storage.digest import compute_digest

log = logging.getLogger(__name__)

Result = TypeVar("Result")

PAUSES = (0.2, 0.5, 1.0, 2.0, 4.0)
"""s before a request that failed is made again."""

AT_ONCE = 8
"""Files sent or fetched at a time."""


class StoreError(StudioError):
    """The store does not do what was asked."""

    status_code = 503


class RemoteStore:
    """A store at an address such as `s3://bucket/prefix`.

    Args:
        url: `s3://bucket/prefix`, or `file:///folder`.
        endpoint: Of an S3-compatible store that is not Amazon's, such as `http://store:8333`.
    """

    def __init__(self, url: str, endpoint: str | None = None) -> None:
        self.url = url
        protocol = url.partition("://")[0]
        options: dict[str, Any] = {"use_listings_cache": False, "skip_instance_cache": True}
        if protocol == "s3":
            # Checksums are ours; newer ones of Amazon's are not understood by every other store.
            plain = {"request_checksum_calculation": "when_required", "response_checksum_validation": "when_required"}
            once = {"connect_timeout": 5, "retries": {"max_attempts": 1}}  # asking again is our own affair
            options["config_kwargs"] = plain | once | ({"s3": {"addressing_style": "path"}} if endpoint else {})
            options["client_kwargs"] = {"endpoint_url": endpoint} if endpoint else {}
        else:
            options["auto_mkdir"] = True
        self._files: AbstractFileSystem
        self._files, root = fsspec.url_to_fs(url, **options)
        self._files.retries = 1  # pyright: ignore[reportAttributeAccessIssue] (s3fs asks five times otherwise)
        self._root = root.rstrip("/")
        self._has_bucket, self._making_bucket = protocol != "s3", threading.Lock()

    def folder(self, area: str, id_: uuid.UUID) -> RemoteFolder:
        """The part of the store that belongs to one thing."""
        return RemoteFolder(self, f"{self._root}/{area}/{id_}")

    def put(self, key: str, path: Path) -> None:
        """Store a file under a key."""
        self._make_bucket()
        self._persist(f"store {key}", lambda: self._files.put_file(str(path), key))

    def get(self, key: str, path: Path) -> None:
        """Fetch a key into a file."""
        self._persist(f"fetch {key}", lambda: self._files.get_file(key, str(path)))

    def write(self, key: str, data: bytes) -> None:
        """Store bytes under a key, in one piece."""
        self._make_bucket()
        self._persist(f"store {key}", lambda: self._files.pipe_file(key, data))

    def read(self, key: str) -> bytes | None:
        """The bytes of a key; None when there is none."""
        try:
            found = self._persist(f"read {key}", lambda: self._files.cat_file(key))
            assert isinstance(found, bytes)
            return found
        except FileNotFoundError:
            return None

    def remove(self, key: str) -> None:
        """Remove a key and all below it, if there is any."""
        try:
            self._persist(f"remove {key}", lambda: self._files.rm(key, recursive=True))
        except FileNotFoundError:
            return

    def _make_bucket(self) -> None:
        """The bucket, made when it is not there yet. Another machine may be quicker."""
        bucket = self._root.partition("/")[0]

        def make() -> None:
            if not self._files.exists(bucket):
                with contextlib.suppress(FileExistsError):
                    self._files.mkdir(bucket)

        with self._making_bucket:
            if not self._has_bucket:
                self._persist(f"make the bucket {bucket}", make)
                self._has_bucket = True

    def _persist(self, what: str, act: Callable[[], Result]) -> Result:
        """Do it, again and again when it fails."""
        for pause in (*PAUSES, None):
            try:
                return act()
            except FileNotFoundError:
                raise
            except Exception as error:  # each kind of store has errors of its own
                if pause is None or isinstance(error, PermissionError):
                    raise StoreError(
                        f"The store {self.url} does not {what}: {type(error).__name__}: {error}. What is on this "
                        "machine is safe; see HANDLOOM_STORE_URL, the keys, and whether the store runs, then try again."
                    ) from error
                log.warning("could not %s (%s); again in %.1f s", what, error, pause)
                time.sleep(pause)
        raise AssertionError("unreachable")


class RemoteFolder:
    """Blobs and documents of one thing."""

    def __init__(self, store: RemoteStore, key: str) -> None:
        self._store, self._key = store, key

    def put_blobs(self, paths: Mapping[str, Path]) -> None:
        """Store files under their hashes, several at a time."""
        _at_once((lambda d=digest, p=path: self._store.put(self._blob(d), p)) for digest, path in paths.items())

    def get_blobs(self, paths: Iterable[tuple[str, Path]]) -> None:
        """Fetch files by their hashes, several at a time. Each gets its name when it is whole and what it should be."""
        _at_once((lambda d=digest, p=path: self._get_blob(d, p)) for digest, path in paths)

    def write_document(self, name: str, document: dict[str, Any]) -> None:
        """Store a document, whose blobs must be there."""
        self._store.write(f"{self._key}/{name}.json", json.dumps(document).encode())

    def read_document(self, name: str) -> dict[str, Any] | None:
        """A document; None when there is none."""
        data = self._store.read(f"{self._key}/{name}.json")
        return None if data is None else json.loads(data)

    def remove(self, name: str) -> None:
        """Remove everything, the document `name` first."""
        self._store.remove(f"{self._key}/{name}.json")
        self._store.remove(self._key)

    def _blob(self, digest: str) -> str:
        return f"{self._key}/blobs/{digest}"

    def _get_blob(self, digest: str, path: Path) -> None:
        path.parent.mkdir(parents=True, exist_ok=True)
        temporary = path.with_name(f".{uuid.uuid4().hex}-{path.name}")
        try:
            for _ in range(2):
                self._store.get(self._blob(digest), temporary)
                if (found := compute_digest(temporary)) == digest:
                    os.replace(temporary, path)
                    return
                log.warning("%s of the store %s has SHA-256 %s", self._blob(digest), self._store.url, found)
        except FileNotFoundError:
            raise StoreError(f"The store {self._store.url} has lost the file {path.name} ({digest[:12]}).") from None
        finally:
            temporary.unlink(missing_ok=True)
        raise StoreError(
            f"The file {path.name} in the store {self._store.url} is damaged: found SHA-256 {found[:12]}, needed "
            f"{digest[:12]}. Restore it from a copy of the store."
        )


def _at_once(acts: Iterable[Callable[[], None]]) -> None:
    with ThreadPoolExecutor(AT_ONCE) as pool:
        for done in [pool.submit(act) for act in acts]:
            done.result()

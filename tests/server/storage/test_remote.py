"""A store beyond this machine: files come back as they were, or the error says what is wrong with them."""

from __future__ import annotations

import uuid
from pathlib import Path

import pytest

import server.storage.remote as remote
from server.storage.digest import compute_digest
from server.storage.remote import PAUSES, RemoteFolder, RemoteStore, StoreError

ID = uuid.UUID(int=7)


@pytest.fixture
def store(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> RemoteStore:
    monkeypatch.setattr(remote, "PAUSES", (0.0,) * len(PAUSES))
    return RemoteStore((tmp_path / "store").as_uri())


@pytest.fixture
def folder(store: RemoteStore) -> RemoteFolder:
    return store.folder("tracks", ID)


def write(path: Path, data: bytes) -> tuple[str, Path]:
    path.write_bytes(data)
    return compute_digest(path), path


def test_blobs_come_back_under_their_hash_and_have_their_name_when_whole(folder: RemoteFolder, tmp_path: Path) -> None:
    kept = dict(write(tmp_path / f"{n}.bin", bytes([n]) * 100) for n in range(12))
    folder.put_blobs(kept)
    folder.put_blobs(kept)
    there = [(digest, tmp_path / "deep" / path.name) for digest, path in kept.items()]
    folder.get_blobs(there)
    assert [path.read_bytes() for _, path in there] == [path.read_bytes() for path in kept.values()]
    assert len(list((tmp_path / "deep").iterdir())) == len(kept), "no half files"


def test_documents_name_blobs_and_are_none_where_there_is_none(folder: RemoteFolder) -> None:
    assert folder.read_document("files") is None
    folder.write_document("files", {"a.bin": "0123"})
    folder.write_document("files", {"a.bin": "4567"})
    assert folder.read_document("files") == {"a.bin": "4567"}


def test_what_is_removed_is_gone_and_can_be_removed_again(folder: RemoteFolder, tmp_path: Path) -> None:
    digest, path = write(tmp_path / "a.bin", b"a")
    folder.put_blobs({digest: path})
    folder.write_document("files", {"a.bin": digest})
    folder.remove("files")
    folder.remove("files")
    assert folder.read_document("files") is None
    with pytest.raises(StoreError, match=r"has lost the file b\.bin"):
        folder.get_blobs([(digest, tmp_path / "b.bin")])


def test_a_blob_that_is_not_what_its_hash_says_is_never_given_its_name(folder: RemoteFolder, tmp_path: Path) -> None:
    digest, path = write(tmp_path / "a.bin", b"whole")
    folder.put_blobs({digest: path})
    (blob,) = (tmp_path / "store").rglob(digest)
    blob.write_bytes(b"half")
    with pytest.raises(
        StoreError, match=r"b\.bin in the store .* is damaged: found SHA-256 \w{12}, needed " + digest[:12]
    ):
        folder.get_blobs([(digest, tmp_path / "out" / "b.bin")])
    assert list((tmp_path / "out").iterdir()) == []


def test_what_fails_is_tried_again_and_given_up_with_the_stores_address(store: RemoteStore) -> None:
    tries = []

    def act() -> str:
        tries.append(1)
        if len(tries) < 3:
            raise OSError("busy")
        return "done"

    assert store._persist("do it", act) == "done" and len(tries) == 3
    with pytest.raises(StoreError, match=f"The store {store.url} does not fetch x: OSError: busy"):
        store._persist("fetch x", lambda: (_ for _ in ()).throw(OSError("busy")))


def test_a_store_that_refuses_the_keys_is_not_asked_again(store: RemoteStore) -> None:
    tries = []

    def refuse() -> None:
        tries.append(1)
        raise PermissionError("forbidden")

    with pytest.raises(StoreError, match="see HANDLOOM_STORE_URL, the keys"):
        store._persist("read x", refuse)
    assert len(tries) == 1

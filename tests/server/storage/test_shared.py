"""Two machines with a store between them: what is finished on one is found whole on the other."""

from __future__ import annotations

import os
import time
import uuid
from collections.abc import Callable
from pathlib import Path

import pytest

from server.settings import Settings
from server.storage import Storage, open_storage
from server.storage.remote import RemoteStore, StoreError
from server.storage.shared import IDLE_SECONDS, SharedStorage
from tests.server.conftest import S3

OpenMachine = Callable[..., SharedStorage]


@pytest.fixture(params=["file", "s3"])
def machine(request: pytest.FixtureRequest, tmp_path: Path) -> OpenMachine:
    """Opens the storage of a machine by its name; all share one store, once a folder and once S3."""
    url, endpoint = f"file://{tmp_path}/store", None
    if request.param == "s3":
        url, endpoint = f"s3://bucket-{uuid.uuid4().hex}/studio", request.getfixturevalue("s3").endpoint

    def open_machine(name: str, cache_gb: float = 1.0) -> SharedStorage:
        settings = Settings(data_dir=tmp_path / name, store_url=url, store_endpoint=endpoint, store_cache_gb=cache_gb)
        storage = open_storage(settings)
        assert isinstance(storage, SharedStorage)
        return storage

    return open_machine


def fill(storage: Storage, id_: uuid.UUID, **files: str) -> None:
    folder = storage.folder("tracks", id_)
    for name, text in files.items():
        path = folder / name.replace("__", "/")
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)


def read(storage: Storage, id_: uuid.UUID) -> dict[str, str]:
    folder = storage.folder("tracks", id_)
    return {p.relative_to(folder).as_posix(): p.read_text() for p in sorted(folder.rglob("*")) if p.is_file()}


def age(storage: Storage, id_: uuid.UUID, seconds: float) -> None:
    """Have a folder been asked for that long ago."""
    then = time.time() - seconds
    os.utime(storage.root / ".store" / "tracks" / f"{id_}.json", (then, then))


def test_without_a_store_nothing_but_the_data_folder_is_used(tmp_path: Path) -> None:
    storage = open_storage(Settings(data_dir=tmp_path))
    assert type(storage) is Storage
    storage.publish("tracks", uuid.uuid4())
    assert storage.remote_folder("jobs", uuid.uuid4()) is None
    assert [path for path in tmp_path.rglob("*") if path.is_file()] == []


@pytest.mark.slow
def test_a_published_folder_is_found_on_another_machine_file_by_file(machine: OpenMachine) -> None:
    here, there, id_ = machine("a"), machine("b"), uuid.uuid4()
    fill(here, id_, **{"track.npz": "poses", "models__right.npz": "hand", "empty": "", "same": "poses"})
    assert not there.folder("tracks", id_).exists(), "not before it is published"
    here.publish("tracks", id_)
    assert read(there, id_) == {"empty": "", "models/right.npz": "hand", "same": "poses", "track.npz": "poses"}
    assert [path.name for path in there.folder("tracks", id_).parent.iterdir()] == [str(id_)], "nothing else is left"


def test_what_is_changed_later_is_seen_by_who_asks_for_it_fresh(machine: OpenMachine) -> None:
    here, there, id_ = machine("a"), machine("b"), uuid.uuid4()
    fill(here, id_, name="one", big="the same")
    here.publish("tracks", id_)
    read(there, id_)
    fill(here, id_, name="two")
    here.publish("tracks", id_)
    assert read(there, id_)["name"] == "one"
    there.refresh("tracks", id_)
    assert read(there, id_) == {"big": "the same", "name": "two"}


def test_half_a_folder_is_never_seen(machine: OpenMachine, monkeypatch: pytest.MonkeyPatch) -> None:
    here, there, id_ = machine("a"), machine("b"), uuid.uuid4()
    fill(here, id_, first="1", second="2")

    def die(*_: object) -> None:
        raise KeyboardInterrupt

    with monkeypatch.context() as broken:  # killed when the files are there and their manifest is not
        broken.setattr(RemoteStore, "write", die)
        with pytest.raises(KeyboardInterrupt):
            here.publish("tracks", id_)
    assert not there.folder("tracks", id_).exists()
    here.publish("tracks", id_)
    with monkeypatch.context() as broken:  # killed while it fetches
        broken.setattr(RemoteStore, "get", die)
        with pytest.raises(KeyboardInterrupt):
            there.folder("tracks", id_)
    assert not (there.root / "tracks" / str(id_)).exists()
    assert read(there, id_) == {"first": "1", "second": "2"}


def test_a_request_that_fails_is_made_again(machine: OpenMachine, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("server.storage.remote.PAUSES", (0.01, 0.01))
    here, there, id_ = machine("a"), machine("b"), uuid.uuid4()
    fill(here, id_, only="this")
    put, failures = here._store._files.put_file, iter([ConnectionError("reset"), TimeoutError()])

    def put_sometimes(*arguments: object) -> None:
        if error := next(failures, None):
            raise error
        put(*arguments)

    monkeypatch.setattr(here._store._files, "put_file", put_sometimes)
    here.publish("tracks", id_)
    assert read(there, id_) == {"only": "this"}


@pytest.mark.slow
def test_a_store_that_is_away_says_so_and_what_is_safe(tmp_path: Path, s3: S3, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("server.storage.remote.PAUSES", (0.01,))
    settings = Settings(data_dir=tmp_path, store_url="s3://nobody/here", store_endpoint="http://127.0.0.1:9")
    storage, id_ = open_storage(settings), uuid.uuid4()
    (storage.root / "tracks" / str(id_)).mkdir(parents=True)
    fill(storage, id_, only="this")
    with pytest.raises(StoreError, match="What is on this machine is safe"):
        storage.publish("tracks", id_)
    assert read(storage, id_) == {"only": "this"}


def test_a_file_that_was_damaged_in_the_store_is_refused(tmp_path: Path) -> None:
    def open_machine(name: str) -> Storage:
        return open_storage(Settings(data_dir=tmp_path / name, store_url=f"file://{tmp_path}/store"))

    here, there, id_ = open_machine("a"), open_machine("b"), uuid.uuid4()
    fill(here, id_, only="this")
    here.publish("tracks", id_)
    [blob] = (tmp_path / "store" / "tracks" / str(id_) / "blobs").iterdir()
    blob.write_text("that")
    with pytest.raises(StoreError, match=r"only in the store .* is damaged"):
        there.folder("tracks", id_)
    assert not (there.root / "tracks" / str(id_)).exists()


def test_what_was_not_asked_for_for_long_leaves_when_there_is_no_room_and_comes_back(machine: OpenMachine) -> None:
    here = machine("a", cache_gb=25e-9)
    ids = [uuid.uuid4() for _ in range(4)]
    for number, id_ in enumerate(ids):
        fill(here, id_, file=f"{number}" * 10)
        if number < 3:
            here.publish("tracks", id_)
    here.evict()
    assert len(here.list_ids("tracks")) == 4, "all were asked for just now"
    for id_, hours in zip(ids, (5, 9, 7), strict=False):
        age(here, id_, IDLE_SECONDS * hours)
    here.evict()
    assert set(here.list_ids("tracks")) == {ids[0], ids[2], ids[3]}, "the longest unused; never what is not safe yet"
    assert read(here, ids[1]) == {"file": "1" * 10}


def test_what_is_removed_is_gone_from_the_store_too(machine: OpenMachine) -> None:
    here, there, id_ = machine("a"), machine("b"), uuid.uuid4()
    fill(here, id_, only="this")
    here.publish("tracks", id_)
    here.remove("tracks", id_)
    here.remove("tracks", id_)
    assert not here.folder("tracks", id_).exists()
    assert not there.folder("tracks", id_).exists()


@pytest.mark.parametrize("url", ["s3://", "http://example.org/x", "file://relative", "/srv/store"])
def test_an_address_that_is_no_store_is_refused(url: str) -> None:
    with pytest.raises(ValueError, match="store_url"):
        Settings(store_url=url)


def test_a_document_is_written_once_and_found_on_every_machine(machine: OpenMachine) -> None:
    one, other = machine("one"), machine("other")
    id_ = uuid.uuid4()
    assert not other.document("snapshots", id_).exists()
    one.add_document("snapshots", id_, b"labels\n")
    assert other.document("snapshots", id_).read_bytes() == b"labels\n"
    with pytest.raises(FileExistsError):
        one.add_document("snapshots", id_, b"others\n")
    assert one.document("snapshots", id_).read_bytes() == b"labels\n"
    assert [path.name for path in (one.root / "snapshots").iterdir()] == [f"{id_}.json"]

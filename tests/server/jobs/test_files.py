"""Working files are whole or not there, and a changed one is noticed."""

from __future__ import annotations

import os
from pathlib import Path

import pytest

from server.jobs.files import DamagedFileError, JobFiles


def test_a_step_is_done_only_while_every_file_of_it_is_as_it_was_written(tmp_path: Path) -> None:
    files = JobFiles(tmp_path / "job")
    assert files.read_manifest("start") is None
    files.write(files.state(0), lambda path: path.write_bytes(b"state"))
    files.write(files.setup, lambda path: (path.mkdir(), (path / "model.npz").write_bytes(b"model")))
    sealed = files.write_manifest("start", [files.state(0), files.setup], {"frames": 3})
    assert files.read_manifest("start") == sealed
    assert sealed["frames"] == 3
    (files.setup / "model.npz").write_bytes(b"other")
    assert files.read_manifest("start") is None
    with pytest.raises(DamagedFileError, match=r"setup/model\.npz is damaged"):
        files.check(sealed["files"])


def test_a_write_that_fails_leaves_what_was_there(tmp_path: Path) -> None:
    files = JobFiles(tmp_path)
    files.write(files.chunk(0), lambda path: path.write_bytes(b"first"))

    def fail(path: Path) -> None:
        path.write_bytes(b"half")
        raise OSError("no space left")

    with pytest.raises(OSError, match="no space"):
        files.write(files.chunk(0), fail)
    assert files.chunk(0).read_bytes() == b"first"
    assert list(tmp_path.iterdir()) == [files.chunk(0)]


def test_a_temporary_file_keeps_its_suffix_since_numpy_adds_one_to_others(tmp_path: Path) -> None:
    files = JobFiles(tmp_path)
    seen: list[str] = []
    files.write(files.state(1), lambda path: (seen.append(path.suffix), path.write_bytes(b"x")))
    assert seen == [".npz"]


def test_a_manifest_cut_short_counts_as_none(tmp_path: Path) -> None:
    files = JobFiles(tmp_path)
    files.write(files.state(0), lambda path: path.write_bytes(b"state"))
    files.write_manifest("start", [files.state(0)], {})
    (tmp_path / "start.json").write_text('{"files": {"state')
    assert files.read_manifest("start") is None


def test_a_write_makes_its_own_files_and_its_name_durable_and_leaves_its_siblings_alone(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Two workers end their jobs in one folder: what the other has begun may vanish at any moment."""
    begun = tmp_path / ".begun-by-another"
    begun.mkdir()
    (begun / "track.npz").write_bytes(b"half")
    synced: list[str] = []
    fsync = os.fsync
    monkeypatch.setattr(os, "fsync", lambda fd: (synced.append(os.readlink(f"/proc/self/fd/{fd}")), fsync(fd))[1])
    files = JobFiles(tmp_path / "job")
    files.write(tmp_path / "track", lambda path: ((path / "deep").mkdir(parents=True), (path / "deep" / "a").touch()))
    names = [Path(name).relative_to(tmp_path).parts for name in synced]
    assert not any(begun.name in parts for parts in names)
    assert {parts[1:] for parts in names} == {("deep", "a"), ("deep",), ()}
    assert names[-1] == (), "the folder, once the name is given"

"""Working files are whole or not there, and a changed one is noticed."""

from __future__ import annotations

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

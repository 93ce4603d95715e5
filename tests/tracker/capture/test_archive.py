"""Archives from outside: bombs, tricks with names, damage."""

from __future__ import annotations

import io
import os
import random
import stat
import struct
import zipfile
from pathlib import Path

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from tracker.capture import ArchiveLimits, check_import, extract_archive, find_path_fault
from tracker.errors import ImportRefusedError


def pack(path: Path, entries: dict[str, bytes], method: int = zipfile.ZIP_DEFLATED) -> Path:
    with zipfile.ZipFile(path, "w", method) as file:
        for name, data in entries.items():
            info = zipfile.ZipInfo()  # keeps names as they are given
            info.filename = info.orig_filename = name
            info.compress_type = method
            file.writestr(info, data)
    return path


def refuse(archive: Path, says: str, limits: ArchiveLimits | None = None) -> None:
    before = sorted(archive.parent.iterdir())
    with pytest.raises(ImportRefusedError, match=says):
        extract_archive(archive, archive.parent / "out", limits)
    assert sorted(archive.parent.iterdir()) == before


def test_a_sound_archive_is_unpacked_whole(tmp_path: Path) -> None:
    archive = pack(tmp_path / "a.zip", {"r/depth/1.png": b"one", "r/depth/2.png": b"two", "r/empty/": b""})
    assert extract_archive(archive, tmp_path / "out") == ["r/depth/1.png", "r/depth/2.png"]
    assert (tmp_path / "out/r/depth/2.png").read_bytes() == b"two" and (tmp_path / "out/r/empty").is_dir()
    assert sorted(p.name for p in tmp_path.iterdir()) == ["a.zip", "out"]


def test_an_empty_folder_may_be_there_already_a_full_one_not(tmp_path: Path) -> None:
    archive = pack(tmp_path / "a.zip", {"a.txt": b"one"})
    (tmp_path / "out").mkdir()
    extract_archive(archive, tmp_path / "out")
    with pytest.raises(ImportRefusedError, match="already"):
        extract_archive(archive, tmp_path / "out")


def test_a_packed_recording_can_be_checked_after_unpacking(recording: Path, tmp_path: Path) -> None:
    names = [p for p in recording.rglob("*") if p.is_file()]
    entries = {f"plate/{p.relative_to(recording).as_posix()}": p.read_bytes() for p in names}
    extract_archive(
        pack(tmp_path / "a.zip", entries | {"__MACOSX/plate/._x": b"", "plate/.DS_Store": b""}), tmp_path / "out"
    )
    report = check_import(tmp_path / "out")
    assert report.ok and report.name == "plate" and report.warnings == ()


@pytest.mark.parametrize(
    "name",
    [
        *("../evil.png", "a/../../evil.png", "..", "a/..", "/etc/passwd", "//server/share", "./a.png", "a//b", "."),
        *("c:/windows/a.png", "C:evil", "a:stream", "..\\evil.png", "a\\b.png", "\\\\server\\share"),
        *("NUL", "aux.png", "a/COM1", "lpt9.txt", "con .png", "COM¹"),
        *(
            "a\nb",
            "a\x01b",
            "a\x7fb",
            "a\u202egnp.exe",
            "a\u200bb",
            "\ufeffa",
            "\uff0e\uff0e/a",
            "a\uff0fb",
            "a\uff3cb",
        ),
        *("x" * 300, "a/" * 600 + "b", "a ", " a", "a./b", "...", "a/.. /b", "d/" * 13 + "a"),
    ],
    ids=lambda v: ascii(v)[:24],
)
def test_names_that_lead_elsewhere_are_refused(tmp_path: Path, name: str) -> None:
    refuse(pack(tmp_path / "a.zip", {"good.png": b"1", name: b"evil"}), "a.zip")
    assert not (tmp_path.parent / "evil.png").exists()


@pytest.mark.parametrize(
    "name", ["a.png", "käse/ß.png", "深度/000001.png", "a b.png", "..a/b..c", "auxiliary.png", "com10.x"]
)
def test_usual_names_are_not_refused(tmp_path: Path, name: str) -> None:
    assert find_path_fault(name) == ""
    assert extract_archive(pack(tmp_path / "a.zip", {name: b"1"}), tmp_path / "out") == [name]


def test_a_name_with_a_zero_byte_is_refused(tmp_path: Path) -> None:
    archive = pack(tmp_path / "a.zip", {"aXb.png": b"1"})
    archive.write_bytes(archive.read_bytes().replace(b"aXb.png", b"a\0b.png"))
    refuse(archive, "invisible or control")


@pytest.mark.parametrize("kind", [stat.S_IFLNK, stat.S_IFIFO, stat.S_IFCHR, stat.S_IFBLK, stat.S_IFSOCK])
def test_links_and_devices_are_refused(tmp_path: Path, kind: int) -> None:
    with zipfile.ZipFile(tmp_path / "a.zip", "w") as file:
        info = zipfile.ZipInfo("link")
        info.external_attr = (kind | 0o777) << 16
        file.writestr(info, "/etc/passwd")
    refuse(tmp_path / "a.zip", "link or a device")


@pytest.mark.parametrize(
    "names",
    [
        ("a.png", "a.png"),
        ("a.png", "A.PNG"),
        ("ﬁ.png", "fi.png"),
        ("é", "e\u0301"),
        ("a", "a/b"),
        ("A", "a/b"),
        ("a/b/", "a/b"),
    ],
)
@pytest.mark.filterwarnings("ignore:Duplicate name")
def test_names_that_mean_the_same_file_are_refused(tmp_path: Path, names: tuple[str, str]) -> None:
    with zipfile.ZipFile(tmp_path / "a.zip", "w") as file:
        for name in names:
            file.writestr(name, b"" if name.endswith("/") else b"1")
    refuse(tmp_path / "a.zip", "same file|file and a folder")


def test_an_encrypted_archive_is_refused(tmp_path: Path) -> None:
    archive = pack(tmp_path / "a.zip", {"a.png": b"1" * 50})
    data = bytearray(archive.read_bytes())
    data[6] |= 1
    at = data.index(b"PK\x01\x02")
    data[at + 8] |= 1
    archive.write_bytes(bytes(data))
    refuse(archive, "encrypted")


@pytest.mark.parametrize("method", [zipfile.ZIP_BZIP2, zipfile.ZIP_LZMA])
def test_unusual_packing_is_refused(tmp_path: Path, method: int) -> None:
    refuse(pack(tmp_path / "a.zip", {"a.png": b"1" * 50}, method), "unusual method")


def test_a_bomb_that_says_so_is_refused_by_ratio_size_and_count(tmp_path: Path) -> None:
    archive = pack(tmp_path / "a.zip", {"a.png": b"\0" * 50_000_000})
    refuse(archive, "zip bomb")
    free = 10**12
    refuse(archive, "at most 1000 a file", ArchiveLimits(file_bytes=1000, free_ratio_bytes=free))
    many = pack(tmp_path / "b.zip", {f"{i}.png": b"\0" * 1_000_000 for i in range(40)})
    refuse(many, "zip bomb")
    refuse(many, "at most 5000000", ArchiveLimits(total_bytes=5_000_000, free_ratio_bytes=free))
    refuse(many, "holds 40 files; at most 39", ArchiveLimits(files=39))
    refuse(many, "table of contents", ArchiveLimits(directory_bytes=100))


def test_a_bomb_that_lies_about_its_size_is_refused(tmp_path: Path) -> None:
    archive = pack(tmp_path / "a.zip", {"a.png": b"\0" * 50_000_000})
    data = bytearray(archive.read_bytes())
    at = data.index(b"PK\x01\x02")
    struct.pack_into("<I", data, at + 24, 1000)
    struct.pack_into("<I", data, 22, 1000)
    archive.write_bytes(bytes(data))
    refuse(archive, "a.zip|a.png")


def test_files_that_overlap_are_refused(tmp_path: Path) -> None:
    noise = random.Random(0).randbytes(100_000)
    archive = pack(tmp_path / "a.zip", {"a.png": noise, "b.png": b"x"}, zipfile.ZIP_STORED)
    data = bytearray(archive.read_bytes())
    first = data.index(b"PK\x01\x02")
    second = data.index(b"PK\x01\x02", first + 4)
    data[second + 16 : second + 28] = data[first + 16 : first + 28]
    data[second + 42 : second + 46] = data[first + 42 : first + 46]
    archive.write_bytes(bytes(data))
    refuse(archive, "a.zip")


def test_an_archive_in_an_archive_stays_packed(tmp_path: Path) -> None:
    inner = pack(tmp_path / "inner.zip", {"a.png": b"1"}).read_bytes()
    archive = pack(tmp_path / "outer.zip", {"inner.zip": inner})
    assert extract_archive(archive, tmp_path / "out") == ["inner.zip"]
    assert not check_import(tmp_path / "out").ok


@pytest.mark.parametrize("data", [b"", b"PK", b"\x1f\x8b" + b"\0" * 100, b"x" * 100_000, b"PK\x05\x06" + b"\xff" * 18])
def test_what_is_no_zip_is_refused(tmp_path: Path, data: bytes) -> None:
    (tmp_path / "a.zip").write_bytes(data)
    refuse(tmp_path / "a.zip", "a.zip")


def test_a_missing_archive_is_refused(tmp_path: Path) -> None:
    with pytest.raises(ImportRefusedError, match="no such file"):
        extract_archive(tmp_path / "a.zip", tmp_path / "out")


@settings(max_examples=150, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(data=st.data())
def test_a_damaged_archive_is_unpacked_right_or_not_at_all(tmp_path_factory, data: st.DataObject) -> None:
    folder = tmp_path_factory.mktemp("zip")
    noise = np.random.default_rng(0).bytes(500)
    entries = {"r/a.png": noise, "r/b.txt": b"text " * 40}
    buffer = io.BytesIO(pack(folder / "a.zip", entries).read_bytes())
    packed = bytearray(buffer.getvalue())
    for _ in range(data.draw(st.integers(1, 6))):
        packed[data.draw(st.integers(0, len(packed) - 1))] = data.draw(st.integers(0, 255))
    packed = packed[: data.draw(st.sampled_from([len(packed), len(packed), data.draw(st.integers(0, len(packed)))]))]
    (folder / "a.zip").write_bytes(bytes(packed))
    try:
        extract_archive(folder / "a.zip", folder / "out")
    except ImportRefusedError:
        assert os.listdir(folder) == ["a.zip"]
    else:
        for path in (folder / "out").rglob("*"):
            assert path.is_dir() or path.read_bytes() in entries.values() or path.stat().st_size == 0

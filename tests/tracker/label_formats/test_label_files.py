"""Files of labels: text alone is read, programs are refused, and the same labels are the same bytes."""

from __future__ import annotations

import zipfile
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tracker.errors import AnnotationError
from tracker.label_formats.label_files import pack_files, read_label_files, save_label_files

FILES = {"a.json": b"{}", "cam0/b.CSV": b"1,2", "cam0/deep/c.txt": b"x"}
NAMES = st.from_regex(r"[a-z]{1,6}\.(json|csv|txt)", fullmatch=True)


def write(folder: Path, files: dict[str, bytes]) -> Path:
    for name, data in files.items():
        path = folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(data)
    return folder


def test_a_folder_a_zip_and_one_file_are_read_by_relative_name(tmp_path: Path) -> None:
    folder = write(tmp_path / "labels", FILES | {"picture.png": b"\x89PNG", "README": b"hello"})
    assert read_label_files(folder) == FILES
    (tmp_path / "labels.ZIP").write_bytes(pack_files(FILES))
    assert read_label_files(tmp_path / "labels.ZIP") == FILES
    assert read_label_files(folder / "a.json") == {"a.json": b"{}"}


@pytest.mark.parametrize(
    ("name", "told"),
    [
        ("a.pkl", "pickles are programs"),
        ("a.h5", "writes the same labels as .csv"),
        ("a.png", "needed labels as .json"),
    ],
)
def test_files_that_are_no_text_are_refused(name: str, told: str, tmp_path: Path) -> None:
    (tmp_path / name).write_bytes(b"x")
    with pytest.raises(AnnotationError, match=told):
        read_label_files(tmp_path / name)


def test_a_folder_with_a_pickle_is_read_without_it_and_refused_where_there_is_nothing_else(tmp_path: Path) -> None:
    folder = write(tmp_path / "labels", {"a.pkl": b"x"})
    with pytest.raises(AnnotationError, match=r"a\.pkl: pickles are programs"):
        read_label_files(folder)
    write(folder, {"a.json": b"{}"})
    assert read_label_files(folder) == {"a.json": b"{}"}
    with pytest.raises(AnnotationError, match=r"empty: holds no \.json"):
        read_label_files(write(tmp_path, {"empty/a.png": b"x"}) / "empty")


def test_links_are_passed_over(tmp_path: Path) -> None:
    folder = write(tmp_path / "labels", {"a.json": b"{}"})
    write(tmp_path, {"secret.json": b"[]"})
    (folder / "b.json").symlink_to(tmp_path / "secret.json")
    assert read_label_files(folder) == {"a.json": b"{}"}


@given(st.dictionaries(NAMES, st.binary(max_size=20), max_size=5), st.randoms())
def test_the_same_files_are_the_same_bytes_in_whatever_order(files: dict[str, bytes], chance) -> None:
    shuffled = list(files.items())
    chance.shuffle(shuffled)
    assert pack_files(dict(shuffled)) == pack_files(files)


def test_an_export_is_one_file_a_folder_or_a_zip(tmp_path: Path) -> None:
    save_label_files(tmp_path / "one.json", {"anything.json": b"{}"})
    assert (tmp_path / "one.json").read_bytes() == b"{}"
    save_label_files(tmp_path / "folder", FILES)
    assert read_label_files(tmp_path / "folder") == FILES
    save_label_files(tmp_path / "all.zip", FILES)
    with zipfile.ZipFile(tmp_path / "all.zip") as archive:
        assert archive.namelist() == sorted(FILES)

"""Names of files from outside: whatever is let through lies in its folder, on every system."""

from __future__ import annotations

import re
from pathlib import Path, PureWindowsPath

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tracker.capture.relative_path import find_path_fault, is_inside

PARTS = st.sampled_from(
    ["a", "..", ".", "", " ", "a.", "b c", "con", "COM¹.txt", "x:y", "é", "\u2024\u2024", "．．", "\u202e", "\\", "/"]
)


@given(st.one_of(st.lists(PARTS, max_size=5).map("/".join), st.text(max_size=12)))
def test_what_is_let_through_stays_below_its_folder(text: str) -> None:
    if find_path_fault(text):
        return
    root = Path("/folder")
    assert (root / text).resolve().is_relative_to(root) and (root / text).as_posix() == f"/folder/{text}"
    windows = PureWindowsPath(re.sub(r'["*<>?|]', "_", text))  # Windows cannot write these; newer Pythons say so
    assert not windows.drive and not windows.is_absolute() and not windows.is_reserved()


@pytest.mark.parametrize(
    ("text", "told"),
    [
        ("", "empty"),
        ("a" * 1025, "1025 characters"),
        ("\ud800", "not valid text"),
        ("a\0b", "control characters"),
        ("a\u200bb", "invisible"),
        ("a\\b", "backslash"),
        ("/a", "absolute"),
        ("a:b", "colon"),
        ("a//b", "empty part"),
        ("a/../b", "leads out"),
        ("a/．．/b", "leads out"),
        ("a／b", "leads out|stands for another"),
        ("é" * 128, "longer than 255 bytes"),
        ("a /b", "space"),
        (" a", "space"),
        ("a./b", "dot"),
        ("a/NUL.txt", "device"),
        ("lpt¹", "device"),
    ],
)
def test_each_fault_is_named(text: str, told: str) -> None:
    assert any(word in find_path_fault(text) for word in told.split("|")), find_path_fault(text)


def test_links_are_followed(tmp_path: Path) -> None:
    folder = tmp_path / "folder"
    folder.mkdir()
    (folder / "out").symlink_to(tmp_path)
    (folder / "round").symlink_to(folder / "round")
    assert is_inside(folder / "new.png", folder) and is_inside(folder, folder)
    assert not is_inside(folder / "out" / "x", folder) and not is_inside(folder / "round", folder)
    assert not is_inside(folder / "round" / "x", folder)
    assert not is_inside(tmp_path / "folder2", folder)

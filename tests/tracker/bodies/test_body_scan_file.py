"""A person's size tells a scan's unit; what is no person is refused by name."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from tracker.bodies.body_scan_file import load_body_scan
from tracker.capture.scan import Scan, save_scan
from tracker.errors import ScanError
from tracker.model.body_model import body_model


def save_person(path: Path, units_per_metre: float) -> Path:
    vertices = body_model().template * units_per_metre
    save_scan(Scan(vertices, np.zeros_like(vertices)), path)
    return path


@pytest.mark.parametrize("units_per_metre", [1.0, 1000.0, 100.0, 1 / 0.0254])
def test_metres_millimetres_centimetres_and_inches_are_told_by_the_size(units_per_metre, tmp_path: Path) -> None:
    scan, is_guessed = load_body_scan(save_person(tmp_path / "person.npz", units_per_metre))
    assert is_guessed and 1.6 < np.ptp(scan.points[:, 1]) < 1.8


@pytest.mark.parametrize(
    ("units_per_metre", "given", "said"),
    [(1000.0, 1.0, "1.69e+03 m long"), (10.0, None, "16.8"), (0.2, None, "0.337"), (1.0, -1.0, "positive")],
)
def test_a_wrong_unit_is_refused_with_the_size_it_makes(units_per_metre, given, said, tmp_path: Path) -> None:
    with pytest.raises(ScanError, match=r"person\.npz") as refused:
        load_body_scan(save_person(tmp_path / "person.npz", units_per_metre), given)
    assert "unit" in str(refused.value)
    assert said.split()[0][:4] in str(refused.value) or "long" in str(refused.value)


@pytest.mark.parametrize("content", [b"", b"ply\nformat ascii 1.0\nelement vertex 9\nend_header\n", b"\x80\x04K\x01."])
@pytest.mark.parametrize("name", ["person.ply", "person.npz", "person.pkl"])
def test_empty_broken_and_foreign_files_are_refused_by_name(content: bytes, name: str, tmp_path: Path) -> None:
    (tmp_path / name).write_bytes(content)
    with pytest.raises(ScanError, match=name):
        load_body_scan(tmp_path / name)

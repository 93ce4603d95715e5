"""Arrays of anybody's .npz: those that NumPy wrote, and nothing that a header only claims."""

from __future__ import annotations

import io
import pickle
import zipfile
from pathlib import Path

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from hypothesis.extra import numpy as npst

from tracker.errors import ModelFileError, ScanError
from tracker.model import npz_arrays
from tracker.model.npz_arrays import NpzFields, list_npz_arrays, read_foreign_npz, read_npz_arrays

OWN = st.sampled_from([np.dtype("<f8"), np.dtype("<i8"), np.dtype("<U3")])
FOREIGN = st.one_of(npst.floating_dtypes(), npst.integer_dtypes(), npst.boolean_dtypes(), OWN)
SHAPES = npst.array_shapes(min_dims=0, min_side=0, max_side=4)
LETTERS = st.text(st.characters(codec="ascii", exclude_characters="\0"), max_size=3)
many = settings(max_examples=50, suppress_health_check=[HealthCheck.function_scoped_fixture])


def arrays(kinds: st.SearchStrategy) -> st.SearchStrategy:
    return kinds.flatmap(lambda kind: npst.arrays(kind, SHAPES, elements=LETTERS if kind.kind == "U" else None))


def member(header: str, data: bytes = b"", version: int = 1, name: str = "a") -> bytes:
    """An archive with one array of this header."""
    file = io.BytesIO()
    with zipfile.ZipFile(file, "w") as archive:
        head = header.encode().ljust(117) + b"\n"
        size = len(head).to_bytes(2 if version == 1 else 4, "little")
        archive.writestr(f"{name}.npy", b"\x93NUMPY" + bytes([version, 0]) + size + head + data)
    return file.getvalue()


def describe(dtype: str, shape: str, fortran: bool = False) -> str:
    return f"{{'descr': {dtype!r}, 'fortran_order': {fortran}, 'shape': {shape}, }}"


@many
@given(saved=st.dictionaries(st.from_regex(r"[a-z]{1,8}", fullmatch=True), arrays(OWN), max_size=3))
def test_arrays_come_back_as_they_were_saved(saved: dict[str, np.ndarray], tmp_path: Path) -> None:
    np.savez(tmp_path / "a.npz", allow_pickle=False, **saved)
    back = read_npz_arrays(tmp_path / "a.npz")
    assert back.keys() == saved.keys() == list_npz_arrays(tmp_path / "a.npz")
    for name, array in saved.items():
        np.testing.assert_array_equal(back[name], array)
        assert back[name].dtype == array.dtype and back[name].flags.writeable


@many
@given(array=arrays(FOREIGN), is_fortran=st.booleans())
def test_foreign_numbers_of_every_kind_and_order_come_back(array: np.ndarray, is_fortran: bool, tmp_path: Path) -> None:
    array = np.asarray(array, order="F" if is_fortran else "C")
    np.savez_compressed(tmp_path / "a.npz", a=array)
    back = read_foreign_npz(tmp_path / "a.npz")["a"]
    np.testing.assert_array_equal(back, array)
    assert back.dtype == array.dtype


class Trap:
    def __reduce__(self) -> tuple:
        return Path("unpickled").write_text, ("x",)


def test_a_pickled_object_is_left_out_unread(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    (tmp_path / "a.npz").write_bytes(member(describe("|O", "(1,)"), pickle.dumps(Trap())))
    assert read_foreign_npz(tmp_path / "a.npz") == {}
    with pytest.raises(ModelFileError, match="holds object"):
        read_npz_arrays(tmp_path / "a.npz")
    assert not (tmp_path / "unpickled").exists()


@pytest.mark.parametrize("read", [read_npz_arrays, read_foreign_npz])
@pytest.mark.parametrize(
    ("data", "told"),
    [
        (b"PK", "not a zip"),
        (member(describe("<f8", "(3,)"), bytes(23)), "23 bytes of data"),
        (member(describe("<f8", "(3,)"), bytes(25)), "25 bytes of data"),
        (member(describe("<f8", f"({2**40},)")), "claims"),
        (member(describe("<f8", f"({2**40}, {2**40}, 0)"), b"x"), "1 bytes of data|claims"),
        (member(describe("<f8", "(-1, -3)"), bytes(24)), "shape"),
        (member(describe("<f8", "(3,)"), bytes(24), version=3), "array format"),
        (member("{'descr': '<f8'}"), "damaged"),
    ],
)
def test_a_header_that_does_not_fit_its_data_is_refused(read, data: bytes, told: str, tmp_path: Path) -> None:
    (tmp_path / "a.npz").write_bytes(data)
    with pytest.raises(ModelFileError, match=told):
        read(tmp_path / "a.npz")
    with pytest.raises(ScanError):
        read_foreign_npz(tmp_path / "a.npz", ScanError)


def test_our_own_files_hold_float64_int64_and_text_in_c_order_only(tmp_path: Path) -> None:
    for header in (describe("<f4", "(2,)"), describe(">f8", "(1,)"), describe("<f8", "(1,)", fortran=True)):
        (tmp_path / "a.npz").write_bytes(member(header, bytes(8)))
        with pytest.raises(ModelFileError, match="not float64"):
            read_npz_arrays(tmp_path / "a.npz")


def test_an_archive_with_too_many_or_too_large_members_is_refused(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    np.savez(tmp_path / "many.npz", **{f"a{n}": np.zeros(1) for n in range(npz_arrays.MAX_MEMBERS + 1)})
    np.savez_compressed(tmp_path / "large.npz", a=np.zeros(10_000))
    monkeypatch.setattr(npz_arrays, "MAX_BYTES", 50_000)
    for name in ("many", "large"):
        with pytest.raises(ModelFileError, match="too many or too large"):
            read_foreign_npz(tmp_path / f"{name}.npz")


def test_what_is_no_archive_has_no_arrays(tmp_path: Path) -> None:
    (tmp_path / "a.npz").write_bytes(b"nothing")
    assert list_npz_arrays(tmp_path / "a.npz") == list_npz_arrays(tmp_path / "missing.npz") == set()


FIELDS = NpzFields(
    Path("a.npz"),
    {
        "f": np.ones((3, 2)),
        "short": np.ones(2, np.float32),
        "nan": np.array([np.nan]),
        "big": np.array([1e9]),
        "i": np.array([0, 7]),
        "t": np.array(["a", "b"]),
        "one": np.array("abc"),
        "bytes": np.array(b"abc"),
    },
)


def test_fields_of_the_wanted_kind_and_shape_are_given() -> None:
    assert FIELDS.floats("f", (-1, 2), 1.0).shape == (3, 2)
    assert FIELDS.numbers("short", (2,), 1.0).dtype == np.float64
    assert FIELDS.integers("i", (-1,), 0, 8).tolist() == [0, 7]
    assert FIELDS.texts("t", 2) == ("a", "b") and FIELDS.text("one") == FIELDS.text("bytes") == "abc"


@pytest.mark.parametrize(
    "take",
    [
        lambda: FIELDS.floats("none", (1,), 1.0),
        lambda: FIELDS.floats("f", (3, 3), 1.0),
        lambda: FIELDS.floats("f", (6,), 1.0),
        lambda: FIELDS.floats("short", (2,), 1.0),
        lambda: FIELDS.floats("nan", (1,), 1.0),
        lambda: FIELDS.floats("big", (1,), 1e8),
        lambda: FIELDS.numbers("t", (2,), 1.0),
        lambda: FIELDS.integers("i", (2,), 0, 7),
        lambda: FIELDS.integers("i", (2,), 1, 8),
        lambda: FIELDS.texts("t", 3),
        lambda: FIELDS.texts("one", -1),
        lambda: FIELDS.text("t"),
        lambda: FIELDS.text("one", longest=2),
    ],
)
def test_fields_of_another_kind_shape_or_size_are_refused(take) -> None:
    with pytest.raises(ModelFileError, match=r"a\.npz: found .*; needed "):
        take()

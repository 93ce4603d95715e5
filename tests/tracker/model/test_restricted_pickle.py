"""A model's pickle is read without running it: a hostile one does nothing, whatever it holds."""

from __future__ import annotations

import builtins
import contextlib
import io
import os
import pickle
import pickletools
import subprocess

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy import sparse

from tests.tracker.chumpy_objects import Ch, Select, chumpy_installed
from tracker.errors import ModelFileError
from tracker.model.restricted_pickle import read_restricted_pickle


@pytest.mark.parametrize("protocol", range(6))
def test_arrays_sparse_matrices_and_chumpy_objects_come_out_of_every_protocol(tmp_path, protocol, rng):
    array = rng.standard_normal((7, 3, 4))
    regressor = sparse.random(5, 9, 0.4, random_state=0)
    whole = {
        "plain": array,
        "turned": np.asfortranarray(array[:, :, 0]),
        "single": array.astype(">f4"),
        "faces": np.arange(12, dtype=np.uint32).reshape(4, 3),
        "none": np.zeros((0, 3)),
        "number": np.float64(2.5),
        "csc": sparse.csc_matrix(regressor),
        "csr": sparse.csr_matrix(regressor),
        "coo": sparse.coo_matrix(regressor),
        "constant": Ch(array),
        "selected": Select(Ch(array), np.arange(10, 20), (5, 2)),
        "bs_style": "lbs",
        "objects": np.array([None, {}], dtype=object),
    }
    with chumpy_installed():
        (tmp_path / "model.pkl").write_bytes(pickle.dumps(whole, protocol))
    found = read_restricted_pickle(tmp_path / "model.pkl")
    for name in ("plain", "turned", "single", "faces", "none"):
        np.testing.assert_array_equal(found[name], whole[name])
    assert found["number"] == 2.5 and found["bs_style"] == "lbs" and found["objects"] is None
    for name in ("csc", "csr", "coo"):
        np.testing.assert_array_equal(found[name].toarray(), regressor.toarray())
    np.testing.assert_array_equal(found["constant"], array)
    np.testing.assert_array_equal(found["selected"], array.ravel()[10:20].reshape(5, 2))


class Runs:
    """An object whose pickle calls something."""

    def __init__(self, function, *arguments):
        self.call = (function, arguments)

    def __reduce__(self):
        return self.call


@pytest.mark.parametrize("protocol", [0, 2, 5])
@pytest.mark.parametrize(
    ("function", "argument"),
    [
        (os.system, "touch {}"),
        (subprocess.check_output, ["touch", "{}"]),
        (builtins.eval, "open('{}', 'w')"),
        (builtins.exec, "open('{}', 'w')"),
        (io.open, "{}"),
        (np.load, "{}"),
        (np.save, "{}"),
        (getattr, None),
        (__import__, "os"),
    ],
)
def test_a_hostile_pickle_runs_nothing(tmp_path, function, argument, protocol):
    mark = tmp_path / "mark"
    if isinstance(argument, str):
        argument = argument.replace("{}", str(mark))
    elif isinstance(argument, list):
        argument = [part.replace("{}", str(mark)) for part in argument]
    arguments = (argument,) if function is not np.save else (argument, 1)
    (tmp_path / "bad.pkl").write_bytes(pickle.dumps({"v_template": Runs(function, *arguments)}, protocol))
    with pytest.raises(ModelFileError, match=r"asks for .*, which was not run"):
        read_restricted_pickle(tmp_path / "bad.pkl")
    assert not mark.exists()


@pytest.mark.parametrize(
    "program",
    [
        b"cos\nsystem\n(S'true'\ntR.",
        b"(S'true'\nios\nsystem\n.",  # INST
        b"(cos\nsystem\nS'true'\no.",  # OBJ
        b"\x80\x02cnumpy\nndarray\n(dS'__reduce__'\ncposix\nsystem\nsb.",
        b"\x80\x02cnumpy\nndarray\n}q\x00b.",  # a state of the class itself
        b"\x80\x02cnumpy\nload\n(S'x'\ntR.",
        b"\x80\x02cscipy.sparse\nload_npz\n(S'x'\ntR.",
        b"\x80\x02cnumpy.core.multiarray\n_reconstruct\n(cos\nsystem\ntR.",
        b"\x80\x04\x8c\x08builtins\x8c\x0bobject.open\x93.",
        b"\x80\x02ccopy_reg\n_reconstructor\n(K\x01tR.",
        b"\x80\x02c_codecs\nencode\n(X\x01\x00\x00\x00aX\x05\x00\x00\x00utf-7tR.",
        b"\x82\x01.",  # EXT1
        b"S'1'\nQ.",  # BINPERSID
        b"",
        b"\x80\x09.",
        b"\x80\x02]q\x00.",
        b"(lp0\n.",
        b"\x80\x02N" + b"r\xff\xff\xff\xff.",  # LONG_BINPUT far away
        b"\x80\x05\x96\xff\xff\xff\xff\xff\xff\xff\x00.",  # BYTEARRAY8 of 2^56 bytes
        b"\x80\x04\x8e\xff\xff\xff\xff\xff\xff\xff\x00.",  # BINBYTES8 of 2^56 bytes
    ],
)
def test_bare_programs_are_refused(tmp_path, program):
    (tmp_path / "bad.pkl").write_bytes(program)
    with pytest.raises(ModelFileError):
        read_restricted_pickle(tmp_path / "bad.pkl")


@settings(max_examples=150, deadline=None)
@given(data=st.data())
def test_a_damaged_pickle_is_a_clear_error_or_data_and_never_anything_else(data, tmp_path_factory):
    good = pickle.dumps({"v": np.arange(6.0).reshape(2, 3), "m": sparse.eye(3, format="csc"), "t": "lbs"}, 2)
    place = data.draw(st.integers(0, len(good) - 1))
    bad = good[:place] + bytes([data.draw(st.integers(0, 255))]) + good[place + 1 :]
    path = tmp_path_factory.getbasetemp() / "damaged.pkl"
    path.write_bytes(bad)
    with contextlib.suppress(ModelFileError):
        for value in read_restricted_pickle(path).values():
            assert value is None or isinstance(
                value, (np.ndarray, sparse.csr_array, str, bytes, int, float, list, tuple)
            )


def test_a_file_beyond_the_limit_is_not_read(tmp_path):
    path = tmp_path / "large.pkl"
    with path.open("wb") as file:
        file.truncate(600 * 2**20)
    with pytest.raises(ModelFileError, match="at most"):
        read_restricted_pickle(path)


def test_arrays_whose_data_do_not_fill_their_shape_are_refused(tmp_path):
    good = pickle.dumps({"v": np.arange(6.0).reshape(2, 3)}, 2)
    assert pickletools.genops(good)
    bad = good.replace(b"K\x02K\x03\x86", b"K\x02K\x04\x86")
    assert bad != good
    (tmp_path / "bad.pkl").write_bytes(bad)
    with pytest.raises(ModelFileError, match=r"'v': found a damaged file .*do not fill"):
        read_restricted_pickle(tmp_path / "bad.pkl")

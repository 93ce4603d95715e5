"""Detector files come back to the last bit; what is no detector is refused."""

import contextlib
import io
import zipfile
from dataclasses import fields

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from tests.tracker.detection.toys import PATCHES, SMALL, disc_image, disc_patches
from tracker.detection.default_detector import DATA, default_detector
from tracker.detection.detect import DetectOptions, find_in_image
from tracker.detection.forest_files import load_forest, save_forest
from tracker.detection.training import train_forest
from tracker.errors import ModelFileError


@pytest.fixture(scope="module")
def forest():
    return train_forest(disc_patches(8), PATCHES, SMALL)


@pytest.fixture(scope="module")
def saved(forest, tmp_path_factory):
    path = tmp_path_factory.mktemp("detectors") / "discs.npz"
    save_forest(forest, path)
    return path


def test_a_detector_comes_back_to_the_last_bit(forest, saved):
    back = load_forest(saved)
    for field in fields(forest):
        one, other = getattr(forest, field.name), getattr(back, field.name)
        if isinstance(one, np.ndarray):
            assert one.dtype == other.dtype
            assert one.shape == other.shape
            assert one.tobytes() == other.tobytes()
        else:
            assert one == other


def test_the_same_detector_makes_the_same_file_contents(forest, saved, tmp_path):
    save_forest(load_forest(saved), tmp_path / "again.npz")
    with np.load(saved) as one, np.load(tmp_path / "again.npz") as other:
        assert one.files == other.files
        assert all(one[name].tobytes() == other[name].tobytes() for name in one.files)


def change(saved, path, **arrays):
    with np.load(saved) as given:
        np.savez(path, **({name: given[name] for name in given.files} | arrays))
    return path


def with_node(saved, row, values):
    with np.load(saved) as given:
        nodes = given["nodes"].copy()
    nodes[row] = values
    return nodes


@pytest.mark.parametrize(
    ("values", "why"),
    [
        ((0, 0, 1, 3, 0), "a child that is its own parent"),
        ((0, 0, 1, 3, 32000), "a child that does not exist"),
        ((11, 0, 1, 3, 1), "a channel that does not exist"),
        ((0, 256, 1, 3, 1), "a place outside the patch"),
        ((0, 0, -1, 3, 1), "a place before the patch"),
        ((-1, 0, 0, 0, 32000), "a leaf that does not exist"),
        ((-1, 0, 0, 0, -5), "a leaf before the first"),
    ],
)
def test_a_walk_that_would_go_astray_is_refused(saved, tmp_path, values, why):
    path = change(saved, tmp_path / "bad.npz", nodes=with_node(saved, 0, values))
    with pytest.raises(ModelFileError, match="tree 0 with an impossible node"):
        load_forest(path)


@pytest.mark.parametrize(
    ("arrays", "said"),
    [
        ({"format": np.array(["something else"])}, "the format 'something else'"),
        ({"kind": np.array(["smell"])}, "the kind 'smell'"),
        ({"sizes": np.array([0.003, 0.032, np.nan])}, "infinite"),
        ({"sizes": np.array([0.003, 0.032, 0.0])}, "sizes"),
        ({"nodes": np.zeros((0, 5), dtype=np.int64)}, "node_starts"),
        ({"nodes": np.full((9, 5), 10**6)}, "values from"),
        ({"node_starts": np.array([0, 7, 3])}, "node_starts"),
        ({"leaf_starts": np.array([0])}, "leaf_starts"),
        ({"probability": np.array([[0.5]])}, "probability"),
        ({"votes": np.zeros((2, 3, 4))}, "votes"),
    ],
)
def test_wrong_contents_are_refused_by_name(saved, tmp_path, arrays, said):
    with pytest.raises(ModelFileError, match=said):
        load_forest(change(saved, tmp_path / "bad.npz", **arrays))


def test_pickles_are_not_opened(saved, tmp_path):
    path = tmp_path / "pickled.npz"
    np.savez(path, format=np.array([{"a": 1}], dtype=object))
    with pytest.raises(ModelFileError, match="object"):
        load_forest(path)


def test_what_is_no_file_or_no_archive_is_refused(tmp_path):
    with pytest.raises(ModelFileError, match="No such file"):
        load_forest(tmp_path / "nowhere.npz")
    (tmp_path / "text.npz").write_text("hello")
    with pytest.raises(ModelFileError, match="5 bytes that are no"):
        load_forest(tmp_path / "text.npz")


@settings(max_examples=60, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(data=st.data())
def test_garbled_bytes_give_a_detector_or_a_clear_error(saved, tmp_path, data):
    content = bytearray(saved.read_bytes())
    for _ in range(data.draw(st.integers(1, 4))):
        place = data.draw(st.integers(0, len(content) - 1))
        content[place] = data.draw(st.integers(0, 255))
    del content[data.draw(st.sampled_from([len(content), len(content) // 2, 10])) :]
    path = tmp_path / "garbled.npz"
    path.write_bytes(bytes(content))
    with contextlib.suppress(ModelFileError):
        # What is still a detector can be used: no walk leaves the forest.
        forest = load_forest(path)
        find_in_image(forest, disc_image(np.random.default_rng(0))[0], DetectOptions(min_confidence=0.0))


def test_a_member_that_claims_more_than_it_holds_is_refused(saved, tmp_path):
    header = io.BytesIO()
    np.lib.format.write_array_header_1_0(header, {"descr": "<f8", "fortran_order": False, "shape": (10**12, 1)})
    path = tmp_path / "huge.npz"
    with zipfile.ZipFile(saved) as given, zipfile.ZipFile(path, "w") as out:
        for name in given.namelist():
            out.writestr(name, header.getvalue() if name == "probability.npy" else given.read(name))
    with pytest.raises(ModelFileError):
        load_forest(path)


def test_the_detector_that_comes_along_is_as_the_paper_wants_it_and_small():
    forest = default_detector()
    assert forest.kind == "depth"
    assert forest.num_trees == 10
    assert DATA.stat().st_size < 3_000_000
    assert (forest.probability[forest.nodes[forest.nodes[:, 0] < 0, 4]] >= 0.0).all()

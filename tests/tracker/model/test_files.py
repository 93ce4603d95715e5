"""Model files are told apart, and bad ones refused."""

from __future__ import annotations

import shutil
from pathlib import Path

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from tracker.errors import ModelFileError
from tracker.model import load_model, load_t16_model, load_t16_motion
from tracker.model.default_hand import default_hand

BOX = """OFF
8 6 0
0 0 0
30 0 0
30 10 0
0 10 0
0 0 10
30 0 10
30 10 10
0 10 10
4 0 3 2 1
4 4 5 6 7
4 0 1 5 4
4 1 2 6 5
4 2 3 7 6
4 3 0 4 7
"""
SKEL = "5\nRoot_NULL\nA\n15\nA\nB\n15\n"
SKIN = "2\nA B \n" + "1 0\n0 1\n0 1\n1 0\n" * 2
LIMITS = """A
1 1 1 1
0 0 0
0 0 0
0 0 0
-1e38 1e38
-1e38 1e38
-1e38 1e38

B
0 0 1 1
1 0 0
0 1 0
0 0 1
-10 10
-60 60
-0 0
"""
MOTION = """A
1 0 0 0 1 0 0 0 1 0 5 5
1 0 0 0 1 0 0 0 1 0 5 500
B
1 0 0 0 1 0 0 0 1 15 5 5
0 0 1 0 1 0 -1 0 0 15 5 500
"""
FILES = {"OFF": BOX, "SKEL": SKEL, "SKIN": SKIN, "LIMITS": LIMITS, "MOTION": MOTION}


def write(folder: Path, **changed: str | None) -> Path:
    """A hinge in T16's format, of one bone that turns on another."""
    for suffix, text in (FILES | changed).items():
        (folder / f"hinge.{suffix}").unlink(missing_ok=True)
        if text is not None:
            (folder / f"hinge.{suffix}").write_text(text)
    return folder / "hinge.OFF"


def test_a_t16_model_is_read_with_its_bind_pose_from_the_motion_beside_it(tmp_path: Path) -> None:
    model = load_model(write(tmp_path))
    assert model.hand is None and model.num_dofs == 7 and len(model.faces) == 12
    np.testing.assert_allclose(model.skeleton.joints_rest, [[0, 0.005, 0.005], [0.015, 0.005, 0.005]])
    np.testing.assert_allclose(model.skeleton.dof_axes, [[0.0, 1.0, 0.0]])
    np.testing.assert_allclose(np.degrees(model.skeleton.upper), [60.0])
    assert model.provenance["bind_pose"] == "first row of hinge.MOTION"


def test_a_t16_model_without_any_motion_gets_its_joints_from_mesh_and_weights(tmp_path: Path) -> None:
    model = load_model(write(tmp_path, MOTION=None))
    assert model.num_dofs == 7 and "estimated" in model.provenance["bind_pose"]
    np.testing.assert_allclose(np.abs(model.skeleton.dof_axes), [[0.0, 1.0, 0.0]], atol=1e-9)


def test_a_bind_pose_can_be_given(tmp_path: Path) -> None:
    bind = np.tile(np.eye(4), (2, 1, 1))
    bind[1, :3, 3] = [0.015, 0.0, 0.0]
    model = load_t16_model(write(tmp_path, MOTION=None), bind=bind)
    np.testing.assert_allclose(model.skeleton.joints_rest, bind[:, :3, 3])


def test_a_motion_is_read_in_metres(tmp_path: Path) -> None:
    write(tmp_path)
    names, motion, bind = load_t16_motion(tmp_path / "hinge.MOTION")
    assert names == ("A", "B") and motion.shape == (1, 2, 4, 4)
    np.testing.assert_allclose(bind[1, :3, 3], [0.015, 0.005, 0.005])
    np.testing.assert_allclose(motion[0, 1, :3, 3], [0.015, 0.005, 0.5])


@pytest.mark.parametrize("suffix", ["SKEL", "SKIN", "LIMITS"])
def test_a_t16_model_without_one_of_its_files_names_the_missing_one(tmp_path: Path, suffix: str) -> None:
    with pytest.raises(ModelFileError, match=f"hinge.{suffix}"):
        load_model(write(tmp_path, **{suffix: None}))


BAD_TEXTS = {
    "an empty mesh": {"OFF": ""},
    "another format": {"OFF": "ply\n"},
    "a head that promises more": {"OFF": BOX.replace("8 6 0", "80 6 0")},
    "a head that promises everything": {"OFF": BOX.replace("8 6 0", "999999999 6 0")},
    "counts that are words": {"OFF": BOX.replace("8 6 0", "eight six 0")},
    "a face with a vertex too many": {"OFF": BOX.replace("4 3 0 4 7", "4 3 0 4 8")},
    "a face with a negative vertex": {"OFF": BOX.replace("4 3 0 4 7", "4 3 0 4 -7")},
    "a face cut short": {"OFF": BOX.replace("4 3 0 4 7", "4 3 0 4")},
    "a face of two corners": {"OFF": BOX.replace("4 3 0 4 7", "2 3 0")},
    "a vertex of two coordinates": {"OFF": BOX.replace("30 10 10", "30 10")},
    "a vertex at infinity": {"OFF": BOX.replace("30 10 10", "inf 10 10")},
    "a skeleton cut short": {"SKEL": SKEL[:-4]},
    "a skeleton in circles": {"SKEL": "5\nB\nA\n15\nA\nB\n15\n"},
    "two roots": {"SKEL": "5\nX\nA\n15\nY\nB\n15\n"},
    "a bone twice": {"SKEL": "5\nX\nA\n15\nA\nA\n15\n"},
    "weights for fewer vertices": {"SKIN": SKIN[:-4]},
    "weights of other bones": {"SKIN": SKIN.replace("A B", "A C")},
    "negative weights": {"SKIN": SKIN.replace("1 0", "2 -1")},
    "weights that are nothing": {"SKIN": SKIN.replace("1 0", "0 0")},
    "limits of one bone": {"LIMITS": LIMITS.split("\n\n")[0]},
    "limits cut short": {"LIMITS": LIMITS[:-6]},
    "a bone that slides": {"LIMITS": LIMITS.replace("0 0 1 1", "1 0 1 1")},
    "an axis of no length": {"LIMITS": LIMITS.replace("0 1 0\n0 0 1", "0 0 0\n0 0 1")},
    "a motion of other bones": {"MOTION": MOTION + "C\n1 0 0 0 1 0 0 0 1 0 0 0\n1 0 0 0 1 0 0 0 1 0 0 0\n"},
    "a motion that shears": {"MOTION": MOTION.replace("1 0 0 0 1 0", "2 0 0 0 1 0")},
    "a motion with fewer rows for a bone": {"MOTION": MOTION + "1 0 0 0 1 0 0 0 1 0 0 0\n"},
    "a motion that starts with numbers": {"MOTION": "1 0 0\n" + MOTION},
}


@pytest.mark.parametrize("what", BAD_TEXTS)
def test_a_t16_model_with_a_wrong_text_is_refused(tmp_path: Path, what: str) -> None:
    with pytest.raises(ModelFileError) as caught:
        load_model(write(tmp_path, **BAD_TEXTS[what]))
    assert caught.value.found and caught.value.needed


def test_a_mano_pickle_is_named_and_never_opened(tmp_path: Path) -> None:
    (tmp_path / "MANO_RIGHT.pkl").write_bytes(b"cos\nsystem\n(S'false'\ntR.")
    with pytest.raises(ModelFileError, match="MANO"):
        load_model(tmp_path / "MANO_RIGHT.pkl")


@pytest.mark.parametrize("name", ["hand.obj", "hand", "missing.npz"])
def test_other_files_are_refused_with_the_kinds_that_are_read(tmp_path: Path, name: str) -> None:
    if not name.startswith("missing"):
        (tmp_path / name).write_text("v 0 0 0\n")
    with pytest.raises(ModelFileError, match=r"\.npz"):
        load_model(tmp_path / name)


@settings(max_examples=150, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(
    suffix=st.sampled_from(sorted(FILES)),
    changes=st.lists(st.tuples(st.integers(0, 400), st.integers(0, 255)), max_size=6),
    cut=st.integers(0, 500),
)
def test_garbled_and_truncated_texts_give_a_model_or_a_model_file_error(
    tmp_path: Path, suffix: str, changes: list[tuple[int, int]], cut: int
) -> None:
    path = write(tmp_path)
    data = bytearray(FILES[suffix].encode())
    for place, value in changes:
        data[place % len(data)] = value
    (tmp_path / f"hinge.{suffix}").write_bytes(bytes(data)[:cut])
    try:
        model = load_model(path)
    except ModelFileError:
        return
    assert np.all(np.isfinite(model.skeleton.dof_axes)) and np.all(np.isfinite(model.vertices))


@settings(max_examples=60, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(data=st.binary(max_size=300), suffix=st.sampled_from([".npz", ".glb", ".gltf", ".OFF"]))
def test_random_bytes_are_refused(tmp_path: Path, data: bytes, suffix: str) -> None:
    write(tmp_path)
    path = tmp_path / f"hinge{suffix}"
    path.write_bytes(data)
    with pytest.raises(ModelFileError):
        load_model(path)


@pytest.mark.shared_data
def test_the_models_of_t16_are_told_by_their_suffix_and_suffice_alone(shared_data: Path, tmp_path: Path) -> None:
    for path in (shared_data / "ijcv16" / "models").glob("Model_Hand_R.*"):
        shutil.copy(path, tmp_path / path.name)
    model = load_model(tmp_path / "Model_Hand_R.OFF")
    known = load_model(shared_data / "ijcv16" / "models" / "Model_Hand_R.OFF")
    assert model.num_dofs == known.num_dofs == default_hand("right").num_dofs
    assert "estimated" in model.provenance["bind_pose"]
    cosines = np.einsum("kx,kx->k", model.skeleton.dof_axes, known.skeleton.dof_axes)
    assert np.degrees(np.arccos(np.median(cosines))) < 10.0 and np.degrees(np.arccos(np.min(cosines))) < 30.0
    errors = np.linalg.norm(model.skeleton.joints_rest - known.skeleton.joints_rest, axis=1)
    assert np.median(errors) < 0.006 and errors.max() < 0.016

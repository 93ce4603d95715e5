import numpy as np
import pytest

from tracker.errors import TrainingError
from tracker.training.training_set import load_training_set, make_training_set


def write(folder, name, verdict="good", side="right", count=20, **changes):
    (folder / name).mkdir(parents=True)
    rng = np.random.default_rng(len(name))
    arrays = {
        "vertices": rng.normal(size=(count, 3)),
        "scan_to_mesh": np.zeros(4, dtype=np.float32),
        **{key: np.array(value) for key, value in {"scan": name, "verdict": verdict, "side": side}.items()},
        "subject": np.array("ann"),
        "pose_name": np.array("fist"),
        **changes,
    }
    np.savez(folder / name / "registration.npz", **arrays)
    return arrays["vertices"]


def test_the_verdict_decides_unless_scans_are_named(tmp_path):
    write(tmp_path, "one")
    write(tmp_path, "three", verdict="doubtful")
    assert len(load_training_set(tmp_path)) == 1
    assert len(load_training_set(tmp_path, verdicts=("good", "doubtful"))) == 2
    assert list(load_training_set(tmp_path, {"three"}).subjects) == ["ann"]


def test_left_hands_are_mirrored(tmp_path):
    right, left = write(tmp_path, "one"), write(tmp_path, "three", side="left")
    loaded = load_training_set(tmp_path)
    np.testing.assert_array_equal(loaded.vertices[0], right)
    np.testing.assert_array_equal(loaded.vertices[1], left * [-1, 1, 1])
    assert list(loaded.mirrored) == [False, True] and list(loaded.hands) == ["ann", "ann (left)"]


def test_the_digest_names_the_set_whatever_the_order():
    rng = np.random.default_rng(0)
    vertices = rng.normal(size=(3, 8, 3))
    a = make_training_set(vertices, "xyz", "pqr", [False] * 3)
    b = make_training_set(vertices[::-1], "zyx", "rqp", [False] * 3)
    c = make_training_set(vertices, "xyz", "pqp", [False] * 3)
    assert a.digest == b.digest != c.digest


def test_what_does_not_fit_is_refused(tmp_path):
    with pytest.raises(TrainingError, match="no such folder"):
        load_training_set(tmp_path / "nowhere")
    with pytest.raises(TrainingError, match="0 registrations"):
        load_training_set(tmp_path)
    write(tmp_path, "bad", verdict="bad")
    with pytest.raises(TrainingError, match="1 registrations, none"):
        load_training_set(tmp_path)
    with pytest.raises(TrainingError, match="20, 21"):
        make_training_set([np.zeros((20, 3)), np.zeros((21, 3))], "ab", "ab", [False, False])
    with pytest.raises(TrainingError, match="first number 1"):
        make_training_set([np.zeros((2, 3)), np.full((2, 3), np.nan)], "ab", "ab", [False, False])


@pytest.mark.parametrize(
    "changes",
    [
        {"vertices": np.zeros((4, 2))},
        {"vertices": np.zeros((4, 3), dtype=np.int64)},
        {"side": np.array("both")},
        {"subject": np.array(3)},
        {"vertices": np.array([{"a": 1}], dtype=object)},
    ],
)
def test_hostile_registrations_are_refused(tmp_path, changes):
    write(tmp_path, "one", **changes)
    with pytest.raises(TrainingError, match=r"registration\.npz"):
        load_training_set(tmp_path)


def test_a_truncated_file_is_refused_and_other_archives_are_passed_over(tmp_path):
    write(tmp_path, "one")
    np.savez(tmp_path / "other.npz", a=np.zeros(3))
    assert len(load_training_set(tmp_path)) == 1
    path = tmp_path / "one" / "registration.npz"
    path.write_bytes(path.read_bytes()[:200])
    with pytest.raises(TrainingError, match="damaged file"):
        load_training_set(tmp_path)

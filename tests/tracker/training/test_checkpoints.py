"""A training that is interrupted anywhere goes on at the last finished stage and ends with the same bits."""

from dataclasses import replace

import numpy as np
import pytest

from tests.tracker.training.test_train import crude_finger, make_set
from tracker.training.checkpoints import FolderCheckpoints, PrefixedCheckpoints
from tracker.training.options import TrainingOptions
from tracker.training.stages import list_stages
from tracker.training.train import train_model

OPTIONS = TrainingOptions(rounds=2, num_shapes=3, ridge=1e-4)
ARRAYS = (
    "template",
    "shape_directions",
    "pose_directions",
    "skinning_weights",
    "pose_mean",
    "pose_components",
)


class Stopped(Exception):
    pass


class Watched:
    """Checkpoints in a folder that may break off, before or after a stage is kept, and that say what was done."""

    def __init__(self, folder, stop_at=None, keeps_it=False):
        self.inner, self.stop_at, self.keeps_it, self.saved = FolderCheckpoints(folder), stop_at, keeps_it, []

    def load(self, stage):
        return self.inner.load(stage)

    def save(self, stage, arrays):
        if stage == self.stop_at and not self.keeps_it:
            raise Stopped
        self.inner.save(stage, arrays)
        self.saved.append(stage)
        if stage == self.stop_at:
            raise Stopped


def assert_same(one, other):
    for name in ARRAYS:
        assert getattr(one.model, name).tobytes() == getattr(other.model, name).tobytes(), name
    assert (one.model.joint_regressor != other.model.joint_regressor).nnz == 0
    assert one.poses.tobytes() == other.poses.tobytes()
    assert one.templates.tobytes() == other.templates.tobytes()
    assert {**one.report, "seconds": 0} == {**other.report, "seconds": 0}


@pytest.fixture(scope="module")
def few():
    return make_set(people=4, poses=8)


@pytest.fixture(scope="module")
def undisturbed(few):
    return train_model(few, crude_finger(), OPTIONS)


@pytest.mark.parametrize("keeps_it", [False, True])
def test_broken_off_at_every_stage_in_turn_it_ends_with_the_same_bits(few, undisturbed, tmp_path, keeps_it):
    done = []
    for stage in list_stages(OPTIONS.rounds):
        watched = Watched(tmp_path, stage, keeps_it)
        with pytest.raises(Stopped):
            train_model(few, crude_finger(), OPTIONS, checkpoints=watched)
        done += watched.saved
    last = Watched(tmp_path)
    again = train_model(few, crude_finger(), replace(OPTIONS, threads=3), checkpoints=last)
    assert done + last.saved == list_stages(OPTIONS.rounds), "no stage was done twice"
    assert_same(undisturbed, again)
    assert set(again.report["seconds"]) == set(undisturbed.report["seconds"])


def test_cancelled_in_the_middle_of_any_part_it_ends_with_the_same_bits(few, undisturbed, tmp_path):
    seen, shares = set(), []

    def cancel_what_is_new(part, share):
        shares.append(share)
        if part not in seen:
            seen.add(part)
            raise Stopped

    for _ in range(30):
        try:
            shares.clear()
            again = train_model(few, crude_finger(), OPTIONS, cancel_what_is_new, FolderCheckpoints(tmp_path))
            break
        except Stopped:
            continue
    assert len(seen) > 10 and shares == sorted(shares) and shares[-1] == 1.0
    assert_same(undisturbed, again)


@pytest.mark.parametrize("other", ["options", "registrations", "order", "initial"])
def test_what_another_training_kept_is_not_gone_on_with(few, tmp_path, other):
    options, chosen, initial = replace(OPTIONS, rounds=1), few, crude_finger()
    train_model(chosen, initial, options, checkpoints=FolderCheckpoints(tmp_path))
    if other == "options":
        options = replace(options, joint_stiffness=3.0)
    elif other == "registrations":
        chosen = few.select(np.arange(len(few) - 1))
    elif other == "order":
        chosen = few.select(np.arange(len(few))[::-1])
    else:
        initial = replace(initial, template=1.001 * initial.template)
    watched = Watched(tmp_path)
    train_model(chosen, initial, options, checkpoints=watched)
    assert watched.saved == list_stages(1)


def test_a_damaged_stage_is_done_again_from_the_one_before(few, undisturbed, tmp_path):
    train_model(few, crude_finger(), OPTIONS, checkpoints=FolderCheckpoints(tmp_path))
    names = list_stages(OPTIONS.rounds)
    (tmp_path / f"{names[-1]}.npz").write_bytes(b"PK nothing")
    middle = tmp_path / f"{names[-2]}.npz"
    data = bytearray(middle.read_bytes())
    data[len(data) // 2] ^= 1
    middle.write_bytes(data)
    watched = Watched(tmp_path)
    again = train_model(few, crude_finger(), OPTIONS, checkpoints=watched)
    assert watched.saved == names[-2:]
    assert_same(undisturbed, again)


def test_two_trainings_in_one_place_do_not_meet_and_each_is_removed_by_itself(few, tmp_path):
    kept = FolderCheckpoints(tmp_path / "kept")
    one = replace(OPTIONS, rounds=1)
    for prefix, options in (("a", one), ("b", replace(one, with_pose_shapes=False))):
        train_model(few, crude_finger(), options, checkpoints=PrefixedCheckpoints(kept, prefix))
    kept.remove(f"a-{name}" for name in list_stages(1))
    assert {path.name for path in (tmp_path / "kept").iterdir()} == {f"b-{name}.npz" for name in list_stages(1)}
    kept.remove(f"b-{name}" for name in list_stages(1))
    assert not (tmp_path / "kept").exists()

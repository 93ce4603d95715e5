"""Stages of a training: their order, every bit of what they leave, and whose it is."""

import numpy as np
from scipy.sparse import csr_array

from tests.tracker.training.fingers import PARENTS, crude_regressor, make_fingers
from tracker.model.skinning import keep_heaviest
from tracker.training.learn import Learnt
from tracker.training.pose_fit import Poses
from tracker.training.rig import Rig
from tracker.training.stages import FIRST, LAST, Stage, find_last, list_stages, pack_stage, unpack_stage


class Kept:
    """Stages in memory."""

    def __init__(self) -> None:
        self.stages: dict[str, dict[str, np.ndarray]] = {}

    def load(self, stage):
        return self.stages.get(stage)

    def save(self, stage, arrays):
        self.stages[stage] = dict(arrays)


def make_stage(errors: tuple[float, ...] = (0.002, 0.001)) -> Stage:
    fingers = make_fingers(people=2, poses=3)
    poses = Poses(fingers.rotations, fingers.translations, np.linspace(0.0, 0.001, 6))
    rig = Rig(PARENTS, keep_heaviest(fingers.weights), fingers.directions)
    regressor = csr_array(crude_regressor(fingers.templates[0]))
    learnt = Learnt(fingers.templates, fingers.joints, poses, rig, regressor)
    return Stage(learnt, errors, {"poses": 1.25, "templates": 0.5})


def test_every_bit_comes_back():
    stage = make_stage()
    again = unpack_stage(pack_stage(stage, "key"))
    assert again.errors == stage.errors and dict(again.seconds) == dict(stage.seconds)
    packed, repacked = pack_stage(stage, "key"), pack_stage(again, "key")
    assert packed.keys() == repacked.keys()
    for name, array in packed.items():
        assert array.dtype == repacked[name].dtype and array.tobytes() == repacked[name].tobytes()


def test_there_are_two_stages_a_round_between_the_first_and_the_last():
    assert list_stages(2) == [FIRST, "round-1-joints", "round-1", "round-2-joints", "round-2", LAST]


def test_the_last_stage_of_the_same_training_is_gone_on_from():
    kept, names = Kept(), list_stages(1)
    assert find_last(kept, names, "mine") == (0, None)
    kept.save(names[0], pack_stage(make_stage(errors=(0.004,)), "mine"))
    kept.save(names[1], pack_stage(make_stage(errors=(0.003,)), "mine"))
    kept.save(names[2], pack_stage(make_stage(errors=(0.002,)), "another"))
    done, stage = find_last(kept, names, "mine")
    assert done == 2 and stage is not None and stage.errors == (0.003,)
    assert find_last(kept, names, "nobody's") == (0, None)


def test_what_another_version_kept_is_refused_in_a_sentence(caplog):
    kept, names = Kept(), list_stages(1)
    old = pack_stage(make_stage(), "mine")
    del old["version"]
    kept.save(names[1], {**old, "ridge": np.array([1e-4]), "ridges": np.zeros((0, 2))})
    assert find_last(kept, names, "mine") == (0, None)
    assert "stage round-1-joints was kept by another version of Handloom" in caplog.text
    assert "version 1, this one reads version 3" in caplog.text

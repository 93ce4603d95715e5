"""A study judges each model once, keeps every part, and tells how far it is."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path
from shutil import copytree
from typing import Any

import numpy as np
import pytest

from tests.tracker.evaluation.test_held_out import OPTIONS, register
from tracker.evaluation.held_out import HeldOut, make_test_hand
from tracker.evaluation.held_out_study import LEARNED, SHAPES_OFF, StudyLevel, study_held_out
from tracker.model.untrained_hand import untrained_hand
from tracker.synthesis.scans.generate import generate_truth
from tracker.training.checkpoints import FolderCheckpoints
from tracker.training.training_set import make_training_set

LEVEL = StudyLevel(hands=1, curve_hands=1, counts=(3, 0, 99, 3), trains_others=False)


@pytest.fixture(scope="module")
def models():
    """A hand that can be made larger, with a pose space of two components, and one that cannot."""
    crude = untrained_hand("right")
    rng = np.random.default_rng(0)
    sized = replace(
        crude,
        shape_directions=0.1 * crude.template[:, :, None],
        pose_components=np.linalg.qr(rng.normal(size=(45, 2)))[0].T,
        pose_directions=1e-5 * rng.normal(size=crude.pose_directions.shape),
    )
    return sized, replace(crude, shape_directions=crude.shape_directions[:, :, :1])


@pytest.fixture(scope="module")
def held_out():
    return HeldOut((make_test_hand(*register(32, 5)),), {"s32": generate_truth(32, 0).vertices})


@pytest.fixture(scope="module")
def training_set():
    truth = generate_truth(1, 0)
    return make_training_set([truth.vertices], ["s1"], [truth.pose_name], [False])


@pytest.fixture(scope="module")
def study(models, held_out, training_set):
    learned, other = models

    def study(kept: FolderCheckpoints, progress=None) -> dict[str, Any]:
        arguments = (learned, {"crude": other}, held_out, training_set, learned, OPTIONS, LEVEL)
        return study_held_out(*arguments, progress, kept)

    return study


@pytest.fixture(scope="module")
def studied(study, tmp_path_factory: pytest.TempPathFactory):
    """The study, what was told of it, and where its parts are kept."""
    folder, told = tmp_path_factory.mktemp("kept") / "parts", []
    found = study(FolderCheckpoints(folder), lambda stage, share: told.append((stage, share)))
    return found, told, folder


def test_each_model_is_judged_with_pose_and_shape_and_with_a_template_of_each_persons_own(studied) -> None:
    found, _, _ = studied
    assert json.loads(json.dumps(found, allow_nan=False)) == found
    assert list(found["models"]) == [LEARNED, "crude"] and list(found["own_template"]) == [LEARNED, SHAPES_OFF]
    assert (found["people"], found["scans"], found["not_compared"]) == (["s32"], 1, {})
    assert found["own_template"][LEARNED]["vertices_mm"] < found["models"][LEARNED]["vertices_mm"]


def test_the_curve_has_each_number_of_components_once_and_no_more_than_there_are(studied) -> None:
    rows = studied[0]["pose_generalisation"][LEARNED]
    assert [row["components"] for row in rows] == [0, 2]
    assert all(0 < row["mean_mm"] < 20 for row in rows)


def test_shares_ascend_to_the_end_and_every_part_is_told_by_name(studied) -> None:
    stages, shares = zip(*studied[1], strict=True)
    assert list(shares) == sorted(shares) and shares[0] >= 0 and shares[-1] <= 1.0
    assert {"learned: pose and shape", "crude: pose and shape", "learned: pose", "blend shapes off: pose"} <= set(
        stages
    )
    assert "learned: 2 pose components" in stages


def test_a_part_that_is_kept_is_not_judged_again(studied, study, tmp_path: Path) -> None:
    found, _, folder = studied
    copytree(folder, tmp_path / "parts")
    kept, told = FolderCheckpoints(tmp_path / "parts"), []
    kept.save("judged-crude-pose-and-shape", {"vertices_mm": np.array(123.0)})
    again = study(kept, lambda stage, share: told.append(stage))
    assert told == [] and again["models"]["crude"] == {"vertices_mm": 123.0}
    again["models"]["crude"] = found["models"]["crude"]
    assert again | {"seconds": 0} == found | {"seconds": 0}


def test_whoever_is_told_may_cancel_and_gone_on_with_it_is_the_same_study(studied, study, tmp_path: Path) -> None:
    found, _, folder = studied
    copytree(folder, tmp_path / "parts")
    (tmp_path / "parts" / "judged-learned-pose.npz").unlink()
    kept = FolderCheckpoints(tmp_path / "parts")

    def stop(stage: str, share: float) -> None:
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        study(kept, stop)
    assert kept.load("judged-learned-pose") is None
    assert study(kept) | {"seconds": 0} == found | {"seconds": 0}

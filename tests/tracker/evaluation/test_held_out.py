"""Models judged on people kept for testing, with what they would be without each of their parts."""

from __future__ import annotations

import json
from dataclasses import replace
from html.parser import HTMLParser

import numpy as np
import pytest

from tracker.capture.scan import Scan
from tracker.errors import RegistrationError
from tracker.evaluation.held_out import HeldOut, choose_held_out, make_test_hand
from tracker.evaluation.held_out_study import StudyLevel, study_held_out
from tracker.evaluation.model_report_html import write_model_html
from tracker.model.untrained_hand import untrained_hand
from tracker.registration.registration import Registration
from tracker.synthesis.scans.generate import generate_truth
from tracker.training.checkpoints import FolderCheckpoints
from tracker.training.options import TrainingOptions
from tracker.training.train import train_model
from tracker.training.training_set import make_training_set

OPTIONS = TrainingOptions(rounds=1, num_shapes=2, ridge=1e-3)
LEVEL = StudyLevel(hands=4, curve_hands=2, counts=(0, 2, 45), trains_others=True)


def register(subject: int, pose: int, side: str = "right") -> tuple[Scan, Registration]:
    """A few points of a surface, and its true vertices as the registration; the first ten points are of no hand."""
    truth = generate_truth(subject, pose, side)
    ids = np.random.default_rng(pose).integers(0, len(truth.surface), 400)
    points = np.concatenate([np.full((10, 3), 0.5), truth.surface[ids]])
    distances = np.where(np.arange(410) < 10, np.nan, 1e-4)
    model = untrained_hand("right")
    found = Registration(
        vertices=truth.vertices,
        model_vertices=truth.vertices,
        faces=np.asarray(model.faces),
        pose=np.zeros((16, 3)),
        shape=np.zeros(0),
        translation=np.zeros(3),
        side=side,
        verdict="good",
        score=0.0,
        reasons=(),
        scan_to_mesh=distances,
        seconds=0.0,
        subject=f"s{subject}",
        pose_name=truth.pose_name,
    )
    return Scan(points, np.zeros_like(points)), found


@pytest.fixture(scope="module")
def chosen():
    truths = [generate_truth(subject, pose) for subject in (1, 2, 3) for pose in (0, 5, 9, 13, 20, 27, 40)]
    truths += [generate_truth(4, pose, "left") for pose in (0, 5, 9)]
    return make_training_set(
        [truth.vertices for truth in truths],
        [f"s{truth.subject}" for truth in truths],
        [truth.pose_name for truth in truths],
        [truth.side == "left" for truth in truths],
    )


@pytest.fixture(scope="module")
def trained(chosen):
    return train_model(chosen, untrained_hand("right"), OPTIONS)


@pytest.fixture(scope="module")
def held_out():
    hands = tuple(make_test_hand(*register(32, pose, side)) for pose, side in ((5, "right"), (9, "left")))
    return HeldOut(hands, {"s32": generate_truth(32, 0).vertices})


def study(trained, held_out, chosen, kept=None, progress=None):
    crude = untrained_hand("right")
    sized = replace(crude, shape_directions=0.1 * crude.template[:, :, None])
    return study_held_out(
        trained.model, {"untrained, size only": sized}, held_out, chosen, crude, OPTIONS, LEVEL, progress, kept
    )


@pytest.fixture(scope="module")
def studied(trained, held_out, chosen):
    return study(trained, held_out, chosen)


def test_a_left_hand_is_judged_as_a_right_one_and_what_is_no_hand_is_left_out():
    scan, found = register(32, 5)
    flip = np.array([-1.0, 1.0, 1.0])
    right = make_test_hand(scan, found)
    in_the_mirror = replace(found, vertices=found.vertices * flip, side="left")
    left = make_test_hand(replace(scan, points=scan.points * flip, normals=scan.normals * flip), in_the_mirror)
    assert len(right.points) == 400 and np.abs(right.points).max() < 0.45
    for name in ("points", "normals", "vertices"):
        assert np.array_equal(getattr(left, name), getattr(right, name)), name
    with pytest.raises(RegistrationError, match="409 points"):
        make_test_hand(scan.select(np.arange(410) > 0), found)
    with pytest.raises(RegistrationError, match="no point that counts"):
        make_test_hand(scan, replace(found, scan_to_mesh=np.full(410, np.nan)))


def test_the_flattest_gives_the_template_and_each_person_is_judged_as_often():
    bent = [np.full((16, 3), angle) for angle in (0.5, 0.1, 0.9, 0.4, 0.3, 0.2, 0.7)]
    flats, judged = choose_held_out(["a", "a", "a", "a", "b", "b", "c"], bent, 5)
    assert flats == {"a": 1, "b": 5}
    assert sorted(judged) == [0, 2, 3, 4, 6] and choose_held_out(["a"] * 7, bent, 3)[1] == [0, 3, 6]
    assert choose_held_out([], [], 5) == ({}, [])


@pytest.mark.slow
def test_every_part_of_the_model_is_seen_to_help_on_people_it_has_not_seen(studied):
    assert json.loads(json.dumps(studied)) == studied
    models, own = studied["models"], studied["own_template"]
    assert set(models) == {"learned", "plain skinning", "right hands only", "untrained, size only"}
    assert set(own) == {"learned", "plain skinning", "right hands only", "blend shapes off"}
    assert models["learned"]["scan_to_mesh_mm"] < models["untrained, size only"]["scan_to_mesh_mm"]
    for other in ("plain skinning", "blend shapes off"):
        assert own["learned"]["vertices_mm"] < own[other]["vertices_mm"]
    for name, most in (("learned", 23), ("right hands only", 20)):
        rows = studied["pose_generalisation"][name]
        assert [row["components"] for row in rows] == [0, 2, most], "no more than there are"
        assert rows[0]["mean_mm"] > rows[-1]["mean_mm"]
    assert studied["not_compared"] == {} and studied["people"] == ["s32"] and studied["scans"] == 2


@pytest.mark.slow
def test_a_study_that_is_broken_off_again_and_again_finds_the_same(studied, trained, held_out, chosen, tmp_path):
    class Stopped(Exception):
        pass

    class Breaking(FolderCheckpoints):
        def save(self, stage, arrays):
            super().save(stage, arrays)
            saved.append(stage)
            if len(saved) % 4 == 1:
                raise Stopped

    saved: list[str] = []
    shares: list[float] = []
    for _ in range(40):
        try:
            shares.clear()
            again = study(trained, held_out, chosen, Breaking(tmp_path), lambda stage, share: shares.append(share))
            break
        except Stopped:
            continue
    assert again | {"seconds": 0} == studied | {"seconds": 0}
    assert len(saved) == len(set(saved)) == 2 * 4 + 4 + 4 + 2 * 3


def test_a_person_with_one_registration_has_no_template_and_too_small_a_set_is_said(trained, held_out, chosen):
    alone = HeldOut(held_out.hands[:1], {})
    few = chosen.select(~chosen.mirrored | (chosen.subjects == "s4"))
    few = replace(few, mirrored=np.arange(len(few)) % 2 == 0)
    found = study(trained, alone, few)
    assert found["own_template"] == {} and found["pose_generalisation"] == {}
    assert "right hands only" in found["not_compared"] and "learned" in found["models"]


class Page(HTMLParser):
    """Tags, and words of a report."""

    def __init__(self, text):
        super().__init__()
        self.tags, self.words = [], []
        self.feed(text)

    def handle_starttag(self, tag, attrs):
        self.tags.append(tag)

    def handle_data(self, data):
        self.words.append(data)


def test_the_report_holds_the_figures_and_no_name_becomes_code(trained, studied):
    report = {**trained.report, "study": studied | {"shape_generalisation": [{"components": 1, "mean_mm": 0.5}]}}
    page = Page(write_model_html(report, title="<script>x</script>", made_at="today", facts={"Round": "1"}))
    words = " ".join(page.words)
    assert "script" not in page.tags and "<script>x</script>" in words
    for found in (*studied["models"].values(), *studied["own_template"].values()):
        assert f"{found['vertices_mm']:.3f}" in words
    for rows in studied["pose_generalisation"].values():
        assert all(f"{row['mean_mm']:.3f}" in words for row in rows)
    assert page.tags.count("polyline") == 2 + 1 + 2
    bare = Page(write_model_html(trained.report, title="x", made_at="today", facts={}))
    assert "Leave subjects out" in " ".join(bare.words) and bare.tags.count("polyline") == 2

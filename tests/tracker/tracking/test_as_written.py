"""T16's algorithm as the paper has it: its terms with its weights and no others, in every iteration."""

from __future__ import annotations

import dataclasses

import cv2
import numpy as np
import pytest

from tests.tracker.grips import PINCH, gripped
from tracker.capture.sequence import load_sequence
from tracker.fitting.attempt import look
from tracker.fitting.options import TrackOptions
from tracker.fitting.presets import find_preset
from tracker.physics import PhysicsWorld
from tracker.search.tools import make_tools
from tracker.terms.physics import Supported
from tracker.tracking.as_written import DATA_TERMS, compose_objective
from tracker.tracking.follow import track_frames
from tracker.tracking.start import start_tracking


@pytest.fixture(scope="module")
def written(recorded):
    options = TrackOptions.from_json(find_preset("t16").values)
    setup, start = start_tracking(recorded.sequence, options, annotations=recorded.annotations)
    return setup, start, *track_frames(recorded.sequence, setup, start, range(12))


def test_a_waving_hand_is_followed_with_the_papers_terms_alone(recorded, written):
    setup, _, _, chunk = written
    assert (
        recorded.joint_errors(chunk.frame, np.stack([setup.scene.pose_at(p).landmarks(0) for p in chunk.pose])).max()
        < 2e-3
    )
    assert set(chunk.status) == {0}, "ok"
    assert chunk.hand_status.tolist() == 12 * [[0]]
    names = {*DATA_TERMS, "collision", "salient", "anatomy", "regularization"}
    assert {str(name) for name in chunk.cost_names} == names
    assert chunk.iterations.tolist() == [50] + 11 * [10]


def test_every_match_counts_in_every_iteration_with_the_weights_of_the_paper(recorded, written):
    setup, start, _, _ = written
    frame, camera = setup.read(recorded.sequence, 0)
    with make_tools(setup, camera.T_world_camera) as tools:
        seen = look(frame, camera, setup, start.pose)
        assert seen is not None
        objective = compose_objective(setup, tools, seen)
    assert {name: term.weight for name, term in objective.terms.items()} == {
        "model_to_data": 1.0,
        "data_to_model": 1.0,
        "collision": 10.0,
        "salient": 1.0,
    }
    assert (objective.anatomy.weight, objective.regularization.weight, objective.bending.weight) == (0.0015, 0.02, 0.0)
    assert {term.stride for term in (objective.terms[name] for name in DATA_TERMS)} == {1}
    assert objective.terms["data_to_model"].max_angle == 45.0


def test_a_run_that_is_cut_in_two_goes_on_to_the_bit(recorded, written):
    setup, start, end, chunk = written
    between, first = track_frames(recorded.sequence, setup, start, range(5))
    last, second = track_frames(recorded.sequence, setup, between, range(5, 12))
    np.testing.assert_array_equal(np.concatenate([first.pose, second.pose]), chunk.pose)
    np.testing.assert_array_equal(last.pose, end.pose)


def test_contacts_are_sought_at_every_look_and_a_thing_that_stays_needs_none():
    loose, firm = gripped(PINCH, (0.004, 0.004)), gripped(PINCH, (0.0, 0.0))
    with PhysicsWorld(loose.scene) as world:
        term = Supported(world)
        assert term.find(loose).count == 2
    with PhysicsWorld(firm.scene) as world:
        assert Supported(world).find(firm).count == 0


def test_meshes_stay_as_they_are_with_the_method_of_the_paper_and_are_decimated_with_ours():
    assert TrackOptions(method="t16").max_faces is None
    assert TrackOptions().max_faces == 1500
    assert dataclasses.replace(TrackOptions(), method="t16").is_as_written


def test_a_hand_that_goes_out_of_sight_is_lost_and_taken_up_where_it_was(recorded, written, tmp_path):
    for path in recorded.sequence.folder.rglob("*"):
        target = tmp_path / path.relative_to(recorded.sequence.folder)
        if path.is_dir():
            target.mkdir(parents=True, exist_ok=True)
        else:
            target.parent.mkdir(parents=True, exist_ok=True)
            target.write_bytes(path.read_bytes())
    blinded = load_sequence(tmp_path)
    cv2.imwrite(str(blinded.image_path("depth", 4, "cam0")), np.zeros((480, 640), np.uint16))
    setup, start, _, chunk = written
    _, found = track_frames(blinded, setup, start, range(7))
    assert found.status.tolist() == [0, 0, 0, 0, 1, 0, 0], "lost where there is nothing"
    assert found.hand_status[:, 0].tolist() == found.status.tolist()
    np.testing.assert_array_equal(found.pose[4], found.pose[3])
    np.testing.assert_array_equal(found.pose[:4], chunk.pose[:4])

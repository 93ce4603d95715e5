"""What is predicted from the last two frames."""

import numpy as np

from tests.tracker.toys import tube
from tracker.geometry import se3
from tracker.model.default_hand import default_hand
from tracker.model.scene import Scene
from tracker.tracking.patience import Patience
from tracker.tracking.state import TrackState


def test_hands_go_on_as_they_moved_and_chains_start_where_they_are(rng):
    scene = Scene((default_hand("right"), tube(bones=5)))
    before, now = (rng.normal(scale=0.1, size=scene.num_dofs) for _ in range(2))
    predicted = TrackState(2, now, before).predict(scene)
    hand, chain = scene.pose_slices
    moved = se3.exp(now[hand][:6]) @ se3.inverse(se3.exp(before[hand][:6]))
    np.testing.assert_allclose(se3.exp(predicted[hand][:6]), moved @ se3.exp(now[hand][:6]), atol=1e-12)
    np.testing.assert_array_equal(predicted[hand][6:], now[hand][6:])
    np.testing.assert_array_equal(predicted[chain], now[chain])


def test_where_bends_go_on_too_angles_move_as_they_did_within_their_limits(rng):
    scene = Scene((default_hand("right"), tube(bones=5)))
    hand, chain = scene.pose_slices
    own = slice(hand.start + 6, hand.stop)
    before, now = (0.5 * (scene.lower + scene.upper) + rng.uniform(-0.1, 0.1, scene.num_dofs) for _ in range(2))
    before[:6], now[:6] = rng.normal(scale=0.1, size=(2, 6))
    before[chain] = now[chain] = 0.0
    now[own.start] = scene.upper[own.start] - 0.01
    before[own.start] = now[own.start] - 0.05
    predicted = TrackState(2, now, before).predict(scene, bends=True)
    assert predicted[own.start] == scene.upper[own.start]
    further = np.clip(2.0 * now[own] - before[own], scene.lower[own], scene.upper[own])
    np.testing.assert_array_equal(predicted[own], further)
    np.testing.assert_array_equal(predicted[:6], TrackState(2, now, before).predict(scene)[:6])
    np.testing.assert_array_equal(predicted[chain], now[chain])


def test_what_was_tried_in_vain_rests_as_long_after_a_state_was_stored(tmp_path):
    state = TrackState(2, np.zeros(26), np.zeros(26), second_try=Patience(1, 2), tips=Patience(0, 4))
    state.save(tmp_path / "state.npz")
    kept = TrackState.load(tmp_path / "state.npz")
    assert (kept.second_try, kept.tips) == (Patience(1, 2), Patience(0, 4))

"""Models, cameras and options of a run: named, kept in a folder, and refused where a recording cannot be tracked."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from tests.tracker.grips import ball
from tests.tracker.model.test_npz_files import assert_same
from tests.tracker.toys import tube
from tracker.capture.camera import Camera
from tracker.capture.frame_pattern import parse_pattern
from tracker.capture.recorded_camera import RecordedCamera
from tracker.capture.sequence import Sequence
from tracker.capture.static_plane import StaticPlane
from tracker.detection.default_detector import default_detector
from tracker.detection.forest import MODES, Forest
from tracker.detection.own_detector import OwnDetector
from tracker.errors import TrackingError
from tracker.fitting.options import TrackOptions
from tracker.fitting.setup import TrackSetup, choose_cameras
from tracker.geometry import se3
from tracker.model.articulated import ArticulatedModel
from tracker.model.default_hand import default_hand
from tracker.model.joints import HAND_JOINTS
from tracker.physics import StaticScene

K = np.array([[500.0, 0.0, 319.5], [0.0, 500.0, 239.5], [0.0, 0.0, 1.0]])


def rope() -> ArticulatedModel:
    """Faces as files have them."""
    model = tube(bones=3)
    return replace(model, faces=model.faces.astype(np.int64))


SETUP = TrackSetup(
    ("rope", "left", "ball"), (rope(), default_hand("left"), ball()), "cam0", TrackOptions(terms="LO+SC")
)


def test_hands_and_objects_are_told_apart_and_keep_the_order_of_the_models() -> None:
    assert (SETUP.hands, SETUP.hand_names) == ((1,), ("left",))
    assert (SETUP.objects, SETUP.object_names) == ((0, 2), ("rope", "ball"))
    assert SETUP.scene.models == SETUP.models


def test_joints_are_those_of_hands_and_of_things_with_more_than_one_bone() -> None:
    rope = tuple(f"rope:bone_{bone}" for bone in range(3))
    assert SETUP.joint_names == (*rope, *(f"left/{joint}" for joint in HAND_JOINTS))


def test_images_are_prepared_for_objects_only_where_there_are_some() -> None:
    alone = replace(SETUP, names=("left",), models=SETUP.models[1:2], options=TrackOptions(use_skin=False))
    assert SETUP.preprocessing.objects and SETUP.preprocessing.use_skin
    assert not alone.preprocessing.objects and not alone.preprocessing.use_skin


def test_the_distance_is_guessed_with_one_colour_camera_alone() -> None:
    views = {(): False, ("a",): True, ("a", "b"): False}
    assert {ids: replace(SETUP, view_ids=ids).is_distance_guessed for ids in views} == views


def test_a_detector_of_one_s_own_finds_fingertips_in_depth_and_nails_in_views() -> None:
    own = OwnDetector(default_detector(), "ours.npz", "0" * 64)
    assert SETUP.fingertip_detector is default_detector() and SETUP.nail_detector is None
    assert replace(SETUP, view_ids=("a", "b")).nail_detector is None, "nobody gave one"
    assert replace(SETUP, own_detector=own).nail_detector is None
    assert replace(SETUP, own_detector=own, view_ids=("a", "b")).nail_detector is own.forest
    assert replace(SETUP, options=TrackOptions(use_detector=False)).hand_detector is None


def test_hands_are_projected_into_a_camera_that_they_are_before() -> None:
    pose = SETUP.scene.rest_pose()
    pose[SETUP.scene.pose_slices[1]][:3] = [0.0, 0.0, 0.6]
    camera = Camera("cam0", 640, 480, K)
    found = SETUP.project_hands(pose, camera)
    assert set(found) == {"left"}
    joints = SETUP.scene.pose_at(pose).landmarks(1)
    np.testing.assert_allclose(found["left"], (joints / joints[:, 2:] @ K.T)[:, :2])
    behind = replace(camera, T_world_camera=se3.exp(np.array([0.0, 0.0, 1.5, 0.0, 0.0, 0.0])))
    assert SETUP.project_hands(pose, behind) == {}


def test_without_a_static_scene_things_fall_along_the_camera_s_y_and_with_one_as_it_says() -> None:
    T = se3.exp(np.array([0.4, -0.2, 0.7, 0.3, -0.8, 0.5]))
    with SETUP.make_world(T) as world:
        np.testing.assert_allclose(world.down, T[:3, 1], atol=1e-9)
    with replace(SETUP, static_scene=StaticScene((0.6, 0.8, 0.0), "recording")).make_world(T) as world:
        np.testing.assert_allclose(world.down, [0.6, 0.8, 0.0])


def small_forest() -> Forest:
    """A single leaf."""
    starts = np.array([0, 1], dtype=np.int32)
    nodes = np.array([[-1, 0, 0, 0, 0]], dtype=np.int16)
    votes = np.zeros((1, MODES, 4), dtype=np.float32)
    return Forest("depth", 0.001, 0.02, 1.0, nodes, starts, starts, np.ones(1, np.float32), votes)


@pytest.fixture
def whole() -> TrackSetup:
    """With everything that a setup may have."""
    floor = StaticPlane((0.0, 0.3, 0.5), (0.0, -1.0, 0.0))
    marks = {"left": np.random.default_rng(0).uniform(0.0, 400.0, (21, 3))}
    return replace(
        SETUP,
        options=TrackOptions(terms="LO+SC", iterations=7, first_frame=3, use_skin=False),
        marks=marks,
        own_detector=OwnDetector(small_forest(), "ours", "f" * 64),
        static_scene=StaticScene((0.0, 1.0, 0.0), "plane", (floor,), "depth"),
        view_ids=("cam0", "b,1"),
    )


def test_a_saved_setup_comes_back_whole(whole: TrackSetup, tmp_path: Path) -> None:
    whole.save(tmp_path / "new" / "track")
    again = TrackSetup.load(tmp_path / "new" / "track")
    for name in ("names", "camera_id", "options", "static_scene", "view_ids"):
        assert getattr(again, name) == getattr(whole, name), name
    np.testing.assert_array_equal(again.marks["left"], whole.marks["left"])
    for own, other in zip(again.models, whole.models, strict=True):
        assert_same(own, other)
    assert again.own_detector is not None and whole.own_detector is not None
    assert again.own_detector.to_json() == whole.own_detector.to_json(), "as it was called, not as the file is"
    files = {path.name for path in (tmp_path / "new" / "track").rglob("*") if path.is_file()}
    assert files == {"setup.json", "fingertips.npz", "rope.npz", "left.npz", "ball.npz"}


def test_a_setup_from_before_views_detectors_and_static_scenes_were_kept_is_read(tmp_path: Path) -> None:
    SETUP.save(tmp_path)
    document = json.loads((tmp_path / "setup.json").read_text())
    del document["views"]
    (tmp_path / "setup.json").write_text(json.dumps(document))
    again = TrackSetup.load(tmp_path)
    assert (again.view_ids, again.own_detector, again.static_scene, again.marks) == ((), None, None, {})


@pytest.mark.parametrize(
    "change",
    [
        {"names": None},
        {"marks": {"left": [[1.0, 2.0, 2.0]] * 20}},
        {"marks": {"left": "here"}},
        {"options": 3},
        {"static_scene": {"down": [0.0, 1.0]}},
        {"detector": {"name": "x"}},
    ],
    ids=lambda change: next(iter(change)),
)
def test_a_setup_that_somebody_changed_is_refused_with_its_folder(change, whole: TrackSetup, tmp_path: Path) -> None:
    few = replace(whole, names=("ball",), models=whole.models[2:])
    few.save(tmp_path)
    document = json.loads((tmp_path / "setup.json").read_text()) | change
    (tmp_path / "setup.json").write_text(json.dumps(document))
    with pytest.raises(TrackingError, match=tmp_path.name):
        TrackSetup.load(tmp_path)


@pytest.mark.parametrize("text", [None, "", "[]", '{"version": 1'], ids=["none", "empty", "a list", "cut off"])
def test_a_folder_without_a_setup_is_refused_with_what_is_needed(text, tmp_path: Path) -> None:
    if text is not None:
        (tmp_path / "setup.json").write_text(text)
    with pytest.raises(TrackingError, match=r"setup\.json as a tracking run writes it"):
        TrackSetup.load(tmp_path)


def recording(hands: tuple[str, ...] = ("right",), **cameras: str) -> Sequence:
    """One with cameras of such ids, with "d" for depth and "c" for colour among their letters."""
    pattern = parse_pattern("images/{:04d}.png")
    return Sequence(
        Path("nowhere"),
        "waving",
        30.0,
        10,
        tuple(
            RecordedCamera(
                name, 640, 480, K, color=pattern if "c" in has else None, depth=pattern if "d" in has else None
            )
            for name, has in cameras.items()
        ),
        hands=hands,
    )


@pytest.mark.parametrize(
    ("cameras", "options", "expected"),
    [
        ({"a": "c", "b": "cd", "e": "d"}, {}, ("b", ())),
        ({"a": "c", "b": "cd", "e": "d"}, {"camera": "e"}, ("e", ())),
        ({"a": "c", "b": "c"}, {}, ("a", ("a", "b"))),
        ({"a": "c", "b": "cd"}, {"cameras": "a,b"}, ("b", ("a", "b"))),
        ({"a": "c", "b": "cd"}, {"cameras": "a,b", "use_depth": False}, ("a", ("a", "b"))),
        ({"a": "c", "b": "c"}, {"cameras": "b"}, ("b", ("b",))),
    ],
)
def test_a_run_tracks_in_its_first_depth_camera_or_in_the_views_that_were_chosen(cameras, options, expected) -> None:
    assert choose_cameras(recording(**cameras), TrackOptions(**options)) == expected


@pytest.mark.parametrize(
    ("cameras", "options", "told"),
    [
        ({"a": "c", "b": "d"}, {"camera": "a"}, "waving: Camera a has no depth images. Choose b"),
        ({"a": "c"}, {"cameras": "z"}, "waving: z is no camera with colour images of this recording. Choose among a"),
        ({"a": "d"}, {"first_frame": 50}, "waving: Frames 50 to 9 were asked for; the recording has 0 to 9"),
    ],
)
def test_a_recording_that_cannot_be_tracked_so_is_refused_by_its_name(cameras, options, told) -> None:
    with pytest.raises(TrackingError, match=told):
        choose_cameras(recording(**cameras), TrackOptions(**options))


def test_every_fault_is_told_at_once() -> None:
    with pytest.raises(TrackingError, match=r"Camera a has no depth images.*does not say which hands it shows"):
        choose_cameras(recording(hands=(), a="c", b="d"), TrackOptions(camera="a"))

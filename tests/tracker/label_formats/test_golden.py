"""Files written by hand after each format's specification: read as meant, and written the same."""

from __future__ import annotations

import contextlib
import io
import json
from pathlib import Path

import numpy as np
import pytest
from pycocotools.coco import COCO
from pycocotools.cocoeval import COCOeval

from tests.tracker.label_formats.conftest import MakeSet, make_sequence
from tests.tracker.label_formats.hands import place_hand
from tracker.capture.annotations import Annotation, Annotations
from tracker.errors import AnnotationError
from tracker.label_formats.formats import export_labels, import_labels
from tracker.label_formats.image_names import ImageNames, list_image_names
from tracker.label_formats.label_set import ImportHints, LabelSet
from tracker.model.joints import HAND_JOINTS

GOLDEN = Path(__file__).parent / "golden"


def load(*names: str) -> dict[str, bytes]:
    return {name: (GOLDEN / name).read_bytes() for name in names}


def mark(*joints: tuple[str, float, float, int]) -> np.ndarray:
    points = np.zeros((21, 3))
    for name, x, y, v in joints:
        points[HAND_JOINTS.index(name)] = x, y, v
    return points


TWO_JOINTS = Annotation(1, "cam0", "left", mark(("wrist", 10, 20, 2), ("thumb_cmc", 30.5, 40.25, 1)))


def test_coco_is_read_by_file_name_and_category_and_written_by_the_book(make_set: MakeSet) -> None:
    _, back = import_labels(None, load("coco_keypoints.json"), [make_set()])
    assert back.problems == ()
    (item,) = back.annotations["aaaaaaaa"].items
    assert item.key == (1, "cam0", "left")
    np.testing.assert_array_equal(item.points, TWO_JOINTS.points)

    written = json.loads(export_labels("coco_keypoints", [make_set((TWO_JOINTS,))]).files["coco_keypoints.json"])
    (annotation,) = written["annotations"]
    golden = json.loads((GOLDEN / "coco_keypoints.json").read_text())["annotations"][0]
    assert annotation["keypoints"] == golden["keypoints"]
    assert annotation["bbox"] == golden["bbox"] == [10.0, 20.0, 21.5, 21.25]
    assert annotation["area"] == 21.5 * 21.25
    assert annotation["num_keypoints"] == 2
    assert written["images"][0]["file_name"] == "cam0/color/000001.png"
    assert [category["name"] for category in written["categories"]] == ["right_hand", "left_hand"]
    assert written["categories"][0]["skeleton"][:2] == [[1, 2], [2, 3]]


def test_coco_with_its_joints_in_another_order_and_corner_pixels_is_read_by_name(make_set: MakeSet) -> None:
    document = json.loads((GOLDEN / "coco_keypoints.json").read_text())
    document["categories"][0]["keypoints"].reverse()
    flat = document["annotations"][0]["keypoints"]
    document["annotations"][0]["keypoints"] = [n for j in reversed(range(21)) for n in flat[3 * j : 3 * j + 3]]
    files = {"labels.json": json.dumps(document).encode()}
    _, back = import_labels("coco_keypoints", files, [make_set()], ImportHints(pixel_centre=0.5))
    (item,) = back.annotations["aaaaaaaa"].items
    shifted = TWO_JOINTS.points - np.where(TWO_JOINTS.points[:, 2:] > 0, [0.5, 0.5, 0.0], 0.0)
    np.testing.assert_array_equal(item.points, shifted)


def test_pycocotools_loads_an_export_and_its_own_labels_score_1(make_set: MakeSet, tmp_path: Path) -> None:
    rng = np.random.default_rng(3)
    items = tuple(
        Annotation(frame, "cam1", hand, np.c_[rng.uniform(50, 400, (21, 2)), rng.integers(1, 3, 21)])
        for frame in range(3)
        for hand in ("right", "left")
    )
    path = tmp_path / "labels.json"
    path.write_bytes(export_labels("coco_keypoints", [make_set(items)]).files["coco_keypoints.json"])
    with contextlib.redirect_stdout(io.StringIO()):
        truth = COCO(path)

        def score(shift: float) -> float:
            found = [
                {
                    "image_id": a["image_id"],
                    "category_id": a["category_id"],
                    "score": 1.0,
                    "keypoints": (np.reshape(a["keypoints"], (21, 3)) + np.array([shift, 0, 0])).ravel().tolist(),
                }
                for a in truth.loadAnns(truth.getAnnIds())
            ]
            evaluation = COCOeval(truth, truth.loadRes(found), "keypoints")
            evaluation.params.kpt_oks_sigmas = np.full(21, 0.035)
            evaluation.evaluate()
            evaluation.accumulate()
            evaluation.summarize()
            return float(evaluation.stats[0])

        assert score(0.0) == pytest.approx(1.0)
        assert score(200.0) == pytest.approx(0.0)


def test_wholebody_hands_are_read_where_they_are_valid(make_set: MakeSet) -> None:
    _, back = import_labels(None, load("coco_wholebody.json"), [make_set()])
    (item,) = back.annotations["aaaaaaaa"].items
    assert item.key == (2, "cam1", "right")
    np.testing.assert_array_equal(item.points, mark(("wrist", 100, 200, 2), ("little_tip", 110, 210.5, 1)))
    assert back.problems == ()
    assert back.warnings == ("1 person has a body, which was left out.",)
    written = json.loads(export_labels("coco_wholebody", [make_set((item,))]).files["coco_wholebody.json"])
    (person,) = written["annotations"]
    golden = json.loads((GOLDEN / "coco_wholebody.json").read_text())["annotations"][0]
    for key in ("righthand_kpts", "righthand_box", "righthand_valid", "lefthand_valid", "lefthand_kpts", "face_valid"):
        assert person[key] == golden[key], key
    assert (len(person["face_kpts"]), len(person["foot_kpts"])) == (68 * 3, 6 * 3)


def test_two_people_in_one_image_are_a_problem_and_not_a_choice(make_set: MakeSet) -> None:
    document = json.loads((GOLDEN / "coco_wholebody.json").read_text())
    document["annotations"].append(document["annotations"][0] | {"id": 2})
    _, back = import_labels("coco_wholebody", {"a.json": json.dumps(document).encode()}, [make_set()])
    assert back.problems == (
        "1 place has two hands of the same side; say which is which (the right hand in frame 2 of cam1).",
    )


def test_a_deeplabcut_table_written_by_hand_is_what_we_write(make_set: MakeSet) -> None:
    name = "labeled-data/cam0/CollectedData_handloom.csv"
    text = (GOLDEN / "CollectedData_handloom.csv").read_bytes()
    _, back = import_labels(None, {name: text}, [make_set()])
    (item,) = back.annotations["aaaaaaaa"].items
    assert item.key == (1, "cam0", "left")
    np.testing.assert_array_equal(item.points, mark(("wrist", 10, 20, 2), ("thumb_cmc", 30.5, 40.25, 2)))
    assert export_labels("deeplabcut", [make_set((TWO_JOINTS,))]).files == {name: text}


def test_a_table_of_one_animal_needs_to_know_which_hand_it_is(make_set: MakeSet) -> None:
    text = (
        b"scorer,me,me,me,me\nbodyparts,wrist,wrist,index1,index1\ncoords,x,y,x,y\n"
        b"labeled-data/cam1/000003.png,5,6,,\nlabeled-data/cam1/elsewhere.png,1,2,3,4\n"
    )
    files = {"CollectedData_me.csv": text}
    with pytest.raises(AnnotationError, match="no row 'individuals', and both hands"):
        import_labels(None, files, [make_set()])
    _, back = import_labels(None, files, [make_set()], ImportHints(hand="right"))
    (item,) = back.annotations["aaaaaaaa"].items
    assert item.key == (3, "cam1", "right")
    np.testing.assert_array_equal(item.points, mark(("wrist", 5, 6, 2)))
    assert any("elsewhere.png" in warning for warning in back.warnings)


def test_predictions_of_deeplabcut_are_no_labels(make_set: MakeSet) -> None:
    text = b"scorer,net,net,net\nbodyparts,wrist,wrist,wrist\ncoords,x,y,likelihood\n0,1.0,2.0,0.99\n"
    with pytest.raises(AnnotationError, match="predictions of a network, not labels"):
        import_labels(None, {"videoDLC_resnet50.csv": text}, [make_set()])


def test_the_layout_of_t16_is_written_as_its_readers_read_it(make_set: MakeSet) -> None:
    exported = export_labels("t16", [make_set((TWO_JOINTS,))])
    golden = {"1/joints_2D_GT/001.txt": "joints_2D_GT_001.txt", "1/joints.txt": "joints.txt"}
    assert exported.files == {name: (GOLDEN / file).read_bytes() for name, file in golden.items()}
    assert "1 position was rounded to whole px." in exported.notes


def test_numbers_of_joints_that_nobody_explained_are_refused_unless_told(make_set: MakeSet) -> None:
    files = {"joints_2D_GT/002.txt": b"0\t7\t8\n1\t0\t5\n2\t-3\t4\n20\t9\t10\n"}
    with pytest.raises(AnnotationError, match="but does not name them"):
        import_labels(None, files, [make_set(cameras=1)])
    hints = ImportHints(joint_order="interhand", hand="left")
    _, back = import_labels(None, files, [make_set(cameras=1)], hints)
    (item,) = back.annotations["aaaaaaaa"].items
    assert item.key == (2, "cam0", "left")
    np.testing.assert_array_equal(item.points, mark(("thumb_tip", 7, 8, 2), ("wrist", 9, 10, 2)))
    with pytest.raises(AnnotationError, match="Which camera"):
        import_labels(None, files, [make_set(cameras=2)], hints)


def test_freihand_samples_are_seen_by_the_camera_of_their_image() -> None:
    sequence = make_sequence(1, hands=("right",))
    world = place_hand("right", 0)
    labels = LabelSet("key", sequence, list_image_names(sequence))
    xyz = [world.tolist()] * 6
    files = {
        "training_xyz.json": json.dumps(xyz).encode(),
        "training_K.json": json.dumps([sequence.cameras[0].K.tolist()] * 6).encode(),
    }
    _, back = import_labels(None, files, [labels])
    assert [item.frame for item in back.annotations["key"].items] == list(range(6))
    uv = world @ sequence.cameras[0].K.T
    np.testing.assert_allclose(back.annotations["key"].items[0].points[:, :2], uv[:, :2] / uv[:, 2:], atol=1e-9)
    files["training_xyz.json"] = json.dumps(xyz[:5]).encode()
    files["training_K.json"] = json.dumps([sequence.cameras[0].K.tolist()] * 5).encode()
    with pytest.raises(AnnotationError, match="5 samples cannot be matched with 6 frames of 1 camera"):
        import_labels(None, files, [labels])


def test_interhand_files_are_laid_out_as_published() -> None:
    sequence = make_sequence(2)
    world = place_hand("left", 3)
    items = tuple(
        Annotation(3, camera.id, "left", np.c_[camera.project(world), np.full(21, 2.0)]) for camera in sequence.cameras
    )
    labels = LabelSet("key", sequence, list_image_names(sequence), Annotations(items))
    files = export_labels("interhand", [labels]).files
    data = json.loads(files["InterHand2.6M_train_data.json"])
    cameras = json.loads(files["InterHand2.6M_train_camera.json"])["0"]
    joints = json.loads(files["InterHand2.6M_train_joint_3d.json"])["0"]["3"]
    assert joints["hand_type"] == data["annotations"][0]["hand_type"] == "left"
    assert np.ravel(joints["joint_valid"]).tolist() == [0] * 21 + [1] * 21
    xyz = np.array(joints["world_coord"])
    np.testing.assert_allclose(xyz[41], world[0] * 1000, atol=1e-3)  # wrist last
    np.testing.assert_allclose(xyz[21], world[4] * 1000, atol=1e-3)  # tip of the thumb first
    image = data["images"][1]
    R, t = np.array(cameras["camrot"]["cam1"]), np.array(cameras["campos"]["cam1"])
    seen = (xyz[21:] - t) @ R.T
    focal, centre = np.array(cameras["focal"]["cam1"]), np.array(cameras["princpt"]["cam1"])
    pixels = seen[:, :2] / seen[:, 2:] * focal + centre
    marked = sequence.cameras[1].project(world)
    np.testing.assert_allclose(pixels[20], marked[0], atol=1e-4)
    assert (image["camera"], image["frame_idx"], image["capture"]) == ("cam1", 3, 0)
    skeleton = files["skeleton.txt"].decode().splitlines()
    assert (len(skeleton), skeleton[0], skeleton[3], skeleton[20]) == (
        42,
        "r_thumb4 0 1",
        "r_thumb1 3 20",
        "r_wrist 20 -1",
    )
    assert skeleton[41] == "l_wrist 41 -1"


def test_original_file_names_lead_to_their_frame_and_a_wrong_frame_number_is_told(make_set: MakeSet) -> None:
    labels = make_set(cameras=1)
    shifted = {("cam0", frame): f"shots/IMG_{frame + 1:04d}.png" for frame in range(6)}
    labels = LabelSet("key", labels.sequence, ImageNames(shifted, labels.names.stored), Annotations((TWO_JOINTS,)))
    document = json.loads(export_labels("coco_keypoints", [labels]).files["coco_keypoints.json"])
    assert document["images"][0]["file_name"] == "shots/IMG_0002.png"
    document["images"][0]["frame"] = 4
    _, back = import_labels(None, {"a.json": json.dumps(document).encode()}, [labels])
    assert [item.frame for item in back.annotations["key"].items] == [1]
    assert "although its frame number says otherwise" in back.warnings[0]
    document["images"][0] |= {"file_name": "renamed.png"}
    _, back = import_labels(None, {"a.json": json.dumps(document).encode()}, [labels])
    assert [item.frame for item in back.annotations["key"].items] == [4]
    assert "the frame number was taken" in back.warnings[0]
    document["images"][0].pop("frame")
    _, back = import_labels(None, {"a.json": json.dumps(document).encode()}, [labels])
    assert back.annotations["key"].items == ()
    assert back.warnings == ("1 image is not in the recording; its labels were left out (renamed.png).",)


def test_a_name_that_two_cameras_have_is_a_problem_and_not_a_choice(make_set: MakeSet) -> None:
    document = json.loads((GOLDEN / "coco_keypoints.json").read_text())
    document["images"][0] = {"id": 7, "file_name": "000001.png"}
    files = {"a.json": json.dumps(document).encode()}
    _, back = import_labels(None, files, [make_set()])
    assert back.problems == ("1 file name means several images of the recording; name the camera (000001.png).",)
    _, back = import_labels(None, files, [make_set()], ImportHints(camera="cam1"))
    assert [item.camera for item in back.annotations["aaaaaaaa"].items] == ["cam1"]

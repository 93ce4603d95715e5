"""What is refused on import, with which words, and that nothing stays behind."""

from __future__ import annotations

import json
import os
import shutil
from pathlib import Path

import numpy as np
import pytest

from tracker.capture import ImportOptions, check_import, load_sequence, run_import
from tracker.capture.annotations import JOINT_NAMES
from tracker.capture.static_plane import StaticPlane
from tracker.errors import ImportRefusedError

RGBD = ImportOptions(fx=60, cx=31.5, cy=23.5, depth_scale=0.001, fps=30)


def refuse(source: Path, says: str, options: ImportOptions | None = None) -> None:
    """The check says it, the run says it too, and the folder it should have gone to is as it was."""
    report = check_import(source, options=options)
    assert not report.ok
    assert says in " ".join(report.problems), report.problems
    json.dumps(report.to_json(), allow_nan=False)
    target = source.parent / "store"
    target.mkdir(exist_ok=True)
    with pytest.raises(ImportRefusedError) as caught:
        run_import(source, target / "r", options=options)
    assert says in str(caught.value)
    assert list(target.iterdir()) == []


@pytest.fixture
def folder(recording: Path) -> Path:
    """Numbered depth and colour images without sequence.json."""
    (recording / "sequence.json").unlink()
    return recording


def change(folder: Path, **values: object) -> None:
    document = json.loads((folder / "sequence.json").read_text())
    camera = document["cameras"][0]
    for key, value in values.items():
        (camera if key in camera else document)[key] = value
    (folder / "sequence.json").write_text(json.dumps(document))


def test_a_sound_recording_comes_in_as_it_is(recording: Path, tmp_path: Path) -> None:
    report = run_import(recording, tmp_path / "store/r")
    assert report.ok and report.warnings == () and report.format == "recording_folder"
    before, after = load_sequence(recording), load_sequence(tmp_path / "store/r")
    assert after.to_json() == before.to_json()
    for index in range(5):
        for kind in ("color", "depth"):
            assert after.image_path(kind, index, "cam0").read_bytes() == (
                before.image_path(kind, index, "cam0").read_bytes()
            )
    assert run_import(tmp_path / "store/r", tmp_path / "store/again").ok


def test_a_check_stores_nothing(recording: Path) -> None:
    before = {p: p.stat().st_mtime_ns for p in recording.parent.rglob("*")}
    assert check_import(recording).ok
    assert {p: p.stat().st_mtime_ns for p in recording.parent.rglob("*")} == before


def test_the_source_is_copied_not_linked(recording: Path, tmp_path: Path) -> None:
    run_import(recording, tmp_path / "store/r")
    (recording / "depth/000000.png").write_bytes(b"changed")
    load_sequence(tmp_path / "store/r").frame(0, "cam0")


def test_a_truncated_image_is_refused(recording: Path) -> None:
    path = recording / "depth/000003.png"
    path.write_bytes(path.read_bytes()[:-20])
    refuse(recording, "depth/000003.png: is cut off")


def test_an_image_damaged_where_the_check_does_not_look_stops_the_run(make_recording, tmp_path: Path) -> None:
    source = make_recording(tmp_path / "long", 40)
    path = source / "depth/000004.png"
    data = bytearray(path.read_bytes())
    data[60] ^= 0xFF
    path.write_bytes(bytes(data))
    (tmp_path / "store").mkdir()
    with pytest.raises(ImportRefusedError, match=r"depth/000004\.png: is damaged"):
        run_import(source, tmp_path / "store/r")
    assert list((tmp_path / "store").iterdir()) == []


def test_one_image_of_another_size_is_refused(recording: Path, save_png) -> None:
    save_png(recording / "color/000002.png", np.zeros((40, 64, 3), np.uint8))
    refuse(recording, "color/000002.png: is 64x40 px where the others are 64x48 px")


def test_all_images_of_another_size_than_declared_are_refused(recording: Path) -> None:
    change(recording, width=72)
    refuse(recording, "calibrated for 72x48 px; its images are 64x48 px")


def test_a_missing_image_in_the_middle_is_refused(recording: Path) -> None:
    (recording / "depth/000002.png").unlink()
    refuse(recording, "1 of 5 files are missing: depth/000002.png")
    refuse(recording, "1 of 5 files are missing", ImportOptions(allow_gaps=True))


def test_fewer_images_than_declared_are_refused(recording: Path) -> None:
    change(recording, frame_count=9)
    refuse(recording, "4 of 9 files are missing")


def test_8_bit_depth_is_refused(recording: Path, save_png) -> None:
    save_png(recording / "depth/000002.png", np.ones((48, 64), np.uint8))
    refuse(recording, "8 bits cannot hold depth")


def test_8_bit_depth_in_16_bit_files_is_refused(recording: Path, save_png) -> None:
    for i in range(5):
        save_png(recording / f"depth/{i:06d}.png", np.full((48, 64), 200, np.uint16))
    refuse(recording, "8-bit depth in 16-bit files")


def test_a_folder_of_8_bit_depth_is_refused(folder: Path, save_png) -> None:
    for i in range(5):
        save_png(folder / f"depth/{i:06d}.png", np.full((48, 64), 200, np.uint8))
    refuse(folder, "each a 64x48 8-bit grey PNG; 8 bits cannot hold depth", RGBD)


def test_colour_as_depth_is_refused(recording: Path, save_png) -> None:
    for i in range(5):
        save_png(recording / f"depth/{i:06d}.png", np.zeros((48, 64, 3), np.uint8))
    refuse(recording, "colour picture (perhaps of depth)")


def test_depth_without_any_value_is_refused(recording: Path, save_png) -> None:
    for i in range(5):
        save_png(recording / f"depth/{i:06d}.png", np.zeros((48, 64), np.uint16))
    refuse(recording, "all pixels are 0")


@pytest.mark.parametrize(("scale", "where"), [(4e-7, "0.0002"), (0.6, "301")])
def test_a_depth_scale_that_puts_the_scene_nowhere_is_refused(recording: Path, scale: float, where: str) -> None:
    change(recording, depth_scale=scale)
    refuse(recording, f"the scene lies at {where}")
    (recording / "sequence.json").unlink()
    refuse(
        recording,
        "With 0.001 (millimetres) it would lie at 0.502 m",
        ImportOptions(**RGBD.to_json() | {"depth_scale": scale}),
    )


@pytest.mark.parametrize(
    "K", [[[float("nan"), 0, 1], [0, 60, 1], [0, 0, 1]], [[0, 0, 0], [0, 0, 0], [0, 0, 1]], [[1, 2], [3, 4]], None]
)
def test_an_impossible_calibration_is_refused(recording: Path, K: object) -> None:
    change(recording, K=K)
    refuse(recording, "sequence.json")


def test_zero_frames_are_refused(recording: Path, tmp_path: Path) -> None:
    change(recording, frame_count=0)
    refuse(recording, "frame_count is 0")
    empty = tmp_path / "empty"
    empty.mkdir()
    refuse(empty, "found no files")


@pytest.mark.parametrize(
    "pattern", ["../secret/{:06d}.png", "/etc/{:06d}.png", "color/../../{:06d}.png", "c:/{:06d}.png"]
)
def test_a_path_out_of_the_recording_is_refused(recording: Path, pattern: str) -> None:
    change(recording, color=pattern)
    refuse(recording, "cameras[0].color")


def test_links_out_of_the_folder_are_refused(recording: Path, folder: Path, tmp_path: Path) -> None:
    shutil.move(folder / "depth/000002.png", tmp_path / "secret.png")
    (folder / "depth/000002.png").symlink_to(tmp_path / "secret.png")
    refuse(folder, "depth/000002.png is a link out of the folder", RGBD)
    os.unlink(folder / "depth/000002.png")
    os.mkfifo(folder / "depth/000002.png")
    refuse(folder, "depth/000002.png is not a plain file", RGBD)


def test_a_linked_folder_is_refused(folder: Path, tmp_path: Path) -> None:
    shutil.move(folder / "depth", tmp_path / "elsewhere")
    (folder / "depth").symlink_to(tmp_path / "elsewhere")
    report = check_import(folder, options=RGBD)
    assert not report.ok


def test_no_source_and_an_unknown_format_are_refused(recording: Path, tmp_path: Path) -> None:
    assert "no such file" in check_import(tmp_path / "nothing").problems[0]
    assert "known: recording_folder" in check_import(recording, "rosbag").problems[0]
    assert not check_import(recording, "tum_rgbd").ok


def test_a_destination_that_exists_is_never_touched(recording: Path, tmp_path: Path) -> None:
    (tmp_path / "there").mkdir()
    (tmp_path / "there/file").write_text("mine")
    (tmp_path / "dangling").symlink_to(tmp_path / "nowhere")
    for name in ("there", "there/file", "dangling"):
        with pytest.raises(ImportRefusedError, match="already"):
            run_import(recording, tmp_path / name)
    assert (tmp_path / "there/file").read_text() == "mine"


def test_a_destination_that_cannot_be_written_is_an_error_not_a_crash(recording: Path, tmp_path: Path) -> None:
    (tmp_path / "file").write_text("")
    with pytest.raises(ImportRefusedError, match="cannot be written"):
        run_import(recording, tmp_path / "file/r")


def test_colour_of_another_size_than_depth_is_refused_and_depth_alone_is_not(folder: Path, save_png) -> None:
    for i in range(5):
        save_png(folder / f"color/{i:06d}.png", np.zeros((96, 128, 3), np.uint8))
    refuse(folder, "colour is 128x96 px and depth 64x48 px", RGBD)
    alone = ImportOptions(**RGBD.to_json() | {"color_pattern": "none"})
    assert check_import(folder, options=alone).ok


def test_colour_with_other_numbers_than_depth_is_refused(folder: Path) -> None:
    (folder / "color/000003.png").unlink()
    refuse(folder, "1 depth image without colour (3)", RGBD)


def test_two_files_of_one_number_are_refused(folder: Path) -> None:
    shutil.copy(folder / "depth/000001.png", folder / "depth/1.png")
    refuse(
        folder,
        "Two files have the same number: depth/1.png",
        ImportOptions(**RGBD.to_json() | {"color_pattern": "none"}),
    )


def test_two_kinds_of_depth_or_colour_are_not_guessed(folder: Path) -> None:
    shutil.copytree(folder / "color", folder / "color2")
    refuse(folder, "Colour images of 2 kinds: color/*.png (5), color2/*.png (5)", RGBD)
    assert check_import(folder, options=ImportOptions(**RGBD.to_json() | {"color_pattern": "color2/{:06d}.png"})).ok
    shutil.copytree(folder / "depth", folder / "raw")
    refuse(folder, "Depth images of 2 kinds", RGBD)


@pytest.mark.parametrize("pattern", ["depth/*_*.png", "depth/000.png", "../*.png", "{0.__class__}.png", "*" * 50])
def test_a_pattern_that_fits_nothing_is_refused(folder: Path, pattern: str) -> None:
    refuse(folder, "depth_pattern", ImportOptions(**RGBD.to_json() | {"depth_pattern": pattern}))


def test_frames_come_in_the_order_of_their_numbers_not_of_their_letters(folder: Path, tmp_path: Path, save_png) -> None:
    shutil.rmtree(folder / "color")
    shutil.rmtree(folder / "depth")
    for n in range(7, 13):
        save_png(folder / f"frame{n}.png", np.full((48, 64), 500 + n, np.uint16))
    run_import(folder, tmp_path / "store/r", options=RGBD)
    sequence = load_sequence(tmp_path / "store/r")
    assert [sequence.depth_raw(i, "cam0")[0, 0] for i in range(6)] == [507, 508, 509, 510, 511, 512]


def test_annotations_models_tables_and_gravity_come_along(recording: Path, tmp_path: Path) -> None:
    points = [[1.0, 2.0, 2]] * 21
    items = [{"frame": 4, "camera": "cam0", "hand": "right", "points": points}]
    annotations = {"version": 1, "joints": list(JOINT_NAMES), "items": items}
    (recording / "marks.json").write_text(json.dumps(annotations))
    (recording / "objects").mkdir()
    for name in ("ball.OFF", "ball.SKEL", "other.txt"):
        (recording / "objects" / name).write_text(name)
    document = json.loads((recording / "sequence.json").read_text())
    document |= {"annotations": "marks.json", "objects": [{"name": "ball", "model": "objects/ball.OFF"}]}
    document |= {"gravity": [0, 3, 4], "planes": [{"point": [0, 0.2, 0.6], "normal": [0, -2, 0]}]}
    (recording / "sequence.json").write_text(json.dumps(document))
    report = run_import(recording, tmp_path / "kept/r")
    assert report.annotations == 1 and report.objects == ("ball",)
    assert report.warnings == ("1 file that sequence.json does not name is left out: objects/other.txt.",)
    sequence = load_sequence(tmp_path / "kept/r")
    assert sequence.annotations_path == tmp_path / "kept/r/annotations.json"
    assert (sequence.gravity, sequence.planes) == ((0.0, 0.6, 0.8), (StaticPlane((0.0, 0.2, 0.6), (0.0, -1.0, 0.0)),))
    assert sorted(p.name for p in (tmp_path / "kept/r/objects").iterdir()) == ["ball.OFF", "ball.SKEL"]
    items[0]["frame"] = 5
    (recording / "marks.json").write_text(json.dumps(annotations))
    refuse(recording, "frame 5 of camera 'cam0' is not in the recording")


@pytest.mark.parametrize(
    "document",
    [
        *(None, [], {"fx": "60"}, {"fx": -1}, {"fx": float("nan")}, {"fps": 0}, {"hands": ["both"]}, {"colour": 1}),
        *({"hands": ["left", "left"]}, {"depth_scale": 5}, {"allow_gaps": 1}, {"name": 5}, {"intrinsics": "kinect"}),
    ],
    ids=str,
)
def test_impossible_options_are_refused(document: object) -> None:
    with pytest.raises(ImportRefusedError, match="import options"):
        ImportOptions.from_json(document)


def test_options_are_read_back_as_they_were() -> None:
    options = ImportOptions(name="a", fx=1.5, hands=("left",), distortion=(0.1, 0, 0, 0), allow_gaps=True)
    assert ImportOptions.from_json(json.loads(json.dumps(options.to_json()))) == options
    assert ImportOptions.from_json({"format": "rgbd_folder", "fx": None, "name": ""}) == ImportOptions()


def test_the_truth_of_a_synthetic_recording_comes_along(recording: Path, tmp_path: Path) -> None:
    (recording / "truth.npz").write_bytes(b"exact")
    assert run_import(recording, tmp_path / "kept/r").warnings == ()
    assert (tmp_path / "kept/r/truth.npz").read_bytes() == b"exact"


def test_the_report_says_what_was_told(folder: Path) -> None:
    assert check_import(folder, options=RGBD).options == RGBD.to_json()
    assert check_import(folder, "tum_rgbd", RGBD).options == RGBD.to_json() | {"format": "tum_rgbd"}

"""Any folder of numbered depth images: what its numbers say, what has to be told, what is left out."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from tests.tracker.capture.conftest import draw_color, draw_depth, write_png
from tracker.capture.import_findings import Findings
from tracker.capture.import_options import ImportOptions
from tracker.capture.import_plan import ImportPlan
from tracker.capture.importers.rgbd_folder import RgbdFolder, read_intrinsics
from tracker.capture.listed_files import ListedFiles, list_files
from tracker.errors import ImportRefusedError

TOLD = {"fx": 60, "cx": 31.5, "cy": 23.5, "depth_scale": 0.001}


def write_frames(folder: Path, numbers: list[int], kind: str = "depth") -> Path:
    draw = draw_depth if kind == "depth" else draw_color
    for number in numbers:
        write_png(folder / kind / f"{kind}_{number:03d}.png", draw(number))
    (folder / "notes.txt").write_text("kept at home")
    return folder


def plan(folder: Path, **options: object) -> ImportPlan:
    return RgbdFolder().plan(list_files(folder), ImportOptions.from_json(TOLD | options))


def test_a_folder_with_any_png_might_be_one() -> None:
    assert RgbdFolder().recognises(ListedFiles(Path("/x"), ("a/b.PNG",)))
    assert not RgbdFolder().recognises(ListedFiles(Path("/x"), ("a.jpg", "png")))


def test_frames_are_those_of_the_numbers_with_their_colour(tmp_path: Path) -> None:
    write_frames(tmp_path, [9, 10, 11])
    made = plan(write_frames(tmp_path, [9, 10, 11], "color"), distortion=[0.1, 0, 0, 0])
    (camera,) = made.cameras
    assert camera.color is not None and camera.depth is not None
    assert [camera.depth.name_of(index) for index in range(3)] == [f"depth/depth_{n:03d}.png" for n in (9, 10, 11)]
    assert [camera.color.name_of(index) for index in range(3)] == [f"color/color_{n:03d}.png" for n in (9, 10, 11)]
    assert camera.K is not None and camera.K.tolist() == [[60, 0, 31.5], [0, 60, 23.5], [0, 0, 1]]
    assert camera.distortion.tolist() == [0.1, 0, 0, 0] and camera.gaps == () and made.problems == ()
    assert made.warnings == ("1 other file is left out: notes.txt.",)


def test_a_step_in_the_numbers_is_no_gap_but_is_told(tmp_path: Path) -> None:
    made = plan(write_frames(tmp_path, [0, 20, 40, 60]))
    assert made.problems == () and made.cameras[0].gaps == ()
    assert made.warnings[0].startswith("depth/depth_*.png is numbered in steps of 20; the frames become 0, 1, 2")


@pytest.mark.parametrize(
    ("numbers", "gaps", "total"),
    [
        ([1, 2, 4], ("1 missing between 2 and 4",), "1 frame is"),
        ([1, 2, 3, 7, 8, 10], ("3 missing between 3 and 7", "1 missing between 8 and 10"), "4 frames are"),
        ([0, 10, 20, 50], ("2 missing between 20 and 50",), "2 frames are"),
    ],
)
def test_missing_numbers_are_counted_and_refuse_until_gaps_are_allowed(
    tmp_path: Path, numbers: list[int], gaps: tuple[str, ...], total: str
) -> None:
    folder = write_frames(tmp_path, numbers)
    refused, allowed = plan(folder), plan(folder, allow_gaps=True)
    text = f"depth/depth_*.png: {total} missing in the numbering ({'; '.join(gaps)})."
    assert refused.problems == (f"{text} Add them, or allow gaps.",)
    assert [question.field for question in refused.questions] == ["allow_gaps"]
    assert refused.cameras[0].gaps == allowed.cameras[0].gaps == gaps
    assert allowed.problems == () and f"{text} The frames around them become neighbours." in allowed.warnings


def test_two_files_of_one_number_are_refused(tmp_path: Path) -> None:
    folder = write_frames(tmp_path, [1, 2])
    write_png(folder / "depth/depth_2.png", draw_depth(2))
    assert plan(folder).problems == ("Two files have the same number: depth/depth_2.png.",)


def test_a_preset_of_another_size_is_a_problem_of_the_preset_alone(tmp_path: Path) -> None:
    made = plan(write_frames(tmp_path, [1, 2]), preset="kinect_v2")
    (question,) = [question for question in made.questions if question.is_required]
    assert question.field == "preset" and made.problems == (question.problem,)
    assert made.cameras[0].K is not None


def test_a_folder_of_colour_alone_is_refused(tmp_path: Path) -> None:
    with pytest.raises(ImportRefusedError, match="8 bits cannot hold depth"):
        plan(write_frames(tmp_path, [1, 2], "color"))


@pytest.mark.parametrize("missing", [("fx",), ("cx", "cy"), ("fx", "cx", "cy")])
def test_what_is_missing_of_a_camera_is_named_in_one_sentence_and_asked_one_by_one(missing: tuple[str, ...]) -> None:
    found = Findings()
    told = {name: value for name, value in TOLD.items() if name not in missing}
    assert read_intrinsics(ImportOptions.from_json(told), found) is None
    (problem,) = found.problems
    assert problem == f"The camera is not known: give {', '.join(missing)} (and fy if it differs from fx), in px."
    assert [question.field for question in found.questions if question.is_required] == list(missing)
    assert [question.field for question in found.questions if not question.is_required] == ["fy"]


def test_fy_is_fx_unless_it_is_told() -> None:
    found = Findings()
    alike, apart = (read_intrinsics(ImportOptions.from_json(TOLD | more), found) for more in ({}, {"fy": 61}))
    assert alike is not None and apart is not None and found == Findings()
    assert np.diag(alike).tolist() == [60, 60, 1] and np.diag(apart).tolist() == [60, 61, 1]

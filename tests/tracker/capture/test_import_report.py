"""A report as sentences and as plain values."""

from __future__ import annotations

import json
from dataclasses import replace

import pytest

from tracker.capture.import_question import make_question
from tracker.capture.import_report import CameraReport, DepthReport, ImportReport

DEPTH = DepthReport(12, 0, 0.25, 0.0, (0.31, 0.35, 0.5, 0.9, 1.2345), 0.35)
CAMERA = CameraReport("cam0", 640, 480, 100, 100, {}, depth=DEPTH)
REPORT = ImportReport("rgbd_folder", "waving", 25.0, 100, (CAMERA,), ("right",))


def test_a_recording_is_told_in_sentences() -> None:
    assert REPORT.summary == (
        "100 frames of 1 camera, 4.0 s at 25 frames per second.",
        "cam0: 640x480 px, 100 colour and 100 depth images.",
        "cam0: the nearest thing is 0.35 m away.",
        "cam0: depth from 0.310 to 1.234 m (1 to 99 %, 12 frames looked at), 25% of the pixels without a value.",
        "Seen: right hand.",
    )


@pytest.mark.parametrize(
    ("changes", "said"),
    [
        ({"fps": None, "frame_count": 1}, "1 frame of 1 camera."),
        ({"cameras": (CAMERA, CAMERA)}, "100 frames of 2 cameras, 4.0 s at 25 frames per second."),
        ({"cameras": (replace(CAMERA, depth_frames=0),)}, "cam0: 640x480 px, 100 colour images."),
        ({"cameras": (replace(CAMERA, color_frames=0, depth_frames=0),)}, "cam0: 640x480 px, no images."),
        ({"baselines_m": {"a - b": 0.5}}, "Cameras are 0.500 m apart."),
        ({"baselines_m": {"a - b": 0.5, "a - c": 0.25}}, "Cameras are 0.250 to 0.500 m apart."),
        ({"hands": ("right", "left"), "objects": ("ball",)}, "Seen: right hand, left hand, ball."),
        ({"hands": ()}, "No hands or objects are named."),
        ({"annotations": 1}, "1 annotated hand is along."),
        ({"annotations": 7}, "7 annotated hands are along."),
    ],
)
def test_each_fact_has_its_sentence(changes: dict, said: str) -> None:
    assert said in replace(REPORT, **changes).summary


@pytest.mark.parametrize("depth", [None, DepthReport(3, 3, 1.0, 0.0, ())])
def test_where_depth_tells_nothing_nothing_is_told_of_it(depth: DepthReport | None) -> None:
    report = replace(REPORT, cameras=(replace(CAMERA, depth=depth),))
    assert not any("m away" in sentence or "depth from" in sentence for sentence in report.summary)


def test_it_can_be_imported_when_nothing_is_a_problem_whatever_is_odd() -> None:
    assert replace(REPORT, warnings=("odd",)).ok and not replace(REPORT, problems=("damaged",)).ok
    assert ImportReport().summary == ("Nothing can be imported.",)


def test_the_report_is_plain_values_with_its_summary() -> None:
    report = replace(REPORT, questions=(make_question("fx", "Give it.", "No fx."),), problems=("No fx.",))
    told = json.loads(json.dumps(report.to_json(), allow_nan=False))
    assert told["ok"] is False and told["summary"] == list(report.summary)
    assert told["questions"][0]["field"] == "fx" and told["cameras"][0]["depth"]["nearest_m"] == 0.35
    fields = {*ImportReport.__dataclass_fields__, "ok", "summary"}
    assert told.keys() == fields

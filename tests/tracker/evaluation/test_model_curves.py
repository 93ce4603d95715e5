"""Curves of a model study are SVG documents that stand alone: one line and one label for each that was measured."""

from __future__ import annotations

import xml.etree.ElementTree as ElementTree

from tracker.evaluation.model_curves import draw_study
from tracker.evaluation.model_report_html import MOST_COMPONENTS

SVG = "{http://www.w3.org/2000/svg}"
ROWS = [{"components": n, "mean_mm": 3.0 / (1 + n)} for n in range(5)]


def texts(document: str) -> list[str]:
    return [text.text or "" for text in ElementTree.fromstring(document).iter(f"{SVG}text")]


def test_what_was_not_measured_is_not_drawn() -> None:
    assert draw_study({}) == {} == draw_study({"pose_space": {}, "shape_space": None})
    assert set(draw_study({"pose_space": {"own": ROWS}})) == {"pose_space"}


def test_each_line_has_its_label_and_its_unit() -> None:
    found = draw_study({"shape_space": {"ours & theirs": ROWS, "<first>": ROWS}})["shape_space"]
    assert {"ours & theirs", "<first>", "components"} <= set(texts(found))
    assert any("mm" in text for text in texts(found))
    assert len(list(ElementTree.fromstring(found).iter(f"{SVG}polyline"))) == 2


def test_of_a_long_space_the_first_components_are_drawn() -> None:
    shares = [1 - 0.9**n for n in range(1, 3 * MOST_COMPONENTS)]
    found = draw_study({"compactness": {"pose": shares}})["compactness"]
    (line,) = ElementTree.fromstring(found).iter(f"{SVG}polyline")
    assert len(line.attrib["points"].split()) == MOST_COMPONENTS and "pose space" in texts(found)


def test_the_picture_grows_with_its_legend() -> None:
    heights = []
    for count in (1, 3, 4):
        rows = {f"line {n}": ROWS for n in range(count)}
        root = ElementTree.fromstring(draw_study({"pose_space": rows})["pose_space"])
        heights.append(float(root.attrib["viewBox"].split()[3]))
    assert heights[0] == heights[1] < heights[2], "three labels a row"

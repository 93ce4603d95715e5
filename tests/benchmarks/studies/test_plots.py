"""Plots are valid SVG, points stand where the scales say, and T16's are set apart."""

from __future__ import annotations

import itertools
import math
import xml.etree.ElementTree as ET

import pytest

from benchmarks.studies.axes import Axes, find_ticks, width_of, wrap
from benchmarks.studies.plots import Bars, Lines, Series, draw_plot

SVG = "{http://www.w3.org/2000/svg}"


@pytest.mark.parametrize(("low", "high"), [(0.0, 0.62), (5.12, 5.61), (0.0, 100.0), (0.0, 0.0), (3.0, 3.0)])
def test_ticks_are_round_and_cover_the_range(low, high):
    ticks = find_ticks(low, high)
    assert ticks[0] <= low and ticks[-1] >= high
    assert 2 <= len(ticks) <= 9
    steps = {round(b - a, 9) for a, b in itertools.pairwise(ticks)}
    assert len(steps) == 1, "equal steps"


def test_axes_put_the_ends_of_the_ranges_on_the_edges():
    axes = Axes(10.0, 20.0, 100.0, 50.0, (1.0, 3.0), (0.0, 5.0))
    assert (axes.x(1.0), axes.x(3.0), axes.y(0.0), axes.y(5.0)) == (10.0, 110.0, 70.0, 20.0)


def test_lines_are_drawn_in_order_with_a_gap_where_nothing_is_known():
    ours = Series("ours <new>", (1, 2, 3, 4), (0.4, math.nan, 0.2, 0.1))
    theirs = Series("T16", (1, 2, 3, 4), (0.5, 0.4, 0.3, 0.3), is_paper=True)
    root = ET.fromstring(draw_plot([Lines("Error", "n", "px", [ours, theirs])], "errors"))
    assert root.attrib["aria-label"] == "errors"
    own, paper = [
        path.attrib["d"]
        for path in root.iter(f"{SVG}path")
        if "class" in path.attrib and "line" in path.attrib["class"]
    ][2:]
    assert own.count("M") == 2 and paper.count("M") == 1
    marks = [(float(c.attrib["cx"]), float(c.attrib["cy"])) for c in root.iter(f"{SVG}circle")]
    assert len(marks) == 7
    assert marks[0][1] < marks[1][1] < marks[2][1], "smaller values are lower"
    dashed = [p for p in root.iter(f"{SVG}path") if "t16" in p.attrib.get("class", "").split()]
    assert len(dashed) == 2, "the legend's sample and the line"


def test_bars_are_as_high_as_their_values():
    root = ET.fromstring(
        draw_plot([Bars("Error", "px", ("a", "b"), {"ours": (1.0, 2.0), "T16": (4.0, math.nan)})], "x")
    )
    heights = [float(rect.attrib["height"]) for rect in root.iter(f"{SVG}rect") if "x" in rect.attrib]
    assert len(heights) == 3, "none for what is not known"
    assert heights[1] == pytest.approx(2 * heights[0], abs=0.2)
    assert heights[2] == pytest.approx(4 * heights[0], abs=0.2)


def test_labels_are_broken_between_words_only():
    assert wrap("T16's LO+SC tracker", 60.0) == ["T16's", "LO+SC", "tracker"]
    assert wrap("T16's LO+SC tracker", 90.0) == ["T16's LO+SC", "tracker"]
    assert all(width_of(line) <= 90.0 for line in wrap("as it comes, with second tries", 90.0))

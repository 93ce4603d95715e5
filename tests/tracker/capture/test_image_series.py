"""Which images are depth and which their colour: taken where it is clear, asked where it is not."""

from __future__ import annotations

import struct
import zlib
from pathlib import Path

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from tracker.capture.image_series import choose_color, choose_depth, look_at
from tracker.capture.import_findings import Findings
from tracker.capture.import_options import ImportOptions
from tracker.capture.listed_files import ListedFiles, list_files
from tracker.capture.numbered_files import NumberedFiles, group_by_number
from tracker.errors import ImportRefusedError

GREY, RGB = 0, 2
SUFFIXES = (".png",)


def png(bits: int, kind: int) -> bytes:
    """The head of an image, as far as it is looked at."""
    chunk = struct.pack(">4sIIBBBBB", b"IHDR", 8, 6, bits, kind, 0, 0, 0)
    return b"\x89PNG\r\n\x1a\n" + struct.pack(">I", 13) + chunk + struct.pack(">I", zlib.crc32(chunk))


@pytest.fixture
def make(tmp_path: Path):
    """Folders of numbered images: `depth=(16, GREY, 3)` is three of them; a tuple may end with the first number."""

    def make(**series: tuple[int, ...]) -> ListedFiles:
        for name, (bits, kind, count, *first) in series.items():
            (tmp_path / name).mkdir()
            for number in range(count):
                (tmp_path / name / f"{sum(first) + number:03d}.png").write_bytes(png(bits, kind))
        (tmp_path / "notes.txt").write_text("so that the folders are not taken for the recording")
        return list_files(tmp_path)

    return make


def depth_of(files: ListedFiles, **options: str) -> tuple[NumberedFiles, Findings]:
    found = Findings()
    return choose_depth(files, ImportOptions(**options), found), found


def color_of(files: ListedFiles, **options: str) -> tuple[str | None, Findings]:
    depth, _ = depth_of(files, depth_pattern="depth/*.png")
    found = Findings()
    chosen = choose_color(files, ImportOptions(**options), depth, found)
    return chosen and chosen.pattern, found


def test_the_only_16_bit_grey_images_are_the_depth_and_nothing_is_asked(make) -> None:
    depth, found = depth_of(make(a=(16, GREY, 3), b=(8, GREY, 5), c=(8, RGB, 9), d=(16, RGB, 9)))
    assert (depth.pattern, depth.numbers, found) == ("a/*.png", (0, 1, 2), Findings())


def test_of_several_the_likeliest_is_proposed_and_asked_for(make) -> None:
    files = make(a=(16, GREY, 9), depth=(16, GREY, 3))
    depth, found = depth_of(files)
    (question,) = found.questions
    assert depth.pattern == question.proposal == "depth/*.png" and question.proposed_by == "its name"
    assert question.is_required and [choice.count for choice in question.choices] == [9, 3]
    assert "Depth images of 2 kinds: a/*.png (9), depth/*.png (3)" in found.problems[0]
    told, after = depth_of(files, depth_pattern="a/*.png")
    assert told.pattern == "a/*.png" and not after.problems and not after.questions[0].is_required


@pytest.mark.parametrize(("pattern", "told"), [("nowhere/*.png", "matches no file; found"), ("a/b", "one place")])
def test_a_pattern_that_names_nothing_is_a_problem_and_not_the_end(make, pattern: str, told: str) -> None:
    depth, found = depth_of(make(depth=(16, GREY, 3)), depth_pattern=pattern)
    assert depth.pattern == "depth/*.png" and told in found.problems[0] and found.questions[0].is_required


def test_without_depth_it_is_said_what_there_is_instead(make) -> None:
    with pytest.raises(ImportRefusedError, match=r"found depth/\*\.png, each a .*8 bits cannot hold depth"):
        depth_of(make(depth=(8, GREY, 3), color=(8, RGB, 9)))


def test_without_any_images_it_is_said_what_is_needed(make) -> None:
    with pytest.raises(ImportRefusedError, match="needed numbered 16-bit grey PNGs, such as"):
        depth_of(make())


def test_the_only_colour_with_the_same_numbers_is_taken(make) -> None:
    chosen, found = color_of(make(depth=(16, GREY, 3), rgb=(8, RGB, 3)))
    assert chosen == "rgb/*.png" and found == Findings()


def test_of_several_colours_those_with_the_same_numbers_are_taken_and_may_be_changed(make) -> None:
    chosen, found = color_of(make(depth=(16, GREY, 3), rgb=(8, RGB, 3), more=(8, RGB, 7)))
    (question,) = found.questions
    assert chosen == "rgb/*.png" and not found.problems and not question.is_required
    assert [choice.value for choice in question.choices] == ["more/*.png", "rgb/*.png", "none"]


def test_two_colours_with_the_same_numbers_must_be_told_apart(make) -> None:
    files = make(depth=(16, GREY, 3), left=(8, RGB, 3), right=(8, RGB, 3))
    chosen, found = color_of(files)
    assert chosen is None and "Colour images of 2 kinds" in found.problems[0] and found.questions[0].is_required
    assert color_of(files, color_pattern="right/*.png")[0] == "right/*.png"


def test_colour_with_other_numbers_is_refused_with_the_numbers_that_are_alone(make) -> None:
    files = make(depth=(16, GREY, 3), rgb=(8, RGB, 3, 1))
    chosen, found = color_of(files)
    assert chosen is None
    assert "1 depth image without colour (0), 1 colour image without depth (3)" in found.problems[0]
    assert color_of(files, color_pattern="none") == (None, color_of(files, color_pattern="none")[1])
    assert not color_of(files, color_pattern="none")[1].problems


def test_a_recording_without_colour_is_depth_alone(make) -> None:
    assert color_of(make(depth=(16, GREY, 3))) == (None, Findings())


@settings(max_examples=40, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(data=st.one_of(st.binary(max_size=40), st.integers(0, 33).map(lambda size: png(16, GREY)[:size])))
def test_what_is_no_image_is_looked_past(data: bytes, tmp_path: Path) -> None:
    for name, content in (("a_1.png", data), ("a_2.png", png(16, GREY))):
        (tmp_path / name).write_bytes(content)
    files = list_files(tmp_path)
    (series,) = group_by_number(files.names, SUFFIXES)
    header = look_at(files, series)
    assert header is not None and header.kind in ("png", "jpeg")
    (tmp_path / "a_2.png").unlink()
    assert look_at(files, NumberedFiles("a_*.png", (2,), ("a_2.png",))) is None

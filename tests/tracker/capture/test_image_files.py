"""Streams of image files: every header is looked at, some pixels, and what is wrong is named and counted."""

from __future__ import annotations

from pathlib import Path

import cv2
import numpy as np
import pytest

from tests.tracker.capture.conftest import draw_color, draw_depth, write_png
from tracker.capture.image_files import ImageFiles
from tracker.errors import FrameError


def write_depth(folder: Path, images: list[np.ndarray]) -> ImageFiles:
    names = tuple(f"{number}.png" for number in range(len(images)))
    for name, image in zip(names, images, strict=True):
        write_png(folder / name, image)
    return ImageFiles(folder, names, True)


def test_sound_files_have_one_size_one_type_and_no_problem(tmp_path: Path) -> None:
    probe = write_depth(tmp_path, [draw_depth(index) for index in range(4)]).probe(2)
    assert (probe.count, probe.size, probe.types, probe.problems) == (4, (64, 48), {"16-bit grey PNG": 4}, ())
    assert probe.depth is not None and probe.depth.frames == 2, "the first and the last"
    assert probe.depth.largest == 503


def test_no_files_are_no_size_no_sample_and_no_problem(tmp_path: Path) -> None:
    empty = ImageFiles(tmp_path, (), True)
    probe = empty.probe(12)
    assert (probe.count, probe.size, probe.types, probe.problems, probe.depth) == (0, None, {}, (), None)
    assert empty.sample_depth().percentiles == () and list(empty.read()) == []


@pytest.mark.parametrize(("lost", "said"), [(1, "1.png"), (5, "5.png"), (6, "5.png, and 1 more"), (9, "and 4 more")])
def test_missing_files_are_counted_and_the_first_five_named(tmp_path: Path, lost: int, said: str) -> None:
    stream = write_depth(tmp_path, [draw_depth(0)] * 12)
    for number in range(1, lost + 1):
        (tmp_path / f"{number}.png").unlink()
    (problem,) = stream.probe(2).problems
    assert problem.startswith(f"{lost} of 12 files are missing: 1.png") and problem.endswith(f"{said}.")


def test_damaged_files_are_named_five_at_most(tmp_path: Path) -> None:
    stream = write_depth(tmp_path, [draw_depth(0)] * 12)
    for number in range(2, 9):
        (tmp_path / f"{number}.png").write_bytes(b"no image at all")
    problems = stream.probe(2).problems
    assert len(problems) == 6 and [problem.split(":")[0] for problem in problems[:5]] == [
        f"{n}.png" for n in range(2, 7)
    ]
    assert problems[5] == "... and 2 more files like these."


def test_files_of_another_size_than_most_are_counted_with_one_of_them(tmp_path: Path) -> None:
    small = np.ones((20, 30), np.uint16)
    probe = write_depth(tmp_path, [small, draw_depth(0), draw_depth(1), small, draw_depth(2)]).probe(2)
    assert probe.size == (64, 48)
    assert probe.problems == ("3.png: is 30x20 px where the others are 64x48 px (2 such files).",)


def test_depth_values_are_those_of_numpy_over_the_pixels_that_have_one(
    tmp_path: Path, rng: np.random.Generator
) -> None:
    images = [rng.integers(0, 3000, (20, 30)).astype(np.uint16) * (rng.random((20, 30)) < 0.7) for _ in range(3)]
    images[1][:] = 0
    images[2][:2] = 65535
    sample = write_depth(tmp_path, images).sample_depth(3)
    pixels = np.array(images)
    assert (sample.frames, sample.empty_frames, sample.largest) == (3, 1, 65535)
    assert sample.zero_share == pytest.approx((pixels == 0).mean())
    assert sample.saturated_share == pytest.approx((pixels == 65535).mean()) and sample.saturated_share > 0
    expected = np.percentile(pixels[pixels > 0], (1, 5, 50, 95, 99), method="inverted_cdf")
    assert np.array_equal(sample.percentiles, expected)


def test_empty_depth_has_no_percentiles_and_nothing_largest(tmp_path: Path) -> None:
    sample = write_depth(tmp_path, [np.zeros((20, 30), np.uint16)] * 2).sample_depth()
    assert (sample.frames, sample.empty_frames, sample.zero_share) == (2, 2, 1.0)
    assert (sample.percentiles, sample.largest) == ((), 0)


def test_files_are_read_in_order_bit_by_bit(tmp_path: Path) -> None:
    stream = write_depth(tmp_path, [draw_depth(index) for index in range(3)])
    images = list(stream.read())
    assert [image.source for image in images] == ["0.png", "1.png", "2.png"]
    assert [image.data for image in images] == [(tmp_path / name).read_bytes() for name in stream.names]
    assert {image.size for image in images} == {(64, 48)}


def test_reading_ends_at_the_first_bad_file_with_its_name_and_not_its_place(tmp_path: Path) -> None:
    stream = write_depth(tmp_path, [draw_depth(index) for index in range(3)])
    (tmp_path / "1.png").unlink()
    reading = stream.read()
    assert next(reading).source == "0.png"
    with pytest.raises(FrameError, match=r"^1\.png: ") as caught:
        next(reading)
    assert str(tmp_path) not in str(caught.value)


def test_a_link_out_of_the_recording_is_neither_looked_at_nor_read(tmp_path: Path) -> None:
    write_png(tmp_path / "secret.png", draw_depth(0))
    (tmp_path / "own").mkdir()
    (tmp_path / "own/0.png").symlink_to(tmp_path / "secret.png")
    stream = ImageFiles(tmp_path / "own", ("0.png",), True)
    assert stream.probe(1).problems == ("0.png: is not a plain file inside the recording.",)
    with pytest.raises(FrameError, match=r"^0\.png: leads out of the recording\.$"):
        next(stream.read())


@pytest.mark.parametrize(
    ("name", "suffix"), [("a.png", ".png"), ("a.PNG", ".png"), ("a.jpeg", ".jpg"), ("a.JPG", ".jpg"), (None, ".png")]
)
def test_stored_files_end_in_png_or_jpg(tmp_path: Path, name: str | None, suffix: str) -> None:
    assert ImageFiles(tmp_path, (name,) if name else (), False).suffix == suffix


def test_a_jpeg_cut_off_is_noticed_although_it_is_not_among_the_samples(tmp_path: Path) -> None:
    for number in range(4):
        cv2.imwrite(str(tmp_path / f"{number}.jpg"), draw_color(number))
    path = tmp_path / "1.jpg"
    path.write_bytes(path.read_bytes()[:-30])
    (problem,) = ImageFiles(tmp_path, tuple(f"{number}.jpg" for number in range(4)), False).probe(2).problems
    assert problem.startswith("1.jpg: ")

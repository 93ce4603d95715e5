"""The part of an image in which hands are marked."""

import shutil

import cv2
import numpy as np
import pytest

from tracker.capture.annotations import Annotation, Annotations, load_annotations
from tracker.capture.sequence import load_sequence
from tracker.cli.__main__ import main
from tracker.detection.annotated_images import TIPS, annotated_images, count_images


@pytest.fixture(scope="module")
def recording(tmp_path_factory):
    out = tmp_path_factory.mktemp("recordings") / "wave"
    arguments = ["synthesize", "--motion", "wave", "--hand", "right", "--hand", "left", "--frames", "0:6"]
    assert main([*arguments, "--background", "1.3", "--out", str(out)]) == 0
    return load_sequence(out)


@pytest.fixture(scope="module")
def annotations(recording):
    return load_annotations(recording.annotations_path)


def test_fingertips_of_both_hands_are_where_they_were_marked(recording, annotations):
    items = list(annotated_images(recording, annotations))
    assert len(items) == 6
    for number, item in enumerate(items):
        marked = np.concatenate([a.points[list(TIPS)] for a in annotations.at(number)])
        region = item.region
        np.testing.assert_allclose(item.tips + np.array([region.column, region.row]), marked[:, :2])
        np.testing.assert_array_equal(item.is_visible, marked[:, 2] == 2)
        assert item.image.depth.shape == item.image.color.shape[:2] == (region.height, region.width)


def test_the_wall_behind_is_left_out_and_colour_leaves_hands_only(recording, annotations):
    for item in annotated_images(recording, annotations, step=3):
        known = item.image.depth[item.image.depth > 0]
        assert known.max() < 0.9
        share = item.image.mask.mean()
        assert 0.1 < share < 0.7


def test_as_many_are_taken_as_were_counted(recording, annotations):
    for step in (1, 4, 100):
        taken = list(annotated_images(recording, annotations, step))
        assert len(taken) == count_images(recording, annotations, step)


def test_one_of_so_many_is_taken(recording, annotations):
    names = [item.name for item in annotated_images(recording, annotations, step=4)]
    assert [name.split()[-1] for name in names] == ["0", "4"]


def test_a_dim_recording_is_learnt_from_as_brightly_as_it_is_tracked(recording, annotations, tmp_path):
    copy = load_sequence(shutil.copytree(recording.folder, tmp_path / "dim"))
    path = copy.image_path("color", 0, "cam0")
    cv2.imwrite(str(path), (0.3 * cv2.imread(str(path))).astype(np.uint8))
    (full, dim) = (next(annotated_images(each, annotations)).image for each in (recording, copy))
    assert np.abs(full.color.astype(float) - dim.color).mean() < 0.2 * full.color.mean()
    assert np.mean(full.mask != dim.mask) < 0.05


def test_images_without_depth_at_any_mark_are_left_out(recording):
    points = np.zeros((21, 3))
    points[:] = [5.0, 5.0, 2.0]  # a corner: the wall, which is a depth
    absent = np.zeros((21, 3))
    outside = points + np.array([10_000.0, 0.0, 0.0])
    items = [Annotation(frame, "cam0", "right", p) for frame, p in enumerate((absent, outside))]
    items.append(Annotation(99, "cam0", "right", points))  # a frame that is not there
    assert list(annotated_images(recording, Annotations(tuple(items)))) == []

"""Nails of annotated views, where people marked joints alone."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from tracker.capture.annotations import Annotations, load_annotations
from tracker.capture.sequence import Sequence
from tracker.model.default_hand import default_hand
from tracker.model.npz_files import save_npz_model
from tracker.model.scene import Scene
from tracker.rendering.seen_nails import NailPlaces
from tracker.search.annotated_nails import annotated_nail_images, count_nail_images
from tracker.synthesis.motion import perform
from tracker.synthesis.nail_paint import NailPaint
from tracker.synthesis.performance import Performance, render_moment
from tracker.synthesis.recording import RecordingOptions, write_recording
from tracker.synthesis.texture import Texture

MOMENTS = range(15, 45, 10)


@pytest.fixture(scope="module")
def performance() -> Performance:
    return perform({"right": default_hand("right")}, "open-close", 46, 3, (640, 480))


@pytest.fixture(scope="module")
def views(performance: Performance, tmp_path_factory: pytest.TempPathFactory) -> Sequence:
    options = RecordingOptions(MOMENTS, sensor=None, texture=Texture(nails=NailPaint()))
    return write_recording(performance, tmp_path_factory.mktemp("nails") / "views", options, save_npz_model)


def read(views: Sequence) -> Annotations:
    assert views.annotations_path is not None
    return load_annotations(views.annotations_path)


def test_nails_are_where_the_drawn_hand_has_them(views: Sequence, performance: Performance) -> None:
    images = list(annotated_nail_images(views, read(views)))
    assert len(images) == count_nail_images(views, read(views)) == 3 * len(MOMENTS)
    places = NailPlaces.of(Scene((default_hand("right"),)))
    errors = []
    for number, item in enumerate(images):
        moment, camera = MOMENTS[number // 3], performance.cameras[number % 3]
        vertices = render_moment(performance.seen_by(camera), moment).vertices
        true = camera.project(places.points(vertices)) - [item.region.column, item.region.row]
        seen = item.tips[item.is_visible]
        errors += np.linalg.norm(seen[:, None] - true[None], axis=2).min(axis=1).tolist()
    assert len(errors) >= 10
    assert np.median(errors) < 3.0 and max(errors) < 8.0, errors  # px of 1.1 mm


def test_one_view_is_enough_and_a_fingertip_that_nobody_marked_teaches_nothing(views: Sequence) -> None:
    alone = [item for item in read(views).items if item.camera == "cam1"]
    (first, *_) = annotated_nail_images(views, Annotations(tuple(alone)))
    assert first.is_visible.any()
    hidden = []
    for item in alone:
        points = item.points.copy()
        points[[4, 8, 12, 16, 20], 2] = 1
        hidden.append(replace(item, points=points))
    assert not any(item.is_visible.any() for item in annotated_nail_images(views, Annotations(tuple(hidden))))


def test_a_hand_with_few_marks_or_in_a_camera_without_colour_is_left_out(views: Sequence, tmp_path: Path) -> None:
    few = []
    for item in read(views).items:
        points = item.points.copy()
        points[:15] = 0
        few.append(replace(item, points=points))
    assert list(annotated_nail_images(views, Annotations(tuple(few)))) == []
    blind = replace(views, cameras=tuple(replace(camera, color=None) for camera in views.cameras))
    assert list(annotated_nail_images(blind, read(views))) == []

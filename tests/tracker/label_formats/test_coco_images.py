"""Images of COCO files are found by file name first, then by the numbers that our own files carry; never by a guess."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from tracker.capture.annotations import Annotation
from tracker.capture.document import Node
from tracker.errors import AnnotationError
from tracker.label_formats.coco_images import list_images, read_images
from tracker.label_formats.label_set import ImportCollector, ImportHints, LabelSet


def marked(*places: tuple[str, int]) -> tuple[Annotation, ...]:
    return tuple(Annotation(frame, camera, "right", np.full((21, 3), 2.0)) for camera, frame in places)


def read(images: Any, sets: list[LabelSet], **hints: Any) -> tuple[dict, ImportCollector]:
    collector = ImportCollector(sets)
    return read_images(Node(images, "a.json", "images", AnnotationError), collector, ImportHints(**hints)), collector


def said(notes: Any) -> str:
    return " ".join(notes.sentences())


def test_images_with_labels_are_listed_once_and_found_again(make_set) -> None:
    only = make_set(marked(("cam1", 2), ("cam0", 2), ("cam0", 0)))
    images, ids = list_images([only])
    assert [(image["camera"], image["frame"]) for image in images] == [("cam0", 0), ("cam0", 2), ("cam1", 2)]
    found, collector = read(images, [only])
    assert {place: id_ for id_, (_, place) in found.items()} == {place: id_ for (_, place), id_ in ids.items()}
    assert said(collector.warnings) == said(collector.problems) == ""


def test_of_several_recordings_each_image_is_of_its_own(make_set) -> None:
    sets = [make_set(marked(("cam0", 1)), key=key * 8) for key in "ab"]
    images, ids = list_images(sets)
    assert len({image["file_name"] for image in images}) == 2
    found, _ = read(images, sets)
    assert {id_: key for id_, (key, _) in found.items()} == {id_: key for (key, _), id_ in ids.items()}


def image(name: str, **more: Any) -> dict[str, Any]:
    return {"id": 1, "file_name": name} | more


def test_a_name_that_is_not_known_is_found_by_our_own_numbers_with_a_warning(make_set) -> None:
    only = make_set()
    found, collector = read([image("renamed.png", camera="cam1", frame=3)], [only])
    assert found == {1: (only.key, ("cam1", 3))} and "the frame number was taken" in said(collector.warnings)
    for more in ({"camera": "cam9", "frame": 3}, {"camera": "cam1", "frame": 99}, {"camera": "cam1", "frame": "3"}, {}):
        found, collector = read([image("renamed.png", **more)], [only])
        assert found == {} and "not in the recording" in said(collector.warnings), more


def test_the_file_name_counts_more_than_our_own_number(make_set) -> None:
    only = make_set()
    found, collector = read([image("cam0/color/000002.png", camera="cam0", frame=4)], [only])
    assert found == {1: (only.key, ("cam0", 2))} and "taken by file name although" in said(collector.warnings)


def test_a_name_that_several_cameras_have_needs_the_camera(make_set) -> None:
    only = make_set()
    found, collector = read([image("000002.png")], [only])
    assert found == {} and "name the camera" in said(collector.problems)
    assert read([image("000002.png")], [only], camera="cam1")[0] == {1: (only.key, ("cam1", 2))}


def test_an_image_of_another_size_is_refused(make_set) -> None:
    found, collector = read([image("cam0/color/000002.png", width=320, height=240)], [make_set()])
    assert found == {} and "320x240, recorded 640x480" in said(collector.problems)


def test_an_id_twice_is_refused(make_set) -> None:
    with pytest.raises(AnnotationError, match=r"images\[1\]\.id is 1; needed an id that no other image has"):
        read([image("cam0/color/000002.png"), image("cam0/color/000003.png")], [make_set()])

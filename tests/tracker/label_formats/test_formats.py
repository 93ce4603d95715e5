"""What every format has in common: names, options, how many recordings, and what is said of joints' sources."""

from __future__ import annotations

import numpy as np
import pytest

from tests.tracker.label_formats.conftest import MakeSet
from tracker.capture.annotations import Annotation
from tracker.capture.joint_source import JointSource
from tracker.errors import AnnotationError
from tracker.label_formats.formats import LABEL_FORMATS, export_labels, find_label_format, import_labels
from tracker.label_formats.label_set import ImportHints

MARKS = np.column_stack([np.linspace(100, 300, 21), np.linspace(50, 200, 21), np.full(21, 2.0)])
MIXED = (JointSource("track", "Track 2"), JointSource("detector"), *(None,) * 19)
IN_2D = ("annotations", "coco_keypoints", "coco_wholebody", "deeplabcut", "t16")


def marked(sources=None) -> tuple[Annotation, ...]:
    return (Annotation(1, "cam0", "right", MARKS, sources),)


def test_a_format_is_found_by_its_name_and_an_unknown_one_is_told_all() -> None:
    for name, item in LABEL_FORMATS.items():
        assert find_label_format(name) is item and item.name == name
    with pytest.raises(
        AnnotationError, match=r"no format of labels 'yolo'; there are annotations, coco_keypoints, .*t16"
    ):
        find_label_format("yolo")


@pytest.mark.parametrize("name", IN_2D)
def test_an_export_counts_its_hands_and_joints_and_is_called_as_promised(name: str, make_set: MakeSet) -> None:
    made = export_labels(name, [make_set(marked())])
    assert (made.items, made.joints) == (1, 21)
    file = LABEL_FORMATS[name].file
    assert file.endswith(".zip") or list(made.files) == [file]


@pytest.mark.parametrize("name", ["freihand", "interhand"])
def test_a_format_of_3d_joints_refuses_labels_of_one_camera_and_says_what_to_do(name: str, make_set: MakeSet) -> None:
    with pytest.raises(AnnotationError, match=r"holds 3D joints only, and .* or give a track\."):
        export_labels(name, [make_set(marked())])


@pytest.mark.parametrize("name", LABEL_FORMATS)
def test_only_a_format_of_several_recordings_takes_two_or_none(name: str, make_set: MakeSet) -> None:
    for sets in ([], [make_set(marked(), key="a" * 8), make_set(marked(), key="b" * 8)]):
        if LABEL_FORMATS[name].several:
            assert export_labels(name, sets).items == len(sets)
        else:
            with pytest.raises(
                AnnotationError, match="holds one recording a file; coco_keypoints, coco_wholebody hold"
            ):
                export_labels(name, sets)
            with pytest.raises(AnnotationError, match="holds one recording a file; name the recording"):
                import_labels(name, {}, sets)


@pytest.mark.parametrize("name", IN_2D)
def test_joints_that_a_machine_made_are_told_where_the_file_does_not_tell_them(name: str, make_set: MakeSet) -> None:
    notes = " ".join(export_labels(name, [make_set(marked(MIXED))]).notes)
    said = "does not say where joints came from: 1 accepted from Track 2, 1 accepted from the hand detector."
    assert (said in notes) != LABEL_FORMATS[name].carries_sources
    assert "came from" not in " ".join(export_labels(name, [make_set(marked((None,) * 21))]).notes)


@pytest.mark.parametrize("name", IN_2D)
def test_only_joints_of_the_chosen_sources_are_exported_and_the_others_counted(name: str, make_set: MakeSet) -> None:
    made = export_labels(name, [make_set(marked(MIXED))], ("independent",))
    assert made.joints == 19 and "accepted from Track 2" in made.notes[0]
    assert export_labels(name, [make_set(marked(MIXED))], ("track",)).joints == 1


@pytest.mark.parametrize(
    ("hints", "said"),
    [
        (ImportHints(hand="both"), "The option hand is 'both'; needed right or left."),
        (ImportHints(pixel_centre=0.25), "The option pixel_centre is 0.25; needed 0 or 0.5."),
    ],
)
def test_impossible_options_are_refused_before_the_files_are_read(
    hints: ImportHints, said: str, make_set: MakeSet
) -> None:
    with pytest.raises(AnnotationError) as caught:
        import_labels("coco_keypoints", {"a.json": b"broken"}, [make_set()], hints)
    assert str(caught.value) == said


def test_a_named_format_counts_more_than_what_the_files_look_like(make_set: MakeSet) -> None:
    files = export_labels("coco_keypoints", [make_set(marked())]).files
    assert import_labels(None, files, [make_set()])[0] == "coco_keypoints"
    with pytest.raises(AnnotationError, match=r"coco_keypoints\.json"):
        import_labels("annotations", files, [make_set()])

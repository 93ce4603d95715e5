"""Tables of DeepLabCut: where its marks go, and which tables are refused because they may mean something else."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.tracker.label_formats.conftest import MakeSet, make_sequence
from tracker.capture.annotations import Annotation
from tracker.errors import AnnotationError
from tracker.label_formats.deeplabcut import read_deeplabcut, write_deeplabcut
from tracker.label_formats.image_names import list_image_names
from tracker.label_formats.label_set import ImportedLabels, ImportHints, LabelSet

HEAD = "scorer,,,me,me\nindividuals,,,right,right\nbodyparts,,,wrist,wrist\ncoords,,,x,y\n"
SINGLE = "scorer,me,me\nbodyparts,wrist,wrist\ncoords,x,y\n"
IMAGE = "labeled-data,cam0,000002.png"


def read(
    text: str | bytes, hints: ImportHints | None = None, hands: tuple[str, ...] = ("right", "left")
) -> ImportedLabels:
    sequence = make_sequence(hands=hands)
    labels = LabelSet("key", sequence, list_image_names(sequence))
    data = text if isinstance(text, bytes) else text.encode()
    return read_deeplabcut({"CollectedData_me.csv": data}, [labels], hints or ImportHints())


def only(found: ImportedLabels) -> Annotation:
    (item,) = found.annotations["key"].items
    return item


def test_a_row_marks_the_joints_of_its_image_and_an_empty_cell_marks_nothing() -> None:
    item = only(read(f"{HEAD}{IMAGE},12.5,7\nlabeled-data,cam1,000003.png,,\n"))
    assert (item.frame, item.camera, item.hand) == (2, "cam0", "right")
    assert item.points[0].tolist() == [12.5, 7.0, 2.0] and not item.points[1:].any()


@pytest.mark.parametrize("empty", ["", "nan", "NaN", "NA", "None", " "])
def test_every_way_to_say_nothing_is_nothing(empty: str) -> None:
    assert read(f"{HEAD}{IMAGE},{empty},{empty}\n").annotations["key"].items == ()


def test_pixel_centres_are_whole_numbers_unless_the_hint_says_half() -> None:
    assert only(read(f"{HEAD}{IMAGE},12.5,7.5\n", ImportHints(pixel_centre=0.5))).points[0, :2].tolist() == [12.0, 7.0]


def test_a_table_of_one_animal_is_of_the_hand_that_is_told_or_the_only_one() -> None:
    row = "cam0/000002.png,1,2\n"
    assert only(read(SINGLE + row, ImportHints(hand="left"))).hand == "left"
    alone = read(SINGLE + row, hands=("left",))
    assert only(alone).hand == "left" and any("taken as the left hand" in text for text in alone.warnings)
    with pytest.raises(AnnotationError, match="Say which hand"):
        read(SINGLE + row)


def test_columns_and_images_that_are_not_known_are_left_out_and_said() -> None:
    head = HEAD.replace("right,right", "right,tail").replace("\nscorer", "scorer")
    with pytest.raises(AnnotationError, match="one of x and y"):
        read(f"{head}{IMAGE},1,2\n")
    wide = "".join(f"{line},{more}\n" for line, more in zip(HEAD.split(), ("me", "mouse", "snout", "x"), strict=True))
    found = read(f"{wide}{IMAGE},1,2,3\nlabeled-data,cam0,nowhere.png,1,2,3\n")
    assert only(found).points[0].tolist() == [1.0, 2.0, 2.0]
    assert any("snout of mouse" in text for text in found.warnings)
    assert any("nowhere.png" in text for text in found.warnings)


@pytest.mark.parametrize(
    ("text", "told"),
    [
        ("", "damaged"),
        ("\n", "damaged"),
        ("a,b\n" * 5, "among the first four"),
        ("scorer,a\ncoords,x\n", "needed scorer"),
        ("scorer,a,a\nbodyparts,wrist\ncoords,x,y\n", "of one length"),
        (SINGLE.replace("me,me", "me,you"), "several scorers"),
        (SINGLE.replace("x,y", "x,likelihood"), "predictions of a network"),
        (HEAD.replace("x,y", "x,x"), "two columns are the x of wrist of right"),
        (HEAD.replace("wrist,wrist", "snout,snout"), "no column is a joint"),
        (f"{HEAD}{IMAGE},1\n", "has 4 cells"),
        (f"{HEAD}{IMAGE},1,\n", "wrist has one of x and y"),
        (f"{HEAD}{IMAGE},1,inf\n", "holds 'inf'"),
        (f"{HEAD}{IMAGE},1e999,1\n", "holds '1e999'"),
        (f"{HEAD}{IMAGE},1,-1e300\n", "holds '-1e300'"),
        (f"{HEAD}{IMAGE},1,{'1' * 60}\n", "holds '1111"),
        (f'{HEAD}"{IMAGE},1,2\n', "damaged"),
        (HEAD.encode() + b"\xff\xfe", "damaged"),
    ],
)
def test_a_table_that_may_mean_something_else_is_refused(text: str | bytes, told: str) -> None:
    with pytest.raises(AnnotationError, match=told):
        read(text)


@given(st.lists(st.text(max_size=6), min_size=2, max_size=2))
def test_any_text_in_a_cell_is_a_number_nothing_or_refused(cells: list[str]) -> None:
    quoted = ",".join('"' + cell.replace('"', '""') + '"' for cell in cells)
    try:
        items = read(f"{HEAD}{IMAGE},{quoted}\n".encode("utf-8", "replace")).annotations["key"].items
    except AnnotationError:
        return
    assert all(np.isfinite(item.points).all() for item in items)


def test_two_rows_of_one_image_are_a_problem() -> None:
    assert "two hands of the same side" in read(f"{HEAD}{IMAGE},1,2\n{IMAGE},3,4\n").problems[0]


def test_each_camera_has_a_table_and_what_is_not_labelled_an_empty_cell(make_set: MakeSet) -> None:
    points = np.zeros((21, 3))
    points[3] = [0.1, 200.25, 1]
    written = write_deeplabcut([make_set((Annotation(4, "cam1", "left", points),))])
    assert list(written.files) == ["labeled-data/cam1/CollectedData_handloom.csv"] and written.joints == 1
    *header, row = written.files["labeled-data/cam1/CollectedData_handloom.csv"].decode().splitlines()
    assert [line.split(",")[0] for line in header] == ["scorer", "individuals", "bodyparts", "coords"]
    cells = row.split(",")
    at = 3 + 42 + 2 * 3
    assert cells[at : at + 2] == ["0.1", "200.25"] and not any(cells[3:at] + cells[at + 2 :])
    with pytest.raises(AnnotationError, match="no labels"):
        write_deeplabcut([make_set()])

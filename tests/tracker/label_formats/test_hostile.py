"""Files that want to do harm or are just broken: an error that says what, never anything else."""

from __future__ import annotations

import json
import pickle
import zipfile
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.tracker.label_formats.conftest import MakeSet, make_sequence
from tracker.capture.annotations import Annotation, Annotations
from tracker.errors import AnnotationError, ImportRefusedError
from tracker.label_formats import label_files
from tracker.label_formats.formats import LABEL_FORMATS, export_labels, import_labels, recognise_labels
from tracker.label_formats.image_names import list_image_names
from tracker.label_formats.label_files import read_label_files
from tracker.label_formats.label_set import ImportHints, LabelSet

GOLDEN = Path(__file__).parent / "golden"


def make_hand() -> LabelSet:
    sequence = make_sequence(2)
    marks = np.c_[np.linspace(100, 300, 21), np.linspace(50, 200, 21), np.full(21, 2.0)]
    items = tuple(Annotation(1, camera.id, "right", marks) for camera in sequence.cameras)
    return LabelSet("key", sequence, list_image_names(sequence), Annotations(items))


BAD_VALUES: list[Any] = [
    None,
    True,
    "x",
    -1,
    1e300,
    10**400,
    [],
    {},
    [[[[]]]],
    "\ud800",
    ["nan"] * 63,
]


def replace_somewhere(document: Any, place: int, value: Any) -> Any:
    """The document with one of its values, counted in depth, replaced."""
    count = -1

    def walk(node: Any) -> Any:
        nonlocal count
        count += 1
        if count == place:
            return value
        if isinstance(node, dict):
            return {key: walk(item) for key, item in node.items()}
        return [walk(item) for item in node] if isinstance(node, list) else node

    return walk(document)


@pytest.mark.parametrize("name", ["annotations", "coco_keypoints", "coco_wholebody", "interhand", "freihand"])
@given(place=st.integers(0, 400), value=st.sampled_from(BAD_VALUES), which=st.integers(0, 3))
@settings(max_examples=60, deadline=None)
def test_one_wrong_value_anywhere_in_a_json_is_refused_or_harmless(
    name: str, place: int, value: Any, which: int
) -> None:
    labels = make_hand()
    files = dict(export_labels(name, [labels]).files)
    target = sorted(file for file in files if file.endswith(".json"))
    file = target[which % len(target)]
    files[file] = json.dumps(replace_somewhere(json.loads(files[file]), place, value)).encode()
    try:
        _, back = import_labels(name, files, [labels])
    except AnnotationError:
        return
    for item in back.annotations["key"].items:
        assert item.points.shape == (21, 3) and np.isfinite(item.points).all()
        assert np.isin(item.points[:, 2], (0, 1, 2)).all()


@pytest.mark.parametrize("name", ["deeplabcut", "t16"])
@given(place=st.integers(0, 3000), junk=st.binary(min_size=1, max_size=8))
@settings(max_examples=60, deadline=None)
def test_bytes_changed_anywhere_in_a_text_are_refused_or_harmless(name: str, place: int, junk: bytes) -> None:
    labels = make_hand()
    files = dict(export_labels(name, [labels]).files)
    file = sorted(files)[place % len(files)]
    at = place % len(files[file])
    files[file] = files[file][:at] + junk + files[file][at + 1 :]
    try:
        _, back = import_labels(name, files, [labels])
    except AnnotationError:
        return
    for item in back.annotations["key"].items:
        assert np.isfinite(item.points).all() and np.isin(item.points[:, 2], (0, 1, 2)).all()


@pytest.mark.parametrize(
    "text",
    [
        b"",
        b"[" * 100_000,
        b'{"a":' * 50_000,
        b"\xff\xfe\x00",
        b"null",
        b'{"items": NaN}',
        b"1" * 10_000,
        b'{"images": 7, "annotations": [], "categories": []}',
    ],
)
@pytest.mark.parametrize("name", LABEL_FORMATS)
def test_what_is_no_such_file_is_said_to_be_none(name: str, text: bytes, make_set: MakeSet) -> None:
    files = {
        "annotations": {"annotations.json": text},
        "coco_keypoints": {"a.json": text},
        "coco_wholebody": {"a.json": text},
        "freihand": {"training_xyz.json": text, "training_K.json": text},
        "interhand": {f"x_{what}.json": text for what in ("data", "camera", "joint_3d")},
        "deeplabcut": {"a.csv": text},
        "t16": {"1/joints_2D_GT/000.txt": text + b"\nx", "1/joints.txt": b"0 right/wrist\n"},
    }[name]
    with pytest.raises(AnnotationError):
        import_labels(name, files, [make_set()])


def test_a_table_with_too_much_in_it_is_refused(make_set: MakeSet) -> None:
    wide = b"scorer" + b",a" * 2000 + b"\nbodyparts" + b",wrist" * 2000 + b"\ncoords" + b",x" * 2000 + b"\n"
    with pytest.raises(AnnotationError, match="2001 columns"):
        import_labels("deeplabcut", {"a.csv": wide}, [make_set()])
    long_cell = b"scorer,a,a\nbodyparts,wrist,wrist\ncoords,x,y\n000001.png," + b"9" * 200_000 + b",1\n"
    with pytest.raises(AnnotationError, match="field limit"):
        import_labels("deeplabcut", {"a.csv": long_cell}, [make_set()], ImportHints(hand="left"))


def test_a_zip_that_leads_out_or_swells_is_refused(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    with zipfile.ZipFile(tmp_path / "out.zip", "w") as archive:
        archive.writestr("../evil.json", "{}")
    with pytest.raises(ImportRefusedError):
        read_label_files(tmp_path / "out.zip")
    with zipfile.ZipFile(tmp_path / "bomb.zip", "w", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr("a.json", b"0" * 40_000_000)
    with pytest.raises(ImportRefusedError, match="zip bomb"):
        read_label_files(tmp_path / "bomb.zip")
    (tmp_path / "big.json").write_bytes(b" " * 1000)
    monkeypatch.setattr(label_files, "MAX_BYTES", 999)
    with pytest.raises(AnnotationError, match="at most 999"):
        read_label_files(tmp_path / "big.json")
    assert not (tmp_path.parent / "evil.json").exists()


def test_pickles_and_hdf5_are_refused_unread(tmp_path: Path) -> None:
    class Evil:
        def __reduce__(self) -> tuple[Any, ...]:
            return (tmp_path.joinpath("ran").write_text, ("x",))

    path = tmp_path / "labels.pkl"
    path.write_bytes(pickle.dumps(Evil()))
    with pytest.raises(AnnotationError, match="pickles are programs"):
        read_label_files(path)
    with pytest.raises(AnnotationError, match="pickles are programs"):
        read_label_files(tmp_path)
    assert not (tmp_path / "ran").exists()
    path.rename(tmp_path / "CollectedData_me.h5")
    with pytest.raises(AnnotationError, match=r"\.csv beside it"):
        read_label_files(tmp_path / "CollectedData_me.h5")


def test_a_link_in_a_folder_is_not_followed(tmp_path: Path) -> None:
    (tmp_path / "secret.txt").write_text("secret")
    folder = tmp_path / "labels"
    folder.mkdir()
    (folder / "a.json").write_text("{}")
    (folder / "b.json").symlink_to(tmp_path / "secret.txt")
    assert read_label_files(folder) == {"a.json": b"{}"}


def test_files_of_no_known_format_are_told_the_formats() -> None:
    with pytest.raises(AnnotationError, match="say the format: annotations, coco_keypoints"):
        recognise_labels({"a.json": b"{}"})


def test_an_unsided_hand_is_refused_unless_told(make_set: MakeSet) -> None:
    document = json.loads((GOLDEN / "coco_keypoints.json").read_text())
    document["categories"][0]["name"] = "hand"
    with pytest.raises(AnnotationError, match="does not say whether it is the right or the left hand"):
        import_labels(None, {"a.json": json.dumps(document).encode()}, [make_set()])


def test_images_of_another_size_are_a_problem(make_set: MakeSet) -> None:
    document = json.loads((GOLDEN / "coco_keypoints.json").read_text())
    document["images"][0] |= {"width": 320, "height": 240}
    _, back = import_labels(None, {"a.json": json.dumps(document).encode()}, [make_set()])
    assert "scaled images cannot be matched" in back.problems[0]

"""Whatever is done to its bytes, a recording comes in whole or is refused in words."""

from __future__ import annotations

import contextlib
import copy
import json
import os
import shutil
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from tracker.capture import ImportOptions, check_import, load_annotations, load_sequence, run_import
from tracker.capture.anipose_calibration import parse_anipose
from tracker.capture.dat_calibration import parse_dat
from tracker.capture.opencv_calibration import find_cameras, parse_opencv
from tracker.errors import ImportRefusedError, TrackerError

MANY = settings(max_examples=150, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])

JSON_VALUES = st.recursive(
    st.none()
    | st.booleans()
    | st.integers(-(10**30), 10**30)
    | st.floats(allow_nan=True)
    | st.text(max_size=30)
    | st.sampled_from(["../x/{:06d}.png", "/{:06d}.png", "{:d}.png", "{0.a}", "right", "a\0b", "\ud800", "é/{:d}.png"]),
    lambda inner: st.lists(inner, max_size=5) | st.dictionaries(st.text(max_size=8), inner, max_size=4),
    max_leaves=8,
)


def list_places(value: Any, place: tuple[Any, ...] = ()) -> list[tuple[Any, ...]]:
    """Every place in a JSON document, as the keys that lead there."""
    keys = list(value) if isinstance(value, dict) else range(len(value)) if isinstance(value, list) else []
    return [place, *(p for key in keys for p in list_places(value[key], (*place, key)))]


def come_in_or_be_refused(source: Path, options: ImportOptions | None = None) -> None:
    """The check never raises; the run either leaves a recording whose every frame can be read, or nothing at all."""
    report = check_import(source, options=options)
    json.dumps(report.to_json(), allow_nan=False)
    store = source.parent / "store"
    shutil.rmtree(store, ignore_errors=True)
    store.mkdir()
    try:
        run_import(source, store / "r", options=options)
    except ImportRefusedError:
        assert os.listdir(store) == []
        return
    assert report.ok
    sequence = load_sequence(store / "r")
    assert sequence.frame_count == report.frame_count
    for camera in sequence.cameras:
        for index in range(sequence.frame_count):
            sequence.frame(index, camera.id)


@pytest.fixture
def small(make_recording, tmp_path_factory) -> Path:
    return make_recording(tmp_path_factory.mktemp("source") / "plate", 2)


@MANY
@given(data=st.data())
def test_any_change_of_a_value_in_sequence_json(small: Path, data: st.DataObject) -> None:
    original = (small / "sequence.json").read_text()
    document = json.loads(original)
    try:
        for _ in range(data.draw(st.integers(1, 3))):
            *parents, last = data.draw(st.sampled_from(list_places(document)[1:]))
            node = document
            for key in parents:
                node = node[key]
            if isinstance(node, dict) and data.draw(st.booleans()):
                del node[last]
            else:
                node[last] = copy.deepcopy(data.draw(JSON_VALUES))
            if not isinstance(document, dict) or not document:
                break
        (small / "sequence.json").write_text(json.dumps(document))
        come_in_or_be_refused(small)
    finally:
        (small / "sequence.json").write_text(original)


def damage(data: bytes, draw: st.DataObject) -> bytes:
    """Some bytes changed, taken out or put in, perhaps cut off."""
    result = bytearray(data)
    for _ in range(draw.draw(st.integers(1, 4))):
        place = draw.draw(st.integers(0, max(0, len(result) - 1)))
        kind = draw.draw(st.sampled_from(["change", "remove", "insert", "cut"]))
        if kind == "insert":
            result[place:place] = draw.draw(st.binary(max_size=12))
        elif kind == "remove":
            del result[place : place + draw.draw(st.integers(1, 40))]
        elif kind == "cut" and draw.draw(st.booleans()):
            del result[place:]
        elif result:
            result[place] = draw.draw(st.integers(0, 255))
    return bytes(result)


@MANY
@given(data=st.data(), name=st.sampled_from(["sequence.json", "color/000001.png", "depth/000000.png"]))
def test_any_damage_to_the_bytes_of_a_file(small: Path, data: st.DataObject, name: str) -> None:
    original = (small / name).read_bytes()
    try:
        (small / name).write_bytes(damage(original, data))
        come_in_or_be_refused(small)
        with contextlib.suppress(TrackerError):
            load_sequence(small).frame(0, "cam0")
    finally:
        (small / name).write_bytes(original)


@MANY
@given(data=st.data(), name=st.sampled_from(["rgb.txt", "depth.txt"]))
def test_any_damage_to_the_lists_of_a_tum_folder(small: Path, data: st.DataObject, name: str) -> None:
    (small / "sequence.json").unlink(missing_ok=True)
    for kind, file in (("color", "rgb.txt"), ("depth", "depth.txt")):
        (small / file).write_text(f"# time file\n0.0 {kind}/000000.png\n0.033 {kind}/000001.png\n")
    (small / name).write_bytes(damage((small / name).read_bytes(), data))
    come_in_or_be_refused(small, ImportOptions(fx=60, cx=31.5, cy=23.5))


@MANY
@given(data=st.data(), document=JSON_VALUES)
def test_any_options(small: Path, data: st.DataObject, document: Any) -> None:
    names = [*ImportOptions.__dataclass_fields__]
    values = {data.draw(st.sampled_from(names)): document, data.draw(st.sampled_from(names)): data.draw(JSON_VALUES)}
    (small / "sequence.json").unlink(missing_ok=True)
    base = {"fx": 60, "cx": 31.5, "cy": 23.5, "depth_scale": 0.001}
    try:
        options = ImportOptions.from_json(base | values)
    except ImportRefusedError:
        return
    come_in_or_be_refused(small, options)


@MANY
@given(data=st.data())
def test_any_damage_to_a_calibration(data: st.DataObject) -> None:
    toml = b'[cam_0]\nname = "a"\nsize = [64, 48]\nmatrix = [[60.0, 0, 31], [0, 60, 23], [0, 0, 1]]\n'
    toml += b"distortions = [0, 0, 0, 0, 0]\nrotation = [0, 0.1, 0]\ntranslation = [1, 2, 3]\n"
    yaml = b"%YAML:1.0\n---\nK1: !!opencv-matrix\n   rows: 3\n   cols: 3\n   dt: d\n   data: [ 60., 0., 31., 0., 60.,\n"
    yaml += b"       23., 0., 0., 1. ]\nK2: [[60, 0, 31], [0, 60, 23], [0, 0, 1]]\nR: [0, 0.1, 0]\nT: [1, 2, 3]\n"
    table = json.dumps({"cameras": {"a": {"K": np.eye(3).tolist(), "rvec": [0, 1, 0], "tvec": [1, 2, 3]}}}).encode()
    dat = b"intrinsic:\n60 0 31\n0 60 23\n0 0 1\ndistortion:\n0 0 0 0 0\n"
    assert len(parse_anipose(toml, "x.toml")) == 1 and len(find_cameras(parse_opencv(yaml, "x.yml"), "x.yml", "x")) == 2
    for parse in (
        lambda: parse_anipose(damage(toml, data), "x.toml"),
        lambda: find_cameras(parse_opencv(damage(yaml, data), "x.yml"), "x.yml", "x"),
        lambda: find_cameras(parse_opencv(damage(table, data), "x.json"), "x.json", "x"),
        lambda: [parse_dat(damage(dat, data), damage(b"R:\n1 0 0\n0 1 0\n0 0 1\nT:\n1\n2\n3\n", data), "c0", "c0.dat")],
    ):
        try:
            cameras = parse()
        except TrackerError:
            continue
        for camera in cameras:
            assert np.isfinite(camera.find_pose(0.001)).all() and camera.K.shape == (3, 3)


@MANY
@given(
    document=st.fixed_dictionaries({"version": st.just(1) | JSON_VALUES, "joints": JSON_VALUES, "items": JSON_VALUES})
)
def test_any_annotation_file(tmp_path_factory, document: Any) -> None:
    path = tmp_path_factory.mktemp("a") / "annotations.json"
    path.write_text(json.dumps(document))
    with pytest.raises(TrackerError):
        load_annotations(path)

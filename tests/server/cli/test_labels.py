"""`handloom export` and `handloom import` with labels, in one process: as people type them, with the exit codes."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from server.cli import main
from server.cli.export_command import LABELS
from tests.server.conftest import MakeRecording
from tracker import HAND_JOINTS, Annotation, load_annotations
from tracker.capture.annotations import save_annotations
from tracker.label_formats import LABEL_FORMATS


@pytest.fixture
def studio_folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.setenv("HANDLOOM_DATA_DIR", str(tmp_path / "studio"))
    return tmp_path


def make_labels(path: Path, shift: float = 0.0) -> Path:
    points = np.array([[5 + shift + j, 3 + 0.5 * j, 2] for j in range(len(HAND_JOINTS))], dtype=np.float64)
    save_annotations(path, [Annotation(frame, "cam0", "right", points) for frame in (0, 2)])
    return path


def run(capsys: pytest.CaptureFixture[str], *arguments: Any) -> tuple[int, str, str]:
    code = main(list(map(str, arguments)))
    out, err = capsys.readouterr()
    return code, out, err


def test_the_command_line_offers_every_format_of_labels() -> None:
    assert list(LABEL_FORMATS) == list(LABELS)


def test_labels_go_in_out_and_in_again(
    studio_folder: Path, make_recording: MakeRecording, capsys: pytest.CaptureFixture[str]
) -> None:
    assert run(capsys, "import", make_recording("one"), "--json")[0] == 0
    assert run(capsys, "import", make_recording("two"), "--json")[0] == 0
    labels = make_labels(studio_folder / "labels.json")
    code, out, _ = run(capsys, "import", labels, "--into", "one", "--json")
    assert (code, json.loads(out)["recordings"][0]["added"]) == (0, 2)

    for name in ("coco_keypoints", "coco_wholebody", "deeplabcut", "t16"):
        out_path = studio_folder / f"{name}-export"
        code, out, _ = run(capsys, "export", "one", "--format", name, "--out", out_path, "--json")
        assert (code, json.loads(out)["items"]) == (0, 2), name
        assert out_path.is_file() if name.startswith("coco") else True
    packed = studio_folder / "labels.zip"
    assert run(capsys, "export", "one", "--format", "t16", "--out", packed)[0] == 0
    code, _, err = run(capsys, "import", packed, "--into", "two")
    assert code == 0 and "does not say what is occluded" in err
    back = studio_folder / "back.json"
    assert run(capsys, "export", "two", "--format", "annotations", "--out", back)[0] == 0
    assert [item.frame for item in load_annotations(back).items] == [0, 2]

    both = studio_folder / "both.json"
    assert run(capsys, "export", "one", "two", "--format", "coco_keypoints", "--out", both)[0] == 0
    assert len(json.loads(both.read_text())["annotations"]) == 4
    code, _, err = run(capsys, "import", both, "--into", "one", "two")
    assert code == 0, err


def test_labels_that_are_there_are_not_overwritten_unless_told(
    studio_folder: Path, make_recording: MakeRecording, capsys: pytest.CaptureFixture[str]
) -> None:
    run(capsys, "import", make_recording("one"))
    run(capsys, "import", make_labels(studio_folder / "a.json"), "--into", "one")
    other = make_labels(studio_folder / "b.json", shift=1.0)
    code, out, err = run(capsys, "import", other, "--into", "one")
    assert (code, out) == (2, "") and "2 hands are labelled otherwise already" in err
    code, out, _ = run(capsys, "import", other, "--into", "one", "--policy", "keep", "--json")
    assert (code, json.loads(out)["recordings"][0]["kept"]) == (0, 2)
    code, out, _ = run(capsys, "import", other, "--into", "one", "--policy", "replace", "--json")
    done = json.loads(out)["recordings"][0]
    assert (code, done["replaced"], done["before"]) == (0, 2, 2)
    old = studio_folder / "old.json"
    assert run(capsys, "export", "one", "--format", "annotations", "--snapshot", 2, "--out", old)[0] == 0
    assert load_annotations(old).items[0].points[0, 0] == 5.0


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["import", "bad.json", "--into", "one"], "not recognised"),
        (["import", "bad.json", "--into", "one", "--format", "coco_keypoints"], "has no 'categories'"),
        (["import", "bad.json", "--format", "t16"], "--into NAME"),
        (["import", "bad.json", "--into", "nobody"], "There is no recording 'nobody'"),
        (["import", "bad.pkl", "--into", "one"], "pickles are programs"),
        (["export", "one", "--format", "freihand", "--out", "x.zip"], "3D joints only"),
        (
            ["export", "one", "--format", "annotations", "--snapshot", "7", "--out", "x.json"],
            "no snapshot of version 7",
        ),
        (["export", "one", "one", "--format", "coco_keypoints", "--out", "x.json"], "named twice"),
        (["export", "one", "--format", "recording", "--snapshot", "1", "--out", "x"], "are for labels"),
    ],
)
def test_bad_input_is_said_with_exit_code_2_and_leaves_nothing(
    studio_folder: Path,
    make_recording: MakeRecording,
    capsys: pytest.CaptureFixture[str],
    monkeypatch: pytest.MonkeyPatch,
    arguments: list[str],
    message: str,
) -> None:
    monkeypatch.chdir(studio_folder)
    Path("bad.json").write_text("{}")
    Path("bad.pkl").write_bytes(b"cos\n.")
    run(capsys, "import", make_recording("one"))
    code, out, err = run(capsys, *arguments)
    assert (code, out) == (2, "") and message in err, err
    assert not any(path.name.startswith(("x", ".")) for path in studio_folder.iterdir())

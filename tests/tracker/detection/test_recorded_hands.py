"""The hands of a recording: where they are, which they are, and their file."""

from __future__ import annotations

import json
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from tracker.capture.annotations import load_annotations
from tracker.capture.sequence import Sequence as Recording
from tracker.capture.sequence import load_sequence
from tracker.cli.__main__ import main
from tracker.detection.image_hands import SOURCE, name_hands
from tracker.detection.recorded_hands import choose_views, detect_hands, join_recorded_hands, load_recorded_hands
from tracker.errors import AnnotationError, SequenceError
from tracker.landmarks import DetectedHand, HandDetector

FRAMES = range(14)


@pytest.fixture(scope="module")
def recording(tmp_path_factory: pytest.TempPathFactory) -> Recording:
    out = tmp_path_factory.mktemp("recordings") / "open"
    assert main(["synthesize", "--motion", "open-close", "--frames", f"0:{len(FRAMES)}", "--out", str(out)]) == 0
    return load_sequence(out)


@pytest.fixture(scope="module")
def detector() -> HandDetector:
    return HandDetector()


def test_every_joint_of_an_open_hand_is_near_its_place_in_every_frame(
    recording: Recording, detector: HandDetector
) -> None:
    found, _ = detect_hands(recording, detector, ("cam0",), FRAMES, {})
    path = recording.annotations_path
    assert path is not None
    truth = load_annotations(path)
    assert [item.key for item in found.hands.items] == [(frame, "cam0", "right") for frame in FRAMES]
    for item in found.hands.items:
        marked = truth.find(*item.key)
        assert marked is not None
        assert np.linalg.norm(item.points[:, :2] - marked.points[:, :2], axis=1).mean() < 8.0
        assert set(item.sources or ()) == {SOURCE}
        assert found.scores[item.key] > 0.8
    assert found.count_frames() == {"right": len(FRAMES), "left": 0}


def test_a_recording_cut_into_parts_gives_the_same_hands(
    recording: Recording, detector: HandDetector, tmp_path: Path
) -> None:
    whole, _ = detect_hands(recording, detector, ("cam0",), FRAMES, {})
    first, before = detect_hands(recording, detector, ("cam0",), range(5), {})
    rest, _ = detect_hands(recording, detector, ("cam0",), range(5, len(FRAMES)), before)
    whole.save(tmp_path / "whole.json")
    join_recorded_hands([first, rest]).save(tmp_path / "parts.json")
    assert (tmp_path / "whole.json").read_bytes() == (tmp_path / "parts.json").read_bytes()


def test_the_file_comes_back_and_is_an_annotation_file_too(
    recording: Recording, detector: HandDetector, tmp_path: Path
) -> None:
    found, _ = detect_hands(recording, detector, ("cam0",), range(3, 6), {})
    found.save(tmp_path / "hands.json")
    back = load_recorded_hands(tmp_path / "hands.json")
    assert (back.cameras, back.frames, back.scores) == (found.cameras, found.frames, found.scores)
    assert back.hands.to_json() == found.hands.to_json() == load_annotations(tmp_path / "hands.json").to_json()
    assert back.covers(5, "cam0") and not back.covers(6, "cam0") and not back.covers(5, "cam1")
    assert [item.key for item in back.at(4, "cam0")] == [(4, "cam0", "right")]


@pytest.mark.parametrize(
    ("change", "said"),
    [
        ({"looked_at": {"cameras": ["cam0"], "frames": [3]}}, "last frame"),
        ({"looked_at": {"cameras": ["cam0"], "frames": [0, 10**12]}}, "whole number"),
        ({"looked_at": None}, "needed an object"),
        ({"items": [{}]}, "has no 'points'"),
    ],
)
def test_a_file_that_somebody_changed_is_refused_with_what_is_needed(
    recording: Recording, detector: HandDetector, tmp_path: Path, change: dict, said: str
) -> None:
    found, _ = detect_hands(recording, detector, ("cam0",), range(3), {})
    found.save(tmp_path / "hands.json")
    document = json.loads((tmp_path / "hands.json").read_text()) | change
    (tmp_path / "hands.json").write_text(json.dumps(document))
    with pytest.raises(AnnotationError, match=said):
        load_recorded_hands(tmp_path / "hands.json")


def test_views_without_colour_are_left_out_and_refused_when_asked_for(recording: Recording) -> None:
    blind = replace(recording.cameras[0], id="infra", color=None)
    both = replace(recording, cameras=(*recording.cameras, blind))
    assert choose_views(both) == ("cam0",)
    with pytest.raises(SequenceError, match="infra has only depth"):
        choose_views(both, ["infra"])
    with pytest.raises(SequenceError, match="only depth images"):
        choose_views(replace(recording, cameras=(blind,)))
    with pytest.raises(SequenceError, match="no camera 'cam7'"):
        choose_views(recording, ["cam7"])


@pytest.mark.parametrize(
    ("rights", "names", "expected"),
    [
        ((0.2,), ("right",), {"right": 0}),  # the only hand of a recording has its name
        ((0.2,), ("right", "left"), {"left": 0}),
        ((0.9, 0.1), ("right", "left"), {"right": 0, "left": 1}),
        ((0.1, 0.9), ("right", "left"), {"left": 0, "right": 1}),
        ((0.9, 0.6), ("right", "left"), {"right": 0, "left": 1}),  # two right hands there are not
        ((), ("right", "left"), {}),
    ],
)
def test_hands_have_the_names_that_are_likeliest_together(
    rights: Sequence[float], names: tuple[str, ...], expected: dict[str, int]
) -> None:
    hands = [DetectedHand(np.zeros((21, 2)), np.zeros((21, 3)), 1.0, right) for right in rights]
    assert name_hands(hands, names) == {name: hands[place] for name, place in expected.items()}

"""A sequence goes on where it was stopped, keeps what is known, and says what it could not read.

Frames that are there already are not registered again, so that most of these need no registration at all.
"""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from tests.tracker.bodies.posed_bodies import A_POSE, MODEL, registration_of, stand
from tracker.bodies.body_registration import save_body_registration
from tracker.bodies.body_sequence import TEMPLATES, Sequence, SequenceOptions, register_sequence
from tracker.bodies.follow_body import FollowOptions
from tracker.errors import TrackerError

FRAMES = 5


def standing_at(frame: int):
    """Somebody who walks 10 cm a frame."""
    return stand(A_POSE, place=(0.1 * frame, 0.0, 0.0))


def begin(folder: Path, known: tuple[int, ...], verdict: str = "good", **options) -> Sequence:
    """A sequence of scans that cannot be read, whose `known` frames and template are registered."""
    sequence = Sequence(
        tuple(folder / f"{frame:06d}.ply" for frame in range(FRAMES)),
        folder / "out",
        SequenceOptions(template_frames=1, **options),
    )
    folder.mkdir(exist_ok=True)
    for path in sequence.paths:
        path.write_bytes(b"no scan")
    save_body_registration(registration_of(standing_at(0), verdict), MODEL.faces, sequence.out / TEMPLATES / "000000")
    for frame in known:
        save_body_registration(
            registration_of(standing_at(frame), seconds={"body": 1.0 + frame}), MODEL.faces, sequence.folder(frame)
        )
    return sequence


def test_a_whole_sequence_is_only_summed_up(tmp_path) -> None:
    sequence = begin(tmp_path, tuple(range(FRAMES)))
    told: list[float] = []
    summary = register_sequence(sequence, MODEL, progress=lambda share, detail: told.append(share))
    assert summary == json.loads((sequence.out / "summary.json").read_text())
    assert (summary["frames"], summary["registered"], summary["errors"]) == (FRAMES, FRAMES, [])
    assert summary["verdicts"] == {"good": FRAMES, "doubtful": 0, "bad": 0}
    assert summary["median_seconds"] == 3.0, "1, 2, 3, 4 and 5 s"
    assert told == sorted(told) and told[-1] == 1.0
    with np.load(sequence.out / "motion.npz") as motion:
        assert np.allclose(motion["trans"], [standing_at(frame).translation for frame in range(FRAMES)])
        assert float(motion["mocap_framerate"]) == 60.0


def test_frames_that_cannot_be_read_are_named_and_keep_the_pose_of_the_one_before(tmp_path) -> None:
    sequence = begin(tmp_path, (1, 3))
    summary = register_sequence(sequence, MODEL)
    assert summary["registered"] == 2 and len(summary["errors"]) == 3
    assert all(f"{frame:06d}.ply" in said for frame, said in zip((0, 2, 4), summary["errors"], strict=True))
    with np.load(sequence.out / "motion.npz") as motion:
        known = [standing_at(frame).translation for frame in (1, 1, 1, 3, 3)]
        assert np.allclose(motion["trans"], known), "before the first that is known it is that one"


def test_hands_that_no_scan_shows_are_listed_by_frame(tmp_path) -> None:
    sequence = begin(tmp_path, tuple(range(FRAMES)))
    one = registration_of(standing_at(2), shown=(True, False))
    save_body_registration(one, MODEL.faces, sequence.folder(2))
    assert register_sequence(sequence, MODEL)["guessed"] == {"left": [], "right": [2]}


def test_a_damaged_frame_counts_as_not_registered(tmp_path) -> None:
    sequence = begin(tmp_path, tuple(range(FRAMES)))
    (sequence.folder(2) / "body.npz").write_bytes(b"half a file")
    assert register_sequence(sequence, MODEL)["registered"] == FRAMES - 1


def test_a_folder_begun_otherwise_is_refused_and_the_template_in_it_is_made_once(tmp_path) -> None:
    sequence = begin(tmp_path, tuple(range(FRAMES)))
    register_sequence(sequence, MODEL)
    before = {name: (sequence.out / name).read_bytes() for name in ("summary.json", "template.npz", "settings.json")}
    for other in ({"fps": 30.0}, {"chunk": 2}, {"metres_per_unit": 0.001}, {"follow": FollowOptions(prior="none")}):
        with pytest.raises(TrackerError, match="other scans or options; choose another folder"):
            register_sequence(replace(sequence, options=replace(sequence.options, **other)), MODEL)
    with pytest.raises(TrackerError, match="other scans or options"):
        register_sequence(replace(sequence, paths=sequence.paths[1:]), MODEL)
    register_sequence(sequence, MODEL)
    assert before == {name: (sequence.out / name).read_bytes() for name in before}


def test_without_one_whole_person_nothing_is_registered_and_the_reason_is_said(tmp_path) -> None:
    with pytest.raises(TrackerError, match="shows one whole person: the scan shows only part of a person"):
        register_sequence(begin(tmp_path, (), "bad"), MODEL)
    with pytest.raises(TrackerError, match="None of 5 scans could be registered"):
        register_sequence(begin(tmp_path / "other", ()), MODEL)


def test_work_that_is_ended_by_whoever_listens_goes_on_behind_the_last_frame(tmp_path) -> None:
    sequence = begin(tmp_path, tuple(range(FRAMES)))

    class StoppedError(Exception):
        pass

    def stop_at_two(share: float, detail: str) -> None:
        if detail == "frame 2":
            raise StoppedError

    with pytest.raises(StoppedError):
        register_sequence(sequence, MODEL, progress=stop_at_two)
    assert not (sequence.out / "summary.json").exists()
    assert register_sequence(sequence, MODEL)["registered"] == FRAMES

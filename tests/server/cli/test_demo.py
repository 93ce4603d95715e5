"""`handloom demo`: its samples can be asked of the tracker, are made once, and not before the port is free."""

from __future__ import annotations

import json
import socket
from argparse import ArgumentParser

import pytest

from server.cli.demo import CAMERAS_SAMPLE, MARKER, SAMPLE, SCANS, make_sample
from server.cli.main import main
from server.cli.open_studio import OpenStudio
from tracker import add_commands
from tracker.cli.synthesize_scans import parse_poses, parse_subjects
from tracker.synthesis.motion import MOTIONS


def test_the_samples_are_motions_that_the_tracker_renders() -> None:
    assert {SAMPLE.motion, CAMERAS_SAMPLE.motion} <= MOTIONS.keys() and SAMPLE.name != CAMERAS_SAMPLE.name


def test_the_scans_are_eight_poses_of_four_people() -> None:
    parser = ArgumentParser()
    add_commands(parser.add_subparsers(required=True))
    args = parser.parse_args(["synthesize-scans", *SCANS, "--out", "x"])
    assert len(parse_subjects(args.subjects)) == 4 and args.sides == "right"
    assert len(parse_poses(args.poses, has_motions=False)) == 8


def test_samples_that_were_made_are_not_made_again(own_studio: OpenStudio) -> None:
    marker = own_studio.storage.root / MARKER
    marker.write_text(json.dumps({"sequence_id": "a", "job_id": "b"}))
    make_sample(own_studio)
    assert [path.name for path in own_studio.storage.root.iterdir()] == [MARKER]


def test_a_taken_port_is_said_before_anything_is_rendered(
    own_studio: OpenStudio, capsys: pytest.CaptureFixture[str]
) -> None:
    with socket.socket() as other:
        other.bind(("127.0.0.1", 0))
        other.listen()
        assert main(["demo", "--port", str(other.getsockname()[1])]) == 1
    failed = capsys.readouterr().err
    assert "is taken by another program" in failed and "rendering" not in failed
    assert list(own_studio.storage.root.iterdir()) == []

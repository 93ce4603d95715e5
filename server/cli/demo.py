"""`handloom demo`: the studio with a sample project, which Handloom renders, annotates and tracks itself."""

from __future__ import annotations

import argparse
import contextlib
import json
import os
import sys
import tempfile
import uuid
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from server.cli.guarded import CommandError, load_settings, run_guarded
from server.cli.import_command import import_recording
from server.cli.open_studio import OpenStudio, open_studio
from server.cli.serve import add_serve_arguments, listen, serve

if TYPE_CHECKING:
    from server.sequences.models import SequenceRow

ANNOTATED_EVERY = 15
"""Frames between annotations that are kept; the others are for people to make."""


@dataclass(frozen=True)
class Sample:
    """A recording that the demo renders."""

    name: str
    motion: str
    frames: int
    cameras: int = 1


SAMPLE = Sample("Sample: open and close", "open-close", 60)
SCAN_POSES = "flat_together,flat_spread,index_bent,half_curl,prismatic_3_finger,tripod,quadpod,point"
SCANS = ("--subjects", "1,2,3,4", "--poses", SCAN_POSES, "--sides", "right", "--points", "6000", "--forearm", "no")
"""Eight of each of four people: enough to train a model from three of them and to judge it on the fourth."""

SCANS_NAME = "Sample scans"
CAMERAS_SAMPLE = Sample("Sample: a pinch in three cameras", "pinch", 20, 3)

MARKER = "demo.json"


def add_command(subparsers: argparse._SubParsersAction) -> None:
    parser = subparsers.add_parser(
        "demo",
        help="run the studio with a sample project",
        description="Run the studio with samples: a rendered recording, annotated here and there, with its track, "
        "a recording of three cameras, and scans of four people, enough to train a hand model from. "
        "They are made once; your changes are kept.",
    )
    add_serve_arguments(parser)
    parser.set_defaults(run=run_guarded(run))


def run(args: argparse.Namespace) -> int:
    settings = load_settings(host=args.host, port=args.port)
    if settings.is_loopback:
        with listen(settings):
            pass  # a port that is taken is better known before the sample is rendered
        with open_studio(settings) as studio:
            make_sample(studio)
    serve(settings, with_worker=not args.no_worker)
    return 0


def make_sample(studio: OpenStudio) -> None:
    """Import the samples, and queue jobs that track the first and register the scans, unless that was done before."""
    from server.access.models import LOCAL_ACCOUNT_ID
    from server.jobs.create_jobs import make_register_job
    from server.jobs.register_schemas import RegisterCreate
    from server.jobs.service import check_track_params, create_job

    marker = studio.storage.root / MARKER
    if marker.exists():
        return
    row = _import_sample(studio, SAMPLE)
    _import_sample(studio, CAMERAS_SAMPLE)
    _import_scans(studio)
    with studio.database.writing() as session:
        job = create_job(session, "track", row.id, check_track_params(session, row.id, {}))
        make_register_job(session, studio.storage, RegisterCreate(collection=SCANS_NAME), LOCAL_ACCOUNT_ID)
    unfinished = marker.with_name(f".{uuid.uuid4().hex}.json")
    unfinished.write_text(json.dumps({"sequence_id": str(row.id), "job_id": str(job.id)}))
    os.replace(unfinished, marker)


def _import_sample(studio: OpenStudio, sample: Sample) -> SequenceRow:
    sys.stderr.write(f"handloom: rendering {sample.name!r}, {sample.frames} frames ...\n")
    with tempfile.TemporaryDirectory(prefix="handloom-demo-") as folder:
        recording = Path(folder) / "recording"
        _render(sample, recording)
        _thin_annotations(recording / "annotations.json")
        return import_recording(studio, recording, {"name": sample.name})


def _import_scans(studio: OpenStudio) -> None:
    from server.access.models import LOCAL_ACCOUNT_ID
    from server.scans.adding import ScanOptions, add_scans

    sys.stderr.write("handloom: making sample scans ...\n")
    with tempfile.TemporaryDirectory(prefix="handloom-demo-") as folder:
        made = Path(folder) / "scans"
        _run_tracker("synthesize-scans", *SCANS, "--out", str(made))
        options = ScanOptions(collection=SCANS_NAME, metres_per_unit=1.0)  # Handloom made them, so nothing is guessed
        add_scans(studio.database, studio.storage, made, options, LOCAL_ACCOUNT_ID, moves=False)


def _render(sample: Sample, folder: Path) -> None:
    what = ["--motion", sample.motion, "--frames", f"0:{sample.frames}", "--cameras", str(sample.cameras)]
    _run_tracker("synthesize", *what, "--out", str(folder))


def _run_tracker(*command: str) -> None:
    """One of the tracker's own commands; what it says goes to stderr."""
    from tracker import add_commands

    parser = argparse.ArgumentParser()
    add_commands(parser.add_subparsers(required=True))
    args = parser.parse_args(command)
    with contextlib.redirect_stdout(sys.stderr):
        code = args.run(args)
    if code != 0:
        raise CommandError(f"The samples could not be made: {command[0]} ended with code {code}.", code)


def _thin_annotations(path: Path) -> None:
    document = json.loads(path.read_text())
    document["items"] = [item for item in document["items"] if item["frame"] % ANNOTATED_EVERY == 0]
    path.write_text(json.dumps(document))

"""`handloom export` writes what was asked for whole, or says why not and leaves nothing."""

from __future__ import annotations

import argparse
import json
import uuid
from collections.abc import Callable
from pathlib import Path

import pytest

from server.access.models import LOCAL_ACCOUNT_ID
from server.cli.export_command import FORMATS, add_command, find_recording
from server.cli.guarded import CommandError
from server.cli.main import main
from server.cli.open_studio import OpenStudio
from server.database import utc_now
from server.imports.service import ImportContext, import_recording
from server.sequences.models import SequenceRow
from tests.server.conftest import MakeRecording
from tests.server.exchange.labels import make_points
from tests.server.rows import keep, make_annotation, make_track
from tests.server.rows import make_recording as make_row
from tracker import load_annotations, load_sequence

Run = Callable[..., tuple[int, str, str]]


@pytest.fixture
def run(own_studio: OpenStudio, capsys: pytest.CaptureFixture[str]) -> Run:
    """Runs the command; its exit code, answer and complaint."""

    def run_command(*arguments: object) -> tuple[int, str, str]:
        return (main(["export", *map(str, arguments)]), *capsys.readouterr())

    return run_command


@pytest.fixture
def recording(own_studio: OpenStudio, make_recording: MakeRecording) -> uuid.UUID:
    """A recording of three frames that is called `wave` by now, with a label in frame 1."""
    context = ImportContext(own_studio.database, own_studio.storage, own_studio.settings)
    id_ = import_recording(context, make_recording("waving"), {}, LOCAL_ACCOUNT_ID)
    with own_studio.database.writing() as session:
        row = session.get_one(SequenceRow, id_)
        row.name, row.hands = "wave", ["left"]
    keep(own_studio.database, make_annotation(row, 1, make_points()))
    return id_


def test_a_recording_goes_out_as_people_call_it_with_its_labels(run: Run, recording: uuid.UUID, tmp_path: Path) -> None:
    out = tmp_path / "out"
    code, told, _ = run(recording, "--format", "recording", "--out", out, "--json")
    assert code == 0
    assert json.loads(told) == {"out": str(out), "format": "recording", "frames": 3}
    sequence = load_sequence(out)
    assert (sequence.name, sequence.hands, sequence.frame_count) == ("wave", ("left",), 3)
    assert sequence.annotations_path is not None
    [item] = load_annotations(sequence.annotations_path).items
    assert item.key == (1, "cam0", "right") and item.points.tolist() == make_points()
    assert sorted(path.name for path in (out / "depth").iterdir()) == [f"{n:06d}.png" for n in range(3)]


def test_a_track_goes_out_without_what_can_be_made_again(
    run: Run, own_studio: OpenStudio, recording: uuid.UUID, tmp_path: Path
) -> None:
    with own_studio.database.reading() as session:
        row = session.get_one(SequenceRow, recording)
    old, new = make_track(row, created_at=utc_now()), make_track(row, "Track 2", frame_count=3)
    gone = make_track(row, "Track 3", deleted_at=utc_now())
    keep(own_studio.database, old, new, gone)
    for track in (old, new):
        folder = own_studio.storage.folder("tracks", track.id)
        for name in ("track.npz", "overlays/0.png", "exports/a.glb"):
            (folder / name).parent.mkdir(parents=True, exist_ok=True)
            (folder / name).write_text(track.name)
    code, told, _ = run("wave", "--format", "track", "--out", tmp_path / "out", "--json")
    assert code == 0 and json.loads(told)["track"] == str(new.id) and json.loads(told)["frames"] == 3
    assert [path.name for path in (tmp_path / "out").iterdir()] == ["track.npz"]
    assert run(old.id, "--format", "track", "--out", tmp_path / "old")[0] == 0
    assert (tmp_path / "old" / "track.npz").read_text() == "Track 1"
    code, _, failed = run(gone.id, "--format", "track", "--out", tmp_path / "gone")
    assert code == 2 and f"There is no recording '{gone.id}'" in failed


def test_labels_go_out_once_and_never_over_something_else(run: Run, recording: uuid.UUID, tmp_path: Path) -> None:
    out = tmp_path / "labels.json"
    code, told, _ = run("wave", "--format", "annotations", "--out", out)
    assert (code, told) == (0, f"annotations of wave: {out}\n") and len(load_annotations(out).items) == 1
    was = out.read_bytes()
    code, told, failed = run("wave", "--format", "annotations", "--out", out)
    assert (code, told) == (2, "") and "is there already; give a name that does not exist yet" in failed
    assert out.read_bytes() == was


REFUSED = (
    (("--format", "track"), "The recording 'wave' has no track yet; start a tracking job first."),
    (("--format", "npz", "--snapshot", "1"), "--snapshot, --sources and --track are for labels (annotations, coco"),
    (("--format", "recording", "--sources", "hand"), "not for recording."),
    (("other", "--format", "recording"), "2 names (wave, other); this exports one thing at a time."),
    (("other", "--format", "coco_keypoints", "--snapshot", "1"), "this exports one thing at a time."),
    (("wave", "--format", "coco_keypoints"), "A recording is named twice."),
    (("none", "--format", "coco_keypoints"), "There is no recording 'none'; there are 'wave'."),
    (("--format", "annotations", "--snapshot", "7"), "The recording has no snapshot of version 7."),
    (("--format", "interhand", "--track", "best"), "--track 'best' is not the id of a track."),
    (("--format", "interhand", "--track", str(uuid.UUID(int=5))), f"There is no track {uuid.UUID(int=5)}."),
    (("--format", "annotations", "--sources", "dream"), "dream"),
)


def test_what_cannot_be_exported_is_said_in_one_line_and_leaves_nothing(
    run: Run, recording: uuid.UUID, tmp_path: Path
) -> None:
    folder = tmp_path / "out"
    folder.mkdir()
    for arguments, said in REFUSED:
        code, told, failed = run("wave", *arguments, "--out", folder / "here")
        assert (code, told) == (2, "") and said in failed and failed.count("\n") == 1, (arguments, failed)
        assert list(folder.iterdir()) == []


def test_a_folder_that_is_not_there_is_named(run: Run, tmp_path: Path) -> None:
    code, _, failed = run("wave", "--format", "recording", "--out", tmp_path / "no" / "out")
    assert code == 2 and failed == f"handloom: {tmp_path / 'no'}: is not a folder; make it first.\n"


def test_an_export_that_breaks_off_leaves_nothing_half_written(
    run: Run, own_studio: OpenStudio, recording: uuid.UUID, tmp_path: Path
) -> None:
    (own_studio.storage.folder("sequences", recording) / "sequence.json").write_text("{")
    folder = tmp_path / "out"
    folder.mkdir()
    code, _, failed = run("wave", "--format", "recording", "--out", folder / "here")
    assert code != 0 and "sequence.json" in failed and list(folder.iterdir()) == []


def test_a_recording_is_found_by_its_id_or_by_a_name_that_is_its_alone(own_studio: OpenStudio) -> None:
    first, second, alone = make_row("twin"), make_row("twin"), make_row("alone")
    gone = make_row("gone", deleted_at=utc_now())
    nothing = "There is no recording 'alone'; the studio has no recordings yet"
    with own_studio.database.reading() as session, pytest.raises(CommandError, match=nothing):
        find_recording(session, "alone")
    named = make_row(str(first.id))  # called like another one's id
    keep(own_studio.database, first, second, alone, gone, named)
    with own_studio.database.reading() as session:
        assert find_recording(session, "alone").id == alone.id
        assert find_recording(session, str(second.id)).id == second.id
        assert find_recording(session, str(first.id)).id == first.id
        with pytest.raises(CommandError, match="2 recordings are named 'twin'; give an id: ") as twice:
            find_recording(session, "twin")
        assert str(first.id) in str(twice.value) and str(second.id) in str(twice.value)
        for name in ("gone", str(gone.id)):
            with pytest.raises(CommandError, match=f"There is no recording '{name}'"):
                find_recording(session, name)


def test_the_help_offers_every_format() -> None:
    parser = argparse.ArgumentParser()
    add_command(parser.add_subparsers())
    for name in FORMATS:
        args = parser.parse_args(["export", "a", "b", "--format", name, "--out", "x"])
        assert (args.format, args.name, args.sources, args.snapshot) == (name, ["a", "b"], "all", None)

"""Where each frame of a set comes from, ready for JSON, and that no frame goes out which was changed since."""

from __future__ import annotations

import json
import uuid
from pathlib import Path
from typing import Any

import pytest

from server.moving_scans.accepted import Accepted, find_accepted
from server.moving_scans.body_set_archive import DamagedFrameError, check_member, describe_lineage
from server.moving_scans.storing import AREA, BODY
from server.storage import Storage
from server.storage.digest import compute_digest
from tests.server.moving_scans.bench import Bench, bench

__all__ = ["bench"]


def describe(bench: Bench) -> dict[str, Any]:
    members = find_accepted(bench.session, bench.scan.id)
    used = {each.registration_id for each in members}
    registrations = {row.id: row for row in bench.registrations if row.id in used}
    return describe_lineage({"name": "kept"}, bench.scan, members, registrations)


def test_each_row_of_the_motion_leads_back_to_its_scan_its_registration_and_its_decision(bench: Bench) -> None:
    first, _ = bench.decide(0, "accept", 2, 4)
    second, _ = bench.decide(1, "accept", 4, 4)
    lineage = describe(bench)
    assert [(one["row"], one["frame"], one["scan"]) for one in lineage["frames"]] == [
        (0, 2, "frame2.ply"),
        (1, 3, "frame3.ply"),
        (2, 4, "frame4.ply"),
    ]
    assert [one["decision"] for one in lineage["frames"]] == [str(first.id), str(first.id), str(second.id)]
    assert [one["registration"] for one in lineage["frames"]] == [
        str(bench.registrations[which].id) for which in (0, 0, 1)
    ]
    assert lineage["frames"][2]["body_sha256"] == f"{4:064d}" and lineage["frames"][2]["scan_sha256"] == "4" * 64
    assert json.loads(json.dumps(lineage)) == lineage, "it is ready for JSON"


def test_the_scan_and_the_registrations_are_told_with_what_made_them(bench: Bench) -> None:
    parent, child = bench.registrations
    child.parent_id, child.template_id, child.prior = parent.id, parent.template_id, "none"
    bench.decide(1, "accept", 4, 5)
    lineage = describe(bench)
    assert (lineage["version"], lineage["set"]) == (1, {"name": "kept"})
    told = lineage["moving_scan"]
    assert (told["subject"], told["sha256"], told["fps"], told["metres_per_unit"]) == ("Ada", "d" * 64, 30.0, 1.0)
    [one] = lineage["registrations"]
    assert (one["id"], one["parent"], one["job"]) == (str(child.id), str(parent.id), str(child.job_id))
    assert (one["model"], one["prior"], one["frames"]) == (f"models/{parent.template_id}.npz", "none", [1, 7])


@pytest.fixture
def member(tmp_path: Path) -> tuple[Storage, Accepted]:
    """A frame whose file is what was accepted."""
    storage, id_ = Storage(tmp_path / "studio"), uuid.uuid4()
    folder = storage.folder(AREA, id_)
    folder.mkdir()
    (folder / BODY).write_bytes(b"as accepted")
    return storage, Accepted(5, id_, compute_digest(folder / BODY), uuid.uuid4(), uuid.uuid4())


def test_a_frame_as_it_was_accepted_goes_out(member: tuple[Storage, Accepted]) -> None:
    storage, one = member
    assert check_member(storage, "kept", one) == storage.folder(AREA, one.frame_registration_id)


@pytest.mark.parametrize("content", [b"changed", None])
def test_a_frame_that_was_changed_or_is_gone_is_named_with_what_to_restore(member, content: bytes | None) -> None:
    storage, one = member
    path = storage.folder(AREA, one.frame_registration_id) / BODY
    if content is None:
        path.unlink()
    else:
        path.write_bytes(content)
    told = f"Frame 5 of “kept” was changed after it was accepted. Restore {AREA}/{one.frame_registration_id} from"
    with pytest.raises(DamagedFrameError, match=told) as fault:
        check_member(storage, "kept", one)
    assert fault.value.status_code == 409

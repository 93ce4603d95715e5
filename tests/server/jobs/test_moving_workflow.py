"""Jobs that register a moving scan: a killed worker loses one frame at most, chunks end as those of the command line,
and another prior goes on from a frame."""

from __future__ import annotations

import itertools
import uuid
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pytest
from sqlalchemy import select

from server.access.models import LOCAL_ACCOUNT_ID
from server.compute import Compute, ComputeContext
from server.database import Database
from server.jobs.models import WorkerRow
from server.jobs.moving import make_moving_job
from server.jobs.moving_run import FAILED
from server.jobs.moving_schemas import RegisterMovingCreate
from server.jobs.restarting import list_kept
from server.jobs.workers import LOST_AFTER
from server.moving_scans.adding import add_moving_scan
from server.moving_scans.body_sets import create_body_set
from server.moving_scans.decision_schemas import BodySetMake, StretchDecisionMake
from server.moving_scans.decisions import decide
from server.moving_scans.models import FrameRegistrationRow, MovingRegistrationRow
from server.moving_scans.person_models import make_person_model, name_person_model
from server.moving_scans.schemas import MovingScanOptions
from server.moving_scans.service import find_scan_file, get_moving_scan
from server.moving_scans.storing import AREA, TEMPLATE, TEMPLATES
from server.settings import Settings
from tests.server.jobs.scan_bench import ScanBench, bench
from tests.server.moving_scans.moving import MovingPerson, moving_person
from tests.server.packed_arrays import unpack_arrays
from tracker.bodies import CHAIN, BodyRegistration, body_model, load_body_registration
from tracker.bodies.body_sequence import Sequence, SequenceOptions, register_sequence

__all__ = ["bench", "moving_person"]


def add(bench: ScanBench, person: MovingPerson, folder: Path, broken: str = "frame0b.ply") -> uuid.UUID:
    """The three frames, and a broken file between two of them."""
    folder.mkdir()
    for name, data in person.files.items():
        (folder / name).write_bytes(data)
    (folder / broken).write_bytes(b"ply\nnothing\n")
    compute = Compute(bench.settings, bench.database, bench.storage)
    row, _ = add_moving_scan(
        bench.database, bench.storage, compute, folder, "moving", MovingScanOptions(), LOCAL_ACCOUNT_ID
    )
    compute.close()
    assert [frame["name"] for frame in row.frames if frame["problem"] is not None] == [broken]
    return row.id


def find_frames(bench: ScanBench, job_id: uuid.UUID) -> tuple[MovingRegistrationRow, list[FrameRegistrationRow]]:
    with bench.database.reading() as session:
        row = session.scalars(select(MovingRegistrationRow).where(MovingRegistrationRow.job_id == job_id)).one()
        query = select(FrameRegistrationRow).where(FrameRegistrationRow.registration_id == row.id)
        return row, list(session.scalars(query.order_by(FrameRegistrationRow.frame)))


def load(bench: ScanBench, row: FrameRegistrationRow) -> BodyRegistration:
    return load_body_registration(bench.storage.folder(AREA, row.id))


@pytest.mark.slow
def test_a_killed_job_goes_on_at_its_frame_and_one_with_another_prior_goes_on_from_there(
    bench: ScanBench, moving_person: MovingPerson, tmp_path: Path
) -> None:
    scan_id = add(bench, moving_person, tmp_path / "walking")
    worker = bench.start_worker()
    asked = RegisterMovingCreate(moving_scan_id=scan_id, template_frames=1)
    job_id = bench.make(make_moving_job, asked)
    bench.wait(job_id, lambda job: job.frames_done >= 1, 240.0)
    bench.kill(worker)
    before = find_frames(bench, job_id)[1]
    done = bench.job(job_id).frames_done
    told = f"{done} registered frame" + "s" * (done > 1)
    assert list_kept(bench.storage, bench.job(job_id)) == ["the person's own model", told]
    bench.start_worker()
    job = bench.wait_for_end(job_id)
    assert (job.frames_done, job.frames_total, job.progress, job.moving_scan_id) == (3, 3, 1.0, scan_id)
    assert any("going on after the last finished step" in line for line in bench.log(job_id))
    assert any("1 frame left out, whose file cannot be used" in line for line in bench.log(job_id))

    made, frames = find_frames(bench, job_id)
    assert [row.frame for row in frames] == [0, 2, 3]
    assert {row.id: row.created_at for row in before}.items() <= {row.id: row.created_at for row in frames}.items()
    assert [(row.has_left, row.has_right) for row in frames] == [(True, True), (True, True), (False, True)]
    for row, body in zip(frames, moving_person.bodies, strict=True):
        found = load(bench, row)
        apart = 1e3 * np.linalg.norm(found.vertices - body.true_vertices, axis=1)
        assert apart[body.is_seen].mean() < 6.0 and row.scan_to_mesh_mm["mean"] < 2.0
        view, _ = unpack_arrays((bench.storage.folder(AREA, row.id) / "body.view").read_bytes())
        np.testing.assert_allclose(view["vertices"], found.vertices, atol=1e-6)
        assert np.nanmean(view["point_error_mm"]) == pytest.approx(row.scan_to_mesh_mm["mean"], rel=0.05)
        assert view["guessed"].any() == (not row.has_left)
        assert np.isnan(view["vertex_error_mm"][view["guessed"] == 1]).all()
    assert (bench.storage.folder(TEMPLATES, made.id) / TEMPLATE).is_file()

    again = RegisterMovingCreate(moving_scan_id=scan_id, parent_id=made.id, first_frame=2, prior="gaussian")
    other_id = bench.make(make_moving_job, again)
    bench.wait_for_end(other_id)
    other, others = find_frames(bench, other_id)
    assert (other.parent_id, other.template_id, other.prior, other.first_frame) == (made.id, made.id, "gaussian", 2)
    assert [row.frame for row in others] == [2, 3] and all(row.verdict != FAILED for row in others)
    one, two = load(bench, frames[1]), load(bench, others[0])
    apart = 1e3 * np.linalg.norm(one.vertices - two.vertices, axis=1).mean()
    assert 0.0 < apart < 10.0, "another prior, from the same frame before"
    assert not bench.storage.folder("jobs", job_id).exists(), "working files go when the job has ended"
    assert bench.job(other_id).title.endswith("frames 2 to 3, on from registration 1, Gaussian prior")


def make_model(bench: ScanBench, registration: MovingRegistrationRow) -> uuid.UUID:
    """Accept the first frame, keep it, and make the person's model of it."""
    with bench.database.writing() as session:
        accepted = StretchDecisionMake(decision="accept", first_frame=0, last_frame=0, operation_id=uuid.uuid4())
        decide(session, registration, LOCAL_ACCOUNT_ID, accepted)
        scan = get_moving_scan(session, registration.moving_scan_id)
        made = BodySetMake(moving_scan_id=scan.id, name="frame 0")
        set_id = create_body_set(session, scan, made, LOCAL_ACCOUNT_ID)[0].id
    assert make_person_model(ComputeContext(bench.database, bench.storage), set_id, LOCAL_ACCOUNT_ID)
    return name_person_model(set_id)


@pytest.mark.slow
def test_a_model_of_accepted_frames_takes_the_place_of_one_from_the_first_frames(
    bench: ScanBench, moving_person: MovingPerson, tmp_path: Path
) -> None:
    scan_id = add(bench, moving_person, tmp_path / "walking")
    bench.start_worker()
    first = RegisterMovingCreate(moving_scan_id=scan_id, template_frames=1, last_frame=0)
    registration, _ = find_frames(bench, bench.wait_for_end(bench.make(make_moving_job, first)).id)
    model_id = make_model(bench, registration)
    job_id = bench.make(
        make_moving_job,
        RegisterMovingCreate(moving_scan_id=scan_id, person_model_id=model_id, first_frame=2, last_frame=2),
    )
    bench.wait_for_end(job_id)
    again, [frame] = find_frames(bench, job_id)
    assert again.template_id == model_id and not any("the person's own model" in line for line in bench.log(job_id))
    body = moving_person.bodies[1]
    apart = 1e3 * np.linalg.norm(load(bench, frame).vertices - body.true_vertices, axis=1)
    assert apart[body.is_seen].mean() < 6.0 and frame.scan_to_mesh_mm["mean"] < 2.0


@dataclass
class Chunked:
    """A job with two chunks, and what the command line makes of the same files."""

    bench: ScanBench
    scan_id: uuid.UUID
    job_id: uuid.UUID
    sequence: Sequence

    def check_same(self) -> None:
        """Frame by frame to the last bit, the seam too."""
        frames = find_frames(self.bench, self.job_id)[1]
        assert [row.frame for row in frames] == [0, 1, 3], "the file of frame 2, the first of its chunk, is broken"
        for row in frames:
            ours, theirs = load(self.bench, row), load_body_registration(self.sequence.folder(row.frame))
            np.testing.assert_array_equal(ours.vertices, theirs.vertices)
            np.testing.assert_array_equal(ours.state.pose, theirs.state.pose)
            assert ours.measures == theirs.measures and (CHAIN in ours.measures) == (row.frame == 3)


@pytest.fixture
def chunked(settings: Settings, database: Database, moving_person: MovingPerson, tmp_path: Path) -> Iterator[Chunked]:
    bench = ScanBench(settings, database)
    scan_id = add(bench, moving_person, tmp_path / "walking", "frame1b.ply")
    asked = RegisterMovingCreate(moving_scan_id=scan_id, template_frames=1, chunk_frames=2)
    with bench.database.reading() as session:
        row = get_moving_scan(session, scan_id)
    paths = tuple(find_scan_file(bench.storage, row, frame) for frame in range(4))
    sequence = Sequence(paths, tmp_path / "out", SequenceOptions(template_frames=1, chunk=2))
    register_sequence(sequence, body_model())
    yield Chunked(bench, scan_id, bench.make(make_moving_job, asked), sequence)
    for process in bench.processes:
        if process.poll() is None:
            bench.kill(process)


@pytest.mark.slow
@pytest.mark.parametrize("database_kind", ["sqlite"])
def test_one_worker_does_all_chunks_and_when_they_were_cancelled_goes_on_to_the_same_bits(
    chunked: Chunked,
) -> None:
    bench, job_id = chunked.bench, chunked.job_id
    bench.start_worker()
    bench.wait(job_id, lambda job: job.frames_done >= 1, 240.0)
    assert [row.frame for row in find_frames(bench, job_id)[1]] in ([], [0]), "the second chunk is not joined yet"
    bench.cancel(job_id)
    done = bench.job(job_id).frames_done
    bench.resume(job_id)
    counts: list[int] = []
    job = bench.wait(job_id, lambda job: counts.append(job.frames_done) or job.state == "succeeded", 240.0)
    assert counts == sorted(counts) and counts[0] >= done and (job.frames_done, job.progress) == (3, 1.0)
    assert any(
        "frame 3 joined to the one before; 1 frame registered again for it" in line for line in bench.log(job_id)
    )
    chunked.check_same()


@pytest.mark.slow
@pytest.mark.parametrize("database_kind", ["postgresql"])
def test_two_workers_share_the_chunks_and_one_goes_on_for_the_other_that_is_killed(chunked: Chunked) -> None:
    bench, job_id = chunked.bench, chunked.job_id
    workers = [bench.start_worker(), bench.start_worker()]
    bench.wait_for_workers(2)
    bench.wait(job_id, lambda job: job.frames_done >= 1, 240.0)
    assert sum("registering frames" in line for line in bench.log(job_id)) == 2, "both chunks at once"
    with bench.database.reading() as session:
        holder = session.get_one(WorkerRow, bench.job(job_id).worker_id)
    bench.kill(next(process for process in workers if process.pid != holder.pid))
    with bench.database.writing() as session:
        for row in session.query(WorkerRow).where(WorkerRow.pid != holder.pid):
            row.last_seen_at -= LOST_AFTER  # as if the other had waited that long
    job = bench.wait_for_end(job_id)
    assert (job.frames_done, job.progress, job.worker_id) == (3, 1.0, holder.id)
    chunked.check_same()


def test_what_cannot_be_registered_is_refused_before_it_is_queued(
    bench: ScanBench, moving_person: MovingPerson, tmp_path: Path
) -> None:
    scan_id = add(bench, moving_person, tmp_path / "walking")
    nobody = uuid.uuid4()
    refused = {
        "has no frame 4; it has 0 to 3": {"last_frame": 4},
        "is after the last one": {"first_frame": 3, "last_frame": 2},
        "None of the frames 1 to 1": {"first_frame": 1, "last_frame": 1},
        f"There is no registration {nobody}": {"parent_id": nobody},
        f"moving scan {nobody} does not exist": {"moving_scan_id": nobody},
    }
    for told, asked in refused.items():
        with pytest.raises(Exception, match=told):
            bench.make(make_moving_job, RegisterMovingCreate(**{"moving_scan_id": scan_id, **asked}))


def test_a_moving_job_is_made_over_the_api_listed_by_its_scan_cancelled_and_retried(studio, moving_person) -> None:
    from tests.server.moving_scans.moving import add as send

    scan = send(studio, dict(itertools.islice(moving_person.files.items(), 2)))
    body = {"kind": "register_moving", "moving_scan_id": scan["id"], "prior": "none"}
    check = studio.client.post("/api/v1/jobs/check", json=body).json()
    assert check["can_start"], check
    job = studio.client.post("/api/v1/jobs", json=body).json()
    assert (job["unit"], job["moving_scan_id"], job["title"]) == ("frames", scan["id"], "Moving scan, no prior")
    assert studio.client.post(f"/api/v1/jobs/{job['id']}/cancel").json()["state"] == "cancelled"
    again = studio.client.post(f"/api/v1/jobs/{job['id']}/retry").json()
    assert (again["moving_scan_id"], again["params"], again["retry_of"]) == (scan["id"], job["params"], job["id"])
    listed = studio.client.get("/api/v1/jobs", params={"moving_scan_id": scan["id"]}).json()["items"]
    assert {each["id"] for each in listed} == {job["id"], again["id"]}
    assert studio.client.post("/api/v1/jobs", json={**body, "prior": "wish"}).status_code == 422

"""A tenth of 1,000 annotators and 10,000 hours of recordings in PostgreSQL: how long what people ask for takes.

    python -m benchmarks.scale [--recordings 100 1000] [--write]

A recording is an hour at 30 frames/s of one camera (108,000 frames), labelled in both hands every 540th frame with
three revisions each, tracked ten times. Rows are made by SQL; requests go through the studio's own application, one by
one.
`--write` puts the table into benchmarks/results/scale.md.
"""

from __future__ import annotations

import argparse
import hashlib
import json
import os
import platform
import socket
import statistics
import subprocess
import sys
import tempfile
import time
import uuid
from collections.abc import Callable, Iterator
from contextlib import closing, contextmanager
from pathlib import Path
from typing import Any

import psycopg
from fastapi.testclient import TestClient

from server.app import create_app
from server.database import Database
from server.jobs.dispatcher import find_waiting
from server.settings import Settings
from server.storage import open_storage
from tests.postgres import run_postgres

PAGE = Path(__file__).parent / "results" / "scale.md"
FRAMES, LABELLED_EVERY, REVISIONS, JOBS_EACH, LINES_EACH = 108_000, 540, 3, 10, 20
RECORDINGS_PER_PERSON, FRAMES_PER_ASSIGNMENT = 10, 10_800
REPEATS = 7
STORED_FILES, STORED_BYTES = 400, 50_000
POINTS = json.dumps([[320.5, 240.25, 2]] * 21)
SOURCES = json.dumps([None] * 16 + [{"kind": "fit", "label": "model fit of 7 joints"}] * 5)

FILL = f"""
CREATE TEMPORARY TABLE numbers AS SELECT n, md5('sequence' || n)::uuid AS id FROM generate_series(1, %(recordings)s) n;
INSERT INTO accounts (id, name, role, preferences, revision, created_at)
  SELECT md5('account' || n)::uuid, 'Person ' || n, 'annotator', '{{}}', 1, now()
  FROM generate_series(1, %(people)s) n;
INSERT INTO sequences (id, name, fps, frame_count, cameras, hands, objects, report, content_key, revision, created_at,
                       updated_at, created_by)
  SELECT numbers.id, 'Recording ' || n, 30, {FRAMES}, cameras, '["right", "left"]', objects, report, content_key, 1,
         now() - n * interval '1 minute', now(), created_by
  FROM numbers, sequences WHERE sequences.id = %(sample)s;
INSERT INTO projects (id, name, description, revision, created_at)
  SELECT md5('project' || n)::uuid, 'Project ' || n, '', 1, now() FROM generate_series(1, 10) n;
INSERT INTO project_sequences (id, project_id, sequence_id, added_at)
  SELECT gen_random_uuid(), md5('project' || (n %% 10 + 1))::uuid, id, now() FROM numbers;
INSERT INTO assignments (id, project_id, sequence_id, account_id, frame_first, frame_last, state, note, revision,
                         created_at, updated_at)
  SELECT gen_random_uuid(), md5('project' || (n %% 10 + 1))::uuid, id, md5('account' || (n %% %(people)s + 1))::uuid,
         part * {FRAMES_PER_ASSIGNMENT}, part * {FRAMES_PER_ASSIGNMENT} + {FRAMES_PER_ASSIGNMENT - 1},
         (ARRAY['open', 'submitted', 'accepted'])[part %% 3 + 1], '', 1, now(), now()
  FROM numbers, generate_series(0, {FRAMES // FRAMES_PER_ASSIGNMENT - 1}) part;
INSERT INTO annotations (id, sequence_id, replica, camera, frame, hand, points, sources, decided, revision, updated_at,
                         author_id)
  SELECT gen_random_uuid(), id, '', 'cam0', frame, hand, '{POINTS}', '{SOURCES}', 21, {REVISIONS},
         now() - frame * interval '1 second', md5('account' || (n %% %(people)s + 1))::uuid
  FROM numbers, generate_series(0, {FRAMES - 1}, {LABELLED_EVERY}) frame, unnest(ARRAY['right', 'left']) hand;
INSERT INTO annotation_revisions (id, annotation_id, revision, operation_id, act, points, sources, created_at,
                                  author_id)
  SELECT gen_random_uuid(), id, revision_made, gen_random_uuid(), 'put', points, sources, updated_at, author_id
  FROM annotations, generate_series(1, {REVISIONS}) revision_made WHERE sequence_id IN (SELECT id FROM numbers);
INSERT INTO jobs (id, kind, state, sequence_id, title, params, progress, stage, frames_done, frames_total, attempt,
                  dispatched_attempt, crashes, version, created_at, updated_at)
  SELECT md5('job' || n || ' ' || part)::uuid, 'track', CASE WHEN part = 0 THEN 'queued' ELSE 'succeeded' END, id, '',
         '{{}}', 0, '', 0, {FRAMES}, 1, CASE WHEN part = 0 THEN 0 ELSE 1 END, 0, 1,
         now() - n * interval '1 minute', now()
  FROM numbers, generate_series(0, {JOBS_EACH - 1}) part;
INSERT INTO job_log_lines (id, job_id, number, time, level, text)
  SELECT gen_random_uuid(), id, number, now(), 'info', 'placing the right hand' FROM jobs,
         generate_series(1, {LINES_EACH}) number;
INSERT INTO tracks (id, sequence_id, job_id, name, frame_first, frame_count, hands, summary, error_px, created_at)
  SELECT gen_random_uuid(), sequence_id, id, 'Track', 0, {FRAMES}, '["right", "left"]', '{{}}', 4.2, created_at
  FROM jobs WHERE state = 'succeeded';
"""


@contextmanager
def fill_studio(url: str, folder: Path, recordings: int) -> Iterator[tuple[TestClient, Database]]:
    """A studio with so many recordings and a tenth as many people, and its application."""
    settings = Settings(data_dir=folder / "data", database_url=url)
    database = Database(settings.sqlalchemy_url)
    with closing(database):
        recording = str(folder / "recording")
        _run(settings, "synthesize", "--motion", "open-close", "--frames", "0:2", "--out", recording)
        sample = json.loads(_run(settings, "import", recording, "--json"))["id"]
        values = {"recordings": recordings, "people": max(recordings // RECORDINGS_PER_PERSON, 1), "sample": sample}
        with psycopg.connect(url, autocommit=True) as connection:
            for statement in FILL.split(";\n"):
                if statement.strip():
                    connection.execute(statement.encode(), values if "%" in statement else None)
            connection.execute("VACUUM ANALYZE")
        with TestClient(create_app(settings), base_url="http://localhost") as client:
            yield client, database


def _run(settings: Settings, *arguments: str) -> str:
    """What a command of ours prints."""
    where = {"HANDLOOM_DATA_DIR": str(settings.data_dir), "HANDLOOM_DATABASE_URL": str(settings.database_url)}
    command = [sys.executable, "-m", "server.cli", *arguments]
    return subprocess.run(command, env=os.environ | where, check=True, stdout=subprocess.PIPE, text=True).stdout


def list_requests(client: TestClient, recordings: int) -> dict[str, Callable[[], Any]]:
    """What is measured, by its name for people."""
    with_id = "/api/v1/sequences?search=Recording%20" + str(recordings // 2) + "&limit=1"
    recording = client.get(with_id).raise_for_status().json()["items"][0]["id"]
    project = client.get("/api/v1/projects").raise_for_status().json()["items"][0]["id"]
    place = f"/api/v1/sequences/{recording}/annotations/cam0/{LABELLED_EVERY * 10}/right"
    revisions = iter(range(REVISIONS, REVISIONS + 10 * REPEATS))

    def get(path: str) -> Callable[[], Any]:
        return lambda: client.get(f"/api/v1{path}").raise_for_status()

    def save() -> Any:
        headers = {"If-Match": f'"{next(revisions)}"', "Origin": "http://localhost"}
        body = {"points": [[320.5, 240.25, 2]] * 21, "operation_id": str(uuid.uuid4())}
        return client.put(place, headers=headers, json=body).raise_for_status()

    around = f"/sequences/{recording}/annotations?camera=cam0&from=4860&to=5939"
    return {
        "recordings, first page of 100": get("/sequences?limit=100"),
        "recordings whose name holds a word": get("/sequences?search=ing%20777"),
        "labels around a frame (4 hands)": get(around),
        "all labels of a recording (400 hands)": get(f"/sequences/{recording}/annotations.json"),
        "history of a hand": get(f"{place.removeprefix('/api/v1')}/history"),
        "saving a hand": save,
        "jobs, first page of 100": get("/jobs?limit=100"),
        "jobs whose recording's name holds a word": get("/jobs?search=ing%20777"),
        "jobs that wait": get("/jobs?state=queued&limit=100"),
        "log of a job": get(f"/jobs/{uuid.UUID(_md5_of('job1 0'))}/log"),
        "tracks of a recording": get(f"/tracks?sequence_id={recording}"),
        "assignments, first page": get("/assignments?limit=100"),
        "a project with its progress": get(f"/projects/{project}"),
        "recordings of a project": get(f"/projects/{project}/sequences?limit=100"),
        "projects, each with its progress": get("/projects"),
    }


def _md5_of(text: str) -> str:
    return hashlib.md5(text.encode(), usedforsecurity=False).hexdigest()


def time_dispatch(database: Database) -> Callable[[], Any]:
    """The look of a worker at the rows that wait, four times a second."""

    def look() -> Any:
        with database.reading() as session:
            return find_waiting(session)

    return look


def measure_store() -> dict[str, float]:
    """ms a file to publish a folder and to fetch it on another machine; the S3 server is moto's, in its own process."""
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        port = probe.getsockname()[1]
    command = [sys.executable, "-m", "moto.server", "--host", "127.0.0.1", "--port", str(port)]
    with tempfile.TemporaryDirectory() as temporary, subprocess.Popen(command, stderr=subprocess.DEVNULL) as server:
        try:
            _wait_for(port)
            os.environ |= {"AWS_ACCESS_KEY_ID": "x", "AWS_SECRET_ACCESS_KEY": "x", "AWS_DEFAULT_REGION": "us-east-1"}
            here, there = (
                open_storage(
                    Settings(
                        data_dir=Path(temporary) / name,
                        store_url="s3://studio/files",
                        store_endpoint=f"http://127.0.0.1:{port}",
                    )
                )
                for name in ("here", "there")
            )
            id_ = uuid.uuid4()
            folder = here.folder("sequences", id_)
            folder.mkdir(parents=True)
            for number in range(STORED_FILES):
                (folder / f"{number:06d}.png").write_bytes(os.urandom(STORED_BYTES))
            began = time.perf_counter()
            here.publish("sequences", id_)
            published = time.perf_counter()
            assert len(list(there.folder("sequences", id_).iterdir())) == STORED_FILES
            fetched = time.perf_counter()
        finally:
            server.terminate()
    return {
        "publishing a recording, for each file": 1000.0 * (published - began) / STORED_FILES,
        "fetching a recording, for each file": 1000.0 * (fetched - published) / STORED_FILES,
    }


def _wait_for(port: int) -> None:
    while True:
        with socket.socket() as probe:
            if probe.connect_ex(("127.0.0.1", port)) == 0:
                return
        time.sleep(0.2)


def measure(act: Callable[[], Any]) -> float:
    """Median ms, after a first time that is not counted."""
    act()
    times = []
    for _ in range(REPEATS):
        began = time.perf_counter()
        act()
        times.append(1000.0 * (time.perf_counter() - began))
    return statistics.median(times)


def study(recordings: int) -> tuple[dict[str, float], list[tuple[str, int, int]]]:
    """Median ms of each request, and name, rows and bytes of the largest tables and of all."""
    with tempfile.TemporaryDirectory() as temporary, run_postgres(is_durable=True) as address:
        with psycopg.connect(f"{address}/postgres", autocommit=True) as connection:
            connection.execute("CREATE DATABASE handloom")
        url = f"{address}/handloom"
        with fill_studio(url, Path(temporary), recordings) as (client, database):
            found = {name: measure(act) for name, act in list_requests(client, recordings).items()}
            found["a worker's look at a job for each recording that waits"] = measure(time_dispatch(database))
        found |= measure_store()
        with psycopg.connect(url) as connection:
            tables = connection.execute(
                "SELECT relname, n_live_tup, pg_total_relation_size(relid) FROM pg_stat_user_tables "
                "UNION ALL SELECT 'all', sum(n_live_tup), pg_database_size('handloom') FROM pg_stat_user_tables "
                "ORDER BY 3 DESC LIMIT 5"
            ).fetchall()
    return found, [(str(name), int(rows), int(size)) for name, rows, size in tables]


def write_page(sizes: list[int]) -> str:
    """The figures of every size beside each other."""
    studies = [study(size) for size in sizes]
    heads = " | ".join(f"{size:,} recordings" for size in sizes)
    lines = [
        "# Hours of recordings in PostgreSQL",
        "",
        f"`python -m benchmarks.scale --recordings {' '.join(map(str, sizes))} --write`, {time.strftime('%Y-%m-%d')}, "
        f"{os.cpu_count()} processors ({platform.machine()}). Median ms of {REPEATS} requests, one after another; "
        f"load of the machine {os.getloadavg()[0]:.0f}.",
        "",
        f"| what | {heads} |",
        f"|---|{'---|' * len(sizes)}",
    ]
    for name in studies[0][0]:
        lines.append(f"| {name} | {' | '.join(f'{found[name]:.1f}' for found, _ in studies)} |")
    for size, (_, tables) in zip(sizes, studies, strict=True):
        lines += ["", f"| table, {size:,} recordings | rows | MB with its indices |", "|---|---|---|"]
        lines += [f"| {name} | {rows:,} | {size / 1e6:,.0f} |" for name, rows, size in tables]
    return "\n".join([*lines, ""])


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--recordings", type=int, nargs="+", default=[100, 1000], metavar="N")
    parser.add_argument("--write", action="store_true")
    args = parser.parse_args()
    page = write_page(args.recordings)
    print(page)
    if args.write:
        PAGE.parent.mkdir(exist_ok=True)
        PAGE.write_text(page)


if __name__ == "__main__":
    main()

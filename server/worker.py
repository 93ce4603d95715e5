"""The worker process: `handloom worker`. It may be killed at any moment; the next one continues where it was."""

from __future__ import annotations

import logging
import os
import signal
import threading
import time
from uuid import UUID

from dbos import DBOS, DBOSConfig
from sqlalchemy import make_url, select

from server.compute import ComputeContext
from server.database import Database
from server.database.migrate import upgrade
from server.evaluations.service import evaluate
from server.jobs import workers
from server.jobs.dispatcher import Dispatcher
from server.jobs.models import JobRow
from server.jobs.moving import KIND as MOVING
from server.jobs.moving_workflow import CHUNK_QUEUE
from server.jobs.run import WorkerContext
from server.jobs.worker_name import WorkerName
from server.jobs.workflow import APPLICATION, APPLICATION_VERSION, QUEUE, register_workflows
from server.settings import Settings
from server.storage import Storage, open_storage
from server.tracks.service import get_track

log = logging.getLogger(__name__)

AT_ONCE = 1
"""Jobs, and chunks of jobs: tracking keeps a core busy; more at once take more workers."""

DISPATCH_SECONDS = 0.25
ADOPT_SECONDS = 5.0
LOST_EXIT = 75

IDLE_SECONDS = 2.0
"""So long nothing is done before kernels are loaded for the first job to come."""


def run_worker(settings: Settings) -> None:
    """Work until SIGTERM or SIGINT; never returns."""
    database = Database(settings.sqlalchemy_url)
    upgrade(database)
    storage = open_storage(settings)
    _drop_leftovers(database, storage)
    held = WorkerName.acquire(storage.root / "workers", workers.find_own_host(settings.worker_host))
    stopping = threading.Event()
    for number in (signal.SIGTERM, signal.SIGINT):
        signal.signal(number, lambda *_: stopping.set())
    with database.writing() as session:
        worker_id = workers.register_worker(session, held.name, held.host).id
    computing = ComputeContext(database, storage)
    context = WorkerContext(database, storage, worker_id, lambda track_id: _evaluate(computing, track_id))
    workflows = register_workflows(context)
    config: DBOSConfig = {
        "name": APPLICATION,
        "system_database_url": find_system_database(settings),
        "executor_id": held.name,
        "application_version": APPLICATION_VERSION,
        "log_level": "WARNING",
        "use_listen_notify": False,
    }
    DBOS(config=config)
    DBOS.launch()
    for queue in (QUEUE, CHUNK_QUEUE):
        DBOS.register_queue(queue, worker_concurrency=AT_ONCE, polling_interval_sec=0.25, on_conflict="always_update")
    threading.Thread(target=_beat_forever, args=(database, worker_id), name="heartbeat", daemon=True).start()
    threading.Thread(target=_warm_up_when_idle, args=(database, worker_id), name="warm-up", daemon=True).start()
    log.info("worker %s ready, pid %d", held.name, os.getpid())
    _dispatch_until(stopping, Dispatcher(database, workflows))
    with database.writing() as session:
        workers.stop_worker(session, worker_id)
    log.info("worker %s stops; unfinished jobs wait for the next one", held.name)
    logging.shutdown()
    # A step in progress is dropped: ended in order it would be recorded as failed. It is done again, as after a crash.
    os._exit(0)


def _evaluate(context: ComputeContext, track_id: UUID) -> None:
    """Find the error of a new track against the labels, so that every list shows it."""
    from tracker.capture import JUDGING

    try:
        with context.database.reading() as session:
            row = get_track(session, track_id)
        evaluate(context, row, JUDGING)
    except Exception:  # the track is stored; whoever opens it is told what is wrong with its evaluation
        log.exception("track %s could not be evaluated", track_id)


def _drop_leftovers(database: Database, storage: Storage) -> None:
    """Remove working files of jobs that another machine has brought to their end."""
    with database.reading() as session:
        done = set(session.scalars(select(JobRow.id).where(JobRow.state == "succeeded")))
    for job_id in storage.list_ids("jobs"):
        if job_id in done:
            storage.remove("jobs", job_id)


def find_system_database(settings: Settings) -> str:
    """Where DBOS keeps its tables: a file in the data folder, or the studio's own PostgreSQL (in the schema `dbos`)."""
    url = make_url(settings.sqlalchemy_url)
    if url.get_backend_name() == "sqlite":
        return f"sqlite:///{settings.data_dir / 'dbos.sqlite'}"
    return url.set(drivername="postgresql").render_as_string(hide_password=False)


def _dispatch_until(stopping: threading.Event, dispatcher: Dispatcher) -> None:
    adopted = 0.0
    while not stopping.wait(DISPATCH_SECONDS):
        try:
            dispatcher.dispatch()
            if time.monotonic() - adopted > ADOPT_SECONDS:
                adopted = time.monotonic()
                dispatcher.adopt()
        except Exception:  # what keeps one job from being dispatched must not end this loop for all others
            log.exception("jobs could not be dispatched; trying again")
            stopping.wait(2.0)


def _beat_forever(database: Database, worker_id: UUID) -> None:
    while True:
        time.sleep(workers.HEARTBEAT_SECONDS)
        try:
            with database.writing() as session:
                is_ours = workers.beat(session, worker_id)
        except Exception as error:  # without this thread the others would take this worker for dead while it works
            log.warning("no heartbeat: %s", error)
            continue
        if not is_ours:
            log.error("the other workers have given this one up and taken its jobs; it ends")
            os._exit(LOST_EXIT)


def _warm_up_when_idle(database: Database, worker_id: UUID) -> None:
    """A job loads the kernels that it needs; beside it the others would only take its time. Who does chunks of a
    moving scan need not hold its job."""
    from tracker import warm_up

    is_mine = (JobRow.state == "running") & ((JobRow.worker_id == worker_id) | (JobRow.kind == MOVING))
    try:
        is_busy = True
        while is_busy:
            time.sleep(IDLE_SECONDS)
            with database.reading() as session:
                is_busy = session.scalar(select(JobRow.id).where(is_mine).limit(1)) is not None
        warm_up(lambda name, share: log.debug("warm-up: %s %.0f %%", name, 100 * share))
    except Exception:  # only a warm-up: the job that needs what failed tells its user
        log.exception("warm-up failed; the first job will show why")

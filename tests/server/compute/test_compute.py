"""Long computations run in one process of low priority that outlives its own death and never the studio."""

from __future__ import annotations

import asyncio
import contextlib
import os
import shutil
import subprocess
import sys
import tempfile
import threading
import time

import pytest

from server.compute import Compute
from server.compute.process import NICENESS, ComputeStoppedError
from server.database import Database
from server.settings import Settings
from server.storage import Storage
from tests.server.compute import work
from tests.server.compute.processes import find_children, is_alive, wait_until

OF_NO_ERROR = {"__notes__"}


@contextlib.contextmanager
def open_compute(settings):
    """Not started yet."""
    with (
        contextlib.closing(Database(settings.sqlalchemy_url)) as database,
        contextlib.closing(Compute(settings, database, Storage(settings.data_dir))) as compute,
    ):
        yield compute


@pytest.fixture
def compute(sqlite_settings):
    with open_compute(sqlite_settings) as compute:
        yield compute


@pytest.fixture
def started(compute):
    compute.start(work.count)
    return compute


@pytest.fixture(scope="module")
def running(sqlite_template, tmp_path_factory):
    """One for all tests that leave it as it is."""
    folder = tmp_path_factory.mktemp("running")
    shutil.copy(sqlite_template, folder / "own.sqlite3")
    with open_compute(Settings(data_dir=folder, database_url=f"sqlite:///{folder}/own.sqlite3")) as compute:
        compute.start(work.count)
        yield compute


def ask(compute, function, *arguments):
    return asyncio.run(compute.run(function, *arguments))


@pytest.fixture
def temporary(tmp_path_factory, monkeypatch):
    """Where its folder goes, which holds a socket and so has a short path."""
    folder = tmp_path_factory.mktemp("t")
    monkeypatch.setattr(tempfile, "tempdir", str(folder))
    return folder


def test_before_it_is_started_it_computes_where_it_is_asked(compute):
    assert ask(compute, work.tell_process) == (os.getpid(), os.nice(0))


def test_once_started_it_computes_in_one_process_of_low_priority(running):
    async def ask_at_once():
        return await asyncio.gather(*(running.run(work.tell_process) for _ in range(12)))

    [(pid, niceness)] = set(asyncio.run(ask_at_once()))
    assert pid != os.getpid()
    assert niceness == min(19, os.nice(0) + NICENESS)


def test_it_remembers_from_one_question_to_the_next(running):
    wait_until(lambda: ask(running, work.count) > 1)
    asked = ask(running, work.count)
    assert [ask(running, work.count) for _ in range(3)] == [asked + 1, asked + 2, asked + 3]


def test_it_reads_the_studios_database(settings):
    with open_compute(settings) as compute:
        compute.start(work.count)
        assert ask(compute, work.count_recordings) == 0


def test_a_short_question_does_not_wait_for_a_long_one(started, tmp_path):
    async def ask_both():
        long = asyncio.create_task(started.run(work.sleep, 60.0, tmp_path / "begun"))
        while not (tmp_path / "begun").exists():
            await asyncio.sleep(0.01)
        await started.run(work.tell_process)
        assert not long.done()
        started.close()
        with pytest.raises(ComputeStoppedError):
            await long

    asyncio.run(ask_both())


@pytest.mark.parametrize("kind", ["api", "cursor", "tracker", "system", "database"])
def test_what_it_raises_arrives_as_the_same_error(running, kind):
    with pytest.raises(type(work.make_error(kind))) as caught:
        ask(running, work.fail, kind)
    error, expected = caught.value, work.make_error(kind)
    assert type(error) is type(expected)
    assert str(error) == str(expected)
    state = {name: value for name, value in vars(error).items() if name not in OF_NO_ERROR}
    assert repr(state) == repr(vars(expected))
    assert "work.py" in error.__notes__[0], "the log can say where"


def test_an_error_that_cannot_be_sent_is_told_and_hurts_nothing(running):
    pid, _ = ask(running, work.tell_process)
    with pytest.raises(Exception, match="lock"):
        ask(running, work.fail, "unsendable")
    assert ask(running, work.tell_process)[0] == pid


def test_killed_in_the_middle_of_a_question_it_starts_again_and_answers_it(started, tmp_path):
    before, _ = ask(started, work.tell_process)
    answered = ask(started, work.die_once, tmp_path / "died")
    assert answered != before
    assert ask(started, work.tell_process)[0] == answered
    assert not is_alive(before)


def test_killed_under_many_questions_it_answers_all_of_them(started, tmp_path):
    """The questions that were under way are asked again; one process follows, not one for each."""
    pid, _ = ask(started, work.tell_process)
    others = find_children(os.getpid()).keys() - {pid}
    marks = [tmp_path / str(n) for n in range(4)]

    def kill():
        wait_until(lambda: all(mark.exists() for mark in marks))
        os.kill(pid, 9)

    async def ask_at_once():
        return await asyncio.gather(*(started.run(work.sleep, 0.5, mark) for mark in marks))

    killer = threading.Thread(target=kill)
    killer.start()
    assert asyncio.run(ask_at_once()) == ["slept"] * 4
    killer.join()
    found = {pid for pid, command in find_children(os.getpid()).items() if "spawn_main" in command}
    assert found - others == {ask(started, work.tell_process)[0]}


def test_a_question_that_kills_it_twice_is_refused_and_others_are_answered(started):
    with pytest.raises(ComputeStoppedError, match="twice"):
        ask(started, work.die)
    assert ask(started, work.tell_process)[0] != os.getpid()


def test_a_route_in_a_thread_gets_the_same_answers(running):
    assert running.ask(work.tell_process) == ask(running, work.tell_process)


def test_closed_it_leaves_no_process_and_no_folder(temporary, started):
    pid, _ = ask(started, work.tell_process)
    assert len(list(temporary.iterdir())) == 1
    started.close()
    wait_until(lambda: not is_alive(pid))
    assert not list(temporary.iterdir())


STUDIO = """
import asyncio, sys, time
from server.compute import Compute
from server.database import Database
from server.settings import Settings
from server.storage import open_storage
from tests.server.compute import work
from tests.server.compute.processes import find_children, is_alive, wait_until

settings = Settings()
compute = Compute(settings, Database(settings.sqlalchemy_url), open_storage(settings))
compute.start(work.count)
print(*asyncio.run(compute.run(work.tell_process)), flush=True)
asyncio.run(compute.run(work.burn, 300.0))
"""


def test_when_the_studio_is_killed_no_process_stays(tmp_path, temporary):
    """`kill -9` while a long question is under way that holds Python's lock."""
    environment = os.environ | {"HANDLOOM_DATA_DIR": str(tmp_path), "TMPDIR": str(temporary)}
    with subprocess.Popen([sys.executable, "-c", STUDIO], env=environment, stdout=subprocess.PIPE) as studio:
        assert studio.stdout is not None
        pid = int(studio.stdout.readline().split()[0])
        children = find_children(studio.pid)
        assert pid in children
        time.sleep(0.3)
        studio.kill()
    wait_until(lambda: not any(is_alive(child) for child in children))
    assert not list(temporary.glob("handloom-compute-*"))

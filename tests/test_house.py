"""The figures of the program itself count what a reader would count."""

from __future__ import annotations

import ast
from pathlib import Path

import pytest

from scripts.measure_house import (
    MOST_COMPLEXITY,
    MOST_PARAMETERS,
    Room,
    add_module,
    complexity,
    count_parameters,
    count_words,
    measure,
)

ROOT = Path(__file__).parents[1]


@pytest.fixture(scope="module")
def rooms() -> list[Room]:
    return measure(ROOT)


SOURCE = """
LIMIT, _OTHER = 1, 2
UNIT: float = 0.001
name = "no constant"


def decide(a, /, b, *more, c=1, **rest):
    def inner(x):
        return x if x else 0

    if a and b or c:
        return [inner(one) for one in more if one]
    while rest:
        rest.popitem()
    return None


class Hand:
    def grow(self, factor):
        return factor


@njit(cache=True)
def kernel(p1, p2, p3):
    for _ in range(p1):
        pass
"""


def test_parameters_leave_self_out_and_complexity_counts_every_branch(tmp_path: Path) -> None:
    decide = ast.parse(SOURCE).body[3]
    assert isinstance(decide, ast.FunctionDef)
    assert count_parameters(decide) == 5
    assert complexity(decide) == 6, "an if with two operators, a comprehension with a condition, a while; not inner's"


def test_a_room_adds_up_its_modules_and_keeps_kernels_apart(tmp_path: Path) -> None:
    path = tmp_path / "tracker" / "fitting" / "fit.py"
    path.parent.mkdir(parents=True)
    path.write_text(SOURCE)
    room = Room("tracker/fitting")
    add_module(room, path, tmp_path)
    assert (room.modules, room.constants, room.lines) == (1, 3, len(SOURCE.splitlines()))
    assert sorted(one[0].split()[1] for one in room.functions) == ["decide", "grow", "inner"]
    assert [one[0].split()[1] for one in room.kernels] == ["kernel"]


def test_a_module_that_branches_wants_a_test_file_of_its_name_and_one_that_only_holds_things_does_not(tmp_path) -> None:
    branches = (
        "def sign(x):\n    if x < 0:\n        return -1\n    return 1 if x else 0\n\nS = [sign(x) for x in (1, 2)]\n"
    )
    room = Room("tracker/fitting")
    for name, text in (("tested", branches), ("bare", branches), ("holder", "def one():\n    return 1\n")):
        path = tmp_path / "tracker" / "fitting" / f"{name}.py"
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)
        test = tmp_path / "tests" / "tracker" / "fitting" / "test_tested.py"
        test.parent.mkdir(parents=True, exist_ok=True)
        test.touch()
        add_module(room, path, tmp_path)
    assert room.unmirrored == ["tracker/fitting/bare.py"]


def test_every_room_is_there_with_its_tests(rooms) -> None:
    named = {room.name: room for room in rooms}
    assert named["tracker/terms"].test_lines > 0 and named["server/jobs"].kernels == []
    assert sum("tests" in name for name in named) == 0


def test_rules_of_tables_are_no_words() -> None:
    assert count_words("| what | mm |\n|---|---|\n| a hand | 0.3 |") == 5


def test_no_function_is_above_the_limits(rooms) -> None:
    above = [
        place
        for room in rooms
        for place, parameters, tangled in room.functions
        if parameters > MOST_PARAMETERS or tangled > MOST_COMPLEXITY
    ]
    assert above == [], "find the noun that is missing"


def test_every_room_has_two_lines_of_tests_for_five_of_its_own(rooms) -> None:
    thin = {room.name: room.test_lines / room.lines for room in rooms if room.test_lines < 0.4 * room.lines}
    assert thin == {}


def test_every_module_that_branches_has_a_test_file_of_its_name_but_those_that_others_run_whole(rooms) -> None:
    run_elsewhere = {
        "server/jobs/calibrate_workflow.py": "tests/server/calibrations/test_jobs.py",
        "server/jobs/track_workflow.py": "tests/server/jobs/test_worker.py",
        "server/moving_scans/body_set_routes.py": "tests/server/moving_scans/test_curation.py",
        "tracker/training/warm_up.py": "tests/server/cli/test_without_pybullet.py",
    }
    assert sorted(one for room in rooms for one in room.unmirrored) == sorted(run_elsewhere)
    assert [test for test in run_elsewhere.values() if not (ROOT / test).exists()] == []

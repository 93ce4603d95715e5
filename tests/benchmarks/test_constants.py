"""The benchmark that halves and doubles the tracker's numbers: it changes what it says it changes, and all of it."""

from __future__ import annotations

import ast
import importlib
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest

from benchmarks.constants.numbers import ROOT, ChangedNumber, Number, find_numbers, list_numbers
from benchmarks.constants.reached import choose_reached, find_names_at_import, record_calls
from benchmarks.constants.table import Outcome, write_table
from tracker.fitting.quality import Quality

USUAL = Outcome(80, 104, 5, 1, 20.0, ("a", "b"))


@pytest.fixture
def module(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[str]:
    """A module with a number, another that is worked out from it, and a function whose default it is."""
    text = "NEAR, FAR = 2.0, 3\nWIDE = 4 * NEAR\n\ndef reach(metres=NEAR):\n    return metres + FAR\n"
    (tmp_path / "module_with_numbers.py").write_text(text)
    monkeypatch.syspath_prepend(tmp_path)
    monkeypatch.setattr(sys, "meta_path", list(sys.meta_path))
    yield "module_with_numbers"
    sys.modules.pop("module_with_numbers", None)


def test_a_changed_number_reaches_what_is_worked_out_from_it_and_defaults_and_nothing_else(module: str) -> None:
    ChangedNumber(module, "NEAR", 5.0).install()
    changed = importlib.import_module(module)
    assert (changed.NEAR, changed.FAR, changed.WIDE, changed.reach()) == (5.0, 3, 20.0, 8.0)


def test_a_name_that_the_module_does_not_assign_is_an_error_and_not_a_run_that_changes_nothing(module: str) -> None:
    ChangedNumber(module, "NOWHERE", 5.0).install()
    with pytest.raises(ImportError, match="assigns no number to NOWHERE"):
        importlib.import_module(module)


def test_a_module_that_is_imported_already_cannot_be_changed(module: str) -> None:
    importlib.import_module(module)
    with pytest.raises(RuntimeError, match="is imported already"):
        ChangedNumber(module, "NEAR", 5.0).install()


def test_numbers_are_literals_in_capitals_at_the_top_those_of_a_tuple_too() -> None:
    text = "A = 1.5\nB, C = 2, -3\nD = 2 * A\nE = 'text'\nF = True\nlower = 4\ndef f():\n    G = 5\n"
    assert list(find_numbers(ast.parse(text))) == [("A", 1.5), ("B", 2), ("C", -3)]


@pytest.mark.parametrize(
    ("value", "factor", "wanted"), [(4, 2.0, 8), (1, 0.5, 1), (5, 0.5, 2), (0.3, 0.5, 0.15), (-2.0, 2.0, -4.0)]
)
def test_counts_stay_whole_and_at_least_one(value: float, factor: float, wanted: float) -> None:
    changed = Number("tracker.a", "A", value, False).times(factor)
    assert changed == pytest.approx(wanted) and type(changed) is type(value)


def test_every_number_of_the_tracker_that_is_listed_is_the_one_that_its_module_holds() -> None:
    for one in list_numbers():
        assert getattr(importlib.import_module(one.module), one.name) == one.value


def test_a_number_is_read_where_a_function_that_was_called_names_it_and_not_because_it_is_there() -> None:
    numbers = {f"{one.module}.{one.name}": one for one in list_numbers()}
    gain, elsewhere = numbers["tracker.fitting.quality.COVERAGE_GAIN"], numbers["tracker.fitting.quality.ELSEWHERE"]
    quality = Quality(0.002, 0.9, 0.9, 0.9, 0.8, 0.9, 0.0, 0.0, 4e-3)
    with record_calls() as called:
        quality.merit  # noqa: B018
    assert choose_reached([gain, elsewhere], called) == [gain]


def test_numbers_that_kernels_take_in_and_that_are_read_at_import_count_as_read_by_every_run() -> None:
    compiled = Number("tracker.terms.collision", "REACH", 4.0, True)
    origins = [
        module for module, name in find_names_at_import(ROOT / "tracker/tracking/fit_views.py") if name == "REACH"
    ]
    assert len(origins) == 1, "FAR_REACH is worked out from it"
    at_import, unread = Number(origins[0], "REACH", 15.0, False), Number("tracker.search.find_again", "STEPS", 8, False)
    assert choose_reached([compiled, at_import, unread], set()) == [compiled, at_import]


def test_the_table_tells_unchanged_changed_failed_and_unread_numbers_apart() -> None:
    same, other, broken, unread = (Number("tracker.a.b", name, 2, False) for name in ("SAME", "OTHER", "BROKEN", "NO"))
    found = {
        (one, factor): Outcome(80, 104, 5, 1, 30.0, ("a", "b")) for one in (same, other, broken) for factor in (0.5, 2)
    }
    found[other, 2] = Outcome(77, 104, 6, 1, 20.0, ("a", "c"))
    found[broken, 0.5] = Outcome(failed="ValueError")
    kernel = Number("tracker.a.b", "KERNEL", 0.5, True)
    assert write_table([same, other, broken, unread, kernel], USUAL, found).splitlines()[2:] == [
        "| a.b.SAME | 2 | same | | | 1.50 | same | | | 1.50 |",
        "| a.b.OTHER | 2 | same | | | 1.50 | -3 | +1 | +0 | 1.00 |",
        "| a.b.BROKEN | 2 | fails | | |  | same | | | 1.50 |",
        "| a.b.NO | 2 | not read | | | | | | | |",
        "| a.b.KERNEL | 0.5 | kernel | | | | | | | |",
    ]

"""JSON beside uploads: whatever is sent, the answer says what came and what is needed."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from server.errors import InvalidError
from server.exchange.routes import parse_options as parse_label_options
from server.imports.service import parse_options as parse_import_options
from server.scans.adding import parse_options as parse_scan_options
from server.scans.folder import find_scans

DEEP = "[" * 100_000
HOSTILE = ["{", DEEP, "[]", "5", '"x"', "\x00", '{"a": ' + "9" * 5000 + "}", '{"nothing of the kind": 1}']


@pytest.mark.parametrize("parse", [parse_label_options, parse_scan_options, parse_import_options])
@pytest.mark.parametrize("text", HOSTILE, ids=lambda text: text[:12])
def test_options_that_are_none_are_refused_in_words(parse, text: str) -> None:
    with pytest.raises(Exception, match=r"needed|knows no|not permitted|options") as fault:
        parse(text)
    assert len(str(fault.value)) < 600


def test_a_unit_is_a_number_and_not_true() -> None:
    assert parse_scan_options('{"metres_per_unit": 1}').metres_per_unit == 1.0
    with pytest.raises(InvalidError, match="metres_per_unit"):
        parse_scan_options('{"metres_per_unit": true}')


@pytest.mark.parametrize(
    "listed",
    [DEEP, "{}", '{"scans": 5}', '["hand.ply"]', '[{"file": "hand.ply", "metres_per_unit": true}]', "\udcff"],
    ids=lambda text: text[:12],
)
def test_a_list_of_scans_that_is_none_is_refused_in_words(tmp_path: Path, listed: str) -> None:
    (tmp_path / "hand.ply").write_bytes(b"")
    (tmp_path / "scans.json").write_bytes(listed.encode("utf-8", "surrogateescape"))
    with pytest.raises(InvalidError, match=r"^scans\.json .*needed a list of objects") as fault:
        find_scans(tmp_path)
    assert len(str(fault.value)) < 600


def test_a_list_that_is_one_is_read(tmp_path: Path) -> None:
    (tmp_path / "hand.ply").write_bytes(b"")
    (tmp_path / "scans.json").write_text(json.dumps([{"file": "hand.ply", "metres_per_unit": 0.001}]))
    assert find_scans(tmp_path).listed["hand.ply"].metres_per_unit == 0.001

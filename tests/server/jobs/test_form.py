"""The form of a tracking job: every option of the tracker, the studio's own models, and presets that fit them."""

from __future__ import annotations

import dataclasses
from datetime import timedelta

import pytest

from server.database import Database, utc_now
from server.detectors.models import DetectorRow
from server.hand_models.models import HandModelRow
from server.jobs import form as form_module
from server.jobs.form import track_form
from server.jobs.service import DETECTOR, HAND_MODEL
from server.jobs.track_schemas import JobForm, JobFormField
from tracker import BUILT_IN_HANDS, PRESETS, TrackOptions, find_physics_fault


@pytest.fixture
def database_kind() -> str:
    """One will do: what is asked here are plain queries."""
    return "sqlite"


def make(database: Database) -> JobForm:
    with database.reading() as session:
        return track_form(session)


def field(form: JobForm, name: str) -> JobFormField:
    [found] = [one for one in form.fields if one.name == name]
    return found


def add_models(database: Database, count: int, deleted: int | None = None) -> list[str]:
    """Ids of hand models, the newest first, without the deleted one."""
    with database.writing() as session:
        rows = [
            HandModelRow(
                name=f"hand {number}",
                kind="trained",
                side="right",
                digest="0" * 64,
                facts={},
                created_at=utc_now() + timedelta(seconds=number),
                deleted_at=utc_now() if number == deleted else None,
            )
            for number in range(count)
        ]
        session.add_all(rows)
        session.flush()
        return [str(row.id) for row in rows[::-1] if row.deleted_at is None]


def test_every_option_of_the_tracker_is_a_field_of_its_type_with_its_default_and_help(database: Database) -> None:
    form, defaults = make(database), TrackOptions().to_json()
    names = [option.name for option in dataclasses.fields(TrackOptions)]
    assert [one.name for one in form.fields] == [*names, HAND_MODEL, DETECTOR]
    types = {bool: "boolean", int: "integer", float: "number", str: "text"}
    for name in names:
        found = field(form, name)
        assert (found.default, found.type) == (defaults[name], types[type(defaults[name])]), name
        assert found.label and found.help.endswith("."), name
        if found.choices is not None:
            assert found.default in found.choices and len(found.choices) == len(found.choice_labels or []), name


def test_presets_are_values_that_fields_offer_and_the_usual_one_is_among_them(database: Database) -> None:
    form = make(database)
    assert form.usual_preset in [preset.name for preset in form.presets]
    for preset in form.presets:
        for name, value in preset.values.items():
            found = field(form, name)
            assert found.about == "method" and (found.choices is None or value in found.choices), (preset.name, name)


def test_without_physics_its_terms_and_presets_are_not_offered_and_the_field_says_why(database, monkeypatch) -> None:
    if find_physics_fault():
        pytest.skip("here physics is never offered")
    with_physics = make(database)
    monkeypatch.setattr("tracker.find_physics_fault", lambda: "Physics needs pybullet.")
    without = make(database)
    terms = field(without, "terms")
    assert terms.help == f"{field(with_physics, 'terms').help} Physics needs pybullet."
    left = [name for name in field(with_physics, "terms").choices or [] if "P" not in name.partition("+")[2]]
    assert terms.choices == left and len(terms.choice_labels or []) == len(left)
    assert all(preset.values["terms"] in left for preset in without.presets)
    assert 0 < len(without.presets) < len(PRESETS)


def test_hands_that_come_with_handloom_are_offered_before_the_studios_own_newest_first(database: Database) -> None:
    own = add_models(database, 3, deleted=1)
    found = field(make(database), HAND_MODEL)
    assert found.choices == ["", *BUILT_IN_HANDS, *own] and found.default == ""
    assert (found.choice_labels or [])[-2:] == ["hand 2", "hand 0"]


def test_of_many_models_the_newest_are_offered(database: Database, monkeypatch) -> None:
    monkeypatch.setattr(form_module, "MOST_OFFERED", 2)
    own = add_models(database, 4)
    assert (field(make(database), HAND_MODEL).choices or [])[-3:] == [[*BUILT_IN_HANDS][-1], *own[:2]]


def test_a_detector_of_ones_own_is_offered_beside_the_one_there_is(database: Database) -> None:
    with database.writing() as session:
        row = DetectorRow(name="our detector", looks_at="depth", trees=3, byte_count=1, digest="0" * 64)
        session.add(row)
        session.flush()
        id_ = str(row.id)
    found = field(make(database), DETECTOR)
    assert found.choices == ["", id_] and found.choice_labels == ["The one that comes with Handloom", "our detector"]

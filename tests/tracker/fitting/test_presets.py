"""Options that go together."""

from __future__ import annotations

import dataclasses

import pytest

from tracker.errors import TrackingError
from tracker.fitting.options import TERM_LABELS, TERMS, TrackOptions
from tracker.fitting.presets import PRESETS, USUAL_PRESET, find_preset


@pytest.mark.parametrize("preset", PRESETS, ids=lambda preset: preset.name)
def test_a_preset_is_values_that_the_tracker_takes_one_sentence_and_a_measured_cost(preset):
    options = TrackOptions.from_json(preset.values)
    assert preset.values.items() <= options.to_json().items()
    assert preset.help.endswith(".") and preset.help.count(". ") == 0
    assert 0.0 < preset.one_hand_ms < preset.two_hands_and_object_ms
    assert find_preset(preset.name) is preset


def test_no_two_presets_are_the_same_and_forms_begin_with_one_of_them():
    assert len({tuple(sorted(preset.values.items())) for preset in PRESETS}) == len(PRESETS)
    assert find_preset(USUAL_PRESET) in PRESETS


def test_a_preset_that_there_is_not_is_refused_with_those_there_are():
    with pytest.raises(TrackingError, match="fast, balanced, plausible, t16"):
        find_preset("best")


def test_every_option_has_a_label_a_sentence_and_if_it_is_a_number_its_bounds():
    for option in dataclasses.fields(TrackOptions):
        assert option.metadata["label"]
        assert option.metadata["help"].endswith(".")
        is_number = isinstance(option.default, int | float) and not isinstance(option.default, bool)
        assert is_number == ("low" in option.metadata) == ("high" in option.metadata)
        for bound in ("low", "high") if is_number else ():
            assert TrackOptions.from_json({option.name: option.metadata[bound]})
    assert tuple(TERM_LABELS) == TERMS

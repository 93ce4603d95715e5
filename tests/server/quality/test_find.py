"""All checks together: each label once for each kind, the worst first, and what each check lacked."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from server.quality.find import MISSING, Coverage, Setting, check_labels, find_flags
from server.quality.finding import KINDS
from server.quality.witnesses import TrackedHands
from tests.server.quality.drawn_hands import FAR_M, cameras, draw_hand, label

ONE = Setting(("right",), cameras(1))


def cover(labels, setting: Setting) -> dict[str, Coverage]:
    return {one.kind: one for one in check_labels(labels, setting).coverage}


def spoil(joint: int = 8, by: float = -900.0, **more):
    """A label with a joint outside its image."""
    pixels = draw_hand()
    pixels[joint, 0] += by
    return label(pixels, **more)


def test_nothing_to_check_finds_nothing_and_names_every_check_without_a_lack() -> None:
    found = check_labels([], ONE)
    assert found.findings == [] and [one.kind for one in found.coverage] == list(KINDS)
    assert {one.missing for one in found.coverage} == {""} and {one.labels for one in found.coverage} == {frozenset()}


def test_a_good_label_raises_nothing() -> None:
    assert find_flags([label()], ONE) == []


def test_a_kind_is_told_once_for_a_label_by_its_worst_finding() -> None:
    depths = np.full(21, FAR_M)
    depths[[4, 8, 12]] = 1.5
    far = replace(label(depths=depths), around=replace(label(depths=depths).around, to_depth=np.full(21, 200.0)))
    found = find_flags([far], ONE)
    [background] = [one for one in found if one.kind == "background"]
    limit = 0.15 * far.size_px
    assert background.score == pytest.approx(max(200.0 / limit, 1.0 + (1.5 - (1.35 * FAR_M + 0.1)) / 0.3))
    assert len({(one.label.id, one.kind) for one in found}) == len(found)


def test_the_worst_finding_comes_first_and_equal_ones_in_an_order_that_is_always_the_same(rng) -> None:
    labels = [spoil(by=-400.0 - 50 * number, frame=100 * number) for number in range(4)]
    found = find_flags(labels, ONE)
    assert [one.score for one in found] == sorted((one.score for one in found), reverse=True)
    key = [(one.label.id, one.kind) for one in found]
    shuffled = [labels[place] for place in rng.permutation(4)]
    assert [(one.label.id, one.kind) for one in find_flags(shuffled, ONE)] == key


def test_a_check_that_looked_at_every_label_lacks_nothing() -> None:
    labels = [label(), label(frame=40)]
    outside = cover(labels, ONE)["outside"]
    assert (outside.labels, outside.missing) == ({one.id for one in labels}, "")


@pytest.mark.parametrize(
    ("kind", "setting", "told"),
    [
        ("residual", ONE, "there is no track"),
        ("residual", replace(ONE, track_missing="Track 1 lost it"), "Track 1 lost it"),
        ("reprojection", ONE, "this recording has one camera"),
        ("reprojection", Setting(("right",), cameras(2)), MISSING["reprojection"]),
        ("depth", replace(ONE, has_depth=False), "this recording has no depth"),
        ("depth", ONE, MISSING["depth"]),
        ("jump", ONE, MISSING["jump"]),
        ("detector", ONE, MISSING["detector"]),
    ],
)
def test_what_a_check_lacked_for_a_lonely_label_is_said(kind: str, setting: Setting, told: str) -> None:
    found = cover([label(depths=np.nan)], setting)[kind]
    assert (found.labels, found.missing) == (frozenset(), told)


def test_a_check_that_some_labels_had_nothing_for_says_so_and_names_the_others() -> None:
    tracked = TrackedHands({("cam0", 0, "right"): draw_hand()})
    compared, other = label(), label(frame=40)
    found = cover([compared, other], replace(ONE, tracked=tracked, track_missing="it does not reach"))["residual"]
    assert (found.labels, found.missing) == ({compared.id}, "it does not reach")


def test_every_kind_that_can_lack_something_has_its_words() -> None:
    assert set(MISSING) == set(KINDS)
    assert [kind for kind, words in MISSING.items() if not words] == ["outside", "residual"]

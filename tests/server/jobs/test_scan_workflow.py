"""The bar of a loop: every part in its turn, without gaps, each as long as it usually takes."""

from __future__ import annotations

from itertools import pairwise

import pytest

from server.jobs.scan_workflow import COLD, TRAINED, TRAINING, WARM, plan_loop
from tracker.evaluation import STUDY_LEVELS


@pytest.mark.parametrize("rounds", [1, 3, 10])
@pytest.mark.parametrize("registers_first", [True, False])
def test_the_bar_of_a_loop_is_filled_without_gaps(rounds: int, registers_first: bool) -> None:
    spans = plan_loop(rounds, registers_first)
    assert len(spans) == 2 * rounds + registers_first
    assert spans[0][0] == 0.0 and spans[-1][1] == 1.0
    assert all(before[1] == after[0] for before, after in pairwise(spans))


def test_each_part_is_as_long_as_it_takes() -> None:
    parts = [COLD, TRAINING, WARM, TRAINING, WARM]
    lengths = [end - begin for begin, end in plan_loop(2, registers_first=True)]
    assert lengths == pytest.approx([part / sum(parts) for part in parts])
    assert [end - begin for begin, end in plan_loop(1, registers_first=False)] == pytest.approx([1 / 3, 2 / 3])


def test_the_more_is_judged_the_smaller_is_the_share_of_training() -> None:
    assert set(TRAINED) == {"no", *STUDY_LEVELS}
    assert 1.0 == TRAINED["no"] > TRAINED["quick"] > TRAINED["full"] > 0.0

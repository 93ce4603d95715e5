"""What the verdict says of a real hand in poses that no limit was chosen on."""

from pathlib import Path

import pytest

from benchmarks.reposed_scans import find_pose, repose
from benchmarks.scan_rotations import METRES_PER_UNIT
from benchmarks.verdict_limits import Known, make_starts
from tracker.capture.scan import load_scan
from tracker.model.untrained_hand import untrained_hand
from tracker.registration.register import Registrar


@pytest.mark.slow
@pytest.mark.shared_data
def test_a_flat_hand_of_the_other_side_is_told_if_turning_it_over_takes_many_steps(shared_data: Path):
    registrar = Registrar(untrained_hand())
    rest = load_scan(shared_data / "hand_scans" / "4_rest.obj", METRES_PER_UNIT)
    scan, truth = repose(rest, registrar.register(rest), find_pose(registrar, 31, "flat_together"))
    known = Known("reposed", "4_rest: flat_together of 31", scan, "left", truth, truth[untrained_hand().tips])
    starts = dict(make_starts(known, registrar))
    verdicts = {what: registrar.register(scan, start=starts[what]).verdict for what in ("true", "other side")}
    assert verdicts == {"true": "good", "other side": "doubtful"}

"""How long a scan takes is told cold and warm; numbers of scans out of limits are refused before any is made."""

from __future__ import annotations

import pytest

from tracker.cli.__main__ import main
from tracker.cli.bench_registration import show


@pytest.mark.parametrize("scans", ["0", "-3", "1001"])
def test_a_number_of_scans_out_of_its_limits_is_refused(scans: str, capsys) -> None:
    assert main(["bench", "registration", "--scans", scans]) == 2
    assert f"--scans {scans}: needed 1 to 1000." in capsys.readouterr().err


def test_cold_and_warm_have_a_line_each_with_their_stages_in_order() -> None:
    runs = {
        name: {"median_s": median, "p95_s": 2 * median, "stages_s": {"search": 0.5, "fit": median - 0.5}}
        for name, median in (("cold", 3.0), ("warm", 1.25))
    }
    assert show(runs | {"scans": 20, "points": 50_000, "right": 19}).splitlines() == [
        "20 scans of 50000 points, 19 of them right",
        "cold: median 3.00 s a scan (p95 6.00); search 0.50, fit 2.50",
        "warm: median 1.25 s a scan (p95 2.50); search 0.50, fit 0.75",
    ]

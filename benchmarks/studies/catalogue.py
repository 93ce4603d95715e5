"""All studies, in the order of the report."""

from __future__ import annotations

from benchmarks.studies import (
    bars,
    figure_13,
    figure_16,
    per_sequence,
    table_02,
    table_03,
    table_04,
    table_05,
    table_06,
    table_06_as_written,
    table_08,
    table_11,
    table_12,
    table_13,
)
from benchmarks.studies.study import Study

STUDIES: tuple[Study, ...] = (
    bars.STUDY,
    table_02.STUDY,
    table_03.STUDY,
    table_04.STUDY,
    table_05.STUDY,
    table_06.STUDY,
    table_06_as_written.STUDY,
    per_sequence.TABLE_7,
    table_08.STUDY,
    table_11.STUDY,
    table_12.STUDY,
    table_13.STUDY,
    per_sequence.TABLE_14,
    figure_13.STUDY,
    figure_16.STUDY,
)

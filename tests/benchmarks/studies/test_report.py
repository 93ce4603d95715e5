"""The report is built from rows alone, in Markdown and HTML, and says what was not run or is not to be quoted."""

from __future__ import annotations

from html.parser import HTMLParser

import pytest

from benchmarks.studies import paper
from benchmarks.studies.bars import show as show_bars
from benchmarks.studies.blocks import Picture, Section, Table, Text
from benchmarks.studies.catalogue import STUDIES
from benchmarks.studies.markdown import write_markdown
from benchmarks.studies.page import write_page
from benchmarks.studies.plots import Lines, Series, draw_plot
from benchmarks.studies.report import StudyRows, build_sections, load_all_rows, load_rows, write_report
from benchmarks.studies.study import Extent, Study
from benchmarks.studies.table_06_as_written import BAR_PX
from benchmarks.studies.trial import ROOT, Trial


def toy_study() -> Study:
    def show(rows):
        drawn = draw_plot([Lines("Error", "n", "px", [Series("ours", [1, 2], [row["px"] for row in rows])])], "toy")
        cells = tuple((str(row["n"]), f"{row['px']:.2f}", "5.12") for row in rows)
        return [
            Table(("n", "mean px", "T16 mean px"), cells),
            Picture("toy", drawn, "A toy."),
            Text("**Bold** `a < b`."),
        ]

    return Study("toy", "A toy", "Table 0", "Does it work?", "This.", "That.", lambda e: [], lambda r, e: [], show)


class Balanced(HTMLParser):
    """Fails where tags do not close."""

    def __init__(self):
        super().__init__()
        self.open: list[str] = []
        self.counts: dict[str, int] = {}

    def handle_starttag(self, tag, attrs):
        self.counts[tag] = self.counts.get(tag, 0) + 1
        if tag not in ("meta", "br"):
            self.open.append(tag)

    def handle_endtag(self, tag):
        assert self.open.pop() == tag


def rows_of(quick: bool = False) -> dict[str, StudyRows]:
    rows = [{"n": 1, "px": 0.5}, {"n": 2, "px": 0.25}]
    return {"toy": StudyRows("toy", quick, ["abc"], rows)}


def test_rows_come_back_from_their_file(tmp_path):
    own = rows_of()["toy"]
    own.save(tmp_path)
    assert load_rows("toy", tmp_path) == own
    assert load_rows("other", tmp_path) is None


def test_the_files_hold_the_rows_and_the_plot(tmp_path):
    written = write_report([toy_study()], rows_of(), tmp_path)
    assert sorted(path.relative_to(tmp_path).as_posix() for path in written) == [
        "studies.md",
        "studies/report.html",
        "studies/toy.svg",
    ]
    page = (tmp_path / "studies.md").read_text()
    assert "| 1 | 0.50 | 5.12 |\n| 2 | 0.25 | 5.12 |" in page
    assert "![A toy.](studies/toy.svg)" in page
    assert "one state of the code (abc)" in page
    assert "not the pixels" in page


def test_the_page_is_whole_and_alone(tmp_path):
    write_report([toy_study()], rows_of(), tmp_path)
    html = (tmp_path / "studies" / "report.html").read_text()
    parser = Balanced()
    parser.feed(html)
    assert parser.open == [] and parser.counts["svg"] == 1 and parser.counts["table"] == 1
    assert '<td class="t16">5.12</td>' in html
    assert "<strong>Bold</strong> <code>a &lt; b</code>" in html
    assert "prefers-color-scheme:dark" in html
    assert "src=" not in html and "<script" not in html, "it needs nothing else"


def test_what_was_not_run_and_what_was_only_tried_is_said():
    (missing,) = build_sections([toy_study()], {})
    assert missing.blocks == (Text("Not run."),)
    (tried,) = build_sections([toy_study()], rows_of(quick=True))
    assert "Not to be quoted" in tried.blocks[0].text


def test_a_missed_bar_stands_out_and_one_without_result_is_neither():
    common = {"group": "speed", "note": "", "ratio": 0.9}
    rows = [
        {**common, "what": "fast", "measured": "14 ms", "is_met": True},
        {**common, "what": "faster", "measured": "40 ms", "is_met": False},
        {**common, "what": "fastest", "measured": "not measured", "is_met": None, "ratio": None},
    ]
    text = write_markdown("t", [], [Section("b", "B", "p", "q", "", "", tuple(show_bars(rows)))])
    assert "**1 of 3 met**, 1 not met, 1 not measured." in text
    assert "| faster | 40 ms | 90 % | **not met** |" in text
    html = write_page("t", [], [Section("b", "B", "p", "q", "", "", tuple(show_bars(rows)))])
    assert '<td class="unmet"><strong>not met</strong></td>' in html


@pytest.mark.parametrize("study", STUDIES, ids=lambda study: study.name)
def test_every_study_names_its_trials_and_says_what_is_comparable(study):
    for extent in (Extent(), Extent(quick=True)):
        trials = study.trials(extent)
        assert trials and all(isinstance(trial, Trial) for trial in trials)
        assert len({hash(trial) for trial in trials}) <= len(trials)
    assert study.same and study.differs and study.question.endswith("?")


def test_every_table_and_figure_that_was_asked_for_has_a_study():
    wanted = {f"table_{n:02d}" for n in (2, 3, 4, 5, 6, 7, 8, 11, 12, 13, 14)} | {"figure_13", "figure_16", "bars"}
    assert {study.name for study in STUDIES} == wanted | {"table_06_as_written"}


def test_the_committed_report_is_what_its_rows_say(tmp_path):
    """After a change of its words: `python -m benchmarks.studies DATA --report --write`."""
    results = ROOT / "benchmarks" / "results"
    rows = load_all_rows(STUDIES, results / "studies" / "rows")
    assert bool(rows) == (results / "studies.md").exists(), "the report and its rows are committed together"
    if rows:
        for written in write_report(STUDIES, rows, tmp_path):
            assert written.read_text() == (results / written.relative_to(tmp_path)).read_text(), written.name
        size = sum(path.stat().st_size for path in (results / "studies").rglob("*") if path.is_file())
        assert size < 1e6, "the report stays small"
        assert not any(own.quick for own in rows.values()), "trial runs are not committed"


def test_rows_come_from_the_first_folder_that_has_them(tmp_path):
    rows_of()["toy"].save(tmp_path / "b")
    rows_of(quick=True)["toy"].save(tmp_path / "a")
    assert load_all_rows([toy_study()], tmp_path / "a", tmp_path / "b")["toy"].quick
    assert not load_all_rows([toy_study()], tmp_path / "none", tmp_path / "b")["toy"].quick


def test_the_papers_method_as_written_meets_its_bar_and_stands_beside_the_papers_figures():
    kept = load_rows("table_06_as_written", ROOT / "benchmarks" / "results" / "studies" / "rows")
    assert kept is not None and not kept.quick
    whole = next(row for row in kept.rows if row["kind"] == "hands" and row["paper"] == "LO+SC")
    assert whole["sequences"] == 4 and whole["failed"] == 0 and whole["px"] <= BAR_PX
    assert {row["paper"] for row in kept.rows if row["kind"] == "hands"} == set(paper.TABLE_6)
    for row in kept.rows:
        if row["kind"] == "pair":
            assert row["low"] <= row["px"] <= row["high"]

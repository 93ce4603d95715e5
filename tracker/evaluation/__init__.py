"""Metrics: a track against annotations, against the truth, against the depth image."""

from __future__ import annotations

from typing import TYPE_CHECKING

from tracker.lazy_names import offer

if TYPE_CHECKING:
    from tracker.evaluation.comparison import JudgedTrack, compare_tracks
    from tracker.evaluation.depth_distance import measure_depth_distances
    from tracker.evaluation.evaluation import Evaluation, evaluate_track
    from tracker.evaluation.held_out import HeldOut, choose_held_out, make_test_hand
    from tracker.evaluation.held_out_study import STUDY_LEVELS, study_held_out
    from tracker.evaluation.model_report_html import write_model_html
    from tracker.evaluation.model_study import generalize_shapes
    from tracker.evaluation.report_csv import write_csv
    from tracker.evaluation.report_html import write_html
    from tracker.evaluation.statistics import Statistics, compute_statistics
    from tracker.evaluation.surface_distance import compute_surface_distances
    from tracker.evaluation.truth_error import TruthError, evaluate_against_truth
    from tracker.evaluation.worst_picture import draw_item, encode_jpeg

__getattr__, __dir__ = offer(__name__)

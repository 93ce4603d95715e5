"""Metrics: a track against annotations, against the truth, against the depth image."""

from tracker.evaluation.depth_distance import measure_depth_distances
from tracker.evaluation.evaluation import Evaluation, evaluate_track
from tracker.evaluation.statistics import Statistics, compute_statistics
from tracker.evaluation.surface_distance import compute_surface_distances
from tracker.evaluation.truth_error import TruthError, evaluate_against_truth

__all__ = [
    "Evaluation",
    "Statistics",
    "TruthError",
    "compute_statistics",
    "compute_surface_distances",
    "evaluate_against_truth",
    "evaluate_track",
    "measure_depth_distances",
]

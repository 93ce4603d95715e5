"""Trackers of others, written anew on our model, renderer and data, to compare ours with."""

from benchmarks.baselines.swarm_options import SwarmOptions
from benchmarks.baselines.swarm_tracker import track_with_swarm

__all__ = ["SwarmOptions", "track_with_swarm"]

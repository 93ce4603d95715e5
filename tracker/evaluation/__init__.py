"""Metrics of a track against annotations or truth."""

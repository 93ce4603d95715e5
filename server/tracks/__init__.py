"""Tracks: what a tracking job found, frame by frame."""

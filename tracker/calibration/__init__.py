"""Cameras from filmed boards: lenses, places, time offsets, and how well they agree on frames that were left out."""

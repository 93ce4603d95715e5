"""Z-buffer rendering of posed models."""

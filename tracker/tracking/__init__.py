"""Algorithm 1 of T16: start, follow, calibrate."""

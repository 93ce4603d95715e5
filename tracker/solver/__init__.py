"""Gauss-Newton on residual blocks. Knows nothing about hands."""

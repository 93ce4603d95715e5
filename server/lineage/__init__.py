"""Lineage: where a thing that was made of scans comes from, and what came of it."""

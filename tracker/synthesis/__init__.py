"""Recordings with known pose."""

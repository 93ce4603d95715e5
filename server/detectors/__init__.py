"""Fingertip detectors that labs have trained, for tracking jobs."""

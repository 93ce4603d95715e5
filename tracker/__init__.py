"""Handloom's science: frames and scans in, poses and models out. Runs without the server."""

"""Recordings: their rows, their files, their images."""

"""Cameras, frames, sequences and importers: bytes in, frames out."""

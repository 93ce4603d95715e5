"""Tracks as files for other programs: npz, CSV, glTF animation, MANO-style parameters."""

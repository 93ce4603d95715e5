"""What a model's file may hold at most, of whatever kind: bounds of our own, so that a hostile file costs little."""

MAX_BYTES = 256 * 2**20
"""Of a file, of what it unpacks to, or of one array."""

MAX_VERTICES = 500_000
"""Of a mesh; a MANO hand has 778, SMPL-H 6890."""

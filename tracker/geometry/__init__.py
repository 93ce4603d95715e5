"""Geometry: rigid motions, lines, meshes. Knows nothing of hands or cameras."""

"""Rendered hands before several colour cameras: what [T16] §4.4.1 measures."""

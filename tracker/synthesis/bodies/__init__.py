"""Scans of whole people whose truth is known, still and moving."""

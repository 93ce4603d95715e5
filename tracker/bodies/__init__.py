"""Scans of whole people with their hands, still and moving: [R17] section 4."""

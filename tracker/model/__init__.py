"""Hands, objects and their files; how a pose moves them. Knows no cameras."""

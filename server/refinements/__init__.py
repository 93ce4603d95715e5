"""Cameras of recordings, refined from labels: shown, taken by a person, put back."""

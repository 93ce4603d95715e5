"""Uploads on their way to become recordings: checked, reported, confirmed or refused."""

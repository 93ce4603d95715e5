"""Registrations that a hand model is trained from, kept as they are."""

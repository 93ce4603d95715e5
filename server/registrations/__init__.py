"""Registrations: the template brought onto a scan, and how well that seems to have gone."""

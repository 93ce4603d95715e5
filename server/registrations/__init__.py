"""Registrations: the template fitted to a scan, and how good that fit seems."""

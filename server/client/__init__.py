"""A small client of the studio's API for scripts; it needs httpx and nothing else of Handloom."""

from server.client.answers import StaleError, StudioRefusal, StudioUnreachable
from server.client.jobs import JobFailed
from server.client.studio import Studio

__all__ = ["JobFailed", "StaleError", "Studio", "StudioRefusal", "StudioUnreachable"]

"""The studio as one web application: its API, the browser app, the viewer behind it."""

from server.app.app import create_app

__all__ = ["create_app"]

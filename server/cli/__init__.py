"""The command `handloom`. Importing this costs little: every command loads what it needs when it runs."""

from server.cli.main import main

__all__ = ["main"]

"""Secrets that open the studio: made here, shown once, kept as their hash only."""

from __future__ import annotations

import hashlib
import secrets
from typing import Literal

Kind = Literal["login", "token", "code"]
TOKEN_PREFIX = "handloom_"
"""So that a token is known for what it is, by people and by scanners of source code."""


def make_secret(kind: Kind) -> str:
    """256 random bits as text."""
    return f"{TOKEN_PREFIX if kind == 'token' else ''}{secrets.token_urlsafe(32)}"


def hash_secret(kind: Kind, secret: str) -> str:
    """What is kept of a secret. It has 256 bits, so a quick hash does; a secret of one kind is none of another."""
    return hashlib.sha256(f"{kind}:{secret}".encode(errors="replace")).hexdigest()

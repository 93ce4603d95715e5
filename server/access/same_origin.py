"""Which hosts and which pages may talk to the studio.

A browser on this machine runs pages of any site, and they reach loopback. So a request must be addressed to a host
name that is ours (or a foreign name was made to point here: DNS rebinding), and a page that writes or opens a socket
must be our own.
"""

from __future__ import annotations

from functools import lru_cache
from urllib.parse import urlsplit

from starlette.datastructures import Headers

from server.settings import LOOPBACK_HOSTS, Settings

SAFE_METHODS = frozenset({"GET", "HEAD", "OPTIONS"})


@lru_cache(maxsize=100)
def parse_host(host: str) -> str | None:
    """The name in a `Host` header, without its port and in lower case; None when it is no host."""
    try:
        parts = urlsplit(f"//{host}")
        port_is_valid = parts.port is None or parts.port > 0
    except ValueError:
        return None
    has_more = parts.path or parts.query or parts.fragment or parts.username is not None
    return parts.hostname if port_is_valid and not has_more else None


def find_host_fault(headers: Headers, settings: Settings, reached: str | None = None) -> str:
    """Why a request to this host is refused; empty when it is not.

    Args:
        reached: The IP address that the connection came to. Where people log in, it may be named instead of a name: an
            address cannot be made to point elsewhere.
    """
    names = headers.getlist("host")
    if len(names) != 1:
        return f"The request has {len(names)} Host headers; needed one."
    name = parse_host(names[0])
    allowed = {*LOOPBACK_HOSTS, settings.host.lower(), *(host.lower() for host in settings.allowed_hosts)}
    is_reached = settings.is_login_needed and name is not None and name == reached
    if not is_reached and (name is None or name not in allowed):
        return (
            f"The studio does not answer to the host {names[0]!r}. Open it at 127.0.0.1 or localhost, or name the host "
            "in HANDLOOM_ALLOWED_HOSTS."
        )
    return ""


def find_origin_fault(headers: Headers, settings: Settings) -> str:
    """Why a page of this origin may not write or open a socket; empty when it may.

    Scripts and command lines send no `Origin`; browsers always do when it matters.
    """
    origins = headers.getlist("origin")
    if not origins:
        if headers.get("sec-fetch-site", "same-origin") not in ("same-origin", "none"):
            return "Pages of other sites may not write here."
        return ""
    if len(origins) != 1:
        return "The request has several Origin headers; needed one."
    origin = origins[0]
    own = {f"http://{headers.get('host', '')}", f"https://{headers.get('host', '')}"}
    if origin.lower() in {name.lower().rstrip("/") for name in (*own, *settings.allowed_origins)}:
        return ""
    return f"Pages of {origin!r} may not write here. If they are yours, name the origin in HANDLOOM_ALLOWED_ORIGINS."

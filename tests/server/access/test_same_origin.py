"""Which hosts and which pages may talk to the studio."""

from __future__ import annotations

from typing import Any

import pytest
from starlette.datastructures import Headers

from server.access.same_origin import find_host_fault, find_origin_fault, parse_host
from server.settings import Settings


def make_settings(**given: Any) -> Settings:
    return Settings(database_url="sqlite://", **given)


@pytest.mark.parametrize(
    ("host", "name"),
    [
        ("localhost:8000", "localhost"),
        ("LAB.example", "lab.example"),
        ("[::1]:8000", "::1"),
        ("127.0.0.1", "127.0.0.1"),
        ("host:port", None),
        ("user@localhost", None),
        ("localhost/path", None),
        ("localhost?x", None),
        ("localhost:99999", None),
        ("[::1", None),
        ("", None),
    ],
)
def test_a_host_is_its_name_without_the_port(host: str, name: str | None) -> None:
    assert parse_host(host) == name


@pytest.mark.parametrize("host", ["localhost:8000", "127.0.0.1:8000", "[::1]:8000", "lab.example"])
def test_hosts_of_ours_are_answered(host: str) -> None:
    assert find_host_fault(Headers({"host": host}), make_settings(allowed_hosts=["Lab.Example"])) == ""


@pytest.mark.parametrize("host", ["evil.example", "localhost.evil.example", "10.0.0.5", ""])
def test_a_foreign_name_that_points_here_is_refused_with_what_to_do(host: str) -> None:
    assert "HANDLOOM_ALLOWED_HOSTS" in find_host_fault(Headers({"host": host}), make_settings(), "10.0.0.5")


@pytest.mark.parametrize("raw", [[], [(b"host", b"localhost"), (b"host", b"evil.example")]])
def test_a_request_names_one_host(raw: list[tuple[bytes, bytes]]) -> None:
    assert f"has {len(raw)} Host headers" in find_host_fault(Headers(raw=raw), make_settings())


@pytest.mark.parametrize(
    ("headers", "is_allowed"),
    [
        ({}, True),
        ({"origin": "http://localhost:8000"}, True),
        ({"origin": "https://localhost:8000"}, True),
        ({"origin": "HTTP://LOCALHOST:8000"}, True),
        ({"origin": "https://annotate.example"}, True),
        ({"origin": "http://localhost:9000"}, False),
        ({"origin": "http://evil.example"}, False),
        ({"origin": "null"}, False),
        ({"sec-fetch-site": "same-origin"}, True),
        ({"sec-fetch-site": "none"}, True),
        ({"sec-fetch-site": "cross-site"}, False),
        ({"sec-fetch-site": "same-site"}, False),
    ],
)
def test_only_our_own_pages_and_scripts_write(headers: dict[str, str], is_allowed: bool) -> None:
    settings = make_settings(allowed_origins=["https://annotate.example/"])
    fault = find_origin_fault(Headers({"host": "localhost:8000", **headers}), settings)
    assert (fault == "") is is_allowed


def test_a_request_has_one_origin() -> None:
    raw = [(b"host", b"localhost"), (b"origin", b"http://localhost"), (b"origin", b"http://evil.example")]
    assert "several Origin headers" in find_origin_fault(Headers(raw=raw), make_settings())

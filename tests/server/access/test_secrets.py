"""Secrets: long, never the same, known by their kind, and not to be got back from what is kept."""

from __future__ import annotations

from typing import get_args

import pytest
from hypothesis import given
from hypothesis import strategies as st

from server.access.secrets import TOKEN_PREFIX, Kind, hash_secret, make_secret

KINDS = get_args(Kind)


@pytest.mark.parametrize("kind", KINDS)
def test_a_secret_has_256_bits_and_goes_into_an_address_or_a_header_as_it_is(kind: Kind) -> None:
    made = {make_secret(kind) for _ in range(100)}
    assert len(made) == 100
    for secret in made:
        assert secret.startswith(TOKEN_PREFIX) == (kind == "token")
        assert len(secret.removeprefix(TOKEN_PREFIX)) >= 43  # 256 bits in steps of 6
        assert secret.isascii() and secret.replace("-", "").replace("_", "").isalnum()


@given(st.text(max_size=20), st.text(max_size=20))
def test_what_is_kept_tells_secrets_and_their_kinds_apart_and_holds_nothing_of_them(one: str, other: str) -> None:
    kept = {(kind, secret): hash_secret(kind, secret) for kind in KINDS for secret in (one, other)}
    assert len(set(kept.values())) == len(kept)
    assert all(len(value) == 64 and set(value) <= set("0123456789abcdef") for value in kept.values())


def test_text_that_cannot_be_encoded_is_nobodys_secret_and_no_error() -> None:
    assert hash_secret("login", "\ud800") != hash_secret("login", "")

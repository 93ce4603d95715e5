"""`handloom serve` opens a port that is free, and only where somebody could let people in."""

from __future__ import annotations

import argparse
import socket

import pytest

from server.access.models import Account, Role
from server.cli.guarded import FAILED, CommandError
from server.cli.open_studio import OpenStudio
from server.cli.serve import add_serve_arguments, check_an_admin_can_log_in, listen
from server.database import utc_now
from server.settings import Settings
from tests.server.rows import keep, make_person


def make_settings(**more: object) -> Settings:
    return Settings(host="127.0.0.1", port=0).model_copy(update=more)


def test_a_free_port_is_found_and_given_back(tmp_path) -> None:
    with listen(make_settings()) as sock:
        host, port = sock.getsockname()
        assert host == "127.0.0.1" and port > 0
    with listen(make_settings(port=port)) as again:
        assert again.getsockname() == (host, port)


def test_a_taken_port_is_named_with_another_one_to_choose() -> None:
    with socket.socket() as other:
        other.bind(("127.0.0.1", 0))
        other.listen()
        port = other.getsockname()[1]
        said = rf"Port {port} is taken .* --port {(port + 1) % 65536}$"
        with pytest.raises(CommandError, match=said) as taken, listen(make_settings(port=port)):
            pass
    assert taken.value.code == FAILED


def test_an_address_of_another_machine_is_refused_with_the_reason() -> None:
    with (
        pytest.raises(CommandError, match=r"Cannot listen at 192\.0\.2\.7:0: Cannot assign") as refused,
        listen(make_settings(host="192.0.2.7")),
    ):
        pass
    assert refused.value.code == FAILED


def test_what_is_not_said_on_the_command_line_is_left_to_the_settings() -> None:
    parser = argparse.ArgumentParser()
    add_serve_arguments(parser)
    assert vars(parser.parse_args([])) == {"host": None, "port": None, "no_worker": False}
    said = parser.parse_args(["--host", "::1", "--port", "0", "--no-worker"])
    assert vars(said) == {"host": "::1", "port": 0, "no_worker": True}


@pytest.mark.parametrize(
    ("role", "password_hash", "is_disabled", "may_open"),
    [
        ("admin", "x", False, True),
        ("admin", None, False, False),
        ("admin", "x", True, False),
        ("lead", "x", False, False),
    ],
)
def test_people_are_let_in_only_where_an_admin_can_log_in(
    own_studio: OpenStudio, role: Role, password_hash: str | None, is_disabled: bool, may_open: bool
) -> None:
    person: Account = make_person("lea", role)
    person.password_hash, person.disabled_at = password_hash, utc_now() if is_disabled else None
    keep(own_studio.database, person)
    if may_open:
        check_an_admin_can_log_in(own_studio.settings)
    else:
        with pytest.raises(CommandError, match=r"no admin can yet. Add one first: `handloom account add NAME --role"):
            check_an_admin_can_log_in(own_studio.settings)


@pytest.mark.parametrize(
    ("host", "where"), [("127.0.0.1", "HANDLOOM_LOGIN=required: "), ("0.0.0.0", r"--host 0\.0\.0\.0: ")]
)
def test_the_refusal_names_what_asked_for_logins(own_studio: OpenStudio, host: str, where: str) -> None:
    with pytest.raises(CommandError, match=f"^{where}people must log in here"):
        check_an_admin_can_log_in(own_studio.settings.model_copy(update={"host": host}))

"""`handloom account`: people for whoever may read the data folder; a password never is an argument."""

from __future__ import annotations

import getpass
import io
import json
import sys
from collections.abc import Callable
from typing import Any

import pytest
from sqlalchemy import select

from server.access.models import ROLES as ALL_ROLES
from server.access.models import Account, AuditRow, LoginRow, PasswordCodeRow
from server.access.passwords import verify_password
from server.access.secrets import hash_secret
from server.cli.account_command import ROLES, read_password
from server.cli.guarded import CommandError
from server.cli.main import main
from server.cli.open_studio import OpenStudio
from server.database import utc_now
from tests.server.rows import keep, make_person

PASSWORD = "four words in a row"
Run = Callable[..., tuple[int, str, str]]


class Terminal(io.StringIO):
    """Somebody sits there."""

    def isatty(self) -> bool:
        return True


@pytest.fixture
def run(own_studio: OpenStudio, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch) -> Run:
    """Runs the command, with `given` through a pipe; its exit code, answer and complaint."""

    def run_command(*arguments: str, given: str = "") -> tuple[int, str, str]:
        monkeypatch.setattr(sys, "stdin", io.StringIO(given))
        return (main(["account", *arguments]), *capsys.readouterr())

    return run_command


def find(studio: OpenStudio, name: str) -> Account | None:
    with studio.database.reading() as session:
        return session.scalar(select(Account).where(Account.name == name))


def test_the_roles_offered_are_those_there_are() -> None:
    assert ROLES == ALL_ROLES


@pytest.mark.parametrize(
    ("given", "read"), [(" a b \r\nmore", " a b "), ("no line end", "no line end"), ("\n", ""), ("", "")]
)
def test_a_password_from_a_pipe_is_the_first_line_to_the_letter(
    monkeypatch: pytest.MonkeyPatch, given: str, read: str
) -> None:
    monkeypatch.setattr(sys, "stdin", io.StringIO(given))
    assert read_password() == read


def test_at_a_terminal_it_is_asked_for_twice_and_must_be_the_same(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sys, "stdin", Terminal())
    for second in (PASSWORD, "another"):
        typed = iter([PASSWORD, second])
        monkeypatch.setattr(getpass, "getpass", lambda _prompt, typed=typed: next(typed))
        if second == PASSWORD:
            assert read_password() == PASSWORD
        else:
            with pytest.raises(CommandError, match=r"The two passwords differ; nothing was changed."):
                read_password()


def test_somebody_is_added_with_the_password_that_came(run: Run, own_studio: OpenStudio) -> None:
    code, told, _ = run("add", "Lea", "--role", "lead", given=f"{PASSWORD}\n")
    assert (code, told) == (0, "Lea may log in as lead.\n")
    account = find(own_studio, "Lea")
    assert account is not None and account.role == "lead"
    assert verify_password(PASSWORD, account.password_hash)[0] and PASSWORD not in account.password_hash


@pytest.mark.parametrize(
    ("name", "given", "said"), [("Lea", "short", "needed 10 to 200"), ("a\tb", PASSWORD, "The name")]
)
def test_nobody_is_added_with_a_bad_name_or_password(
    run: Run, own_studio: OpenStudio, name: str, given: str, said: str
) -> None:
    code, told, failed = run("add", name, given=given)
    assert (code, told) == (2, "") and said in failed and find(own_studio, name) is None


def test_a_code_stands_for_a_password_that_its_owner_sets(run: Run, own_studio: OpenStudio) -> None:
    code, told, _ = run("add", "Lea", "--code", "--json")
    made = json.loads(told)
    assert (code, made["name"], made["role"]) == (0, "Lea", "annotator")
    _, again, _ = run("code", "Lea")
    assert again.startswith("Lea sets a password within 3 days at the studio's address followed by /login?code=")
    newest = again.strip().rpartition("=")[2]
    assert newest != made["code"]
    with own_studio.database.reading() as session:
        [row] = session.scalars(select(PasswordCodeRow))
        [line] = session.scalars(select(AuditRow).where(AuditRow.act == "account.code"))
    assert row.secret_hash == hash_secret("code", newest), "the newest code alone counts"
    assert line.account_id is None and line.detail == {"by": "command line"}


def test_a_new_password_ends_every_login(run: Run, own_studio: OpenStudio) -> None:
    lea = make_person("Lea")
    keep(own_studio.database, lea, LoginRow(account_id=lea.id, secret_hash="0" * 64, expires_at=utc_now()))
    code, told, _ = run("password", "Lea", given=PASSWORD)
    assert (code, told) == (0, "The password of Lea is set; Lea must log in again.\n")
    with own_studio.database.reading() as session:
        assert session.scalars(select(LoginRow)).all() == []


def test_everybody_is_listed_by_name_with_what_they_can_do(run: Run, own_studio: OpenStudio) -> None:
    keep(own_studio.database, make_person("Zoe", "admin"), make_person("Ann"))
    with own_studio.database.writing() as session:
        session.get_one(Account, find(own_studio, "Zoe").id).password_hash = "x"  # type: ignore[union-attr]
    assert run("disable", "Ann")[1] == "Ann may no longer log in.\n"

    def states() -> dict[str, Any]:
        return {one["name"]: one["state"] for one in json.loads(run("list", "--json")[1])["accounts"]}

    assert states() == {"Ann": "disabled", "Zoe": "may log in", "local": "has no password"}
    assert list(states()) == ["Ann", "Zoe", "local"]
    assert run("enable", "Ann")[1] == "Ann may now log in.\n"
    assert states()["Ann"] == "has no password"
    assert run("list")[1].splitlines()[1].split() == ["Zoe", "admin", "may", "log", "in"]
    ann = find(own_studio, "Ann")
    assert ann is not None and ann.revision == 3


@pytest.mark.parametrize("act", ["password", "code", "disable", "enable"])
def test_an_unknown_name_is_said_with_where_the_names_are(run: Run, act: str) -> None:
    code, told, failed = run(act, "Nobody", given=PASSWORD)
    assert (code, told) == (2, "")
    assert failed == "handloom: There is no account 'Nobody'. `handloom account list` names those there are.\n"

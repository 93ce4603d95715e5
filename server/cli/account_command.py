"""`handloom account`: people of the studio, for whoever may read its data folder."""

from __future__ import annotations

import argparse
import getpass
import sys
from typing import TYPE_CHECKING

from server.cli.guarded import CommandError, add_json, answer, run_guarded

if TYPE_CHECKING:
    from sqlalchemy.orm import Session

    from server.access.models import Account

ROLES = ("annotator", "reviewer", "lead", "admin")


def add_command(subparsers: argparse._SubParsersAction) -> None:
    parser = subparsers.add_parser(
        "account",
        help="people who may log in",
        description="Add people, list them, disable their accounts, set passwords. A password is asked for, or read "
        "from a pipe; it is never an argument, because everybody on the machine can read arguments.",
    )
    acts = parser.add_subparsers(required=True, metavar="ACT")
    add = acts.add_parser("add", help="add somebody")
    add.add_argument("name", metavar="NAME")
    add.add_argument("--role", choices=ROLES, default="annotator", help="their role (default: annotator)")
    add.add_argument("--code", action="store_true", help="ask for no password; print a one-time code that sets one")
    add.set_defaults(run=run_guarded(_add))
    password = acts.add_parser("password", help="set somebody's password")
    password.add_argument("name", metavar="NAME")
    password.set_defaults(run=run_guarded(_set_password))
    code = acts.add_parser("code", help="print a one-time code with which somebody sets their password")
    code.add_argument("name", metavar="NAME")
    code.set_defaults(run=run_guarded(_make_code))
    for act, words in (("disable", "disable an account; its work is kept"), ("enable", "enable an account again")):
        one = acts.add_parser(act, help=words)
        one.add_argument("name", metavar="NAME")
        one.set_defaults(run=run_guarded(_set_disabled), is_disabled=act == "disable")
        add_json(one)
    listing = acts.add_parser("list", help="list everybody")
    listing.set_defaults(run=run_guarded(_list))
    for one in (add, password, code, listing):
        add_json(one)


def read_password() -> str:
    """Asked for twice at a terminal; else the first line of stdin."""
    if not sys.stdin.isatty():
        return sys.stdin.readline().rstrip("\r\n")
    password = getpass.getpass("Password: ")
    if getpass.getpass("Again: ") != password:
        raise CommandError("The two passwords differ; nothing was changed.")
    return password


def _find(session: Session, name: str) -> Account:
    from sqlalchemy import select

    from server.access.models import Account

    account = session.scalar(select(Account).where(Account.name == name))
    if account is None:
        raise CommandError(f"There is no account {name!r}. `handloom account list` names those there are.")
    return account


def _add(args: argparse.Namespace) -> int:
    from server.access.logins import make_code, set_password
    from server.access.passwords import check_new_password
    from server.access.people import add_account, check_name
    from server.cli.open_studio import open_studio

    name = check_name(args.name)
    password = None if args.code else read_password()
    if password is not None:
        check_new_password(password, name)
    with open_studio() as studio:
        with studio.database.writing() as session:
            account = add_account(session, None, name, args.role)
            code = make_code(session, account.id)[0] if args.code else None
        if password is not None:
            set_password(studio.database, account.id, name, password)
    return _say(args, account, code, f"{name} may log in as {args.role}.")


def _set_password(args: argparse.Namespace) -> int:
    from server.access.logins import set_password
    from server.cli.open_studio import open_studio

    with open_studio() as studio:
        with studio.database.reading() as session:
            account = _find(session, args.name)
        set_password(studio.database, account.id, account.name, read_password())
    return _say(args, account, None, f"The password of {account.name} is set; {account.name} must log in again.")


def _make_code(args: argparse.Namespace) -> int:
    from server.access.audit import record_act
    from server.access.logins import make_code
    from server.cli.open_studio import open_studio

    with open_studio() as studio, studio.database.writing() as session:
        account = _find(session, args.name)
        code, _ = make_code(session, account.id)
        record_act(session, None, "account.code", "account", account.id, by="command line")
    return _say(args, account, code, "")


def _set_disabled(args: argparse.Namespace) -> int:
    from server.access.people import set_disabled
    from server.cli.open_studio import open_studio

    with open_studio() as studio, studio.database.writing() as session:
        account = _find(session, args.name)
        set_disabled(session, None, account, args.is_disabled)
        account.revision += 1
    return _say(args, account, None, f"{account.name} may {'no longer' if args.is_disabled else 'now'} log in.")


def _list(args: argparse.Namespace) -> int:
    from sqlalchemy import select

    from server.access.models import Account
    from server.cli.open_studio import open_studio

    with open_studio() as studio, studio.database.reading() as session:
        rows = list(session.scalars(select(Account).order_by(Account.name)))
    lines = [f"{row.name:<24} {row.role:<10} {_state(row)}" for row in rows]
    people = [{"name": row.name, "role": row.role, "state": _state(row)} for row in rows]
    return answer(args, {"accounts": people}, "\n".join(lines))


def _state(account: Account) -> str:
    if account.disabled_at is not None:
        return "disabled"
    return "may log in" if account.password_hash else "has no password"


def _say(args: argparse.Namespace, account: Account, code: str | None, text: str) -> int:
    if code is not None:
        text = f"{account.name} sets a password within 3 days at the studio's address followed by /login?code={code}"
    return answer(args, {"name": account.name, "role": account.role, "code": code}, text)

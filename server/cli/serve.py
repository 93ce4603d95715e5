"""`handloom serve`: the studio, with a worker beside it."""

from __future__ import annotations

import argparse
import contextlib
import errno
import gc
import logging
import signal
import socket
import sys
from collections.abc import Iterator
from typing import TYPE_CHECKING

from server.cli.guarded import FAILED, CommandError, load_settings, run_guarded

if TYPE_CHECKING:
    from server.settings import Settings

log = logging.getLogger(__name__)


def add_command(subparsers: argparse._SubParsersAction) -> None:
    parser = subparsers.add_parser("serve", help="run the studio", description="Run the studio until it is stopped.")
    add_serve_arguments(parser)
    parser.set_defaults(run=run_guarded(run))


SWITCH_SECONDS = 0.0005
"""A thread that computes gives way after this. A save takes its turn with such threads some twenty times; at Python's
default of 5 ms one label check made it ten times slower."""

GARBAGE = (20_000, 20, 50)
"""When Python looks for cycles (its default: 700, 10, 10). An answer of a thousand labels is so many objects that the
looking took three times as long as the answer (0.43 s instead of 0.12)."""


def add_serve_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("--host", metavar="NAME", help="address to listen at (default: 127.0.0.1)")
    parser.add_argument("--port", type=int, metavar="N", help="port to listen at, 0 for a free one (default: 8000)")
    parser.add_argument("--no-worker", action="store_true", help="run no jobs; `handloom worker` runs them elsewhere")


def run(args: argparse.Namespace) -> int:
    serve(load_settings(host=args.host, port=args.port), with_worker=not args.no_worker)
    return 0


def serve(settings: Settings, *, with_worker: bool) -> None:
    """Serve until SIGTERM or SIGINT; then end the worker and the viewer too."""
    if settings.is_login_needed:
        check_an_admin_can_log_in(settings)
    with listen(settings) as sock:
        from server.cli.studio import StudioServer
        from server.cli.supervisor import WorkerSupervisor
        from server.log import configure_logging
        from tracker import find_physics_fault

        configure_logging(settings.log_level)
        if fault := find_physics_fault():
            log.warning(fault)
        sys.setswitchinterval(SWITCH_SECONDS)
        gc.freeze()
        gc.set_threshold(*GARBAGE)
        signal.signal(signal.SIGTERM, lambda *_: sys.exit(0))
        with contextlib.ExitStack() as stack:
            if with_worker:
                stack.enter_context(WorkerSupervisor(settings))
            # A second SIGINT after the server has stopped ends nothing but the waiting.
            with contextlib.suppress(KeyboardInterrupt):
                StudioServer(settings, sock).run(sockets=[sock])


def check_an_admin_can_log_in(settings: Settings) -> None:
    """Refuse to open a port at which nobody could let anybody in."""
    from server.access.logins import count_admins_who_can_log_in
    from server.cli.open_studio import open_studio

    with open_studio(settings) as studio, studio.database.reading() as session:
        if count_admins_who_can_log_in(session) > 0:
            return
    where = "HANDLOOM_LOGIN=required" if settings.is_loopback else f"--host {settings.host}"
    raise CommandError(
        f"{where}: people must log in here, and no admin can yet. Add one first: `handloom account add NAME --role "
        "admin` asks for a password. Or serve at 127.0.0.1 alone, where no login is needed."
    )


@contextlib.contextmanager
def listen(settings: Settings) -> Iterator[socket.socket]:
    """A socket at the address, so that a port that is taken is noticed before anything else is done."""
    family = socket.AF_INET6 if ":" in settings.host else socket.AF_INET
    with socket.socket(family) as sock:
        sock.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        try:
            sock.bind((settings.host, settings.port))
        except OSError as error:
            if error.errno == errno.EADDRINUSE:
                raise CommandError(
                    f"Port {settings.port} is taken by another program, perhaps by another Handloom. Stop that one, or "
                    f"choose another port: --port {settings.port + 1 if settings.port < 65535 else 0}",
                    FAILED,
                ) from None
            raise CommandError(f"Cannot listen at {settings.host}:{settings.port}: {error.strerror}.", FAILED) from None
        yield sock

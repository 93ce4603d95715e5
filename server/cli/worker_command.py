"""`handloom worker`: does the jobs."""

from __future__ import annotations

import argparse
import os
import signal
import sys
import threading

from server.cli.guarded import load_settings, run_guarded


def add_command(subparsers: argparse._SubParsersAction) -> None:
    parser = subparsers.add_parser(
        "worker",
        help="run the jobs of a studio",
        description="Run jobs until stopped. Each worker runs one job at a time. A worker may be killed at any "
        "moment: its job continues when a worker starts again.",
    )
    parser.add_argument("--with-parent", action="store_true", help=argparse.SUPPRESS)
    parser.set_defaults(run=run_guarded(run))


def run(args: argparse.Namespace) -> int:
    from server.log import configure_logging
    from server.worker import run_worker

    settings = load_settings()
    configure_logging(settings.log_level)
    if args.with_parent:
        threading.Thread(target=_end_with_parent, name="parent", daemon=True).start()
    run_worker(settings)
    return 0


def _end_with_parent() -> None:
    """Standard input is a pipe that nobody writes to: it ends when the process at its other end does."""
    while sys.stdin.buffer.read(1):
        pass
    os.kill(os.getpid(), signal.SIGTERM)

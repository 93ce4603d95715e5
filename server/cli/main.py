"""Parses the command line and runs the command."""

from __future__ import annotations

import argparse
import sys

from server.cli import account_command, bench_server, demo, export_command, import_command, serve, worker_command
from tracker import add_commands

COMMANDS = (serve, worker_command, demo, import_command, export_command, account_command)


def make_parser() -> argparse.ArgumentParser:
    """Every command with its arguments."""
    parser = argparse.ArgumentParser(
        prog="handloom",
        description="A studio that captures hands in action. Everything it keeps is under $HANDLOOM_DATA_DIR.",
    )
    subparsers = parser.add_subparsers(required=True, metavar="COMMAND")
    for command in COMMANDS:
        command.add_command(subparsers)
    bench_server.add_subject(add_commands(subparsers))
    return parser


def main(arguments: list[str] | None = None) -> int:
    """Run `handloom`; the exit code: 0, 2 for bad input, 1 for any other failure."""
    args = make_parser().parse_args(arguments)
    try:
        return args.run(args)
    except KeyboardInterrupt:
        sys.stderr.write("handloom: stopped\n")
        return 130

"""`python -m tracker.cli`: the tracker's commands where the server is not installed."""

from __future__ import annotations

import argparse
import sys

from tracker.cli import add_commands


def main(arguments: list[str] | None = None) -> int:
    """Parse and run; the exit code."""
    parser = argparse.ArgumentParser(prog="handloom", description="Track, evaluate and synthesize recordings of hands.")
    add_commands(parser.add_subparsers(required=True, metavar="COMMAND"))
    args = parser.parse_args(arguments)
    return args.run(args)


if __name__ == "__main__":
    sys.exit(main())

"""What all commands share: exit codes, `--json`, and the reading of arguments."""

from __future__ import annotations

import argparse
import json
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

from tracker.errors import TrackerError
from tracker.model.built_in_hands import BUILT_IN_HANDS

BAD_INPUT, FAILED = 2, 1
"""Exit codes."""


def run_guarded(work: Callable[[argparse.Namespace], Any], show: Callable[[Any], str]):
    """The function to run for a parsed command.

    Args:
        work: Does it and returns what `--json` prints.
        show: The same for people to read.

    Returns:
        A function of the parsed arguments that prints, and returns 0, or says on stderr what went wrong and returns
        `BAD_INPUT` where the input was at fault and `FAILED` otherwise.
    """

    def run(args: argparse.Namespace) -> int:
        try:
            result = work(args)
        except TrackerError as error:
            print(f"handloom: {error}", file=sys.stderr)
            return BAD_INPUT
        except OSError as error:
            print(f"handloom: {error}", file=sys.stderr)
            return FAILED
        except KeyboardInterrupt:
            print("handloom: stopped", file=sys.stderr)
            return 130
        print(json.dumps(result) if args.json else show(result))
        return 0

    return run


def add_json(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("--json", action="store_true", help="print one JSON object on stdout")


def parse_range(text: str) -> tuple[int | None, int | None]:
    """`A:B`, `A:` or `:B`, as in Python: frames A to B - 1."""
    first, colon, last = text.partition(":")
    try:
        bounds = int(first) if first else None, int(last) if last else None
    except ValueError:
        bounds = None
    if bounds is None or not colon or any(bound is not None and bound < 0 for bound in bounds):
        raise argparse.ArgumentTypeError(f"{text!r} is not a range of frames; write A:B for the frames A to B - 1")
    return bounds


def parse_named_file(text: str) -> tuple[str, Path]:
    """`NAME=FILE`."""
    name, equals, path = text.partition("=")
    if not equals or not name or not path:
        raise argparse.ArgumentTypeError(f"{text!r} is not NAME=FILE")
    return name, Path(path)


def parse_hand(text: str) -> tuple[str, Path | None]:
    """`right`, `left`, either with `=FILE`, its model, or `=trained`; `trained` alone for every hand."""
    name, path = parse_named_file(text) if "=" in text else (text, None)
    if name not in ("right", "left", *BUILT_IN_HANDS):
        raise argparse.ArgumentTypeError(
            f"{text!r}: a hand is 'right' or 'left', or right=FILE with its model, or for both "
            + " or ".join(f"'{hand.name}' ({hand.label.lower()})" for hand in BUILT_IN_HANDS.values())
        )
    return name, path


def choose_frames(bounds: tuple[int | None, int | None], count: int, step: int = 1) -> range:
    """The frames that `A:B` means in a recording of `count` frames.

    Raises:
        TrackerError: There are none.
    """
    first, last = bounds[0] or 0, count if bounds[1] is None else min(bounds[1], count)
    if first >= last:
        raise TrackerError(f"There are {count} frames, 0 to {count - 1}; none is left of {first}:{bounds[1]}.")
    return range(first, last, step)

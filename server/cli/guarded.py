"""What the studio's commands share: reading settings, saying what came out, saying what went wrong."""

from __future__ import annotations

import argparse
import json
import sys
from collections.abc import Callable
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from server.settings import Settings

BAD_INPUT, FAILED = 2, 1


class CommandError(Exception):
    """The command cannot do what it was asked.

    Args:
        message: What came, what is needed, what to do.
        code: Exit code.
    """

    def __init__(self, message: str, code: int = BAD_INPUT) -> None:
        super().__init__(message)
        self.code = code


def run_guarded(work: Callable[[argparse.Namespace], int]) -> Callable[[argparse.Namespace], int]:
    """`work` with its errors said on stderr in one line."""

    def run(args: argparse.Namespace) -> int:
        from pydantic import ValidationError

        from server.errors import StudioError
        from tracker import TrackerError

        try:
            return work(args)
        except CommandError as error:
            return _fail(str(error), error.code)
        except ValidationError as error:
            faults = [
                f"HANDLOOM_{'_'.join(map(str, fault['loc'])).upper()}: {fault['msg']}" for fault in error.errors()
            ]
            return _fail("; ".join(faults), BAD_INPUT)
        except TrackerError as error:
            return _fail(str(error), BAD_INPUT)
        except StudioError as error:
            return _fail(error.detail, BAD_INPUT if error.status_code < 500 else FAILED)
        except OSError as error:
            return _fail(str(error), FAILED)

    return run


def load_settings(**given: Any) -> Settings:
    """The settings, with what was given on the command line."""
    from server.settings import Settings

    return Settings(**{name: value for name, value in given.items() if value is not None})


def add_json(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("--json", action="store_true", help="print one JSON object on stdout")


def answer(args: argparse.Namespace, result: dict[str, Any], text: str) -> int:
    """Print what came out: as JSON if so asked, else for people."""
    sys.stdout.write(f"{json.dumps(result) if args.json else text}\n")
    return 0


def _fail(message: str, code: int) -> int:
    sys.stderr.write(f"handloom: {message}\n")
    return code

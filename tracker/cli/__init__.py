"""The commands that need no server, one module each: `handloom track`, `evaluate`, `synthesize` and others."""

from __future__ import annotations

import argparse

from tracker.cli import (
    bench,
    body,
    calibrate,
    calibrate_cameras,
    detect,
    evaluate,
    model_loop,
    refine_cameras,
    register,
    register_body,
    register_body_sequence,
    shift_cameras,
    synthesize,
    synthesize_scans,
    track,
    train_detector,
    train_model,
    warm_up,
)

COMMANDS = (
    track,
    register,
    register_body,
    register_body_sequence,
    body,
    calibrate,
    calibrate_cameras,
    refine_cameras,
    shift_cameras,
    detect,
    evaluate,
    synthesize,
    synthesize_scans,
    train_detector,
    train_model,
    model_loop,
    warm_up,
)


def add_commands(subparsers: argparse._SubParsersAction) -> argparse._SubParsersAction:
    """Add every command; after parsing, `args.run(args)` runs the one chosen and returns the exit code.

    Returns:
        What further subjects of `bench` are added to.
    """
    for command in COMMANDS:
        command.add_command(subparsers)
    return bench.add_command(subparsers)

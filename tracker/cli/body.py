"""`handloom body`: the model of a body with hands for other programs, and motions of it as meshes."""

from __future__ import annotations

import argparse
import time
from pathlib import Path
from typing import Any

from tracker.cli.command import add_json, choose_frames, parse_range, run_guarded
from tracker.cli.progress import ProgressLine
from tracker.errors import TrackerError, say_count

MAX_GLB_FRAMES = 20_000
"""Of an animation; a bound of ours."""


def add_command(subparsers: argparse._SubParsersAction) -> None:
    parser = subparsers.add_parser("body", help="the model of a body with hands: for smplx, or posed as meshes")
    actions = parser.add_subparsers(required=True, metavar="ACTION")
    export = actions.add_parser(
        "export",
        help="write the model for smplx",
        description="Write the body with hands as smplx.SMPLH loads it: .npz, or .pkl as its older files are. The "
        "landmarks that smplx must be told, because the vertices are not SMPL-H's, are printed.",
    )
    export.add_argument("--to", type=Path, required=True, metavar="FILE", help=".npz or .pkl")
    _add_population(export, "neutral")
    add_json(export)
    export.set_defaults(run=run_guarded(export_body, show_export))
    pose = actions.add_parser(
        "pose",
        help="write a motion as meshes",
        description="Pose the body by a motion file: an .npz as AMASS writes them, 'poses' with 156 numbers a frame, "
        "rad, and perhaps 'trans', 'betas', 'mocap_framerate', 'gender'. obj and ply write one mesh a frame into the "
        "folder OUT, glb one animated file OUT.",
    )
    pose.add_argument("motion", type=Path, metavar="MOTION", help="the motion, .npz")
    pose.add_argument("--to", type=Path, required=True, metavar="OUT", help="a folder for obj and ply, a file for glb")
    pose.add_argument(
        "--format", choices=("obj", "ply", "glb"), help="obj, ply or glb (glb if OUT ends in .glb, otherwise obj)"
    )
    pose.add_argument("--frames", type=parse_range, default=(None, None), metavar="A:B", help="frames A to B - 1 (all)")
    _add_population(pose, None)
    add_json(pose)
    pose.set_defaults(run=run_guarded(pose_body, show_pose))


def _add_population(parser: argparse.ArgumentParser, default: str | None) -> None:
    from_file = "the motion's own" if default is None else default
    parser.add_argument(
        "--population",
        choices=("neutral", "male", "female"),
        default=default,
        help=f"population of the body ({from_file})",
    )


def export_body(args: argparse.Namespace) -> dict[str, Any]:
    from tracker.model.body_model import body_model
    from tracker.model.mano_writer import save_mano, smplx_vertex_ids

    if args.to.suffix.lower() not in (".npz", ".pkl"):
        raise TrackerError(f"{args.to}: smplx reads .npz and .pkl; give the file such a name.")
    _need_folder(args.to)
    model = body_model(args.population)
    save_mano(model, args.to)
    return {
        "file": str(args.to),
        "population": args.population,
        "vertices": len(model.template),
        "joints": model.num_bones,
        "num_betas": model.num_shape,
        "vertex_ids": smplx_vertex_ids(model),
    }


def show_export(result: dict[str, Any]) -> str:
    ids = ", ".join(f"{name}={number}" for name, number in result["vertex_ids"].items())
    kind = Path(result["file"]).suffix[1:].lower()
    return (
        f"{result['file']}: {result['vertices']} vertices, {result['joints']} joints, {result['num_betas']} shapes\n"
        f"smplx.SMPLH({result['file']!r}, ext={kind!r}, num_betas=10, vertex_ids=dict({ids}))"
    )


def pose_body(args: argparse.Namespace) -> dict[str, Any]:
    from tracker.capture.atomic_file import write_atomically
    from tracker.export.body_files import check_shape, write_body_glb, write_meshes
    from tracker.model.body_model import body_model
    from tracker.model.body_motion import load_body_motion

    kind = args.format or ("glb" if args.to.suffix.lower() == ".glb" else "obj")
    motion = load_body_motion(args.motion)
    frames = choose_frames(args.frames, len(motion))
    population = args.population or motion.population
    model = body_model(population)
    check_shape(model, motion)
    began = time.monotonic()
    if kind == "glb":
        if args.to.suffix.lower() != ".glb":
            raise TrackerError(f"{args.to}: one .glb is written; give the file such a name.")
        if len(frames) > MAX_GLB_FRAMES:
            raise TrackerError(f"{len(frames)} frames; a .glb takes {MAX_GLB_FRAMES}: choose fewer with --frames A:B.")
        _need_folder(args.to)
        write_atomically(args.to, write_body_glb(model, motion, frames))
        written = 1
    else:
        if args.to.exists() and not args.to.is_dir():
            raise TrackerError(f"{args.to} is a file; {kind} needs a folder, which gets one mesh a frame.")
        line = ProgressLine(f"posing {say_count(len(frames), 'frame')}")
        written = len(write_meshes(model, motion, frames, args.to, kind, line.show))
    seconds = round(time.monotonic() - began, 2)
    return {"out": str(args.to), "format": kind, "frames": len(frames), "files": written, "seconds": seconds}


def show_pose(result: dict[str, Any]) -> str:
    files = say_count(result["files"], f"{result['format']} file")
    return f"{say_count(result['frames'], 'frame')} in {result['out']} ({files}, {result['seconds']:.1f} s)"


def _need_folder(path: Path) -> None:
    if not path.resolve().parent.is_dir():
        raise TrackerError(f"{path}: there is no folder {path.resolve().parent}; make it first.")

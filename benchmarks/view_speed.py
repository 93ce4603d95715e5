"""Frames a second from films of several colour cameras: `python -m benchmarks.view_speed [--cameras 8] [--size W H]`.

A rendered hand waves before a ring of cameras; each camera's images become a film, which is decoded while
the hand is tracked, without annotation. `--memory` tracks 1,500 frames instead and tells the resident set on the way.
"""

from __future__ import annotations

import argparse
import os
from dataclasses import replace
from pathlib import Path
from time import perf_counter, process_time

for name in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "NUMBA_NUM_THREADS"):
    os.environ.setdefault(name, "1")  # before numpy: `--threads` alone tells how many work

import cv2  # noqa: E402
import numpy as np  # noqa: E402

from tracker.capture.sequence import Sequence, load_sequence, save_sequence_json  # noqa: E402
from tracker.capture.truth import load_truth  # noqa: E402
from tracker.fitting.options import TrackOptions  # noqa: E402
from tracker.model.default_hand import default_hand  # noqa: E402
from tracker.model.npz_files import save_npz_model  # noqa: E402
from tracker.synthesis.motion import perform  # noqa: E402
from tracker.synthesis.recording import RecordingOptions, write_recording  # noqa: E402
from tracker.synthesis.texture import Texture  # noqa: E402
from tracker.tracking.follow import track_frames  # noqa: E402
from tracker.tracking.start import start_tracking  # noqa: E402
from tracker.tracking.track import Track, join_chunks  # noqa: E402

ROOT = Path(__file__).resolve().parents[1]
MOMENTS = 60
"""Rendered; a longer film goes through them forwards and backwards."""

LONG, EVERY = 1500, 100
"""Frames of the run whose memory is told, and how often."""


def order(count: int) -> list[int]:
    """Which of the rendered moments each of so many frames shows."""
    there_and_back = [*range(MOMENTS), *range(MOMENTS - 2, 0, -1)]
    return [there_and_back[frame % len(there_and_back)] for frame in range(count)]


def film(work: Path, cameras: int, size: tuple[int, int], sides: tuple[str, ...], count: int) -> Sequence:
    """The recording with a film for each camera; rendered and written once."""
    home = f"{cameras}_{size[0]}x{size[1]}_{'_'.join(sides)}"
    images, out = work / f"{home}_images", work / f"{home}_{count}"
    if (out / "sequence.json").exists():
        return load_sequence(out)
    if not images.exists():
        performance = perform({side: default_hand(side) for side in sides}, "wave", MOMENTS, cameras, size)
        options = RecordingOptions(range(MOMENTS), sensor=None, texture=Texture())
        write_recording(performance, images, options, save_npz_model)
    rendered = load_sequence(images)
    out.mkdir(parents=True, exist_ok=True)
    for camera in rendered.cameras:
        codec = cv2.VideoWriter.fourcc(*"mp4v")
        writer = cv2.VideoWriter(str(out / f"{camera.id}.mp4"), cv2.CAP_FFMPEG, codec, rendered.fps, size)
        for moment in order(count):
            writer.write(cv2.cvtColor(rendered.color(moment, camera.id), cv2.COLOR_RGB2BGR))
        writer.release()
    filmed = [replace(camera, color=None, depth=None, film=f"{camera.id}.mp4") for camera in rendered.cameras]
    save_sequence_json(Sequence(out, home, rendered.fps, count, tuple(filmed), sides))
    return load_sequence(out)


def follow(sequence: Sequence, threads: int, tells_memory: bool) -> tuple[Track, float, float]:
    """The track, frames a second from the end of the first one to the end of the last, and s of processors a frame."""
    setup, state = start_tracking(sequence, TrackOptions(calibrate=False, threads=threads))
    done: list[float] = []
    worked: list[float] = []

    def note(frame: int, _: object) -> None:
        done.append(perf_counter())
        worked.append(process_time())
        if tells_memory and (frame + 1) % EVERY == 0:
            print(f"frame {frame + 1}: {resident_megabytes():.0f} MB", flush=True)

    _, chunk = track_frames(sequence, setup, state, range(sequence.frame_count), note)
    steps = len(done) - 1
    return join_chunks(sequence, setup, [chunk]), steps / (done[-1] - done[0]), (worked[-1] - worked[0]) / steps


def resident_megabytes() -> float:
    """Of this process."""
    pages = int(Path("/proc/self/statm").read_text().split()[1])
    return pages * os.sysconf("SC_PAGE_SIZE") / 1e6


def measure_error(work: Path, sequence: Sequence, track: Track) -> float:
    """Mean distance of the joints that are not lost from the truth, mm."""
    truth = load_truth(work / f"{sequence.name}_images" / "truth.npz").joints_3d[order(sequence.frame_count)]
    held = track.status != "lost"
    return 1000.0 * float(np.linalg.norm(track.joints_3d[held] - truth[held], axis=2).mean())


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--cameras", type=int, default=8)
    parser.add_argument("--size", type=int, nargs=2, default=(1280, 1024))
    parser.add_argument("--hands", nargs="+", choices=("right", "left"), default=["right"])
    parser.add_argument("--threads", type=int, nargs="+", default=[2])
    parser.add_argument("--memory", action="store_true", help=f"tell the resident set of {LONG} frames")
    parser.add_argument("--frames", type=int, help=f"so many ({MOMENTS}, with --memory {LONG})")
    parser.add_argument("--work", type=Path, default=ROOT / "out" / "view_speed")
    given = parser.parse_args()
    count = given.frames or (LONG if given.memory else MOMENTS)
    sequence = film(given.work, given.cameras, (given.size[0], given.size[1]), tuple(given.hands), count)
    for threads in given.threads:
        track, rate, work = follow(sequence, threads, given.memory)
        summary = track.summary()
        stages = sorted(summary["stages_ms"].items(), key=lambda stage: -stage[1])
        print(
            f"{sequence.name}, {threads} threads: {rate:.1f} frames a second, {1000 * work:.0f} ms of processors each, "
            f"{summary['lost']} of {count} lost, {measure_error(given.work, sequence, track):.2f} mm\n"
            f"median ms of a frame's stages: {', '.join(f'{name} {ms:.0f}' for name, ms in stages)}",
            flush=True,
        )


if __name__ == "__main__":
    main()

"""A trial: one measurement that a study needs, with its result kept in a file so that it is not run twice."""

from __future__ import annotations

import hashlib
import inspect
import json
import time
import traceback
from concurrent.futures import ProcessPoolExecutor, as_completed
from dataclasses import asdict, dataclass, fields
from functools import lru_cache
from pathlib import Path
from typing import Any, Protocol, runtime_checkable

from tracker.capture.atomic_file import write_atomically

HERE = Path(__file__).resolve().parent
ROOT = HERE.parents[1]


@runtime_checkable
class Trial(Protocol):
    """A frozen dataclass of plain values; the same values give the same result, times apart."""

    def __call__(self, data: Path, twins: Path, /) -> dict[str, Any]:
        """Measure; `data` is the authors' folder, `twins` where rendered recordings are kept."""
        ...


class NotMeasured(Exception):
    """A trial that was not run, or failed; the message says why."""


@dataclass(frozen=True)
class Kept:
    """A result in its file.

    Attributes:
        code: Of the tracker and the study, see `fingerprint`.
        seconds: It took.
        result: What was measured; empty where it failed.
        error: Why it failed.
    """

    code: str
    seconds: float
    result: dict[str, Any]
    error: str = ""


@lru_cache
def fingerprint(*files: Path) -> str:
    """A short hash of the tracker's sources and of these files: a result belongs to the code that made it."""
    digest = hashlib.sha256()
    for path in (*sorted((ROOT / "tracker").rglob("*.py")), *files):
        digest.update(path.read_bytes())
    return digest.hexdigest()[:12]


def code_of(trial: Trial) -> str:
    """The fingerprint that a trial's result has now: its file counts, and those that its class names as `made_with`."""
    own = Path(inspect.getfile(type(trial)))
    others = (HERE / name for name in getattr(trial, "made_with", ("twin_runs.py",)))
    return fingerprint(own, *others)


def path_of(trial: Trial, folder: Path) -> Path:
    """The file of a trial's result."""
    values = json.dumps(asdict(trial), sort_keys=True)  # type: ignore[call-overload]
    return folder / f"{type(trial).__name__}_{hashlib.sha256(values.encode()).hexdigest()[:16]}.json"


def load_kept(trial: Trial, folder: Path) -> Kept | None:
    """The result in the file, whatever code made it."""
    path = path_of(trial, folder)
    if not path.is_file():
        return None
    document = json.loads(path.read_text())
    return Kept(document["code"], document["seconds"], document["result"], document["error"])


def run_trial(trial: Trial, data: Path, twins: Path, folder: Path) -> Kept:
    """Run a trial and keep what came out, an error too."""
    began, code = time.perf_counter(), code_of(trial)
    try:
        result, error = trial(data, twins), ""
    except Exception as problem:  # one failed measurement must not take the night's others with it
        traceback.print_exc()
        result, error = {}, f"{type(problem).__name__}: {problem}"
    kept = Kept(code, time.perf_counter() - began, result, error)
    folder.mkdir(parents=True, exist_ok=True)
    document = {"trial": type(trial).__name__, "of": asdict(trial), **asdict(kept)}  # type: ignore[call-overload]
    write_atomically(path_of(trial, folder), json.dumps(document, indent=1).encode())
    return kept


@dataclass(frozen=True)
class Results:
    """The results of trials, read from their files as they are asked for."""

    folder: Path

    def __getitem__(self, trial: Trial) -> dict[str, Any]:
        """What a trial measured.

        Raises:
            NotMeasured: It was not run, or failed.
        """
        kept = load_kept(trial, self.folder)
        if kept is None:
            raise NotMeasured(f"{describe_trial(trial)} was not run.")
        if kept.error:
            raise NotMeasured(f"{describe_trial(trial)} failed: {kept.error}")
        return kept.result


def describe_trial(trial: Trial) -> str:
    """Its kind and the values that are not the usual ones."""
    usual = {f.name: f.default for f in fields(trial)}  # type: ignore[arg-type]
    named = {name: value for name, value in asdict(trial).items() if value != usual[name]}  # type: ignore[call-overload]
    return f"{type(trial).__name__}({', '.join(f'{name}={value!r}' for name, value in named.items())})"


def is_due(trial: Trial, folder: Path, keep: bool) -> bool:
    """Whether a trial must be run: nothing is there, it failed, or (unless `keep`) other code made it."""
    kept = load_kept(trial, folder)
    return kept is None or bool(kept.error) or (not keep and kept.code != code_of(trial))


def run_trials(trials: list[Trial], data: Path, twins: Path, folder: Path, processes: int, keep: bool) -> None:
    """Run what is due, each trial once; those that measure time run last and alone."""
    due = [trial for trial in dict.fromkeys(trials) if is_due(trial, folder, keep)]
    shared = [trial for trial in due if not getattr(trial, "alone", False)]
    alone = [trial for trial in due if getattr(trial, "alone", False)]
    print(f"{len(set(trials))} trials, {len(due)} to run", flush=True)
    done = 0

    def tell(trial: Trial, kept: Kept) -> None:
        print(f"[{done}/{len(due)}] {kept.seconds:6.1f} s  {describe_trial(trial)}  {kept.error}", flush=True)

    if processes > 1 and len(shared) > 1:
        with ProcessPoolExecutor(processes) as pool:
            waiting = {pool.submit(run_trial, trial, data, twins, folder): trial for trial in shared}
            for future in as_completed(waiting):
                done += 1
                tell(waiting[future], future.result())
        shared = []
    for trial in (*shared, *alone):
        kept = run_trial(trial, data, twins, folder)
        done += 1
        tell(trial, kept)

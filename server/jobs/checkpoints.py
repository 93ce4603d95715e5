"""Stages of long steps among the working files of a job: whoever goes on with the step finds them."""

from __future__ import annotations

from collections.abc import Callable, Mapping

import numpy.typing as npt

from server.jobs.files import JobFiles


class JobCheckpoints:
    """What `tracker.Checkpoints` asks for: a file and its manifest for each stage, as for a chunk of frames.

    Args:
        files: Of the job.
        prefix: Of the names of this step's stages.
        kept: Told the name of a stage when it is safe; may raise to stop.
        found: Told the name of a stage that need not be done again.
    """

    def __init__(
        self,
        files: JobFiles,
        prefix: str,
        kept: Callable[[str], None],
        found: Callable[[str], None] = lambda stage: None,
    ) -> None:
        self._files, self._prefix, self._kept, self._found = files, prefix, kept, found

    def load(self, stage: str) -> dict[str, npt.NDArray] | None:
        from tracker.training import unpack_arrays

        step = f"{self._prefix}-{stage}"
        if self._files.read_manifest(step) is None:
            return None
        try:
            arrays = unpack_arrays((self._files.folder / f"{step}.npz").read_bytes())
        except (OSError, ValueError):
            return None
        self._found(stage)
        return arrays

    def save(self, stage: str, arrays: Mapping[str, npt.NDArray]) -> None:
        from tracker.training import pack_arrays

        step = f"{self._prefix}-{stage}"
        path = self._files.folder / f"{step}.npz"
        self._files.write(path, lambda temporary: temporary.write_bytes(pack_arrays(arrays)))
        self._files.write_manifest(step, [path], {})
        self._kept(stage)

"""Jobs: started, watched, waited for."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterable, Iterator
from typing import Any

from server.client.link import Link

ENDED = ("succeeded", "failed", "cancelled")
POLL_SECONDS = 0.5


class JobFailed(Exception):
    """The job ended without a result; `job` says why."""

    def __init__(self, job: dict[str, Any]) -> None:
        self.job = job
        super().__init__(f"The job {job['id']} {job['state']}" + (f": {job['error']}" if job["error"] else "."))


class Jobs:
    """Of a studio."""

    def __init__(self, link: Link) -> None:
        self._link = link

    def __iter__(self) -> Iterator[dict[str, Any]]:
        return self._link.pages("/jobs")

    def find(self, **filters: Any) -> Iterator[dict[str, Any]]:
        """Those of a `state`, a `sequence_id`, a `batch_id`, or with words of the recording's name in `search`."""
        return self._link.pages("/jobs", **filters)

    def get(self, job_id: str) -> dict[str, Any]:
        return self._link.get(f"/jobs/{job_id}")

    def track(self, sequence_id: str, **params: Any) -> dict[str, Any]:
        """Start tracking a recording; `params` as `GET /jobs/form` lists them."""
        return self._link.send("POST", "/jobs", json={"sequence_id": sequence_id, "params": params}).json()

    def track_all(self, sequence_ids: Iterable[str], **params: Any) -> list[dict[str, Any]]:
        """Start tracking several recordings: all, or none when one of them cannot be."""
        body = {"sequence_ids": list(sequence_ids), "params": params}
        return self._link.send("POST", "/jobs/batch", json=body).json()["jobs"]

    def register(self, **asked: Any) -> dict[str, Any]:
        """Start registering scans: a `collection`, or `scan_ids`; `only` is `new`, `not_accepted` or `all`."""
        return self._link.send("POST", "/jobs", json={"kind": "register", **asked}).json()

    def train(self, training_set_id: str, name: str, **asked: Any) -> dict[str, Any]:
        """Start training a hand model, which will be the job's `hand_model_id`."""
        return self._link.send(
            "POST", "/jobs", json={"kind": "train", "training_set_id": training_set_id, "name": name, **asked}
        ).json()

    def loop(self, name: str, **asked: Any) -> dict[str, Any]:
        """Start register, choose, train, register again."""
        return self._link.send("POST", "/jobs", json={"kind": "loop", "name": name, **asked}).json()

    def cancel(self, job_id: str) -> dict[str, Any]:
        return self._link.send("POST", f"/jobs/{job_id}/cancel", is_repeatable=True).json()

    def resume(self, job_id: str) -> dict[str, Any]:
        return self._link.send("POST", f"/jobs/{job_id}/resume").json()

    def log(self, job_id: str) -> Iterator[str]:
        """What the job said so far."""
        after = 0
        while lines := self._link.get(f"/jobs/{job_id}/log", after=after)["lines"]:
            yield from (line["text"] for line in lines)
            after = lines[-1]["n"]

    def wait(
        self,
        job_id: str,
        on_progress: Callable[[dict[str, Any]], None] = lambda job: None,
        timeout: float | None = None,
    ) -> dict[str, Any]:
        """Wait for the end of a job.

        Args:
            job_id: Which.
            on_progress: Called with the job whenever anything of it has changed.
            timeout: s; None waits for ever.

        Returns:
            The job; its track is `track_id`.
        """
        ends, version = None if timeout is None else time.monotonic() + timeout, -1
        while True:
            job = self.get(job_id)
            if job["version"] != version:
                version = job["version"]
                on_progress(job)
            if job["state"] == "succeeded":
                return job
            if job["state"] in ENDED:
                raise JobFailed(job)
            if ends is not None and time.monotonic() > ends:
                raise TimeoutError(f"The job {job_id} is still {job['state']} after {timeout:g} s; it is not finished.")
            time.sleep(POLL_SECONDS)

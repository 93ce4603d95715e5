"""What the studio refuses is raised with its words, and a conflict with how the thing is now."""

from __future__ import annotations

import httpx
import pytest

from server.client.answers import StaleError, StudioRefusal, check


def test_a_success_is_given_on() -> None:
    answer = httpx.Response(201, json={"id": 1})
    assert check(answer) is answer


def test_a_refusal_says_what_the_studio_said() -> None:
    with pytest.raises(StudioRefusal, match=r"NotFoundError \(404\): no such thing") as told:
        check(httpx.Response(404, json={"error": "NotFoundError", "detail": "no such thing"}))
    assert (told.value.status, told.value.error, told.value.detail) == (404, "NotFoundError", "no such thing")


def test_a_conflict_with_theirs_is_stale_and_one_without_is_not() -> None:
    with pytest.raises(StaleError) as told:
        check(httpx.Response(409, json={"error": "ConflictError", "detail": "changed", "theirs": {"revision": 4}}))
    assert told.value.theirs == {"revision": 4}
    with pytest.raises(StudioRefusal) as other:
        check(httpx.Response(409, json={"error": "ConflictError", "detail": "busy"}))
    assert not isinstance(other.value, StaleError)


@pytest.mark.parametrize("content", [b"<html>Bad gateway</html>", b"[1, 2]", b""])
def test_an_answer_that_is_not_ours_is_told_by_its_status(content: bytes) -> None:
    with pytest.raises(StudioRefusal) as told:
        check(httpx.Response(502, content=content))
    assert (told.value.status, told.value.detail) == (502, "status 502")

"""Operations that others have replaced answer for one version more, and name what replaces them."""

from __future__ import annotations

import re
from pathlib import Path

from fastapi import FastAPI
from fastapi.testclient import TestClient

from server.deprecation import SINCE, deprecated
from tests.server.api_document import read_document

PAGE = Path(__file__).parents[2] / "docs" / "api.md"


def list_operations(*, is_deprecated: bool) -> set[str]:
    return {
        f"{method.upper()} {path.removeprefix('/api/v1')}"
        for path, item in read_document()["paths"].items()
        for method, operation in item.items()
        if bool(operation.get("deprecated")) is is_deprecated
    }


def test_the_answer_of_a_deprecated_operation_says_since_when_and_what_to_use() -> None:
    app = FastAPI()

    @app.post("/old/{thing_id}/restore", **deprecated("/bin/thing/{thing_id}/restore"))
    def restore(thing_id: int) -> int:
        return thing_id

    answer = TestClient(app).post("/old/17/restore")
    assert answer.json() == 17
    assert answer.headers["Deprecation"] == f"@{SINCE.timestamp():.0f}"
    assert answer.headers["Link"] == '</api/v1/bin/thing/17/restore>; rel="successor-version"'
    assert app.openapi()["paths"]["/old/{thing_id}/restore"]["post"]["deprecated"] is True


def test_every_deprecated_operation_is_listed_with_one_that_is_not() -> None:
    section = PAGE.read_text().partition("### Deprecated")[2]
    listed = dict(re.findall(r"^\| `([A-Z]+ /\S*)` \| `([A-Z]+ /\S*)`.* \|$", section, re.MULTILINE))
    assert set(listed) == list_operations(is_deprecated=True)
    kept = {re.sub(r"\{kind\}", "KIND", operation) for operation in list_operations(is_deprecated=False)}
    for successor in listed.values():
        assert re.sub(r"/bin/\w+/", "/bin/KIND/", successor) in kept, successor

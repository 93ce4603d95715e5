"""Operations that others have replaced answer for one version more, and name what replaces them."""

from __future__ import annotations

import re
from pathlib import Path

import pytest
from fastapi import FastAPI
from fastapi.testclient import TestClient

from server.deprecation import SINCE, deprecated
from tests.server.api_document import read_document

ROOT = Path(__file__).resolve().parents[2]


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
    def restore(thing_id: str) -> str:
        return thing_id

    answer = TestClient(app).post("/old/17/restore")
    assert answer.json() == "17"
    assert answer.headers["Deprecation"] == f"@{SINCE.timestamp():.0f}"
    assert answer.headers["Link"] == '</api/v1/bin/thing/17/restore>; rel="successor-version"'
    odd = TestClient(app).post("/old/\U00087a0c>/restore")
    assert odd.status_code == 200
    assert odd.headers["Link"] == '</api/v1/bin/thing/%F2%87%A8%8C%3E/restore>; rel="successor-version"'
    assert app.openapi()["paths"]["/old/{thing_id}/restore"]["post"]["deprecated"] is True


def test_every_deprecated_operation_names_one_that_is_not() -> None:
    kept = {re.sub(r"\{\w+\}", "*", path) for path in list_operations(is_deprecated=False)}
    for operation in list_operations(is_deprecated=True):
        method, path = operation.split(" ")
        successor = read_document()["paths"][f"/api/v1{path}"][method.lower()]["x-successor"]
        pattern = re.sub(r"\{\w+\}", "*", f"{method} {re.sub('/bin/[a-z_]+/', '/bin/{kind}/', successor)}")
        assert pattern in kept, operation


@pytest.mark.parametrize("path", sorted({operation.split()[1] for operation in list_operations(is_deprecated=True)}))
def test_the_browser_app_the_client_and_the_examples_call_nothing_deprecated(path: str) -> None:
    asked = re.compile(r"\{[^{}]+\}".join(re.escape(part) + r"\$?" for part in re.split(r"\{\w+\}", path)) + "[`'\"?]")
    files = [*ROOT.glob("web/src/**/*.ts*"), *ROOT.glob("server/c*/**/*.py"), *ROOT.glob("examples/**/*.py")]
    assert len(files) > 200
    assert [file.name for file in files if file.name != "schema.ts" and asked.search(file.read_text())] == []

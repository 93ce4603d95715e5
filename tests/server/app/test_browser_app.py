"""The built browser app: files, addresses of its own, caches."""

from __future__ import annotations

import gzip
from collections.abc import Iterator
from pathlib import Path

import pytest
from fastapi.testclient import TestClient

from server.app import create_app
from server.settings import Settings
from tests.server.conftest import BASE_URL


@pytest.fixture
def dist(tmp_path: Path) -> Path:
    folder = tmp_path / "dist"
    (folder / "assets").mkdir(parents=True)
    (folder / "index.html").write_text("<html>one</html>")
    (folder / "assets" / "index-4f2a.js").write_text("run()")
    (folder / "icon.svg").write_text("<svg/>")
    (tmp_path / "secret.txt").write_text("secret")
    return folder


@pytest.fixture
def browser(dist: Path, sqlite_settings: Settings) -> Iterator[TestClient]:
    app = create_app(sqlite_settings.model_copy(update={"web_dist": dist}))
    with TestClient(app, base_url=BASE_URL) as client:
        yield client


@pytest.mark.parametrize("path", ["/", "/recordings", "/recordings/7/annotate?frame=3", "/index.html", "/a/b/c.d"])
def test_every_address_of_the_app_gives_the_app(browser: TestClient, path: str) -> None:
    answer = browser.get(path)
    assert (answer.status_code, answer.text) == (200, "<html>one</html>")
    assert answer.headers["cache-control"] == "no-cache"
    assert answer.headers["content-type"].startswith("text/html")


def test_hashed_files_are_kept_for_good_and_others_are_compared(browser: TestClient) -> None:
    script = browser.get("/assets/index-4f2a.js")
    assert script.text == "run()"
    assert "immutable" in script.headers["cache-control"]
    assert script.headers["content-type"].startswith("text/javascript")
    icon = browser.get("/icon.svg")
    assert browser.get("/icon.svg", headers={"If-None-Match": icon.headers["etag"]}).status_code == 304


def test_what_is_missing_is_not_answered_with_the_app(browser: TestClient) -> None:
    for path in ("/assets/old-1234.js", "/api/v2/x", "/api", "/viewer/unknown/x"):
        answer = browser.get(path)
        assert answer.status_code in (404, 422), path
        assert set(answer.json()) == {"error", "detail"}


@pytest.mark.parametrize(
    "path",
    [
        "/../secret.txt",
        "/%2e%2e/secret.txt",
        "/assets/../../secret.txt",
        "/assets/%2e%2e%2f%2e%2e%2fsecret.txt",
        "//etc/passwd",
        "/..%5csecret.txt",
        "/assets/%00",
    ],
)
def test_no_path_leads_out_of_the_app(browser: TestClient, path: str) -> None:
    answer = browser.get(path)
    assert answer.text != "secret"
    assert "root:" not in answer.text


def test_a_new_build_is_served_without_a_restart(browser: TestClient, dist: Path) -> None:
    browser.get("/")
    (dist / "assets" / "index-9999.js").write_text("more()")
    (dist / "index.html").write_text("<html>two</html>")
    assert browser.get("/").text == "<html>two</html>"
    assert browser.get("/assets/index-9999.js").text == "more()"


def test_an_app_that_is_not_built_says_how_to_build_it(tmp_path: Path) -> None:
    settings = Settings(data_dir=tmp_path / "data", web_dist=tmp_path / "nothing")
    with TestClient(create_app(settings), base_url=BASE_URL) as client:
        answer = client.get("/recordings")
        assert answer.status_code == 503
        assert "make setup" in answer.text
        assert client.get("/api/v1/health").status_code == 200


def test_files_that_the_build_packed_go_out_packed_to_those_who_take_it(browser: TestClient, dist: Path) -> None:
    script = dist / "assets" / "index-4f2a.js"
    (dist / "assets" / "index-4f2a.js.br").write_bytes(b"brotli of it")
    (dist / "assets" / "index-4f2a.js.gz").write_bytes(gzip.compress(b"run()"))
    (dist / "index.html").write_text("<html>new</html>")
    tags = set()
    for accepted, coding in (("gzip, br", "br"), ("gzip", "gzip"), ("br;q=0, gzip", "gzip"), ("identity", None)):
        with browser.stream("GET", "/assets/index-4f2a.js", headers={"Accept-Encoding": accepted}) as answer:
            sent = b"".join(answer.iter_raw())
        assert answer.headers.get("content-encoding") == coding, accepted
        assert sent == (script.with_name(f"{script.name}.{coding[:2]}") if coding else script).read_bytes()
        assert answer.headers["vary"] == "Accept-Encoding"
        assert answer.headers["content-type"].startswith("text/javascript")
        assert "immutable" in answer.headers["cache-control"]
        tags.add(answer.headers["etag"])
    assert len(tags) == 3, "each way of packing is another file to caches"
    assert browser.get("/assets/index-4f2a.js.br").status_code == 404, "a packed file has no address of its own"


def test_the_icon_is_kept_for_a_day(browser: TestClient) -> None:
    assert browser.get("/icon.svg").headers["cache-control"] == "public, max-age=86400"

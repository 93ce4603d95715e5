"""Settings: from the environment, from arguments, in the documentation."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from server.settings import Settings

ROOT = Path(__file__).parents[2]


def test_every_setting_is_documented_with_its_default() -> None:
    page = (ROOT / "docs/operating.md").read_text()
    rows = re.findall(r"^\| `HANDLOOM_(\w+)` \| (.+?) \| (.+?) \|$", page, re.MULTILINE)
    documented = {name.lower(): (default, text) for name, default, text in rows}
    assert documented.keys() == Settings.model_fields.keys()
    for name, field in Settings.model_fields.items():
        default, text = documented[name]
        assert text == field.description, name
        value = field.default
        shown = "none" if value is None or value == () else f"`{value}`"
        assert default == shown, name


def test_only_the_settings_read_the_environment() -> None:
    readers = [
        path.relative_to(ROOT).as_posix()
        for path in (ROOT / "server").rglob("*.py")
        if re.search(r"os\.environ(\[|\.get)|getenv\(|import environ", path.read_text())
    ]
    assert readers in ([], ["server/settings.py"])


def test_settings_come_from_the_environment_and_arguments_win(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.setenv("HANDLOOM_DATA_DIR", str(tmp_path))
    monkeypatch.setenv("HANDLOOM_PORT", "9000")
    monkeypatch.setenv("HANDLOOM_ALLOWED_HOSTS", "a.lab, b.lab")
    monkeypatch.setenv("HANDLOOM_WEB_DIST", "")
    settings = Settings(port=9001)
    assert (settings.data_dir, settings.port, settings.allowed_hosts) == (tmp_path, 9001, ("a.lab", "b.lab"))
    assert settings.web_dist is None
    assert settings.sqlalchemy_url == f"sqlite+pysqlite:///{tmp_path}/handloom.sqlite3"


def test_a_postgresql_url_of_any_spelling_uses_the_driver_that_comes_along() -> None:
    for url in ("postgresql://u@h/d", "postgres://u@h/d", "postgresql+psycopg://u@h/d"):
        assert Settings(database_url=url).sqlalchemy_url == "postgresql+psycopg://u@h/d"


def test_only_loopback_counts_as_loopback() -> None:
    assert Settings(host="127.0.0.1").is_loopback
    assert Settings(host="::1").is_loopback
    assert not Settings(host="0.0.0.0").is_loopback
    assert not Settings(host="192.168.1.2").is_loopback

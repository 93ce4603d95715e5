"""The files of docker/ against the program they run: no daemon is needed, and none is used."""

from __future__ import annotations

import os
import re
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest
import yaml

from server.cli.main import make_parser
from server.database import Database
from server.jobs import workers
from server.settings import Settings

ROOT = Path(__file__).resolve().parents[3]
COMPOSE = (ROOT / "docker" / "compose.yaml").read_text()
DOCKERFILE = (ROOT / "docker" / "Dockerfile").read_text()
OURS = ("web", "worker-1", "worker-2")


@pytest.fixture(scope="module")
def services() -> dict[str, Any]:
    return yaml.safe_load(COMPOSE)["services"]


def test_there_are_web_two_workers_a_database_and_a_store_and_each_says_whether_it_is_well(services) -> None:
    assert set(services) == {*OURS, "database", "store"}
    assert all("test" in service["healthcheck"] for service in services.values())
    for name in OURS:
        waits = services[name]["depends_on"]
        assert {value["condition"] for value in waits.values()} == {"service_healthy"}


def test_every_variable_is_a_setting(services) -> None:
    for name in OURS:
        given = {key for key in services[name]["environment"] if key.startswith("HANDLOOM_")}
        assert given <= {f"HANDLOOM_{field.upper()}" for field in Settings.model_fields}
        assert {"HANDLOOM_DATABASE_URL", "HANDLOOM_STORE_URL", "HANDLOOM_STORE_ENDPOINT"} <= given
    in_image = {f"HANDLOOM_{found}" for found in re.findall(r"HANDLOOM_([A-Z_]+)=", DOCKERFILE)}
    assert in_image <= {f"HANDLOOM_{field.upper()}" for field in Settings.model_fields}
    environment = services["web"]["environment"]
    Settings(store_url=environment["HANDLOOM_STORE_URL"], store_endpoint=environment["HANDLOOM_STORE_ENDPOINT"])


def test_every_command_is_one_of_ours_and_the_web_asks_for_a_login(services) -> None:
    for name in OURS:
        program, *arguments = services[name]["command"]
        assert program == "handloom"
        make_parser().parse_args(arguments)
    assert "--no-worker" in services["web"]["command"]
    assert services["web"]["environment"]["HANDLOOM_LOGIN"] == "required"
    assert services["web"]["ports"] == ["${HANDLOOM_PUBLISH:-127.0.0.1:8000}:8000"], "this machine only, unless told"
    assert not any("ports" in services[name] for name in services if name != "web")


def test_machines_have_data_folders_and_names_of_their_own(services) -> None:
    folders = [next(v for v in services[name]["volumes"] if v.endswith(":/data")) for name in OURS]
    assert len(set(folders)) == 3
    assert services["worker-1"]["environment"]["HANDLOOM_WORKER_HOST"] == "worker-1"
    assert services["worker-2"]["environment"]["HANDLOOM_WORKER_HOST"] == "worker-2"


def test_no_secret_has_a_default_and_every_one_is_explained() -> None:
    asked = set(re.findall(r"\$\{([A-Z_]+):\?", COMPOSE))
    assert asked == {"POSTGRES_PASSWORD", "STORE_ACCESS_KEY", "STORE_SECRET_KEY"}
    example = (ROOT / "docker" / "env.example").read_text()
    assert set(re.findall(r"^([A-Z_]+)=$", example, re.M)) == asked
    assert set(re.findall(r"\$\{([A-Z_]+):-", COMPOSE)) == set(re.findall(r"^#([A-Z_]+)=", example, re.M))
    assert not re.search(r"(PASSWORD|SECRET|KEY)[A-Z_]*:-", COMPOSE)


def test_the_image_is_made_of_what_is_here_and_does_not_run_as_root() -> None:
    copied = [name for line in re.findall(r"^COPY (?!--)(.+)$", DOCKERFILE, re.M) for name in line.split()[:-1]]
    assert copied
    for name in copied:
        assert (ROOT / name).exists(), name
        allowed = [line[1:] for line in (ROOT / ".dockerignore").read_text().splitlines() if line.startswith("!")]
        assert any(name == kept or name.startswith(f"{kept}/") for kept in allowed), name
    assert re.findall(r"^USER (.+)$", DOCKERFILE, re.M) == ["handloom"]
    assert DOCKERFILE.index("USER handloom") < DOCKERFILE.index("RUN handloom warm-up")


@pytest.mark.parametrize("is_there", [True, False])
def test_a_worker_container_is_well_while_its_worker_is_heard_of(
    is_there: bool, settings: Settings, database: Database
) -> None:
    with database.writing() as session:
        workers.register_worker(session, "other-0", "other")
        if is_there:
            workers.register_worker(session, "here-0", "here")
    environment = os.environ | {
        "HANDLOOM_DATABASE_URL": str(settings.database_url),
        "HANDLOOM_WORKER_HOST": "here",
        "PYTHONPATH": str(ROOT),
    }
    command = [sys.executable, "docker/worker_health.py"]
    assert (subprocess.run(command, cwd=ROOT, env=environment, timeout=60).returncode == 0) == is_there

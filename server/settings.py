"""Every setting of the studio. The only module that reads the environment; `docs/operating.md` lists them for users."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Literal

from pydantic import BeforeValidator, Field
from pydantic_settings import BaseSettings, NoDecode, SettingsConfigDict


def _split(value: object) -> object:
    return [part.strip() for part in value.split(",") if part.strip()] if isinstance(value, str) else value


Names = Annotated[tuple[str, ...], NoDecode, BeforeValidator(_split)]
LOOPBACK_HOSTS = ("127.0.0.1", "localhost", "::1")


class Settings(BaseSettings):
    """Read from variables `HANDLOOM_<NAME>`; an argument of the same name wins."""

    model_config = SettingsConfigDict(env_prefix="HANDLOOM_", frozen=True, extra="forbid", env_ignore_empty=True)

    data_dir: Path = Field(
        default=Path("~/.local/share/handloom"), description="Folder of everything the studio keeps."
    )
    database_url: str | None = Field(
        default=None,
        description="`postgresql://user@host/name`, or `sqlite:////path`; without it SQLite in the data folder.",
    )
    store_url: str | None = Field(
        default=None,
        pattern=r"^(s3://[^/]+(/.*)?|file:///.+)$",
        description="Where finished files are kept for several machines: `s3://bucket/prefix`, or `file:///folder`.",
    )
    store_endpoint: str | None = Field(
        default=None, description="Address of an S3-compatible store that is not Amazon's: `http://store:8333`."
    )
    store_cache_gb: float = Field(
        default=100.0, gt=0, description="GB of files that may stay in the data folder although they are in the store."
    )
    worker_host: str | None = Field(
        default=None,
        pattern=r"^[A-Za-z0-9._-]{1,100}$",
        description="Name of this machine among those with workers; without it its host name.",
    )
    host: str = Field(default="127.0.0.1", description="Address to listen at.")
    port: int = Field(default=8000, ge=0, le=65535, description="Port to listen at; 0 takes a free one.")
    log_level: Literal["DEBUG", "INFO", "WARNING", "ERROR"] = Field(
        default="INFO", description="Least severity of the lines that are logged."
    )
    allowed_hosts: Names = Field(
        default=(), description="Further host names, separated by commas, that a request may be addressed to."
    )
    allowed_origins: Names = Field(
        default=(), description="Further origins (`http://localhost:5173`), separated by commas, whose pages may write."
    )
    login: Literal["auto", "required"] = Field(
        default="auto",
        description="`auto`: people log in unless only this machine can reach the studio; `required`: here too.",
    )
    login_days: float = Field(
        default=14.0, gt=0, le=400, description="Days after which a browser that was not used must log in again."
    )
    web_dist: Path | None = Field(
        default=None, description="Folder of the built browser app; without it the one that came with the server."
    )
    max_upload_bytes: int = Field(
        default=20 * 1024**3, gt=0, description="Most bytes of one upload, and of what is unpacked from it."
    )
    max_upload_files: int = Field(
        default=100_000, gt=0, description="Most files of one upload, and of what is unpacked from it."
    )
    abandoned_import_hours: float = Field(
        default=24.0,
        gt=0,
        description="Hours after which unconfirmed uploads and unused films are removed when the studio starts.",
    )
    image_cache_mb: int = Field(
        default=256, ge=0, description="Memory in MB for images that had to be encoded for the browser."
    )

    def model_post_init(self, _context: object) -> None:
        """Make paths absolute once, so that a later change of folder moves nothing."""
        object.__setattr__(self, "data_dir", self.data_dir.expanduser().absolute())
        if self.web_dist is not None:
            object.__setattr__(self, "web_dist", self.web_dist.expanduser().absolute())

    @property
    def is_loopback(self) -> bool:
        """Whether only this machine can reach the address."""
        return self.host in LOOPBACK_HOSTS

    @property
    def is_login_needed(self) -> bool:
        """Whether people must log in: always when the address, or a name for a proxy, is not this machine's own."""
        names = {self.host.lower(), *(host.lower() for host in self.allowed_hosts)}
        return self.login == "required" or not names <= {*LOOPBACK_HOSTS}

    @property
    def sqlalchemy_url(self) -> str:
        """The database as SQLAlchemy names it, with the drivers that come with Handloom."""
        if self.database_url is None:
            return f"sqlite+pysqlite:///{self.data_dir / 'handloom.sqlite3'}"
        for prefix in ("postgresql://", "postgres://"):
            if self.database_url.startswith(prefix):
                return "postgresql+psycopg://" + self.database_url.removeprefix(prefix)
        return self.database_url

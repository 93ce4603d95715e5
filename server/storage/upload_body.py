"""The body of an upload as the API's documentation describes it, and what a form with one file says."""

from __future__ import annotations

from pathlib import Path
from typing import Any, TypeVar

from pydantic import BaseModel

from server.errors import InvalidError
from server.storage.sent_json import reading_json
from server.storage.upload import Upload

Options = TypeVar("Options", bound=BaseModel)


def describe_upload_body(files: str, *, is_one: bool = False, **more: dict[str, Any]) -> dict[str, Any]:
    """The request body for `openapi_extra`.

    Args:
        files: What the field `files` holds.
        is_one: Whether it is one file.
        more: JSON schemas of the form's other fields, by name.
    """
    file = {"type": "string", "format": "binary"}
    held = file if is_one else {"type": "array", "items": file}
    properties = {"files": {**held, "description": files}, **more}
    schema = {"type": "object", "required": ["files"], "properties": properties}
    return {"requestBody": {"required": True, "content": {"multipart/form-data": {"schema": schema}}}}


def read_one_file(folder: Path, upload: Upload, of: str, kind: type[Options], needed: str) -> tuple[Path, Options]:
    """The only file of an upload, and what the form's other fields say of it.

    Args:
        folder: Where the files are.
        upload: What arrived.
        of: What the file holds, such as "detector".
        kind: Of the fields; empty ones count as left out.
        needed: What the form must hold.

    Raises:
        InvalidError: Another number of files, or a field that is wrong.
    """
    if len(upload.names) != 1:
        raise InvalidError(f"The upload holds {len(upload.names)} files; needed one {of}.")
    with reading_json("The form", needed):
        options = kind.model_validate({name: text for name, text in upload.fields.items() if text.strip()})
    return folder / upload.names[0], options

"""A form with one file: the file and what its fields say, or what came in their place."""

from __future__ import annotations

from pathlib import Path

import pytest
from pydantic import BaseModel, ConfigDict

from server.errors import InvalidError
from server.storage.upload import Upload
from server.storage.upload_body import describe_upload_body, read_one_file

NEEDED = "`name`, and `count` where it is known"


class Options(BaseModel):
    model_config = ConfigDict(extra="forbid")

    name: str
    count: int = 7


def read(folder: Path, names: list[str], **fields: str) -> tuple[Path, Options]:
    upload = Upload(folder, max_files=9, max_bytes=99)
    upload.names.extend(names)
    upload.fields.update(fields)
    return read_one_file(folder, upload, "detector", Options, NEEDED)


def test_one_file_comes_with_what_the_fields_say(tmp_path: Path) -> None:
    assert read(tmp_path, ["a/b.onnx"], name="ours", count="3") == (
        tmp_path / "a/b.onnx",
        Options(name="ours", count=3),
    )


def test_an_empty_field_counts_as_left_out(tmp_path: Path) -> None:
    assert read(tmp_path, ["b.onnx"], name="ours", count=" \t")[1].count == 7


@pytest.mark.parametrize("names", [[], ["a", "b"]])
def test_another_number_of_files_is_told_with_what_is_needed(tmp_path: Path, names: list[str]) -> None:
    with pytest.raises(InvalidError, match=f"The upload holds {len(names)} files; needed one detector"):
        read(tmp_path, names, name="ours")


@pytest.mark.parametrize(
    ("fields", "told"),
    [
        ({}, r"name: Field required \(got '\{\}'\)"),
        ({"name": "ours", "count": "many"}, r"count: .*\(got 'many'\)"),
        ({"name": "ours", "colour": "red"}, r"colour: Extra inputs are not permitted \(got 'red'\)"),
    ],
)
def test_a_field_that_is_wrong_is_named_with_what_came(tmp_path: Path, fields: dict[str, str], told: str) -> None:
    with pytest.raises(InvalidError, match=f"The form is wrong: {told}; needed {NEEDED}"):
        read(tmp_path, ["b.onnx"], **fields)


def test_the_documentation_names_the_files_and_every_other_field() -> None:
    [(kind, body)] = describe_upload_body("A film each.", name={"type": "string"})["requestBody"]["content"].items()
    schema = body["schema"]
    assert kind == "multipart/form-data" and schema["required"] == ["files"]
    assert schema["properties"] == {
        "files": {"type": "array", "items": {"type": "string", "format": "binary"}, "description": "A film each."},
        "name": {"type": "string"},
    }
    one = describe_upload_body("It.", is_one=True)["requestBody"]["content"]["multipart/form-data"]["schema"]
    assert one["properties"] == {"files": {"type": "string", "format": "binary", "description": "It."}}

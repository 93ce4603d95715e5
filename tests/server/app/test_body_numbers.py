"""In the JSON of a request true is no number: of no body that the API takes."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import pytest
from pydantic import BaseModel, TypeAdapter, ValidationError

from server.annotations.schemas import Visibility
from server.database.numbers import FrameNumber, Joint, Whole
from server.quality.schemas import FlagLook
from tests.server.api_document import read_document

DOCUMENT = read_document()


def find_models(of: type[BaseModel] = BaseModel) -> Iterator[type[BaseModel]]:
    for model in of.__subclasses__():
        yield model
        yield from find_models(model)


def find_lax(schema: Any, place: str) -> Iterator[str]:
    """Places in a schema of pydantic's core where true would pass for 1."""
    if isinstance(schema, list | tuple):
        for part in schema:
            yield from find_lax(part, place)
    if not isinstance(schema, dict):
        return
    if schema.get("type") in ("int", "float") and not schema.get("strict"):
        yield place
    for name, part in schema.items():
        if name == "fields" and isinstance(part, dict):
            for field, inner in part.items():
                yield from find_lax(inner, f"{place}.{field}")
        elif name not in ("metadata", "serialization", "default"):
            yield from find_lax(part, place)


def test_no_body_takes_true_for_a_number() -> None:
    operations = [operation for path in DOCUMENT["paths"].values() for operation in path.values()]
    bodies = [
        operation["requestBody"]["content"].get("application/json", {})
        for operation in operations
        if "requestBody" in operation
    ]
    names = {body["schema"]["$ref"].split("/")[-1] for body in bodies if "$ref" in body.get("schema", {})}
    models = {model.model_config.get("title") or model.__name__: model for model in find_models()}
    assert len(names) > 30 and names <= models.keys()
    lax = [place for name in sorted(names) for place in find_lax(models[name].__pydantic_core_schema__, name)]
    assert lax == []


@pytest.mark.parametrize("kind", [Whole, FrameNumber, Joint])
def test_a_whole_number_may_be_written_with_a_point(kind: Any) -> None:
    assert TypeAdapter(kind).validate_json("17.0") == 17


def test_the_revision_of_a_dismissed_flag_may_be_written_with_a_point() -> None:
    assert FlagLook.model_validate_json('{"revision": 48586.0}').revision == 48586


@pytest.mark.parametrize("kind", [Whole, FrameNumber, Joint])
@pytest.mark.parametrize("sent", [True, False, "5", 5.5, None, float("inf"), float("nan")])
def test_a_whole_number_is_a_number_of_json_and_nothing_else(kind: Any, sent: object) -> None:
    with pytest.raises(ValidationError):
        TypeAdapter(kind).validate_python(sent)


def test_visibility_is_no_truth() -> None:
    with pytest.raises(ValidationError, match="not true or false"):
        TypeAdapter(Visibility).validate_python(True)

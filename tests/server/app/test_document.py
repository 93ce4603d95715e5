"""The OpenAPI document is one that other people's tools read."""

from __future__ import annotations

import json
from collections.abc import Iterator
from typing import Any

import jsonschema_rs

from tests.server.api_document import read_document

DOCUMENT = read_document()


def find_schemas(node: Any) -> Iterator[dict[str, Any]]:
    """Schemas of bodies, parameters and headers, and the named ones."""
    if isinstance(node, dict):
        if isinstance(node.get("schema"), dict):
            yield node["schema"]
        for key, value in node.items():
            if key != "schema":
                yield from find_schemas(value)
    elif isinstance(node, list):
        for value in node:
            yield from find_schemas(value)


def test_every_schema_is_valid_json_schema() -> None:
    schemas = [*find_schemas(DOCUMENT["paths"]), *DOCUMENT["components"]["schemas"].values()]
    assert len(schemas) > 500
    distinct = {json.dumps(schema, sort_keys=True): schema for schema in schemas}
    for schema in distinct.values():
        jsonschema_rs.Draft202012Validator({**schema, "components": DOCUMENT["components"]})
        jsonschema_rs.meta.validate({"$schema": "https://json-schema.org/draft/2020-12/schema", **schema})


def test_answers_hold_no_tuples_which_many_tools_cannot_read() -> None:
    skeleton = DOCUMENT["components"]["schemas"]["HandSkeleton"]["properties"]["edges"]["items"]
    assert skeleton == {"type": "array", "items": {"type": "integer"}, "minItems": 2, "maxItems": 2}
    point = DOCUMENT["components"]["schemas"]["AnnotationOut"]["properties"]["points"]["items"]
    assert point == {"type": "array", "items": {"type": "number"}, "minItems": 3, "maxItems": 3}


def test_a_change_that_needs_a_revision_says_so() -> None:
    for item in DOCUMENT["paths"].values():
        for operation in item.values():
            heads = {p["name"]: p["required"] for p in operation.get("parameters", []) if p["in"] == "header"}
            if "428" in operation["responses"] and "if-none-match" not in heads:
                assert heads["if-match"], operation["operationId"]
            for parameter in operation.get("parameters", []):
                assert {"type": "null"} not in parameter["schema"].get("anyOf", []), operation["operationId"]

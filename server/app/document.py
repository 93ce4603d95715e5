"""The OpenAPI document, said so that every tool reads it: FastAPI's own, with what it cannot know put right."""

from __future__ import annotations

from typing import Any

from fastapi import FastAPI


class DocumentedApp(FastAPI):
    """An app whose OpenAPI document says what its routes really take."""

    def openapi(self) -> dict[str, Any]:
        if self.openapi_schema is None:
            document = super().openapi()
            for item in document["paths"].values():
                for operation in item.values():
                    _tidy_parameters(operation)
            _simplify_tuples(document["components"])
            _simplify_tuples(document["paths"])
        assert self.openapi_schema is not None
        return self.openapi_schema


def _tidy_parameters(operation: dict[str, Any]) -> None:
    """A header or a query is never null, and `If-Match` is needed where its lack is answered by 428."""
    parameters = operation.get("parameters", [])
    for parameter in parameters:
        kinds = parameter["schema"].pop("anyOf", None)
        if kinds is not None:
            kinds = [kind for kind in kinds if kind != {"type": "null"}]
            parameter["schema"] |= kinds[0] if len(kinds) == 1 else {"anyOf": kinds}
    needed = {
        parameter["name"]: parameter for parameter in parameters if parameter["name"] in ("if-match", "if-none-match")
    }
    if "428" in operation["responses"] and set(needed) == {"if-match"}:
        needed["if-match"]["required"] = True


def _simplify_tuples(node: Any) -> None:
    """A tuple of one kind is an array of that kind and of fixed length: not every tool reads `prefixItems`."""
    if isinstance(node, dict):
        kinds = node.get("prefixItems")
        if isinstance(kinds, list) and "items" not in node and all(kind == kinds[0] for kind in kinds):
            node["items"] = kinds[0]
            del node["prefixItems"]
        for value in node.values():
            _simplify_tuples(value)
    elif isinstance(node, list):
        for value in node:
            _simplify_tuples(value)

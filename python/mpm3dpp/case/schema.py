# SPDX-License-Identifier: BSD-3-Clause
"""The JSON schema of case files."""

from __future__ import annotations

from typing import Any

from pydantic import BaseModel

from mpm3dpp.shapes.base import KINDS


def schema_of(case: type[BaseModel]) -> dict[str, Any]:
    """Return the schema of the model of cases, with the tables of all shapes."""
    schema = case.model_json_schema()
    definitions = schema.setdefault("$defs", {})
    definitions["shape"] = {
        "type": "object",
        "additionalProperties": False,
        "minProperties": 1,
        "maxProperties": 1,
        "properties": {kind: shape.model_json_schema() for kind, shape in KINDS.items()},
    }
    definitions["Body"]["properties"]["shape"] = {"$ref": "#/$defs/shape"}
    return schema

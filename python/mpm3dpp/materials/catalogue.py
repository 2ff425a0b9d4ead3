# SPDX-License-Identifier: BSD-3-Clause
"""Material models: the catalogue of the core is the schema; nothing is listed here again."""

from __future__ import annotations

import importlib
from functools import lru_cache
from typing import Any

KINDS = {
    "strength": "strength model",
    "eos": "equation of state",
    "failure": "failure model",
}
"""Kinds of models, as the key of a material, and in words."""


@lru_cache(maxsize=len(KINDS))
def catalogue(kind: str = "strength") -> dict[str, Any]:
    """Return the models of a kind that the core knows, by name.

    Each has `name`, `doc`, `source`, `parameters` (each with `name`, `unit`, `meaning`, `default`
    or None, `rule` in words, `bounds`) and `state` (the columns that the model stores, each with
    `name` and `unit`); a strength model also has `eos`, whether it "never", "may" or "must" have an
    equation of state.
    """
    core = importlib.import_module("mpm3dpp._core")
    return {model.name: model for model in core.catalogue() if model.kind == kind}


def state_columns(models: set[str]) -> list[str]:
    """Return the names of the state columns that these models store, in the catalogue's order."""
    every = [item for kind in KINDS for item in catalogue(kind).items()]
    names = [s.name for name, model in every if name in models for s in model.state]
    return list(dict.fromkeys(names))

# SPDX-License-Identifier: BSD-3-Clause
"""The record of a run, read back from `manifest.json` as the `Manifest` that was written."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Mapping
from pathlib import Path
from typing import Any, TypeVar

from mpm3dpp.base.errors import CaseError

from .manifest import Manifest, read_manifest
from .records import ContactRecord, LoadRecord, PairRecord, WallRecord, WarningRecord

Record = TypeVar("Record")

# What the manifests of earlier versions did not have.
_LATER: dict[str, Any] = {
    "left": {"mass": 0.0, "count": 0},
    "ranks": {"mpi": None, "ranks": 1, "share": 0.0, "imbalance": 1.0},
    "device": "cpu",
    "walls": {},
    "notes": [],
    "processor": "",
    "command": "",
    "case_file": "",
}


def stored_manifest(folder: Path) -> Manifest:
    """Return the record of a run; numbers that JSON could not hold are NaN.

    Args:
        folder: of the run.

    Raises:
        CaseError: the file is missing, or is no manifest, or damaged.
    """
    data = _LATER | read_manifest(folder)
    try:
        contact = dict(data["contact"])
        contact["pairs"] = [_record(PairRecord, pair) for pair in contact["pairs"]]
        data["contact"] = _record(ContactRecord, contact)
        data["loads"] = {k: _record(LoadRecord, v) for k, v in data["loads"].items()}
        data["walls"] = {k: _record(WallRecord, v) for k, v in data["walls"].items()}
        data["warnings"] = [_record(WarningRecord, v) for v in data["warnings"]]
        for name in ("energies", "bodies"):
            data[name] = _numbers(data[name])
        return _record(Manifest, data)
    except (AttributeError, KeyError, TypeError, ValueError) as error:
        rule = f"'{folder / 'manifest.json'}' is not a manifest of mpm3dpp, or damaged"
        raise CaseError(rule, "remove it, or run the case again") from error


def _record(kind: type[Record], data: Mapping[str, Any]) -> Record:
    """Return a record of what is known of it; names that it does not have are left out."""
    names = {field.name for field in dataclasses.fields(kind)}  # type: ignore[arg-type]
    return kind(**{name: value for name, value in data.items() if name in names})


def _numbers(value: Any) -> Any:
    """Return tables of numbers with NaN for what JSON could not hold."""
    if isinstance(value, dict):
        return {name: _numbers(item) for name, item in value.items()}
    return math.nan if value is None else value

# SPDX-License-Identifier: BSD-3-Clause
"""The record of a run, read back from `manifest.json`, and checked as it is read."""

from __future__ import annotations

import json
from functools import cache
from pathlib import Path
from typing import Any

from pydantic import TypeAdapter, ValidationError

from mpm3dpp.base.errors import CaseError
from mpm3dpp.base.reading import read_file

from .manifest import Manifest

_MOST = 256 << 20  # Bytes of a manifest that are read.

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


def read_manifest(path: str | Path) -> dict[str, Any]:
    """The record of a run as plain data.

    Args:
        path: `manifest.json` or the output folder that holds it.

    Raises:
        CaseError: the file is missing, or is no manifest, or damaged.
    """
    path = _file(path)
    data = manifest_data(path)
    _checked(data, path)
    return data


def stored_manifest(path: str | Path) -> Manifest:
    """Return the record of a run; numbers that JSON could not hold are NaN.

    Args:
        path: see `read_manifest`.

    Raises:
        CaseError: see `read_manifest`.
    """
    path = _file(path)
    return _checked(manifest_data(path), path)


def manifest_data(path: str | Path) -> dict[str, Any]:
    """Return what a manifest holds, whatever that is. Arguments and errors: `read_manifest`."""
    path = _file(path)
    try:
        data = json.loads(read_file(path, _MOST, "give the output folder of a run"))
    except FileNotFoundError as error:
        raise CaseError(f"there is no file '{path}': give the output folder of a run") from error
    except CaseError as error:
        raise CaseError(f"'{path}' {error.rule}", error.remedy) from error
    except (OSError, ValueError, RecursionError) as error:
        raise CaseError(f"'{path}' is not a manifest of mpm3dpp: {error}") from error
    if not isinstance(data, dict):
        raise CaseError(f"'{path}' is not a manifest of mpm3dpp: it holds no table")
    return data


def _file(path: str | Path) -> Path:
    path = Path(path)
    return path / "manifest.json" if path.is_dir() else path


def _checked(data: dict[str, Any], path: Path) -> Manifest:
    """Return the record; names that it does not have are left out."""
    try:
        # Text, since tables are those of JSON there and no objects of ours.
        return _form().validate_json(json.dumps(_LATER | data), strict=True)
    except (ValidationError, ValueError, RecursionError) as error:
        where = ""
        if isinstance(error, ValidationError):
            first = error.errors(include_url=False, include_context=False, include_input=False)[0]
            where = f" ({'.'.join(map(str, first['loc']))}: {first['msg'].lower()})"
        rule = f"'{path}' is not a manifest of mpm3dpp, or damaged{where}"
        raise CaseError(rule, "remove it, or run the case again") from error


@cache
def _form() -> TypeAdapter[Manifest]:
    return TypeAdapter(Manifest)

# SPDX-License-Identifier: BSD-3-Clause
"""What `results.vtkhdf` tells of a run and of its frames, checked as it is read."""

from __future__ import annotations

import json
from collections.abc import Collection, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, Literal

import numpy as np
from pydantic import BaseModel, ConfigDict, Field, FiniteFloat

from mpm3dpp.base.errors import CaseError

from .forms import Length
from .open_h5 import checked_h5, own

if TYPE_CHECKING:
    import h5py

_BROKEN = (OSError, LookupError, ValueError, TypeError, AttributeError, RuntimeError)
"""What h5py and pydantic raise when they meet what nobody has written."""


class RunTold(BaseModel):
    """Of the run; see `Results`. `frames` is the folder with its frames, None in one file."""

    model_config = ConfigDict(strict=True, extra="allow")
    title: str
    case_hash: str
    bodies: list[str]
    materials: list[str]
    dimension: Literal[2, 3]
    cell_size: Length
    origin: Annotated[list[FiniteFloat], Field(min_length=3, max_length=3)]
    units: dict[str, str]
    walls: list[str] = []
    box: list[list[FiniteFloat]] = []
    frames: Annotated[str, Field(pattern=r"^[^/\\\x00]+$")] | None = None


@dataclass
class ResultsFile:
    """A results file, open: what it tells, times [s] and steps of its frames, and their arrays."""

    file: h5py.File
    root: h5py.Group
    run: RunTold
    times: list[float]
    steps: list[int]
    names: list[str]


def open_file(path: Path) -> ResultsFile:
    """Open a results file. Raises `CaseError` if it is none of ours, or damaged."""
    try:
        file = checked_h5(path)
        try:
            return _told(file)
        except BaseException:
            file.close()
            raise
    except CaseError as error:
        raise CaseError(f"'{path}' {error.rule}", error.remedy) from error
    except _BROKEN as error:
        rule = f"'{path}' is not a results file of mpm3dpp, or damaged"
        raise CaseError(f"{rule}: give the results.vtkhdf of a run") from error


def _told(file: h5py.File) -> ResultsFile:
    root = file["VTKHDF"]
    count = int(root["Steps"].attrs["NSteps"])
    times = np.asarray(own(root["Steps/Values"])[()], dtype=float)
    steps = np.zeros(0, dtype=np.int64)
    if "step" in root["FieldData"]:
        steps = np.asarray(own(root["FieldData/step"])[()])
        if steps.dtype.kind not in "iu":
            raise ValueError("steps that are no whole numbers")
    for table in (times, *([steps] if len(steps) else [])):
        if table.ndim != 1 or not 0 <= count <= len(table) or not np.isfinite(table).all():
            raise ValueError("other frames")
    run = RunTold.model_validate(json.loads(file["mpm3dpp"].attrs["run"]))
    names = ["position", *root["PointData"]]
    return ResultsFile(file, root, run, times[:count].tolist(), steps[:count].tolist(), names)


def are_whole(
    arrays: Mapping[str, np.ndarray], names: Collection[str], counts: Mapping[str, int]
) -> bool:
    """Return whether arrays of a frame are what readers take them for.

    Args:
        arrays: by name.
        names: of those that must be there.
        counts: name -> how many words an array counts: its numbers are below that.
    """
    rows = len(arrays["position"]) if "position" in arrays else -1
    for name, values in arrays.items():
        if values.dtype.kind not in "fiu" or values.ndim not in (1, 2) or len(values) != rows:
            return False
        if values.ndim != _DIMENSIONS.get(name, values.ndim):
            return False
        is_vector = name in ("position", "velocity")
        if is_vector and values.shape[1] != 3:
            return False
        if name in counts and rows and not _counts(values, counts[name]):
            return False
    return set(names) <= set(arrays)


_DIMENSIONS = {"position": 2, "velocity": 2, "stress": 2} | dict.fromkeys(
    ("size", "body", "grain", "material", "failed", "mass", "density", "pressure"), 1
)


def _counts(values: Any, most: int) -> bool:
    return values.dtype.kind in "iu" and 0 <= values.min() <= values.max() < most

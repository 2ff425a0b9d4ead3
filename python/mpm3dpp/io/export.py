# SPDX-License-Identifier: BSD-3-Clause
"""Frames of a run as files for other programs."""

from __future__ import annotations

import shutil
import tempfile
from pathlib import Path
from typing import Any

import numpy as np

from mpm3dpp.base.disk import make_folder, replacing, writing
from mpm3dpp.base.errors import CaseError
from mpm3dpp.base.ours import MARK, refuse_others

from .data_frames import columns_of
from .results import Results
from .rows import TO_VTK
from .where import chosen


def export(
    results: Results,
    frame: int,
    out: Path,
    kind: str = "csv",
    where: str = "",
    *,
    strain: bool = False,
) -> Path:
    """Write a frame to a file, and return it.

    Args:
        results: of a run.
        frame: see `Results.arrays`.
        out: the file.
        kind: "csv", a row for each particle and a column for each component of what it has; "vtu"
            or "vtp", points with these arrays, which need PyVista.
        where: conditions on the particles (`io/where.py`); all if empty.
        strain: whether to add the strain since the first frame (`Results.strain`).

    Raises:
        IndexError: there is no such frame.
        CaseError: the file cannot be written, or one is there that is not of an export; PyVista is
            not installed, or see `chosen`.
    """
    arrays = results.arrays(frame)
    if strain:
        arrays["strain"] = results.strain(frame)
    columns = columns_of(arrays)
    keep = np.ones(len(arrays["position"]), dtype=bool)
    if where:
        words = {"body": results.bodies, "material": results.materials}
        units = {name: results.units.get(_array_of(name, results), "") for name in columns}
        keep = chosen(where, columns, words, units)
    if not keep.any():
        raise CaseError("leaves no particle", "give other conditions", key="where", value=where)
    make_folder(out.parent)
    if kind == "csv":
        refuse_others(out, b"position_x,", mark="")
        _write_csv(out, {name: values[keep] for name, values in columns.items()})
        return out
    cloud: Any = results[frame]
    if strain:
        cloud.point_data["strain"] = arrays["strain"][:, TO_VTK]
    if where:
        cloud = cloud.extract_points(np.flatnonzero(keep), adjacent_cells=False)
    whole = cloud.cast_to_unstructured_grid() if kind == "vtu" else _as_poly_data(cloud)
    refuse_others(out, b"<?xml")
    _save_vtk(out, whole, kind)
    return out


def _save_vtk(out: Path, whole: Any, kind: str) -> None:
    """Write a file for VTK, with our mark as a comment at its head."""
    with (
        writing(out),
        tempfile.TemporaryDirectory(prefix=".", dir=out.parent) as folder,
    ):
        made = Path(folder, f"made.{kind}")
        whole.save(made)
        with open(made, "rb") as source, replacing(out) as file:
            file.write(source.readline() + f"<!-- {MARK} -->\n".encode())
            shutil.copyfileobj(source, file)


def _as_poly_data(cloud: Any) -> Any:
    """Return points with what they and the whole have; of all points they are that already."""
    import pyvista

    if isinstance(cloud, pyvista.PolyData):
        return cloud
    points = pyvista.PolyData(np.asarray(cloud.points))
    points.point_data.update(cloud.point_data)
    points.field_data.update(cloud.field_data)
    return points


def _array_of(column: str, results: Results) -> str:
    """Return the array of which a column is a component."""
    return column if column in results.fields else column.rpartition("_")[0]


def _write_csv(out: Path, columns: dict[str, np.ndarray]) -> None:
    """Write a table; single numbers have as many digits as tell them apart."""
    kinds = ["%d" if np.issubdtype(c.dtype, np.integer) else "%.9g" for c in columns.values()]
    with replacing(out) as file:
        file.write((",".join(columns) + "\n").encode())
        rows = np.rec.fromarrays([*columns.values()])
        np.savetxt(file, rows, fmt=kinds, delimiter=",")


def file_name(frame: int, kind: str) -> str:
    """Return the name that the file of a frame has by default."""
    return f"frame_{frame:06d}.{kind}"

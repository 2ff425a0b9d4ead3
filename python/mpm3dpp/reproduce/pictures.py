# SPDX-License-Identifier: BSD-3-Clause
"""Our pictures in place of the paper's figures."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from mpm3dpp.io.results import open_results
from mpm3dpp.plots import first_contact
from mpm3dpp.plots.frames import save_frame, view_of
from mpm3dpp.plots.labels import scaled
from mpm3dpp.plots.used_cells import save_used_cells

from .runs import Done, Measured, held_cells, tile_cells


@dataclass
class Picture:
    """A picture that was made.

    Attributes:
        path: of the file.
        caption: what it shows, in a few words.
    """

    path: Path
    caption: str


def make(number: int, measured: Measured, out: Path) -> list[Picture]:
    """Make our pictures in place of a figure of the paper; none where the run gave nothing.

    Args:
        number: of the figure.
        measured: the example that it belongs to.
        out: folder of the pictures.

    Raises:
        CaseError: a file cannot be read or written.
    """
    draw, run = _FIGURES[number]
    return draw(measured.runs[run], out / f"figure_{number}.png")


def _last_frame(done: Done, path: Path) -> list[Picture]:
    return _frames(done, path, shares=(1.0,))


def _several_frames(done: Done, path: Path) -> list[Picture]:
    return _frames(done, path, shares=(0.25, 0.5, 0.75, 1.0))


def _from_the_start(done: Done, path: Path) -> list[Picture]:
    return _frames(done, path, shares=(0.0, 1 / 3, 2 / 3, 1.0))


def _frames(done: Done, path: Path, shares: tuple[float, ...]) -> list[Picture]:
    """Draw the frames nearest to shares of the end time, alike in view and colours."""
    colour = done.case.output.picture
    made = []
    with open_results(done.folder) as results:
        if not len(results):
            return []
        wanted = [share * float(results.times[-1]) for share in shares]
        numbers = [int(np.abs(results.times - time).argmin()) for time in wanted]
        numbers = list(dict.fromkeys(numbers))
        view = view_of(results, numbers, colour)
        for k, number in enumerate(numbers):
            letter = chr(ord("a") + k) if len(numbers) > 1 else ""
            file = save_frame(results, number, path.with_stem(path.stem + letter), colour, view)
            time = scaled(float(results.times[number]), "s")
            made.append(Picture(file, f"{colour.replace('_', ' ')} at {time}"))
    return made


def _used(done: Done, path: Path) -> list[Picture]:
    curves = {
        "cells that hold a particle": held_cells(done),
        "cells of tiles, each body's counted": tile_cells(done),
    }
    if any(not np.isfinite(shares).all() or not len(shares) for _, shares in curves.values()):
        return []
    most = float(curves["cells that hold a particle"][1].max())
    return [Picture(save_used_cells(curves, path), f"at most {most:.2%} hold a particle")]


def _touch(done: Done, path: Path) -> list[Picture]:
    file = first_contact(done.folder, path)
    gap = first_gap(done)
    if file is None or gap is None:
        return []
    shown = f"{round(gap, 2) + 0.0:.2f}"  # Never -0.00.
    return [Picture(file, f"{done.label} rule: at the first contact the gap is {shown} cells")]


def first_gap(done: Done) -> float | None:
    """Return the distance of the surfaces at the first contact force [cells]; None without one."""
    pairs = [p for p in done.manifest["contact"]["pairs"] if p["first_time"] is not None]
    if not pairs:
        return None
    first = min(pairs, key=lambda pair: pair["first_time"])
    return float(first["first_gap"]) / float(done.manifest["cell_size"])


# What draws the figure, and which run of the example it shows.
_FIGURES: dict[int, tuple[Callable[[Done, Path], list[Picture]], int]] = {
    9: (_last_frame, 0),
    10: (_used, 0),
    12: (_several_frames, 0),
    13: (_from_the_start, 0),
    14: (_touch, 0),
    15: (_touch, 1),
}

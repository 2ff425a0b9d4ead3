# SPDX-License-Identifier: BSD-3-Clause
"""Results as a notebook shows them: a small table, and pictures of their frames."""

from __future__ import annotations

import abc
import importlib
from collections.abc import Collection
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from mpm3dpp.base.markup import element, joined, table

if TYPE_CHECKING:
    from matplotlib.figure import Figure

_MOST_NAMES = 12


class Shown(abc.ABC):
    """What notebooks show of results; of `Results`."""

    path: Path
    title: str
    dimension: int
    cell_size: float
    times: np.ndarray
    bodies: list[str]
    materials: list[str]
    units: dict[str, str]
    _names: list[str]

    @abc.abstractmethod
    def number(self, frame: int) -> int:
        """See `Results`."""

    @abc.abstractmethod
    def arrays(self, frame: int, names: Collection[str] | None = None) -> dict[str, np.ndarray]:
        """See `Results`."""

    def plot(
        self,
        frame: int = -1,
        colour: str | None = None,
        *,
        section: Any = None,
        view: Any = None,
        crop: Any = None,
        range: Any = None,
        size: Any = None,
        arrows: bool = False,
    ) -> Figure:
        """Return a picture of a frame, a matplotlib `Figure`, which a notebook shows.

        `results.plot(colour="pressure", section="y=0")`; `figure.savefig("frame.png")` writes it.

        Args:
            frame: number of the frame; negative numbers count from the end.
            colour, section, view, crop, range, size, arrows: see `mpm3dpp.plots.plot_results`.

        Raises:
            IndexError: there is no such frame.
            CaseError: one of the arguments is wrong; or see `arrays`.
        """
        frame = self.number(frame)
        # The one door to a layer above this one.
        plots = importlib.import_module("mpm3dpp.plots")
        figure: Figure = plots.draw_results(
            *(self, frame, colour),
            section=section,
            view=view,
            crop=crop,
            range=range,
            size=size,
            arrows=arrows,
        )
        return figure

    def _repr_html_(self) -> str:
        """What a notebook shows: what was run, its bodies, frames and fields."""
        rows = [("file", str(self.path)), ("bodies", _listed(self.bodies))]
        rows.append(("materials", _listed(list(dict.fromkeys(self.materials)))))
        rows.append(("grid", f"{self.dimension}D, cells of {self.cell_size:.6g} m"))
        count = len(self.times)
        frames = f"{count:,}"
        if count:
            frames += f", t = {self.times[0]:.6g} s to {self.times[-1]:.6g} s"
        rows.append(("frames", frames))
        units = ((name, self.units.get(name, "")) for name in self._names)
        fields = [f"{name} [{unit}]" if unit not in ("", "1") else name for name, unit in units]
        rows.append(("fields", ", ".join(fields)))
        title = element("strong", f"Results: {self.title}" if self.title else "Results")
        return joined([title, table(("", ""), rows, words=2)])


def _listed(names: list[str]) -> str:
    """Return names; of many the first, and how many there are."""
    shown = ", ".join(names[:_MOST_NAMES])
    more = f", \N{HORIZONTAL ELLIPSIS} ({len(names):,})" if len(names) > _MOST_NAMES else ""
    return shown + more

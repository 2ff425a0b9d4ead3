# SPDX-License-Identifier: BSD-3-Clause
"""What results tell of bodies one by one: tables of grains and contacts, and measures of a heap."""

from __future__ import annotations

import abc
from collections.abc import Collection, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from mpm3dpp.base import arguments
from mpm3dpp.base.errors import CaseError

from .data_frames import maybe_frame
from .frame_file import frame_path, read_info, read_table
from .part_cells import PART_LIMIT
from .rows import takes_part

_AXES = "xyz"


class GrainResults(abc.ABC):
    """Tables of bodies in each frame, and what they come to; of `Results`."""

    dimension: int
    cell_size: float
    bodies: list[str]
    _folder: Path | None

    @abc.abstractmethod
    def arrays(self, frame: int, names: Collection[str] | None = None) -> dict[str, np.ndarray]:
        """See `Results`."""

    @abc.abstractmethod
    def number(self, frame: int) -> int:
        """See `Results`."""

    def bodies_at(self, frame: int) -> Any:
        """Return the table of all bodies in a frame, a row for each; columns as of `history`.

        Raises:
            IndexError: there is no such frame.
            CaseError: there are 12 bodies or fewer; or a frame is missing or damaged.
        """
        if len(self.bodies) <= PART_LIMIT or self._folder is None:
            rule = f"frames have a table of bodies if these are more than {PART_LIMIT}"
            raise CaseError(rule, "take history(body), which goes by the history")
        return maybe_frame(self._table(frame, "bodies"))

    def grains(self, frame: int = -1, body: str | None = None) -> Any:
        """Return the table of all bodies in a frame, each grain in a row of its own.

        Columns: `name`; `grain`, its number among those of this name; and `GRAIN_COLUMNS` of
        `mpm3dpp.io.frame_tables`: `mass`, `centre_x`, `velocity_x`, `spin_z`, `force_x` of all
        contacts, `contacts`, the number of bodies that it acts on, and so on. A
        `pandas.DataFrame` where pandas is installed, else arrays by name.

        Args:
            frame: number of the frame; negative numbers count from the end.
            body: only those of this name; default all, as `contacts` counts them.

        Raises:
            IndexError: there is no such frame.
            CaseError: the case has one body only; there is no such body; or a frame is missing or
                damaged.
        """
        table = self._table(frame, "grains")
        names = np.array(self.bodies, dtype=object)[table["entry"]]
        columns = {"name": names} | {k: v for k, v in table.items() if k != "entry"}
        if body is not None:
            chosen = table["entry"] == self._body(body)
            columns = {k: v[chosen] for k, v in columns.items()}
        return maybe_frame(columns)

    def contacts(self, frame: int = -1) -> Any:
        """Return the table of all contacts in a frame, a row for each pair of bodies that act.

        Columns: `a` and `b`, rows of `grains`, `a` the lower; the point; the normal from a to b;
        `gap` [m], negative where they overlap; the force on a [N]; `slip` [m/s]: the work of
        friction over its impulse. The forces are those of the last step before the frame: there
        are none at the start.

        Raises:
            IndexError, CaseError: see `grains`.
        """
        return maybe_frame(self._table(frame, "contacts"))

    def coordination_number(self, frame: int = -1, body: str | None = None) -> float:
        """Return the mean number of bodies that a grain acts on.

        Args:
            frame: see `grains`.
            body: name of the grains; default all bodies of which there are several of a name.

        Raises:
            IndexError, CaseError: see `grains`; or there are no grains.
        """
        table = self._table(frame, "grains")
        several = np.bincount(table["entry"], minlength=len(self.bodies)) > 1
        chosen = several[table["entry"]]
        if body is not None:
            chosen = table["entry"] == self._body(body)
        if not chosen.any():
            raise CaseError("there are no grains in these results", "name a body")
        return float(table["contacts"][chosen].mean())

    def solid_fraction(
        self,
        lower: Sequence[float | str],
        upper: Sequence[float | str],
        frame: int = -1,
    ) -> float:
        """Return the share of a box that is filled, by the volumes of the particles at the start.

        Args:
            lower, upper: corners of the box [m], or text with a unit; D numbers each.
            frame: see `arrays`.

        Raises:
            IndexError: there is no such frame.
            CaseError: the box is none; or see `arrays`.
        """
        low = arguments.place("lower", lower, self.dimension)
        high = arguments.place("upper", upper, self.dimension)
        if not (high > low).all():
            raise CaseError("must be above lower on every axis", "exchange them", key="upper")
        arrays = self.arrays(frame, ["size", "failed"])
        x, edge = arrays["position"][:, : self.dimension].astype(float), arrays["size"][:, None]
        # Of each particle's square or cube the part in the box.
        inside = np.minimum(x + 0.5 * edge, high) - np.maximum(x - 0.5 * edge, low)
        part = np.prod(np.clip(inside, 0.0, None), axis=1) * takes_part(arrays)
        return float(part.sum() / np.prod(high - low))

    def surface(
        self,
        frame: int = -1,
        along: str = "x",
        up: str | None = None,
        width: float | str | None = None,
        body: str | None = None,
    ) -> dict[str, np.ndarray]:
        """Return how high the particles reach along an axis.

        Args:
            frame: see `arrays`.
            along: axis of the profile.
            up: axis of the heights; default the last.
            width: of the strips whose highest particle counts [m], or text with a unit; default
                two cells.
            body: whose particles, or of which entry of grains; default all grains where there are
                any, so that a drum around them is no part of their surface, else all bodies.

        Returns:
            `along` -> middles of the strips in which there are particles, `up` -> the upper faces
            of the highest ones [m].

        Raises:
            IndexError: there is no such frame.
            CaseError: there are no two such axes, or no such body; or see `arrays`.
        """
        known = list(_AXES[: self.dimension])
        up = known[-1] if up is None else up
        if along not in known or up not in known or along == up:
            raise CaseError(f"must be two of {', '.join(known)}", key="along, up", value=along)
        strip = 2.0 * self.cell_size
        if width is not None:
            strip = arguments.quantity("width", width, "m")
        if not strip > 0.0:
            raise CaseError(
                "must be > 0", "give a length, or leave it out", key="width", value=width
            )
        arrays = self.arrays(frame, ["size", "failed", "body", "grain"])
        kept = takes_part(arrays)
        if body is not None:
            kept &= arrays["body"] == self._body(body)
        elif "grain" in arrays and arrays["grain"].any():
            kept &= np.isin(arrays["body"], np.unique(arrays["body"][arrays["grain"] > 0]))
        x = arrays["position"][kept][:, _AXES.index(along)].astype(float)
        top = arrays["position"][kept][:, _AXES.index(up)] + 0.5 * arrays["size"][kept]
        strips = np.floor(x / strip).astype(int)
        found, where = np.unique(strips, return_inverse=True)
        heights = np.full(len(found), -np.inf)
        np.maximum.at(heights, where, top)
        return {along: (found + 0.5) * strip, up: heights}

    def angle_of_repose(
        self,
        start: float | str,
        end: float | str,
        frame: int = -1,
        along: str = "x",
        up: str | None = None,
        width: float | str | None = None,
        body: str | None = None,
    ) -> float:
        """Return the slope of a surface [degrees]: of the straight line nearest to its heights.

        Args:
            start, end: of the slope on the axis `along` [m], or text with a unit: for a heap a
                flank, for a drum its middle.
            frame, along, up, width, body: see `surface`; two grains are a good width.

        Returns:
            The angle, positive where the surface rises along the axis.

        Raises:
            IndexError: there is no such frame.
            CaseError: there are not three strips with particles, or start or end lie farther from
                the surface than it is long; or see `surface`.
        """
        profile = self.surface(frame, along, up, width, body)
        x, heights = profile.values()
        low, high = (arguments.quantity(k, v, "m") for k, v in (("start", start), ("end", end)))
        if len(x) and (low < x[0] - (x[-1] - x[0]) or high > x[-1] + (x[-1] - x[0])):
            rule = f"lie far beyond the surface, from {x[0]:.4g} m to {x[-1]:.4g} m"
            remedy = "give places on it, with a unit: a plain number is in metres"
            raise CaseError(rule, remedy, key="start, end", value=[start, end])
        chosen = (x >= low) & (x <= high)
        if chosen.sum() < 3:
            rule = f"only {chosen.sum()} strips between them have particles"
            raise CaseError(rule, "take more of the surface, or a smaller width", key="start, end")
        slope = np.polyfit(x[chosen], heights[chosen], 1)[0]
        return float(np.degrees(np.arctan(slope)))

    @abc.abstractmethod
    def _body(self, body: str) -> int:
        """See `Results`."""

    def tables(self, frame: int = -1) -> list[str]:
        """Return the names of the tables of a frame: `grains`, `contacts`, `bodies`.

        Raises:
            IndexError, CaseError: see `grains`.
        """
        frame = self.number(frame)
        return list(read_info(frame_path(self._folder, frame)).tables) if self._folder else []

    def _table(self, frame: int, name: str) -> dict[str, np.ndarray]:
        frame = self.number(frame)
        if self._folder is None:
            raise CaseError("results in one file have no tables of frames", "run the case again")
        return read_table(frame_path(self._folder, frame), name)

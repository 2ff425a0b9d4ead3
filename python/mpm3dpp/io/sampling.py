# SPDX-License-Identifier: BSD-3-Clause
"""Fields of the particles of a frame along a line, on a grid and in a section, and their strain."""

from __future__ import annotations

import abc
from collections.abc import Collection, Sequence

import numpy as np

from mpm3dpp.base import arguments
from mpm3dpp.base.errors import CaseError, nearest

from .rows import field_of, takes_part

_AXES = "xyz"
_MOST_NODES = 50_000_000  # of a grid


class Sampling(abc.ABC):
    """What results have beside the particles themselves; of `Results`.

    A value at a place is the mean of the particles less than a cell away along each axis, by their
    volume at the start and by nearness, prod_a (1 - |x_a - x_pa| / h); where there is none, NaN.
    """

    dimension: int
    cell_size: float

    @abc.abstractmethod
    def arrays(self, frame: int, names: Collection[str] | None = None) -> dict[str, np.ndarray]:
        """See `Results`."""

    @abc.abstractmethod
    def _body(self, body: str) -> int:
        """See `Results`."""

    def section(
        self,
        frame: int = -1,
        names: Collection[str] | None = None,
        thickness: float | str | None = None,
        **plane: float | str,
    ) -> dict[str, np.ndarray]:
        """Return the arrays of the particles in a layer about a plane: `results.section(y=0)`.

        Args:
            frame, names: see `arrays`.
            thickness: of the layer [m], or text with a unit; by default a cell.
            plane: one of x, y and z, where the plane is [m], or text with a unit.

        Raises:
            IndexError: there is no such frame.
            CaseError: not one axis is given; or see `arrays`.
        """
        known = _AXES[: self.dimension]
        if len(plane) != 1 or next(iter(plane)) not in known:
            rule = f"must have one of {', '.join(known)}"
            raise CaseError(rule, "write section(y=0)", key="section", value=dict(plane) or None)
        ((axis, value),) = plane.items()
        at = arguments.quantity(axis, value, "m")
        thick = self.cell_size
        if thickness is not None:
            thick = arguments.quantity("thickness", thickness, "m")
        arrays = self.arrays(frame, names)
        inside = np.abs(arrays["position"][:, _AXES.index(axis)] - at) <= 0.5 * thick
        return {name: values[inside] for name, values in arrays.items()}

    def strain(self, frame: int = -1) -> np.ndarray:
        """Return the logarithmic strain [1] of each particle since the first frame (Hencky 1928).

        It is that of the displacements of the particles of its body, or grain, that were within 1.8
        particle sizes of it in the first frame, whatever the material: plastic and elastic strain
        together. Frames hold numbers of seven digits: it is uncertain by some 1e-7 times the
        distance from the origin over the particle's size.

        Args:
            frame: see `arrays`.

        Returns:
            Shape (n, 6), in the order xx yy zz yz xz xy; NaN for particles that are gone,
            and where one has no neighbours on all sides, as in a layer of one.

        Raises:
            IndexError: there is no such frame.
            CaseError: see `arrays`.
        """
        from .strain import hencky_strain

        start = self.arrays(0, ["size", "body", "grain"])
        present = self.arrays(frame, ["failed"])
        before, after = (
            arrays["position"][:, : self.dimension].astype(float) for arrays in (start, present)
        )
        body = start["body"].astype(np.int64)
        if "grain" in start:
            body = body * (1 + int(start["grain"].max(initial=0))) + start["grain"]
        there, strain = takes_part(present), np.full((len(body), 6), np.nan)
        size = start["size"].astype(float)
        strain[there] = hencky_strain(before[there], after[there], size[there], body[there])
        return strain

    def line(
        self,
        start: Sequence[float | str],
        end: Sequence[float | str],
        name: str,
        frame: int = -1,
        count: int = 200,
        body: str | None = None,
    ) -> dict[str, np.ndarray]:
        """Return a field along a straight line: `results.line((0, 0), (0.1, 0), "pressure")`.

        Args:
            start, end: of the line [m], or text with a unit; D numbers each.
            name: of the field, an array of `arrays`, "speed", or a component such as "stress_yy".
            frame: see `arrays`.
            count: of places, evenly apart, both ends among them.
            body: if given, of this body alone, or of these grains.

        Returns:
            "distance" from the start [m], shape (count,), "position" [m], shape (count, D), and the
            field, shape (count,) or (count, c).

        Raises:
            IndexError: there is no such frame.
            CaseError: a wrong argument; or see `arrays`.
        """
        count = arguments.whole_number("count", count, 2, 1_000_000)
        ends = [
            arguments.place(key, place, self.dimension)
            for key, place in (("start", start), ("end", end))
        ]
        share = np.linspace(0.0, 1.0, count)[:, None]
        places = (1.0 - share) * ends[0] + share * ends[1]
        positions, volumes, values = self._particles(frame, name, body)
        return {
            "distance": share[:, 0] * float(np.linalg.norm(ends[1] - ends[0])),
            "position": places,
            name: self._at(places, positions, volumes, values),
        }

    def on_grid(
        self,
        name: str,
        frame: int = -1,
        spacing: float | str | None = None,
        body: str | None = None,
    ) -> dict[str, np.ndarray]:
        """Return a field at the nodes of a grid about the particles: `results.on_grid("stress")`.

        Args:
            name, frame, body: see `line`.
            spacing: of the nodes [m], or text with a unit; by default a cell.

        Returns:
            "x", "y" (and "z"), the coordinates of the nodes [m], shape (nx,) and so on, and the
            field, shape (nx, ny[, nz]) or (nx, ny[, nz], c).

        Raises:
            IndexError: there is no such frame.
            CaseError: a wrong argument, or too many nodes; or see `arrays`.
        """
        step = self.cell_size
        if spacing is not None:
            step = arguments.quantity("spacing", spacing, "m")
        if not step > 0.0:
            raise CaseError("must be > 0", "give a length", key="spacing", value=spacing)
        positions, volumes, values = self._particles(frame, name, body)
        if len(positions) == 0:
            raise CaseError("the frame has no particle left", "take an earlier one")
        low = np.floor(positions.min(axis=0) / step)
        counts = (np.ceil(positions.max(axis=0) / step) - low).astype(int) + 1
        if np.prod(counts.astype(float)) > _MOST_NODES:
            rule = f"makes {np.prod(counts.astype(float)):.3g} nodes"
            raise CaseError(rule, "give a larger one", key="spacing", value=spacing)
        axes = [step * (low[a] + np.arange(counts[a])) for a in range(self.dimension)]
        # Each particle gives to the nodes around it: the same sums as `_at`, for all nodes at once.
        local = positions / step - low
        first = np.minimum(np.floor(local).astype(int), counts - 2).clip(0)
        fraction = local - first
        size, flat = int(np.prod(counts)), values.reshape(len(values), -1)
        weights, sums = np.zeros(size), np.zeros((size, flat.shape[1]))
        for corner in np.ndindex(*(2,) * self.dimension):
            node = np.minimum(first + corner, counts - 1)
            share = np.prod(np.where(corner, fraction, 1.0 - fraction), axis=1).clip(0.0) * volumes
            index = np.ravel_multi_index(tuple(node.T), tuple(counts))
            weights += np.bincount(index, share, size)
            for c in range(flat.shape[1]):
                sums[:, c] += np.bincount(index, share * flat[:, c], size)
        with np.errstate(invalid="ignore", divide="ignore"):
            means = np.where(weights[:, None] > 0.0, sums / weights[:, None], np.nan)
        shape = (*counts.tolist(), *values.shape[1:])
        return dict(zip(_AXES, axes, strict=False)) | {name: means.reshape(shape)}

    def _particles(
        self, frame: int, name: str, body: str | None
    ) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Return place, volume at the start and value of the particles that have one."""
        whole = "velocity" if name == "speed" else arguments.text("name", name).rpartition("_")[0]
        arrays = self.arrays(frame, [name, whole, "size", "failed", "body"])
        values = field_of(arrays, name)
        if values is None:
            known = [*self.arrays(frame), "speed", "velocity_x", "stress_xx"]
            raise CaseError("is not an array of these frames", nearest(name, known), value=name)
        values = np.asarray(values, dtype=float)
        positions = np.asarray(arrays["position"][:, : self.dimension], dtype=float)
        seen = takes_part(arrays) & np.isfinite(values.reshape(len(values), -1)).all(axis=1)
        if body is not None:
            seen &= arrays["body"] == self._body(body)
        volumes = np.asarray(arrays["size"], dtype=float) ** self.dimension
        return positions[seen], volumes[seen], values[seen]

    def _at(
        self, places: np.ndarray, positions: np.ndarray, volumes: np.ndarray, values: np.ndarray
    ) -> np.ndarray:
        """Return the means at some places, shape (places, ...)."""
        from scipy.spatial import cKDTree

        h = self.cell_size
        found = np.full((len(places), *values.shape[1:]), np.nan)
        if len(positions) == 0:
            return found
        near = cKDTree(positions).query_ball_point(places, h, p=np.inf)
        for k, rows in enumerate(near):
            shares = 1.0 - np.abs(positions[rows] - places[k]) / h
            weights = np.prod(shares.clip(0.0), axis=1) * volumes[rows]
            if weights.sum() > 0.0:
                found[k] = np.tensordot(weights, values[rows], axes=1) / weights.sum()
        return found

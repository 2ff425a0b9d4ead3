# SPDX-License-Identifier: BSD-3-Clause
"""Reading `results.vtkhdf` back: times, frames as numpy arrays or as PyVista objects."""

from __future__ import annotations

from collections.abc import Collection, Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from mpm3dpp.base import arguments
from mpm3dpp.base.errors import CaseError, nearest

from .data_frames import data_frame, maybe_frame
from .frame_file import damaged, frame_path, is_whole, read_arrays, read_info, read_table
from .grain_results import GrainResults
from .one_file import arrays_of_one_file
from .part_cells import PART_COLUMNS, PART_LIMIT, of_body
from .probe_tables import read_probe
from .read_history import read_history
from .results_file import are_whole, open_file
from .rows import FROM_VTK, is_tensor
from .sampling import Sampling
from .shown import Shown

if TYPE_CHECKING:
    import pyvista


class Results(Sampling, GrainResults, Shown):
    """The frames of one run; `results[k]` is a `pyvista.PolyData`, `arrays(k)` plain numpy.

    Attributes:
        path: the file.
        times: time of each frame [s], shape (frames,).
        steps: steps made until each frame, shape (frames,).
        bodies, materials: names; the arrays `body` and `material` count in this order.
        dimension: 2 or 3.
        cell_size: edge of a grid cell [m].
        origin: a corner of the grid [m], shape (3,).
        walls: words of the faces x- x+ y- y+ z- z+ of the case's box; () without one.
        box: its lower and upper corner [m], shape (2, dimension); None without one.
        units: name -> unit of each array.
        title, case_hash: of the case.
    """

    def __init__(self, path: str | Path) -> None:
        path = arguments.path("path", path)
        if path.is_dir():
            path = path / "results.vtkhdf"
        self.path = path
        if not path.is_file():
            raise CaseError(f"there is no file '{path}': give the output folder of a run")
        told = open_file(path)
        self._file, self._root, self._names = told.file, told.root, told.names
        run, times, steps = told.run, told.times, told.steps
        self._folder = path.parent / run.frames if run.frames else None
        if self._folder is not None:
            self._file.close()  # A run that goes on replaces it.
            self._add_later(self._folder, times, steps)
        self._open = True
        self.times = np.array(times, dtype=float)
        self.steps = np.array(steps, dtype=np.int64)
        self.title, self.case_hash = run.title, run.case_hash
        self.bodies, self.materials = run.bodies, run.materials
        self.dimension: int = run.dimension
        self.cell_size = run.cell_size
        self.origin = np.array(run.origin)
        self.units = run.units
        whole = len(run.walls) == 6 and [len(c) for c in run.box] == [run.dimension] * 2
        self.walls = tuple(run.walls) if whole else ()
        self.box = np.array(run.box) if whole else None

    @property
    def fields(self) -> list[str]:
        """Names of the arrays of every frame, "position" first.

        Raises:
            CaseError: the file has been closed.
        """
        self._must_be_open()
        return list(self._names)

    def arrays(self, frame: int, names: Collection[str] | None = None) -> dict[str, np.ndarray]:
        """All arrays of a frame, float32 (integers int32), SI units.

        Args:
            frame: number of the frame; negative numbers count from the end.
            names: of the arrays that are wanted beside "position"; default all.

        Returns:
            name -> (n,) or (n, c); symmetric tensors (n, 6) in the order xx yy zz yz xz xy.

        Raises:
            IndexError: there is no such frame.
            CaseError: `frame` is no whole number, the file has been closed, or a frame is missing
                or damaged.
        """
        frame = self.number(frame)
        wanted = None if names is None else {"position", *names}
        if self._folder:
            arrays = read_arrays(self._folder, frame, wanted)
        else:
            arrays = arrays_of_one_file(self._root, frame, wanted)
        known = self._names if wanted is None else wanted.intersection(self._names)
        counts = {"body": len(self.bodies), "material": len(self.materials)}
        if not are_whole(arrays, known, counts):
            raise damaged(frame_path(self._folder, frame) if self._folder else self.path, frame)
        return {k: v[:, FROM_VTK] if is_tensor(v) else v for k, v in arrays.items()}

    def to_pandas(self, frame: int, names: Collection[str] | None = None) -> Any:
        """Return a frame as a `pandas.DataFrame`, a row for each particle.

        Vectors and tensors have a column for each component: `velocity_x`, `stress_xx` and so on.

        Args:
            frame: see `arrays`.
            names: see `arrays`.

        Raises:
            CaseError: pandas is not installed; or see `arrays`.
        """
        return data_frame(self.arrays(frame, names))

    def track(
        self, particle: int, names: Collection[str] | None = None, body: str | None = None
    ) -> dict[str, np.ndarray]:
        """Return what one particle had in each frame.

        Args:
            particle: its number, in the order of `arrays`; negative ones count from the end.
            names: see `arrays`.
            body: if given, `particle` is the number among those of this body, or of these grains.

        Returns:
            "time" [s], shape (frames,), and name -> (frames,) or (frames, c).

        Raises:
            IndexError: there is no such particle.
            CaseError: there is no such body; or see `arrays`.
        """
        particle = self._particle(arguments.whole_number("particle", particle), body)
        frames = [self.arrays(k, names) for k in range(len(self))]
        columns = {name: [frame[name][particle] for frame in frames] for name in frames[0]}
        return {"time": self.times} | {name: np.array(rows) for name, rows in columns.items()}

    def history(self, body: str | None = None) -> Any:
        """Return the table of the run, `history.csv`, by the names of its columns.

        That is a `pandas.DataFrame` where pandas is installed, else arrays by name.

        Args:
            body: if given, what this body had, or these grains together: `time` and the columns
                `body_A_` of docs/reference/history.md, where they were written.

        Raises:
            CaseError: there is no such body; a file is missing or damaged.
        """
        if body is not None:
            return maybe_frame(self._history_of(body))
        return maybe_frame(read_history(self.path.parent))

    def probe(self, name: str) -> Any:
        """Return what a probe saw, its columns by name: time, step, particles, mass and fields.

        That is a `pandas.DataFrame` where pandas is installed, else arrays by name.

        Raises:
            CaseError: there is no such probe, or its table is damaged.
        """
        return maybe_frame(read_probe(self.path.parent, arguments.text("name", name)))

    def nearest(self, time: float) -> int:
        """Number of the frame nearest to `time` [s].

        Raises:
            CaseError: `time` is no time.
        """
        return int(np.argmin(np.abs(self.times - arguments.quantity("time", time, "s"))))

    def __len__(self) -> int:
        return len(self.times)

    def __getitem__(self, frame: int) -> pyvista.PolyData:
        """Frame as PyVista points with all arrays; tensors in VTK's order xx yy zz xy yz xz.

        Raises:
            IndexError: there is no such frame.
            CaseError: PyVista is not installed.
        """
        from .point_cloud import point_cloud

        return point_cloud(self.arrays(frame), float(self.times[frame]), int(self.steps[frame]))

    def __iter__(self) -> Iterator[Any]:
        return (self[k] for k in range(len(self)))

    def close(self) -> None:
        """Close the file."""
        self._open = False
        self._file.close()

    def __enter__(self) -> Results:
        return self

    def __exit__(self, *about: object) -> None:
        self.close()

    def _add_later(self, folder: Path, times: list[float], steps: list[int]) -> None:
        """Add the frames that have been written since the file was, as long as they are whole."""
        while frame_path(folder, len(times)).is_file():
            try:
                info = read_info(frame_path(folder, len(times)))
            except CaseError:
                return
            if not is_whole(folder, len(times), info):
                return
            self._names = info.names
            times.append(info.time)
            steps.append(info.step)

    def _particle(self, particle: int, body: str | None) -> int:
        """Return the number of a particle among all, which may be given among those of a body."""
        where = self.arrays(0, ["body"])["body"] if len(self) else np.zeros(0, dtype=int)
        among = np.arange(len(where))
        if body is not None:
            among = among[where == self._body(body)]
        if not -len(among) <= particle < len(among):
            of = f"body {body}" if body else f"'{self.path}'"
            raise IndexError(f"particle {particle} of {of}: it has {len(among):,} particles")
        return int(among[particle])

    def _history_of(self, body: str) -> dict[str, np.ndarray]:
        """Return what a body had over time, columns by name."""
        number = self._body(body)
        if len(self.bodies) > PART_LIMIT and self._folder is not None:
            files = [frame_path(self._folder, k) for k in range(len(self))]
            tables = [read_table(file, "bodies") for file in files]
            rows = {name: [table[name][number] for table in tables] for name in PART_COLUMNS}
            return {"time": self.times} | {name: np.array(row) for name, row in rows.items()}
        return of_body(read_history(self.path.parent), body)

    def _body(self, body: str) -> int:
        """Return the number of a body. Raises `CaseError` if there is none of that name."""
        if arguments.text("body", body) not in self.bodies:
            raise CaseError(
                "is not a body of these results", nearest(body, self.bodies), value=body
            )
        return self.bodies.index(body)

    def _must_be_open(self) -> None:
        if not self._open:
            raise CaseError(f"'{self.path}' has been closed", "open it again with open_results")

    def number(self, frame: int) -> int:
        """Return the number of a frame that is counted from the end, if it is negative.

        Raises:
            IndexError: there is no such frame.
            CaseError: it is no whole number, or the file has been closed.
        """
        frame = arguments.whole_number("frame", frame)
        self._must_be_open()
        if not -len(self) <= frame < len(self):
            raise IndexError(f"frame {frame} of '{self.path}': it has {len(self)} frames")
        return frame % len(self)


def open_results(path: str | Path) -> Results:
    """Open the results of a run.

    Args:
        path: `results.vtkhdf` or the output folder that holds it.

    Raises:
        CaseError: the file is missing or is not one of ours.
    """
    return Results(path)

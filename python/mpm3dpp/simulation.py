# SPDX-License-Identifier: BSD-3-Clause
"""A case as a running simulation, and the whole run of a case: frames, history, manifest, pictures."""

from __future__ import annotations

import json as json_format
import signal
import sys
import time as clock
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np

from . import _core
from .build import build, warnings
from .case import Case
from .errors import CaseError, RunError
from .folders import thread_count, writable_folder
from .io.history import HistoryWriter
from .io.manifest import Manifest, Status, build_manifest
from .io.vtkhdf import ResultsWriter
from .progress import Progress
from .report import contact_table, speed_line

_BLOCK = 64  # Steps between two looks at the clock and at Ctrl-C, without contact.


class Simulation:
    """A case filled with particles and ready to step.

    Args:
        case: what to simulate.
        threads: how many; by default OMP_NUM_THREADS, else all cores.

    Attributes:
        case: as given.
        bodies: the bodies' names, in the order of their numbers.
        summary: energies of the whole run, once `run_case` has made it.
        core: the compiled simulation (`mpm3dpp._core.Simulation`).

    Raises:
        CaseError: the case cannot be filled, or the core refuses a parameter.
    """

    def __init__(self, case: Case, threads: int | None = None) -> None:
        filled = build(case)
        self.case = case
        self.threads = thread_count(threads)
        self.bodies = [body.name for body in filled]
        self.materials = [body.material for body in filled]
        self.warnings = warnings(filled)
        self.core = _core.Simulation(_settings(case, self.threads))
        numbers = {name: self._add_material(name) for name in dict.fromkeys(self.materials)}
        while filled:  # Particles given to the core are dropped here, so that memory holds them once.
            body = filled.pop(0)
            self.core.add_body(
                body.name,
                numbers[body.material],
                body.positions,
                np.ascontiguousarray(body.velocities),
                body.volumes[:1].copy(),
            )
        for a, b, friction in case.frictions():
            self.core.set_friction(self.bodies.index(a), self.bodies.index(b), friction)
        self.core.prepare()
        self.summary: dict[str, Any] = {}

    def _add_material(self, name: str) -> int:
        material = self.case.material[name]
        strength = material.strength
        try:
            return self.core.add_material(material.density, strength.model, strength.parameters)
        except ValueError as error:
            remedy = "see `mpm3dpp materials`"
            raise self.case.error(("material", name, "strength"), str(error), remedy) from None

    @property
    def time(self) -> float:
        """Time reached [s]."""
        return self.core.time

    @property
    def step(self) -> int:
        """Steps made."""
        return self.core.step

    def advance(self, steps: int, end_time: float | None = None) -> int:
        """Make up to `steps` steps, to `end_time` [s] at most (the case's by default).

        Returns:
            The number of steps made.

        Raises:
            RunError: the run has become unstable: who, where, when and why.
        """
        made = 0
        end = self.case.run.end_time if end_time is None else end_time
        while made < steps:
            done = self.core.advance(min(steps - made, self.core.history_capacity), end)
            made += done
            if self.core.failure is not None:
                raise RunError(self.core.failure.message)
            if done == 0:
                break
        return made

    def column(self, body: str, name: str) -> np.ndarray:
        """Return a column of a body, shape (n, components), particles in the order of filling.

        Args:
            body: its name.
            name: "position" [m], "velocity" [m/s], "stress" [Pa] (xx yy zz yz xz xy, tension
                positive), "volume" [m^3], "mass" [kg], or a state column of its material.
        """
        return self.core.column(self.bodies.index(body), name)

    def set_velocity(self, body: str, velocities: np.ndarray) -> None:
        """Give the particles of a body velocities [m/s], shape (n, D), in the order of filling."""
        values = np.ascontiguousarray(velocities, dtype=float)
        self.core.set_velocity(self.bodies.index(body), values)


def run_case(
    case: Case,
    out: str | Path,
    threads: int | None = None,
    quiet: bool = True,
    json: bool = False,
) -> Manifest:
    """Run a case to its end: results.vtkhdf, history.csv, manifest.json and pictures in a folder.

    Args:
        case: what to run.
        out: the output folder; it is made.
        threads: how many; by default OMP_NUM_THREADS, else all cores.
        quiet: no progress and no summary.
        json: print the manifest at the end.

    Raises:
        CaseError: a mistake in the case, or a folder that cannot be written.
        RunError: the run became unstable; what was computed before is kept.
        KeyboardInterrupt: the user stopped it; what was computed is kept.
    """
    folder = writable_folder(Path(out))
    begin = clock.monotonic()
    simulation = Simulation(case, threads)
    status, reason = _write_run(simulation, folder, quiet or json)
    manifest = _manifest(simulation, status, reason, clock.monotonic() - begin)
    manifest.energies = simulation.summary
    manifest.write(folder)
    with _mended_pictures(quiet or json):
        _draw(folder, case)
    if json:
        print(json_format.dumps(manifest.to_dict(), indent=2))
    elif not quiet:
        print("\n".join([*contact_table(manifest), speed_line(manifest), f"results in {folder}"]))
    if status == "failed":
        raise RunError(f"{reason}; frames and history up to then are in {folder}")
    if status == "interrupted":
        if not quiet:
            print(f"mpm3dpp: {reason}; results are in {folder}", file=sys.stderr)
        raise KeyboardInterrupt
    return manifest


def _write_run(simulation: Simulation, folder: Path, quiet: bool) -> tuple[Status, str | None]:
    """Step to the end time, writing frames and history; return how it ended, and why."""
    case, core = simulation.case, simulation.core
    contact = case.contact_enabled
    block = case.output.history_every if contact else _BLOCK
    frames = [t for t in case.frame_times() if t > 0.0]
    results = ResultsWriter(
        folder / "results.vtkhdf",
        bodies=simulation.bodies,
        materials=simulation.materials,
        dimension=case.grid.dimension,
        cell_size=case.grid.cell_size,
        origin=case.grid.lower,
        fields=case.output.fields,
        title=case.title,
        case_hash=case.case_hash,
    )
    history = HistoryWriter(
        folder / "history.csv",
        columns=core.history_columns,
        bodies=simulation.bodies,
        contact=contact,
        every=case.output.history_every,
    )
    unit = "J/m" if case.grid.dimension == 2 else "J"
    progress = Progress(case.run.end_time, quiet=quiet, energy_unit=unit)
    status: Status = "completed"
    reason: str | None = None
    with results, history, progress, _interrupt() as stopped:
        for sentence in simulation.warnings:
            progress.note(f"warning: {sentence}")
        results.write(core)
        touched = 0
        while status == "completed" and core.time < case.run.end_time:
            try:
                simulation.advance(block)
            except RunError as error:
                status, reason = "failed", str(error)
            rows, pairs = core.history(), core.contact_pairs() if contact else []
            history.append(rows, pairs)
            if status == "failed":
                if core.failure.kind != "non-finite":
                    results.write(core)
                break
            due = bool(frames) and core.time >= frames[0]
            while frames and core.time >= frames[0]:
                frames.pop(0)
            if due or len(pairs) > touched:  # A frame too whenever two bodies first touch.
                results.write(core)
                touched = len(pairs)
            overlapped = core.contact_summary()["overlapped_nodes"] if contact else None
            kinetic, internal = rows[-1, 3:5]
            progress.update(core.time, core.step, core.dt, kinetic, internal, overlapped)
            if stopped():
                status, reason = "interrupted", f"stopped by the user at t = {core.time:.6g} s"
    simulation.summary = history.summary()
    return status, reason


def _manifest(
    simulation: Simulation, status: Status, reason: str | None, wall_time: float
) -> Manifest:
    from . import __version__

    case = simulation.case
    return build_manifest(
        simulation.core,
        version=__version__,
        case=case.table(),
        case_text=case.text,
        bodies=simulation.bodies,
        cell_size=case.grid.cell_size,
        threads=simulation.threads,
        wall_time=wall_time,
        status=status,
        reason=reason,
        case_hash=case.case_hash,
        build=_core.build_info(),
    )


def _draw(folder: Path, case: Case) -> None:
    from .plots import first_contact, plot_results

    plot_results(folder)
    if case.contact_enabled:
        first_contact(folder)


@contextmanager
def _mended_pictures(quiet: bool) -> Iterator[None]:
    """A picture that cannot be made must not lose a finished run: say so, and go on."""
    try:
        yield
    except CaseError as error:
        if not quiet:
            print(f"no picture: {error}")


@contextmanager
def _interrupt() -> Iterator[Any]:
    """Within it, Ctrl-C only sets a flag, which the object given tells when called."""
    hit: list[bool] = []
    try:
        old = signal.signal(signal.SIGINT, lambda *_: hit.append(True))
    except ValueError:  # Not the main thread: nobody can press Ctrl-C here.
        yield lambda: False
        return
    try:
        yield lambda: bool(hit)
    finally:
        signal.signal(signal.SIGINT, old)


def _settings(case: Case, threads: int) -> _core.Settings:
    """Return a case's numbers as the core wants them."""
    grid, run = case.grid, case.run

    def three(values: Any, fill: Any) -> list[Any]:
        return [*values, fill, fill, fill][:3]

    settings = _core.Settings()
    settings.dimension = grid.dimension
    settings.cell_size = grid.cell_size
    settings.origin = three(grid.lower, 0.0)
    settings.box_cells = three(grid.box_cells, 0) if grid.box_cells else [0, 0, 0]
    names = ["slip" if wall == "symmetry" else wall for wall in grid.walls]
    settings.walls = [_core.Wall[name] for name in [*names, *["free"] * 6][:6]]
    settings.basis = _core.Basis[grid.basis]
    settings.scheme = _core.Scheme[run.scheme]
    settings.time_step_factor = run.time_step_factor
    settings.gravity = three(run.gravity, 0.0)
    if run.viscosity is not None:
        settings.viscosity_quadratic = run.viscosity.quadratic
        settings.viscosity_linear = run.viscosity.linear
    settings.contact = case.contact_enabled
    settings.detection = _core.Detection[case.contact.detection]
    settings.normal_rule = _core.NormalRule[case.contact.normal]
    settings.gap_distance = case.contact.gap_distance
    settings.friction = case.contact.friction
    settings.threads = threads
    settings.energy_growth_limit = run.energy_growth_limit
    return settings

# SPDX-License-Identifier: BSD-3-Clause
"""`manifest.json`: what was run, with what, how fast, and what came out of it. SI units."""

from __future__ import annotations

import dataclasses
import hashlib
import json
import math
import platform
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any, Literal

import numpy as np

from mpm3dpp.base.disk import write_atomically
from mpm3dpp.base.machine import command_line, processor_name

from .forms import CaseTables, Count, Ends, Energies, Gone, Length, Limiter, Number, Ranks, Size
from .records import (
    ContactRecord,
    LoadRecord,
    WallRecord,
    WarningRecord,
    contact_of,
    limiter_of,
    loads_of,
    walls_of,
    warnings_of,
)
from .result_hash import Parts, result_hash

Status = Literal["completed", "interrupted", "failed"]


@dataclasses.dataclass
class Manifest:
    """The record of one run; the names are the keys of the file.

    Attributes:
        version: of mpm3dpp.          case_hash: SHA-256 of the case.
        mass: of all particles [kg] (per metre in 2D).          cell_size: [m].
        eroded, left: mass [kg] (per metre in 2D) and count of the particles that have eroded,
            and that have left `grid.outflow_box`.
        ranks: how many processes in its last part, the `mpi` they spoke by, and, of one of them in
            the mean, what it has sent the others in a step: `letters` and their `bytes`,
            `exchanges` and `reductions` in which all take part; the `share` of the steps' time that
            went with that, waiting included, and the `imbalance`, the longest time at work over
            the mean.
        device: that made the steps of the last part, by its name; "cpu" for the processor.
        particles, steps: counts.          wall_time: of the run [s].
        ns_per_particle_step, stages: time in the steps and in each stage [ns]; with a device in the
            steps of the last part.
        resumed_step: from which the run went on last with `--resume`, else 0. Steps, times and
            energies are those of all its parts together, `threads` and memory those of the last.
        peak_memory_bytes: largest resident size of the process so far, the program, frames and
            checkpoints included, pictures not: they have a process of their own [bytes].
        bytes: of the core alone: particles, grid, contact, other.
        loads: see `LoadRecord`, by name.          walls: see `WallRecord`, by face.
        warnings: see `WarningRecord`.
        notes: what was told before the first step, of settling and of the energy that numerics made
            or lost, "note: ..." or "warning: ...".
        result_hash: see `mpm3dpp.io.result_hash`.
        contact: see `ContactRecord`.          end_time: time reached [s].
        status, reason: "completed", "interrupted" or "failed", and why.
        limiter: who limits the time step: body, particle, sound_speed and speed [m/s].
        energies: see `HistoryWriter.summary`.          bodies: see `HistoryWriter.bodies`.
        compiler, flags, isa, platform, python: how it was built and where it ran.
        processor: its name.          command: what was typed, or the program that made the run.
        case, case_text: the whole case as data, and the text of its file.
        case_file: whole path of that file; empty where none was read.
    """

    version: str
    case_hash: str
    status: Status
    reason: str | None
    mass: Number
    eroded: Gone
    left: Gone
    cell_size: Length
    particles: Count
    threads: Count
    device: str
    ranks: Ranks
    steps: Count
    resumed_step: Count
    end_time: float
    wall_time: Size
    ns_per_particle_step: Size
    stages: dict[str, Size]
    peak_memory_bytes: Count
    bytes: dict[str, Count]
    result_hash: str
    contact: ContactRecord
    loads: dict[str, LoadRecord]
    walls: dict[str, WallRecord]
    warnings: list[WarningRecord]
    notes: list[str]
    limiter: Limiter | None
    energies: Energies
    bodies: dict[str, Ends]
    compiler: str
    flags: str
    isa: str
    platform: str
    processor: str
    python: str
    command: str
    case: CaseTables
    case_text: str
    case_file: str

    def to_dict(self) -> dict[str, Any]:
        """As plain data that is strictly valid JSON: NaN and infinity become None."""
        return dict(_plain(dataclasses.asdict(self)))

    def write(self, path: str | Path) -> Path:
        """Write the file in one step. Raises `CaseError` when the folder cannot be written."""
        path = Path(path)
        if path.is_dir():
            path = path / "manifest.json"
        text = json.dumps(self.to_dict(), indent=2, allow_nan=False, ensure_ascii=False)
        write_atomically(path, text + "\n")
        return path


def build_manifest(
    simulation: Any,
    *,
    version: str,
    case: Mapping[str, Any],
    case_text: str,
    case_file: str = "",
    bodies: Sequence[str],
    parts: Sequence[str] | None = None,
    cell_size: float,
    threads: int,
    device: str = "cpu",
    device_seconds: float = 0.0,
    mpi: str | None = None,
    wall_time: float,
    status: Status,
    resumed_step: int = 0,
    reason: str | None = None,
    energies: Mapping[str, Any] | None = None,
    case_hash: str | None = None,
    build: Mapping[str, Any] | None = None,
    columns: Parts | None = None,
    notes: Sequence[str] = (),
) -> Manifest:
    """Collect the record of a run from the core's `Simulation`.

    Args:
        simulation: after its last step.
        version: of mpm3dpp.
        case: the whole case as plain data, SI units.
        case_text, case_file: text and path of the case file.
        bodies: name of each body.
        parts: name under which contact reports each body; grains have one. Default `bodies`.
        cell_size: [m].
        threads: used, by each process.
        device: name of the one that made the steps.
        device_seconds: that it and the host took for them [s].
        mpi: name of the MPI, if there are several.
        wall_time: of the whole run [s].
        status: how the run ended.
        resumed_step: from which it went on, if it did.
        reason: one sentence, for "interrupted" and "failed".
        energies: `HistoryWriter.summary()`.
        case_hash: when the case has its own; else SHA-256 of the canonical JSON of `case`.
        build: the core's `build_info()`.
        columns: see `result_hash`.
        notes: what was told before the first step.
    """
    build = build or {}
    work = max(1, int(simulation.particle_count) * int(simulation.step))
    stages = {name: 1e9 * t / work for name, t in simulation.timers().items()}
    if device != "cpu":
        made = int(simulation.particle_count) * (int(simulation.step) - resumed_step)
        host = dict(simulation.device_host_seconds)
        times = {"steps on the device": device_seconds - sum(host.values())} | host
        stages = {name: 1e9 * t / max(1, made) for name, t in times.items() if t > 0.0}
    return Manifest(
        version=version,
        case_hash=case_hash or hash_case(case),
        status=status,
        reason=reason,
        mass=float(simulation.total_mass),
        eroded=dict(simulation.eroded()),
        left=dict(simulation.left()),
        cell_size=float(cell_size),
        particles=int(simulation.particle_count),
        threads=int(threads),
        device=device,
        ranks={"mpi": mpi, **simulation.ranks()},
        steps=int(simulation.step),
        resumed_step=resumed_step,
        end_time=float(simulation.time),
        wall_time=float(wall_time),
        ns_per_particle_step=sum(stages.values()),
        stages=stages,
        peak_memory_bytes=peak_memory_bytes(),
        bytes={k: int(v) for k, v in simulation.bytes().items()},
        result_hash=result_hash(simulation, columns),
        contact=contact_of(simulation, parts or bodies),
        loads=loads_of(simulation),
        walls=walls_of(simulation),
        warnings=warnings_of(simulation, bodies),
        notes=list(notes),
        limiter=limiter_of(simulation, bodies),
        energies=dict(energies or {}),
        bodies={},
        compiler=str(build.get("compiler", "unknown")),
        flags=str(build.get("flags", "unknown")),
        isa=str(build.get("isa", "unknown")),
        platform=platform.platform(),
        processor=processor_name(),
        python=platform.python_version(),
        command=command_line(),
        case=dict(case),
        case_text=case_text,
        case_file=case_file,
    )


def hash_case(case: Mapping[str, Any]) -> str:
    """SHA-256 (hexadecimal) of the case as JSON with sorted keys and no white space."""
    text = json.dumps(_plain(dict(case)), sort_keys=True, separators=(",", ":"))
    return hashlib.sha256(text.encode()).hexdigest()


def peak_memory_bytes() -> int:
    """Largest resident size of this process so far [bytes]; 0 where the system does not say."""
    try:
        import resource
    except ImportError:  # not on Windows
        return 0
    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    return peak if platform.system() == "Darwin" else 1024 * peak  # Linux counts in KiB


def _plain(value: Any) -> Any:
    """Numbers, text, lists and dictionaries only; numbers that JSON cannot hold become None."""
    if isinstance(value, Mapping):
        return {str(k): _plain(v) for k, v in value.items()}
    if isinstance(value, (list, tuple, set, np.ndarray)):
        return [_plain(v) for v in value]
    if isinstance(value, np.generic):
        return _plain(value.item())
    if isinstance(value, float):
        return value if math.isfinite(value) else None
    if value is None or isinstance(value, (bool, int, str)):
        return value
    return str(value)

# SPDX-License-Identifier: BSD-3-Clause
"""The process in which a benchmark runs alone, so that no earlier memory hides its own.

    python -m mpm3dpp.bench.worker NAME SIZE THREADS SCHEME WARM_UP [DEVICE [KEY=VALUE ...]]

Scheme "-" is that of a case which says nothing; keys are those of `Numerics`.
It answers commands on standard input with one line of JSON each on standard output: `block N`
makes and times N steps, `finish` reads the memory and then, in the same process and state of the
machine, measures what it can do at best. Of several ranks the first one answers.
"""

from __future__ import annotations

import contextlib
import json
import sys
import time as clock
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from mpm3dpp import _core
from mpm3dpp.base.errors import CaseError
from mpm3dpp.ranks.world import World, world
from mpm3dpp.run.device import CPU

from .cases import BENCHES, FOREVER, make
from .numerics import Numerics
from .process import NO_WORD

TOUCHING = ("overlapped_nodes", "touching_points")
"""Of `contact_summary`: how much touches, of bodies by their nodes and by their surfaces."""


def status_bytes(field: str) -> int:
    """Return a size from /proc/self/status [bytes]: VmRSS is resident now, VmHWM at most."""
    for line in Path("/proc/self/status").read_text().splitlines():
        if line.startswith(field + ":"):
            return int(line.split()[1]) * 1024
    raise OSError(f"/proc/self/status has no {field}")


def forget_peak() -> None:
    """Set the peak VmHWM back to the present size, so that it belongs to what follows."""
    with contextlib.suppress(OSError):  # Not allowed everywhere; the process is fresh anyway.
        Path("/proc/self/clear_refs").write_text("5")


def advance(simulation: Any, steps: int) -> None:
    """Make exactly `steps` steps; raise RuntimeError with the core's sentence if it cannot."""
    left = steps
    while left > 0:
        left -= simulation.advance(min(left, simulation.history_capacity), FOREVER)
        simulation.history()
        if simulation.failure is not None:
            raise RuntimeError(simulation.failure.message)


def timed_block(simulation: Any, steps: int) -> dict[str, Any]:
    """Return ns per particle-step of a block of steps, and of each stage in it."""
    simulation.reset_timers()
    begin = clock.perf_counter()
    advance(simulation, steps)
    seconds = clock.perf_counter() - begin
    scale = 1e9 / (steps * simulation.particle_count)
    return {
        "ns": seconds * scale,
        "exchange": dict(simulation.ranks()),
        "stages": {name: spent * scale for name, spent in simulation.timers().items()},
    }


def measure_device(simulation: Any, steps: int) -> dict[str, Any]:
    """Return what the device takes in `steps` more steps, and what it can do at best.

    Returns:
        `device`, its name; `device_bytes`; `kernels` [ns per particle-step]; `bandwidth` [GB/s] and
        `arithmetic` [GFLOP/s], those that its clocks give.
    """
    simulation.device_times()  # From now on kernels are timed, which makes steps slower.
    advance(simulation, steps)
    scale = 1e9 / (steps * simulation.particle_count)
    about = simulation.device()
    return {
        "device": about["name"],
        "device_bytes": simulation.device_bytes,
        "kernels": {name: spent * scale for name, spent in simulation.device_times().items()},
        "bandwidth": about["bandwidth"] / 1e9,
        "arithmetic": 2e-9 * about["fma_per_second"],
    }


def main(arguments: list[str]) -> None:
    """Serve the commands of `mpm3dpp.bench.main`."""
    name, scheme = arguments[0], arguments[3]
    size, threads, warm_up = int(arguments[1]), int(arguments[2]), int(arguments[4])
    device = arguments[5] if len(arguments) > 5 else CPU
    ranks = world()
    numerics = Numerics.of_words(arguments[6:])
    if scheme != NO_WORD:
        numerics = numerics._replace(scheme=scheme)
    _core.return_freed_memory()  # as `mpm3dpp run` does
    BENCHES[name].case(size, numerics)  # What reads cases is in memory before it is measured.
    forget_peak()
    before = status_bytes("VmRSS")
    simulation = make(BENCHES[name], size, threads, numerics, ranks)
    if device != CPU:
        simulation.use_device()
    advance(simulation, warm_up)
    answer({"ready": True}, ranks)
    for command, *values in orders(ranks):
        if command == "block":
            answer(timed_block(simulation, int(values[0])), ranks)
        elif command == "finish":
            growth, touching = status_bytes("VmHWM") - before, simulation.contact_summary()
            result = {
                "growth": ranks.comm.allreduce(growth) if ranks else growth,
                "particles": simulation.particle_count,
                "bytes": dict(simulation.bytes()),
                **{key: touching[key] for key in TOUCHING},
                "isa": _core.build_info()["isa"],
            }
            if device != CPU:
                result |= measure_device(simulation, warm_up)
            del simulation  # The arrays of the bandwidth test take its place.
            if device == CPU:
                result["device"] = CPU
                result["bandwidth"] = _core.measure_bandwidth(threads)
                result["arithmetic"] = _core.measure_arithmetic(threads)
            answer(result, ranks)
            return


def orders(ranks: World | None) -> Iterator[tuple[str, ...]]:
    """Yield the commands on standard input, which the first rank reads for all."""
    while True:
        if ranks is not None and ranks.rank > 0:
            order = ranks.hear()
            if order == ("quit",):
                return
            yield order
            continue
        line = sys.stdin.readline()
        if not line:  # Who asks is gone.
            if ranks is not None:
                ranks.tell("quit")
            return
        if ranks is not None:
            ranks.tell(*line.split())
        yield tuple(line.split())


def answer(content: dict[str, Any], ranks: World | None = None) -> None:
    """Send one line to the process that asks; one rank does."""
    if ranks is None or ranks.rank == 0:
        print(json.dumps(content), flush=True)


if __name__ == "__main__":
    try:
        main(sys.argv[1:])
    except (CaseError, RuntimeError, ValueError, MemoryError) as error:
        answer({"error": str(error) or "there is not enough memory"})

# SPDX-License-Identifier: BSD-3-Clause
"""`mpm3dpp bench`: time per particle-step and stage, bytes per particle, share of the bandwidth.

Each benchmark runs in a process of its own (`worker.py`). After warm-up steps it is timed in five
blocks of steps; the figure is the median block, and the stages are those of that block. A
benchmark with a twin (`two_cubes`) takes turns with it, block by block, for an honest ratio.

- Bytes per particle: `total` is how much the process' resident size has grown at its peak since
  before the bodies were made; `particles`, `grid` and `contact` are what the core counts, `other`
  is the difference (the input while it is handed over, sorting, history, threads, the allocator).
  The core also counts memory it has reserved and not used, so in small problems `other` can be
  negative.
- Bandwidth and arithmetic: measured by the same process after its memory has been read. How the
  traffic and the operations of a step are counted: see `traffic.py` and `operations.py`.
- Numerics are those of a case that says nothing of them, but where a word is given: `numerics.py`.
  All bodies that deform have the same frame.
- With a device both limits are nominal, of its clocks, and the traffic is the same count: what
  the stages of the step must move, whatever its kernels do.
"""

from __future__ import annotations

import json as json_format
from collections.abc import Callable, Sequence
from contextlib import ExitStack
from dataclasses import replace
from pathlib import Path
from typing import Any

from mpm3dpp.base.errors import CaseError, nearest
from mpm3dpp.base.frames import MATERIAL, UPDATED
from mpm3dpp.base.machine import MEMORY, PARTICLE_BYTES_WITH_GRID
from mpm3dpp.case.case import Case
from mpm3dpp.io.folders import writable_folder
from mpm3dpp.io.foreign import refuse_to_draw
from mpm3dpp.run.device import CPU, CUDA, ONE_PROCESS

from .cases import BENCHES, Bench
from .numerics import DEFAULT, Numerics, words_of
from .process import Part, Process
from .result import result_of

__all__ = ["BENCHES", "Numerics", "block_lengths", "find", "main", "measure", "series"]

BLOCKS = 5
STEPS = 400  # So that a block of 80 steps holds several crossings of whole layers of particles.
WARM_UP = 20


def find(name: str) -> Bench:
    """Return a benchmark by name. Raises `CaseError` that lists the names."""
    if name not in BENCHES:
        raise CaseError("is not a known benchmark", nearest(name, BENCHES), value=name)
    return BENCHES[name]


def block_lengths(steps: int) -> list[int]:
    """Return the steps of each block: five nearly equal ones, fewer only for fewer steps."""
    count = min(BLOCKS, steps)
    return [steps // count + (k < steps % count) for k in range(count)]


def measure(
    name: str,
    size: int | None = None,
    threads: int = 1,
    numerics: Numerics = DEFAULT,
    steps: int | None = None,
    told: Callable[[int, int], None] | None = None,
    ranks: int = 1,
    device: str = CPU,
) -> dict[str, Any]:
    """Measure a benchmark.

    Args:
        name: see `cases.BENCHES`.
        size: cells along the edge of a body, or the number of grains.
        threads: how many.
        numerics: what is said of them.
        steps: how many are timed.
        told: called with (parts done, parts in all) as the measurement goes on.
        ranks: processes, each with so many threads.
        device: "cpu" or "cuda", which makes the steps.

    Returns:
        What `--json` prints: `particles`, `threads`, `ns_per_particle_step`, `stages` [ns per
        particle-step], `bytes_per_particle` {particles, grid, contact, other, total},
        `bandwidth_GBps`, `bandwidth_fraction`, `arithmetic_GFLOPS`, `arithmetic_fraction`; what
        was measured (`bench`, `basis`, `transfer`, `scheme`, `preset`, `frame`, `size`, `steps`,
        `version`, `machine`, `isa`); `ranks` and what passes between them, see `Manifest.ranks`;
        `blocks`, all blocks [ns]; `device`, its name or "cpu", and with one
        `device_bytes_per_particle`, `stages` being its kernels, of steps of their own; and with a
        twin `without_contact_ns` and `contact_ratio` (`elastic3d_ns`, `elastic3d_ratio` for `jc`
        and `debris`), the median over pairs of blocks. What is counted of traffic and operations is
        None for a transfer that is not counted, and in the material frame.

    Raises:
        CaseError: there is no such benchmark, not with these numerics, or no memory for this size.
        RunError: it could not be run to its end, or there is no device that can.
    """
    bench = find(name)
    cells = size or bench.size
    numerics = _with_frame(bench, cells, numerics, device)
    specs = [
        Part(part, cells, threads, ranks, device, numerics) for part in (name, bench.twin) if part
    ]
    lengths = block_lengths(steps or STEPS)
    _check_memory(specs)
    case = _allowed(bench, cells, numerics, device, ranks)
    blocks, ends = _in_turns(specs, lengths, told)
    return result_of(bench, specs[0], case, sum(lengths), blocks, ends[0])


def series(
    name: str,
    sizes: Sequence[int],
    threads: Sequence[int],
    numerics: Numerics = DEFAULT,
    steps: int | None = None,
    told: Callable[[int, int], None] | None = None,
    ranks: Sequence[int] = (1,),
    device: str = CPU,
) -> list[dict[str, Any]]:
    """Measure a benchmark for every size with every number of ranks and of threads, in turns.

    All take turns block by block, so that they can be compared; their memory is needed at once.
    The twin of a benchmark is left out. Arguments, results and errors are those of `measure`.
    """
    bench = find(name)
    lengths = block_lengths(steps or STEPS)
    numerics = _with_frame(bench, sizes[0], numerics, device)
    specs = [
        Part(name, size, count, parts, device, numerics)
        for size in sizes
        for parts in ranks
        for count in threads
    ]
    _check_memory(specs)
    case = _allowed(bench, sizes[0], numerics, device, max(ranks))
    blocks, ends = _in_turns(specs, lengths, told)
    alone = replace(bench, twin="")
    return [
        result_of(alone, part, case, sum(lengths), [found], end)
        for part, found, end in zip(specs, blocks, ends, strict=True)
    ]


def _with_frame(bench: Bench, size: int, numerics: Numerics, device: str) -> Numerics:
    """Return the numerics with the frame that a case of them has which says nothing of it."""
    if numerics.frame is not None:
        return numerics
    in_space = bench.loose or device == CUDA
    frame = UPDATED if in_space else words_of(bench.case(size, numerics))["frame"]
    return numerics._replace(frame=frame)


def _allowed(bench: Bench, size: int, numerics: Numerics, device: str, ranks: int) -> Case:
    """Return the case of a benchmark. Raises `CaseError` if it cannot be measured so."""
    if device not in (CPU, CUDA):
        raise CaseError("must be cpu or cuda", nearest(device, (CPU, CUDA)), key="device")
    if device == CUDA and ranks > 1:
        raise CaseError(f"{ONE_PROCESS}: leave --ranks out")
    if numerics.frame == MATERIAL and (device == CUDA or bench.loose):
        loose = f"{bench.name}, whose particles are no neighbours of each other"
        rule = f"does not go with {loose if bench.loose else '--device cuda yet'}"
        raise CaseError(rule, "leave it out", key="frame", value=MATERIAL)
    case = bench.case(size, numerics)
    if bench.loose and case.run.scheme == "usl":
        raise CaseError(
            "cannot be measured with USL, which is unstable where particles enter empty cells",
            "give usf or musl",
            value=bench.name,
        )
    return case


def _check_memory(specs: Sequence[Part]) -> None:
    """Raise `CaseError` if benchmarks at once have no room in memory."""
    particles = sum(BENCHES[part.name].particles(part.size, part.numerics.frame) for part in specs)
    needed = particles * PARTICLE_BYTES_WITH_GRID
    if needed > MEMORY:
        name, size = max(specs, key=lambda part: part.size)[:2]
        at_once = f"{len(specs)} benchmarks at once" if len(specs) > 1 else name
        raise CaseError(
            f"is too large: {at_once} would need some {needed / 2**30:,.0f} GiB of memory, and "
            f"this machine has {MEMORY / 2**30:,.1f} GiB",
            "give a smaller one",
            key="size",
            value=size,
        )


def _in_turns(
    specs: Sequence[Part],
    lengths: Sequence[int],
    told: Callable[[int, int], None] | None,
) -> tuple[list[list[dict[str, Any]]], list[dict[str, Any]]]:
    """Measure benchmarks block by block; return their blocks and ends."""
    parts = len(specs) * (len(lengths) + 1) + 1
    blocks: list[list[dict[str, Any]]] = [[] for _ in specs]
    done = 0

    def tell() -> None:
        nonlocal done
        if told is not None:
            told(done, parts)
        done += 1

    with ExitStack() as stack:
        workers = []
        # One after the other: making particles disturbs the rest.
        for part in specs:
            tell()
            worker = Process(part, min(WARM_UP, sum(lengths)))
            workers.append(stack.enter_context(worker))
            worker.ask()
        for length in lengths:
            for worker, found in zip(workers, blocks, strict=True):
                tell()
                found.append(worker.ask(f"block {length}"))
        tell()
        ends = [worker.ask("finish") for worker in workers]
    tell()
    return blocks, ends


def main(
    name: str,
    sizes: Sequence[int] = (),
    threads: Sequence[int] = (1,),
    numerics: Numerics = DEFAULT,
    steps: int | None = None,
    json: bool = False,
    plot: Path | None = None,
    ranks: Sequence[int] = (1,),
    device: str = CPU,
) -> None:
    """Measure a benchmark and print a table, or JSON, and draw it; see `measure` and `series`."""
    from .report import progress, show, show_series

    bench = find(name)
    if plot is not None and plot.suffix.lower() != ".png":
        remedy = "give a name that ends in .png"
        raise CaseError("is not the name of a PNG file", remedy, key="--plot", value=str(plot))
    if plot is not None:
        writable_folder(plot.parent)
        refuse_to_draw(plot)
    alone = len(sizes) <= 1 and len(threads) == len(ranks) == 1
    with progress(quiet=json) as told:
        try:
            if alone:
                size = next(iter(sizes), None)
                results = [measure(name, size, threads[0], numerics, steps, told, ranks[0], device)]
            else:
                sizes = sizes or (bench.size,)
                results = series(name, sizes, threads, numerics, steps, told, ranks, device)
        except CaseError as error:
            if error.key not in ("size", *Numerics._fields):
                raise
            key = f"--{error.key}"
            raise CaseError(error.rule, error.remedy, key=key, value=error.value) from None
    if json:
        print(json_format.dumps(results[0] if alone else results, indent=2))
    elif alone:
        show(results[0])
    else:
        show_series(results)
    if plot:
        from .picture import save_picture

        saved = save_picture(plot, results)
        if not json:
            print(f"picture    {saved}")

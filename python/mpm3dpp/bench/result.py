# SPDX-License-Identifier: BSD-3-Clause
"""The result of a benchmark, of what its process has measured."""

from __future__ import annotations

import statistics
from typing import Any

from mpm3dpp import _core
from mpm3dpp.base.machine import processor_name

from .cases import Bench
from .operations import operations_per_particle_step
from .process import Part
from .traffic import bytes_per_particle_step


def result_of(
    bench: Bench,
    part: Part,
    scheme: str,
    steps: int,
    blocks: list[list[dict[str, Any]]],
    last: dict[str, Any],
) -> dict[str, Any]:
    """Put the measurements together; see `measure`."""
    from mpm3dpp import __version__

    size = part.size
    count = bench.particles(size)
    median = statistics.median_low(block["ns"] for block in blocks[0])
    block = next(block for block in blocks[0] if block["ns"] == median)
    stages = block["stages"]
    # A device has kernels in place of stages; what it must do is what the stages say.
    told = [name for name, *_ in _core.stages(scheme, True)] if part.on_device else list(stages)
    moved = sum(bytes_per_particle_step(told, bench.dimension, bench.state).values())
    made = sum(operations_per_particle_step(told, bench.dimension, bench.basis, bench.law).values())
    memory = {key: last["bytes"][key] / count for key in ("particles", "grid", "contact")}
    total = last["growth"] / count
    result: dict[str, Any] = {
        "bench": bench.name,
        "version": __version__,
        "machine": processor_name(),
        "isa": last["isa"],
        "scheme": scheme,
        "size": size,
        "steps": steps,
        "particles": count,
        "threads": part.threads,
        "device": last["device"],
        **block["exchange"],
        "ns_per_particle_step": median,
        "blocks": [block["ns"] for block in blocks[0]],
        "stages": last["kernels"] if part.on_device else stages,
        "bytes_per_particle": {**memory, "other": total - sum(memory.values()), "total": total},
        "bandwidth_GBps": last["bandwidth"],
        "bytes_moved_per_particle_step": moved,
        "bandwidth_fraction": moved / median / last["bandwidth"],
        "arithmetic_GFLOPS": last["arithmetic"],
        "operations_per_particle_step": made,
        "arithmetic_fraction": made / median / last["arithmetic"],
        "overlapped_nodes": last["overlapped_nodes"],
    }
    if part.on_device:
        result["device_bytes_per_particle"] = last["device_bytes"] / count
    if bench.twin:
        pairs = zip(*blocks, strict=True)
        key = "without_contact" if bench.contact else bench.twin
        result[f"{key}_ns"] = statistics.median(block["ns"] for block in blocks[1])
        ratio = statistics.median(a["ns"] / b["ns"] for a, b in pairs)
        result["contact_ratio" if bench.contact else f"{key}_ratio"] = ratio
    return result

# SPDX-License-Identifier: BSD-3-Clause
"""The result of a benchmark, of what its process has measured."""

from __future__ import annotations

import statistics
from typing import Any

from mpm3dpp import _core
from mpm3dpp.base.frames import MATERIAL
from mpm3dpp.base.machine import processor_name
from mpm3dpp.case.case import Case

from .cases import Bench
from .numerics import words_of
from .operations import TAKES, operations_per_particle_step
from .process import Part
from .traffic import bytes_per_particle_step


def result_of(
    bench: Bench,
    part: Part,
    case: Case,
    steps: int,
    blocks: list[list[dict[str, Any]]],
    last: dict[str, Any],
) -> dict[str, Any]:
    """Put the measurements together; see `measure`."""
    from mpm3dpp import __version__

    count, words = last["particles"], words_of(case)
    median = statistics.median_low(block["ns"] for block in blocks[0])
    block = next(block for block in blocks[0] if block["ns"] == median)
    stages = block["stages"]
    # A device has kernels in place of stages; what it must do is what the stages say.
    told = [name for name, *_ in _core.stages(words["scheme"], True)]
    moved, made = counted(bench, words, told if part.on_device else list(stages))
    memory = {key: last["bytes"][key] / count for key in ("particles", "grid", "contact")}
    total = last["growth"] / count
    result: dict[str, Any] = {
        "bench": bench.name,
        "version": __version__,
        "machine": processor_name(),
        "isa": last["isa"],
        **words,
        "size": part.size,
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
        **_shares("bytes_moved", "bandwidth", moved, median, last),
        "arithmetic_GFLOPS": last["arithmetic"],
        **_shares("operations", "arithmetic", made, median, last),
        "overlapped_nodes": last["overlapped_nodes"],
        "touching_points": last["touching_points"],
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


def counted(
    bench: Bench, words: dict[str, Any], stages: list[str]
) -> tuple[dict[str, int], dict[str, int]]:
    """Return bytes and operations of each stage per particle and step, of what is counted.

    Args:
        bench: which one.
        words: with `basis`, `transfer` and `frame`; for what is not counted nothing is returned.
        stages: names of those of a step.
    """
    basis, transfer, d = words["basis"], words["transfer"], bench.dimension
    if transfer not in TAKES or words["frame"] == MATERIAL:
        return {}, {}
    moved = bytes_per_particle_step(stages, d, transfer, bench.state)
    return moved, operations_per_particle_step(stages, d, basis, transfer, bench.law)


def _shares(
    what: str, limit: str, each: dict[str, int], ns: float, last: dict[str, Any]
) -> dict[str, Any]:
    """Return the sum over the stages and its share of a limit; None of what is not counted."""
    whole = sum(each.values()) if each else None
    share = None if whole is None else whole / ns / last[limit]
    return {f"{what}_per_particle_step": whole, f"{limit}_fraction": share}

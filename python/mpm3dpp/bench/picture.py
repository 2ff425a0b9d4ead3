# SPDX-License-Identifier: BSD-3-Clause
"""The picture of a measurement: where the time and the memory go, or how they grow."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

from mpm3dpp.plots.style import PALETTE, new_figure, save, styled

from .report import numerics

if TYPE_CHECKING:
    from matplotlib.axes import Axes

_LEAST = 0.005  # Stages with a smaller share of the step have no bar.
_PARTS = ("particles", "grid", "contact", "other")


def save_picture(path: Path, results: list[dict[str, Any]]) -> Path:
    """Draw results of `mpm3dpp.bench.measure` (one) or `series` (more) and write them as PNG."""
    first = results[0]
    with styled():
        figure = new_figure(8.6, 3.2)
        left, right = figure.subplots(1, 2, width_ratios=(3, 2))
        if len(results) == 1:
            _stages(left, first)
        else:
            _growth(left, results)
        _memory(right, results)
        title = f"{first['bench']}: {numerics(first)} ({first['machine']}, {first['isa']})"
        figure.suptitle(title, fontsize=10)
        return save(figure, path)


def _stages(axes: Axes, result: dict[str, Any]) -> None:
    total = result["ns_per_particle_step"]
    stages = {name: ns for name, ns in result["stages"].items() if ns > _LEAST * total}
    bars = axes.barh(list(stages), list(stages.values()), color=PALETTE[0])
    axes.bar_label(bars, fmt="%.1f", padding=3, fontsize=8)
    axes.invert_yaxis()
    axes.set_xlabel(f"ns per particle and step; {total:.1f} in all")


def _growth(axes: Axes, results: list[dict[str, Any]]) -> None:
    """Time over the number of particles for each number of threads; of one size, over threads."""
    sizes = sorted({result["particles"] for result in results})
    ranks = sorted({result["ranks"] for result in results})
    kind = "rank" if len(ranks) > 1 else "thread"
    counts = ranks if len(ranks) > 1 else sorted({result["threads"] for result in results})
    ns = {(r["particles"], r[f"{kind}s"]): r["ns_per_particle_step"] for r in results}
    if len(sizes) > 1:
        for count, colour in zip(counts, PALETTE, strict=False):
            found = [ns[size, count] for size in sizes]
            label = f"{count} {kind}{'s' if count > 1 else ''}"
            axes.plot(sizes, found, "o-", color=colour, label=label)
        axes.set_xscale("log")
        axes.set_xlabel("particles")
    else:
        found = [ns[sizes[0], count] for count in counts]
        axes.plot(counts, found, "o-", color=PALETTE[0], label=f"{sizes[0]:,} particles")
        ideal = [found[0] * counts[0] / count for count in counts]
        axes.plot(counts, ideal, "--", color="black", linewidth=1.0, label="ideal")
        axes.set_xticks(counts)
        axes.set_xlabel(f"{kind}s")
    axes.set_ylim(0.0, 1.1 * max(ns.values()))
    axes.set_ylabel("ns per particle and step")
    axes.grid(True)
    axes.legend()


def _memory(axes: Axes, results: list[dict[str, Any]]) -> None:
    """Bytes per particle by what they are for, a bar for each size."""
    by_size = {result["particles"]: result["bytes_per_particle"] for result in results}
    names = [f"{size:,}" for size in by_size]
    below = [0.0] * len(names)
    for part, colour in zip(_PARTS, PALETTE, strict=False):
        values = [max(memory[part], 0.0) for memory in by_size.values()]
        axes.bar(names, values, 0.6, bottom=below, color=colour, label=part)
        below = [low + value for low, value in zip(below, values, strict=True)]
    axes.set_xlabel("particles")
    axes.set_ylabel("bytes per particle at the peak")
    axes.set_ylim(top=1.35 * max(below))
    axes.legend(ncols=2, loc="upper center")

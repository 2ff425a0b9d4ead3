# SPDX-License-Identifier: BSD-3-Clause
"""What `mpm3dpp bench` shows: a bar while it measures, then a table."""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any

from mpm3dpp.base.frames import MATERIAL

from .cases import BENCHES
from .result import counted


@contextmanager
def progress(quiet: bool) -> Iterator[Callable[[int, int], None] | None]:
    """Yield a function that shows how far the measurement is, on standard error.

    Nothing is shown where standard error is not a terminal, or if `quiet`.
    """
    if quiet or not sys.stderr.isatty():
        yield None
        return
    from rich.console import Console
    from rich.progress import (
        BarColumn,
        Progress,
        TextColumn,
        TimeElapsedColumn,
        TimeRemainingColumn,
    )

    columns = (
        TextColumn("measuring"),
        BarColumn(bar_width=24),
        TextColumn("{task.completed:.0f} of {task.total:.0f} parts"),
        TimeElapsedColumn(),
        TextColumn("left"),
        TimeRemainingColumn(),
    )
    # The bar is drawn between two parts only, so that drawing takes no time from what is timed.
    bar = Progress(*columns, console=Console(stderr=True), auto_refresh=False, transient=True)
    with bar:
        task = bar.add_task("measuring", total=1)

        def told(done: int, parts: int) -> None:
            bar.update(task, completed=done, total=parts)
            bar.refresh()

        yield told


def show(result: dict[str, Any]) -> None:
    """Print the tables of a result of `mpm3dpp.bench.measure` on standard output."""
    from rich.console import Console

    console = Console(highlight=False)
    console.print(headline(result), markup=False, soft_wrap=True)
    console.print(_kernels(result) if _on_device(result) else _stages(result))
    for line in lines(result):
        console.print(line, markup=False, soft_wrap=True)


def show_series(results: list[dict[str, Any]]) -> None:
    """Print a row for each result of `mpm3dpp.bench.series` on standard output."""
    from rich.box import SIMPLE_HEAD
    from rich.console import Console
    from rich.table import Table

    first = results[0]
    several = any(result["ranks"] > 1 for result in results)
    last = ("exchange", "kB", "letters", "imbalance") if several else ("GB/s", "limit")
    heads = ("particles", "ranks", "threads", "ns", "ratio", "bytes", *last)
    table = Table(box=SIMPLE_HEAD, padding=0)
    for head in heads:  # Ten fit into 80 columns.
        table.add_column(head, justify="right", no_wrap=True)
    for result in results:
        ns = result["ns_per_particle_step"]
        moved = result["bytes_moved_per_particle_step"]
        used = "" if moved is None else f"{moved / ns:.1f}"
        limits = (used, f"{result['bandwidth_GBps']:.1f}")
        table.add_row(
            f"{result['particles']:,}",
            f"{result['ranks']}",
            f"{result['threads']}",
            f"{ns:.3f}" if _on_device(result) else f"{ns:.1f}",
            f"{ns / first['ns_per_particle_step']:.3f}",
            f"{_memory(result):.1f}",
            *(_exchange(result) if several else limits),
        )
    console = Console(highlight=False)
    about = BENCHES[first["bench"]].about
    console.print(
        f"{first['bench']}: {about}; {numerics(first)}; {first['steps']} steps, in turns",
        markup=False, soft_wrap=True,
    )  # fmt: skip
    console.print(table)
    for line in (
        "ns per particle-step and their ratio to the first row; bytes per particle at the peak;",
        *(_ABOUT_EXCHANGE if several else _about_bandwidth(first)),
        f"machine    {first['machine']}, {first['isa']}",
    ):
        console.print(line, markup=False, soft_wrap=True)


def numerics(result: dict[str, Any]) -> str:
    """Return what the numerics were, in a few words."""
    preset = f'preset "{result["preset"]}": ' if result["preset"] else ""
    step = f"{result['transfer'].upper()}, {result['scheme'].upper()}, "
    # Whatever these are, a body in the material frame makes the same steps.
    step = "" if result["frame"] == MATERIAL else step
    return f"{preset}{result['basis']}, {step}{result['frame']} frame"


def _about_bandwidth(first: dict[str, Any]) -> tuple[str, ...]:
    if first["bytes_moved_per_particle_step"] is None:
        return (_not_counted("bandwidth", first),)
    if _on_device(first):
        return (f"of {first['device']}; bandwidth used, and its nominal one",)
    return ("bandwidth used, and measured in the same run",)


def _not_counted(limit: str, result: dict[str, Any]) -> str:
    key = "frame" if result["frame"] == MATERIAL else "transfer"
    return f'{limit:10} not counted for {key} = "{result[key]}"'


_ABOUT_EXCHANGE = (
    "of a rank in the mean: the share of the time that exchange takes, waiting included; kB and",
    "letters that it sends in a step; imbalance: the longest time at work over the mean one",
)


def _exchange(result: dict[str, Any]) -> tuple[str, ...]:
    return (
        f"{result['share']:.1%}",
        f"{result['bytes'] / 1000:.0f}",
        f"{result['letters']:.1f}",
        f"{result['imbalance']:.2f}",
    )


def _memory(result: dict[str, Any]) -> float:
    """Return the bytes per particle, of the device if there is one."""
    own = result["bytes_per_particle"]["total"]
    return float(result.get("device_bytes_per_particle", own))


def headline(result: dict[str, Any]) -> str:
    """Return what was measured, in one line."""
    threads, ranks = result["threads"], result["ranks"]
    of_ranks = f" of each of {ranks} ranks" if ranks > 1 else ""
    on = f"{threads} thread{'s' if threads > 1 else ''}{of_ranks}"
    if _on_device(result):
        on = result["device"]
    return (
        f"{result['bench']}: {BENCHES[result['bench']].about}; {result['particles']:,} particles, "
        f"{numerics(result)}; {on}, {result['steps']} steps"
    )


def _on_device(result: dict[str, Any]) -> bool:
    return "device_bytes_per_particle" in result


def _kernels(result: dict[str, Any]) -> Any:
    """Return the table of a device, whose kernels are no stages."""
    from rich.table import Table

    kernels = result["stages"]
    total = sum(kernels.values()) or 1.0
    table = Table(show_footer=True, caption="per particle and step, timed in steps of their own")
    table.add_column("kernels", footer="all", no_wrap=True)
    table.add_column("ns", footer=f"{total:.3f}", justify="right")
    table.add_column("share", footer="100 %", justify="right")
    for name, ns in kernels.items():
        table.add_row(name, f"{ns:.3f}", f"{100 * ns / total:.0f} %")
    return table


def _stages(result: dict[str, Any]) -> Any:
    from rich.table import Table

    total, stages = result["ns_per_particle_step"], result["stages"]
    bench = BENCHES[result["bench"]]
    moved, made = counted(bench, result, list(stages))
    table = Table(show_footer=True, caption="per particle and step")
    table.add_column("stage", footer="step", no_wrap=True)
    sums = [f"{sum(of.values())}" if of else "" for of in (moved, made)]
    footers = (f"{total:.1f}", "100 %", *sums)
    heads = ("ns", "share", "bytes", "operations")
    for head, footer in zip(heads, footers, strict=True):
        table.add_column(head, footer=footer, justify="right")
    rest = total - sum(stages.values())
    for stage, ns in [*stages.items(), ("ledger and time step", rest)]:
        counts = [f"{of[stage]}" if of.get(stage) else "" for of in (moved, made)]
        table.add_row(stage, f"{ns:.1f}", f"{100 * ns / total:.0f} %", *counts)
    return table


def lines(result: dict[str, Any]) -> list[str]:
    """Return the lines below the table: spread, memory, bandwidth, contact."""
    memory, blocks = result["bytes_per_particle"], result["blocks"]
    parts = ", ".join(f"{key} {memory[key]:.1f}" for key in memory if key != "total")
    device = _on_device(result)
    places = 3 if device else 1
    found = [
        f"time       {result['ns_per_particle_step']:.{places}f} ns per particle-step, the median "
        f"of {len(blocks)} blocks from {min(blocks):.{places}f} to {max(blocks):.{places}f}",
        f"memory     {memory['total']:.1f} bytes per particle at the peak: {parts}",
        *_shares(result),
    ]
    if device:
        found.insert(
            2,
            f"device     {result['device_bytes_per_particle']:.1f} bytes of its memory per "
            "particle; the line above is the host's",
        )
    if result["ranks"] > 1:
        share, kilobytes, letters, imbalance = _exchange(result)
        found.append(
            f"exchange   {share} of the time, waiting included; of a rank in a step {kilobytes} kB "
            f"in {letters} letters, {result['exchanges']:.1f} exchanges, "
            f"{result['reductions']:.1f} reductions; imbalance {imbalance}"
        )
    if "contact_ratio" in result:
        touching = f"{result['overlapped_nodes']:,} overlapped nodes"
        if result["frame"] == MATERIAL:
            touching = f"{result['touching_points']:,} points of surfaces touch"
        found.append(
            f"contact    {result['contact_ratio']:.3f} times the same without contact "
            f"({result['without_contact_ns']:.1f} ns); {touching}"
        )
    bench = BENCHES[result["bench"]]
    twin = bench.twin
    if f"{twin}_ratio" in result:
        found.append(
            f"against    {twin}, in turns: {result[f'{twin}_ratio']:.3f} times its "
            f"{result[f'{twin}_ns']:.1f} ns (median of the blocks' ratios)"
        )
    if result["scheme"] == "usl" and bench.flies:
        found.append("note       with USL the bodies stay in place: no particle crosses cells")
    found.append(f"machine    {result['machine']}, {result['isa']}")
    return found


def _shares(result: dict[str, Any]) -> tuple[str, ...]:
    """Return the lines of bandwidth and arithmetic."""
    if result["bytes_moved_per_particle_step"] is None:
        return _not_counted("bandwidth", result), _not_counted("arithmetic", result)
    ns = result["ns_per_particle_step"]
    cached = ": most comes from the caches" if result["bandwidth_fraction"] > 1.0 else ""
    limit = "nominal" if _on_device(result) else "measured now"
    return (
        f"bandwidth  {result['bytes_moved_per_particle_step'] / ns:.1f} of "
        f"{result['bandwidth_GBps']:.1f} GB/s ({100 * result['bandwidth_fraction']:.0f} %{cached})"
        f", as counted; the limit is {limit}",
        f"arithmetic {result['operations_per_particle_step'] / ns:.1f} "
        f"of {result['arithmetic_GFLOPS']:.1f} GFLOP/s "
        f"({100 * result['arithmetic_fraction']:.0f} %), as the equations are written",
    )

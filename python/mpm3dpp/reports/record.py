# SPDX-License-Identifier: BSD-3-Clause
"""The section on with what the run was made: version, build, machine, hashes."""

from __future__ import annotations

from mpm3dpp.base.markup import Html, element, paragraph, table
from mpm3dpp.io.manifest import Manifest

from .document import Section
from .found import Found
from .numbers import counted, duration, number


def record(found: Found) -> Section:
    """Return the table of the manifest."""
    name, title = "manifest", "Manifest"
    if found.manifest is None:
        return Section(name, title, paragraph("A run writes manifest.json when it ends."))
    rows = [[what, _code(value)] for what, value in _rows(found.manifest, found.per) if value]
    return Section(name, title, table(["entry", "value"], rows, words=2))


def _code(value: str) -> Html:
    return element("code", value)


def _rows(manifest: Manifest, per: str) -> list[tuple[str, str]]:
    used = sum(manifest.bytes.values())
    return [
        ("version", manifest.version),
        ("command", manifest.command),
        ("case file", manifest.case_file),
        ("case hash", manifest.case_hash),
        ("result hash", manifest.result_hash),
        ("status", manifest.status),
        ("reason", manifest.reason or ""),
        ("compiler", manifest.compiler),
        ("flags", manifest.flags),
        ("instruction set", manifest.isa),
        ("processor", manifest.processor),
        ("device", manifest.device),
        ("platform", manifest.platform),
        ("Python", manifest.python),
        ("threads", str(manifest.threads)),
        ("ranks", _ranks(manifest)),
        ("particles", f"{manifest.particles:,}"),
        ("mass", f"{number(manifest.mass)} kg{per}"),
        ("steps", f"{manifest.steps:,}"),
        ("resumed at step", f"{manifest.resumed_step:,}" if manifest.resumed_step else ""),
        ("wall time", duration(manifest.wall_time)),
        ("time of a particle-step", f"{number(manifest.ns_per_particle_step, 4)} ns"),
        ("memory of the process", f"{manifest.peak_memory_bytes / 2**20:,.0f} MiB"),
        ("memory of the core", f"{used / 2**20:,.1f} MiB"),
    ]


def _ranks(manifest: Manifest) -> str:
    ranks = manifest.ranks
    if ranks["ranks"] == 1:
        return "1"
    return (
        f"{counted(ranks['ranks'], 'rank')} by {ranks['mpi']}; {ranks['share']:.0%} of the steps' "
        f"time in exchange, imbalance {ranks['imbalance']:.2f}"
    )

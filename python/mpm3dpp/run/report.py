# SPDX-License-Identifier: BSD-3-Clause
"""What a finished run prints: contact, speed, memory."""

from __future__ import annotations

import math
from collections import Counter
from typing import Any

from mpm3dpp.base.frames import MATERIAL
from mpm3dpp.case.box import CONTACT
from mpm3dpp.io.manifest import Manifest

_PAIRS_SHOWN = 10
_BODIES_SHOWN = 10
_ROUNDING = 1e-9  # Components of a velocity that are less than this share of it are none.
_TURNING = 1e-3  # Twice the share of a body's kinetic energy in its spin, from which that is told.
_OF_A_KIND = 3  # warnings shown
_NUMERICAL_WARNING = 0.05
_CROWD = 5  # Bodies at a node, beyond which impulses of all pairs take many sweeps ...
_MOST_SHARE = 0.8  # ... which is told if contact takes more of the step's time than this.


def summary_lines(manifest: Manifest) -> list[str]:
    """Return the lines of the whole summary."""
    lines = [*body_lines(manifest), *contact_table(manifest), *load_lines(manifest)]
    lines += [*wall_lines(manifest), *gone_lines(manifest), *warning_lines(manifest)]
    lines.append(energy_line(manifest))
    if manifest.status == "completed" and manifest.reason:
        lines.append(manifest.reason)
    return [*lines, speed_line(manifest)]


def _is_contact(stage: str) -> bool:
    return stage.startswith("contact") or "surfaces" in stage.removeprefix("load surfaces")


def contact_table(manifest: Manifest) -> list[str]:
    """Return the lines about contact: overlapped nodes, pairs, bytes, share of the step's time."""
    contact = manifest.contact
    if not contact.overlapped_nodes_max and not contact.touching_points_max:
        return []
    total = sum(manifest.stages.values()) or 1.0
    share = sum(ns for name, ns in manifest.stages.items() if _is_contact(name)) / total
    unit = "J/m" if manifest.case.get("grid", {}).get("dimension") == 2 else "J"
    pairs = sum(p.pairs for p in contact.pairs)
    where, crowd = [], ""
    if contact.overlapped_nodes_max:
        where.append(
            f"{contact.overlapped_nodes:,} overlapped nodes at the end, "
            f"{contact.overlapped_nodes_max:,} at most"
        )
        crowd = f", {contact.bodies_per_node_max} bodies at a node at most"
    if contact.touching_points_max:
        where.append(
            f"points of surfaces that touch: {contact.touching_points:,} at the end, "
            f"{contact.touching_points_max:,} at most"
        )
    bodies = f"{contact.bodies:,} {'body' if contact.bodies == 1 else 'bodies'}"
    lines = [
        f"contact: {bodies}, {', '.join(where)}, "
        f"{pairs:,} {'pair' if pairs == 1 else 'pairs'}{crowd}, "
        f"{contact.peak_bytes / 2**20:.2f} MiB, {share:.1%} of the step's time"
    ]
    if contact.unconverged_nodes:
        lines.append(
            f"warning: {contact.unconverged_nodes:,} contact solutions at nodes with several "
            "bodies stopped short of the tolerance; give smaller cells"
        )
    impulses = manifest.case.get("contact", {}).get("response") == "impulses"
    if impulses and contact.bodies_per_node_max > _CROWD and share > _MOST_SHARE:
        lines.append(
            f"warning: contact took {share:.0%} of the step's time: nodes with up to "
            f"{contact.bodies_per_node_max} bodies need hundreds of sweeps to find their impulses; "
            'give contact.response = "springs", or smaller cells (six to eight over a grain)'
        )
    for pair in contact.pairs[:_PAIRS_SHOWN]:
        if pair.first_time is None or pair.first_gap is None:
            continue
        many = f" ({pair.pairs:,} pairs)" if pair.pairs > 1 else ""
        lines.append(
            f"  {' - '.join(pair.bodies)}{many}: first contact at {pair.first_time:.6g} s, "
            f"surfaces {round(pair.first_gap / manifest.cell_size, 2) + 0.0:.2f} cells apart, "
            f"friction work {pair.friction_work:.4g} {unit}"
        )
    if len(contact.pairs) > _PAIRS_SHOWN:
        lines.append(f"  ... and {len(contact.pairs) - _PAIRS_SHOWN} more, in manifest.json")
    return lines


def body_lines(manifest: Manifest) -> list[str]:
    """Return a line for each body that moves freely: the speed of its mass centre and its energy.

    That is before and after, then the velocity; of grains the mean one. And what has eroded.
    """
    grid = manifest.case.get("grid", {})
    flat, walls = grid.get("dimension") == 2, grid.get("box", {}).get("walls", {})
    whole = not any(wall in ("slip", "fixed") for wall in walls.values())
    unit, axes = ("J/m", "xy") if flat else ("J", "xyz")
    given = manifest.case.get("body", {})
    lines = []
    for name, found in manifest.bodies.items():
        if given.get(name, {}).get("motion") is not None:
            continue
        if not found:
            continue
        velocities = [[found[k][f"velocity_{x}"] for x in axes] for k in ("initial", "final")]
        before, after = (math.hypot(*velocity) for velocity in velocities)
        energies = " -> ".join(f"{found[k]['kinetic']:.4g}" for k in ("initial", "final"))
        final = [v if abs(v) > _ROUNDING * after else 0.0 for v in velocities[1]]
        eroded = found["final"].get("eroded_mass", 0.0)
        lines.append(
            f"{name}: {before:.4g} -> {after:.4g} m/s ({_listed(final)})"
            f"{_spins(found, flat) if whole else ''}, kinetic energy {energies} {unit}"
            + (f", eroded {eroded:.4g} kg{unit[1:]}" if eroded else "")
        )
    if len(lines) > _BODIES_SHOWN:
        more = len(lines) - _BODIES_SHOWN
        lines = [*lines[:_BODIES_SHOWN], f"... and {more} more bodies, in manifest.json"]
    return lines


def _spins(found: dict[str, dict[str, float]], flat: bool) -> str:
    """Return how fast a body turns before and after, where that has a share of its energy.

    Halves and quarters before planes of symmetry are not asked: they do not turn as wholes.
    """
    axes = "z" if flat else "xyz"
    turns = any(
        sum(state.get(f"spin_{x}", 0.0) * state.get(f"angular_momentum_{x}", 0.0) for x in axes)
        > _TURNING * state.get("kinetic", 0.0)
        for state in (found["initial"], found["final"])
    )
    if not turns:
        return ""
    spins = [[found[k][f"spin_{x}"] for x in axes] for k in ("initial", "final")]
    least = _ROUNDING * max(math.hypot(*spin) for spin in spins)
    spins = [[s if abs(s) > least else 0.0 for s in spin] for spin in spins]
    if flat:
        return f", spin {spins[0][0]:.4g} -> {spins[1][0]:.4g} rad/s"
    before, after = (math.hypot(*spin) for spin in spins)
    return f", spin {before:.4g} -> {after:.4g} rad/s ({_listed(spins[1])})"


def energy_line(manifest: Manifest) -> str:
    """Return the line about the energy that numerics made or lost, a warning where it is large."""
    said, large = energies_made(manifest)
    return f"{'warning: ' if large else ''}energy: {said}"


def _restitution_takes(case: dict[str, Any]) -> bool:
    """Return whether a case asks for a restitution below 1, of all or of a pair."""
    contact = case.get("contact", {})
    return any(one.get("restitution", 1.0) < 1.0 for one in (contact, *contact.get("pair", [])))


def _nodes_in_bodies(case: dict[str, Any]) -> bool:
    """Return whether no body that deforms has its nodes in space, so that there is no transfer."""
    parts = [*case.get("body", {}).values(), *case.get("grains", {}).values()]
    strengths = {name: one.get("strength", {}) for name, one in case.get("material", {}).items()}
    return all(
        part.get("frame") == MATERIAL
        or part.get("motion") is not None
        or "rigid" in strengths.get(part.get("material"), {})
        for part in parts
    )


def energies_made(manifest: Manifest) -> tuple[str, bool]:
    """Return what is said of the energy that numerics made or lost, and whether that is much.

    It is a share of what came in (kinetic energy at the start, or the most that work from outside
    had brought), or of all energy at the start where most of that is internal, as in a compressed
    gas or an explosive.
    """
    energies = manifest.energies
    final, start = energies.get("final", {}), energies.get("initial", {})
    kinetic, internal = start.get("kinetic", 0.0), start.get("internal", 0.0)
    work = max(abs(final.get("external", 0.0)), energies.get("external_max", 0.0))
    whole, of_what = max(abs(kinetic), work), "what came in"
    if abs(internal) > whole:
        whole, of_what = kinetic + abs(internal), "the energy at the start"
    if not final or whole == 0.0:
        return "none came in", False
    # One by one: what one makes and the other takes is no less wrong.
    shares = {"numerical terms": final["numerical"] / whole, "contact": final["contact"] / whole}
    said = [
        f"{what} {'lost' if share >= 0.0 else 'made'} {abs(share):.2%}"
        for what, share in shares.items()
        if share != 0.0 or what != "contact"
    ]
    if "restitution" not in final and _restitution_takes(manifest.case):
        shares.pop("contact")  # In runs of older versions it has what restitution took.
    large = max(map(abs, shares.values())) > _NUMERICAL_WARNING
    line = f"{', '.join(said)} of {of_what}"
    if taken := final.get("restitution", 0.0):  # Manifests of older versions have none.
        line += f"; restitution has taken {taken / whole:.2%}"
    transfer = manifest.case.get("run", {}).get("transfer", "flip")
    if transfer != "flip" and not _nodes_in_bodies(manifest.case):
        line += "; what run.transfer takes is in it"
        if large and "aflip" in transfer:
            line += "; `mpm3dpp study CASE` tells whether smaller cells make it less"
    elif large:
        line += "; a smaller run.cfl or smaller cells may help"
    return line, large


def gone_lines(manifest: Manifest) -> list[str]:
    """Return a line each about particles that have eroded or left, with mass and energy."""
    lines = []
    per = "/m" if manifest.case.get("grid", {}).get("dimension") == 2 else ""
    words = {"eroded": manifest.eroded, "left": manifest.left}
    for word, gone in words.items():
        count, mass = int(gone["count"]), float(gone["mass"])
        if not count:
            continue
        energy = manifest.energies.get("final", {}).get(word, 0.0)
        lines.append(
            f"{word}: {count:,} of {manifest.particles:,} particles, {mass:.4g} kg{per} "
            f"({mass / (manifest.mass or 1.0):.2%} of the mass), {energy:.4g} J{per}"
        )
    return lines


def often(count: int) -> str:
    """Return a number of times in words: "once", "1,200 times"."""
    return "once" if count == 1 else f"{count:,} times"


def warning_lines(manifest: Manifest) -> list[str]:
    """Return a line for each thing that the run has warned of, with how often it was seen.

    Of each kind the first three; the manifest has all, and the notes, which are no warnings.
    """
    lines, told = [], Counter[str]()
    for w in manifest.warnings:
        told[w.kind] += w.is_error
        if w.is_error and told[w.kind] <= _OF_A_KIND:
            lines.append(f"warning: {w.message}; seen {often(w.count)}")
    for kind, count in told.items():
        if count > _OF_A_KIND:
            lines.append(f"warning: {count - _OF_A_KIND:,} more of {kind}, in manifest.json")
    return lines


def load_lines(manifest: Manifest) -> list[str]:
    """Return a line for each load on a surface: its impulse and, at the end, its force and area."""
    flat = manifest.case.get("grid", {}).get("dimension") == 2
    per, square = ("/m", "m^2 per metre") if flat else ("", "m^2")
    numbers = slice(0, 2 if flat else 3)
    return [
        f"load {name}: impulse [{_listed(load.impulse[numbers])}] N s{per}, at the end force "
        f"[{_listed(load.force[numbers])}] N{per}"
        + (f" on {load.area:.4g} {square}" if load.area > 0.0 else "")
        for name, load in manifest.loads.items()
    ]


def wall_lines(manifest: Manifest) -> list[str]:
    """Return a line for each face of the box that bodies have pushed: force, pressure, impulse.

    There is no pressure of faces that are contact, which bodies touch here and there.
    """
    grid = manifest.case.get("grid", {})
    flat, words = grid.get("dimension") == 2, grid.get("box", {}).get("walls", {})
    per, numbers = ("/m", slice(0, 2)) if flat else ("", slice(0, 3))
    return [
        f"wall {name}: at the end force [{_listed(wall.force[numbers])}] N{per}"
        + ("" if words.get(name) == CONTACT else f", {wall.pressure:.4g} Pa over the whole face")
        + f"; impulse [{_listed(wall.impulse[numbers])}] N s{per}"
        for name, wall in manifest.walls.items()
        if any(wall.impulse)
    ]


def _listed(values: list[float]) -> str:
    return ", ".join(f"{value:.4g}" for value in values)


def speed_line(manifest: Manifest) -> str:
    """Return the line about speed and memory; all parts of a run that went on count together."""
    used = sum(manifest.bytes.values()) / max(1, manifest.particles)
    threads = "1 thread" if manifest.threads == 1 else f"{manifest.threads} threads"
    on = f"on {threads if manifest.device == 'cpu' else manifest.device}"
    ranks = manifest.ranks
    if ranks["ranks"] > 1:
        on += f" of each of {ranks['ranks']} ranks ({ranks['mpi']}), "
        on += f"{ranks['share']:.0%} of the time in exchange, imbalance {ranks['imbalance']:.2f}"
    if manifest.resumed_step and manifest.device != "cpu":
        on += f" (from step {manifest.resumed_step:,} on)"
    elif manifest.resumed_step:
        on = f"in all parts of the run (from step {manifest.resumed_step:,} {on})"
    return (
        f"{manifest.status}: {manifest.steps:,} steps of {manifest.particles:,} particles in "
        f"{manifest.wall_time:.1f} s, {manifest.ns_per_particle_step:.1f} ns per particle-step "
        f"{on}, memory {manifest.peak_memory_bytes / 2**20:,.0f} MiB, of which the core "
        f"{sum(manifest.bytes.values()) / 2**20:,.1f} MiB ({used:.0f} bytes per particle)"
    )

# SPDX-License-Identifier: BSD-3-Clause
"""What the manifest of a run tells of its contacts, loads and warnings."""

from __future__ import annotations

import dataclasses
from collections.abc import Sequence
from typing import Annotated, Any

from pydantic import Field, FiniteFloat

from .forms import Count, Number
from .part_cells import wall_pressure

Pair = Annotated[list[str], Field(min_length=2, max_length=2)]
Vector = Annotated[list[Number], Field(min_length=3, max_length=3)]


@dataclasses.dataclass(kw_only=True)
class PairRecord:
    """Contact of two bodies, or of the grains of an entry with each other or with others.

    Attributes:
        bodies: their names; an entry of `grains` is one name, twice for grains among themselves.
        pairs: how many pairs of single bodies have touched.
        first_time: time of the first contact force [s]; None when they never touched.
        first_gap: distance of the two surfaces at that time [m]; None when never.
        first_normal: unit vector from the first to the second along which that contact acted, three
            numbers; None when never.
        first_node: the node of the grid at which it acted [m], three numbers; None when never.
        impulse: impulse on the first body until the end [N s] (per metre in 2D); 0 for grains
            among themselves.
        friction_work: energy lost by friction [J] (per metre in 2D).
    """

    bodies: Pair
    pairs: Count
    first_time: FiniteFloat | None
    first_gap: FiniteFloat | None = None  # Earlier versions have recorded less.
    first_normal: Vector | None = None
    first_node: Vector | None = None
    impulse: list[Number]
    friction_work: Number


@dataclasses.dataclass
class LoadRecord:
    """A load on a surface over the whole run.

    Attributes:
        impulse: that it has given its body until the end [N s] (per metre in 2D).
        force: of the last step [N] (per metre in 2D).
        area: on which it acts at the end [m^2; in 2D m times 1 m].
    """

    impulse: list[Number]
    force: list[Number]
    area: Number


@dataclasses.dataclass
class WallRecord:
    """What bodies have done to a face of the box.

    Attributes:
        force: of the last step on the face [N] (per metre in 2D).
        impulse: of it so far, that of settling too [N s] (per metre in 2D).
        pressure: the force out of the box over the area of the whole face [Pa].
        area: of the face [m^2; in 2D m times 1 m].
    """

    force: list[Number]
    impulse: list[Number]
    pressure: Number
    area: Number


@dataclasses.dataclass
class WarningRecord:
    """Something that a run went on with but warned of, once for each kind and body.

    Attributes:
        kind: "time step", "energy of a step", "load", "outside walls", "volume", "left box",
            "crowded node", "deep surface", ...
        body, particle: whom it first was about; the particle in the order of filling.
        step, time, position: when [s] and where [m] that was.
        share: of the particles of the body, or of all grains of its entry, the largest at a look;
            0 where it is about one particle.
        count: steps at which it was so; with a share looks, of which there is one in 64 steps.
        is_error: false for what may be meant: particles leave through an open face of the box.
        message: the sentence that was told.
    """

    kind: str
    body: str
    particle: int
    step: int
    time: Number
    position: list[Number]
    share: Number
    count: Count
    is_error: bool
    message: str


@dataclasses.dataclass
class ContactRecord:
    """Contact of the whole run: bodies, overlapped nodes at the end and at most, pairs, bytes.

    `touching_points` are those of surfaces that touch without nodes.

    `unconverged_nodes` counts the solutions at nodes with several bodies that stopped short of
    the tolerance; 0 is usual.
    """

    bodies: Count = 0
    overlapped_nodes: Count = 0
    overlapped_nodes_max: Count = 0
    touching_points: Count = 0
    touching_points_max: Count = 0
    bodies_per_node_max: Count = 0
    peak_bytes: Count = 0
    unconverged_nodes: Count = 0
    pairs: list[PairRecord] = dataclasses.field(default_factory=list)


def contact_of(simulation: Any, parts: Sequence[str]) -> ContactRecord:
    """Return what there was of contact; `parts` names each body, grains alike."""
    summary = simulation.contact_summary()
    pairs = [
        PairRecord(
            bodies=[parts[b] for b in pair.bodies],
            pairs=int(pair.pairs),
            first_time=float(pair.first_time),
            first_gap=float(pair.first_gap),
            first_normal=list(pair.first_normal) if pair.first_step >= 0 else None,
            first_node=list(pair.first_node) if pair.first_step >= 0 else None,
            impulse=[float(v) for v in pair.impulse],
            friction_work=float(pair.friction_work),
        )
        for pair in simulation.contact_groups()
    ]
    return ContactRecord(
        bodies=len(parts),
        overlapped_nodes=int(summary.get("overlapped_nodes", 0)),
        overlapped_nodes_max=int(summary.get("overlapped_nodes_max", 0)),
        touching_points=int(summary.get("touching_points", 0)),
        touching_points_max=int(summary.get("touching_points_max", 0)),
        bodies_per_node_max=int(summary.get("bodies_per_node_max", 0)),
        peak_bytes=int(summary.get("bytes", 0)),
        unconverged_nodes=int(summary.get("unconverged_nodes", 0)),
        pairs=pairs,
    )


def loads_of(simulation: Any) -> dict[str, LoadRecord]:
    """Return what loads have done, by name."""
    return {
        load.name: LoadRecord(list(load.impulse), list(load.force), float(load.area))
        for load in simulation.loads()
    }


def walls_of(simulation: Any) -> dict[str, WallRecord]:
    """Return what bodies have done to the faces of the box that are not free, by name."""
    return {
        face.name: WallRecord(
            list(face.force), list(face.impulse), wall_pressure(face), float(face.area)
        )
        for face in simulation.walls()
    }


def warnings_of(simulation: Any, bodies: Sequence[str]) -> list[WarningRecord]:
    """Return what the core has warned of."""
    return [
        WarningRecord(
            kind=w.kind,
            body=bodies[w.body],
            particle=int(w.particle),
            step=int(w.step),
            time=float(w.time),
            position=[float(x) for x in w.position],
            share=float(w.share),
            count=int(w.count),
            is_error=bool(w.is_error),
            message=w.message,
        )
        for w in simulation.warnings()
    ]


def limiter_of(simulation: Any, bodies: Sequence[str]) -> dict[str, Any] | None:
    """Return who limits the time step; None if nobody does."""
    who = simulation.limiter()
    if who is None or not 0 <= int(who.body) < len(bodies):
        return None
    return {
        "body": bodies[int(who.body)],
        "particle": int(who.particle),
        "sound_speed": float(who.sound_speed),
        "speed": float(who.speed),
    }

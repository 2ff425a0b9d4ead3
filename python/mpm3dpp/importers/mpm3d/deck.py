# SPDX-License-Identifier: BSD-3-Clause
"""What an `.mpm` file says, in its own units and numbers."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .lexer import Source

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Record:
    """A named list of numbers and its line: a material, an equation of state.

    Attributes:
        kind: its type, for example "sjc" or "3".
        values: by name.
        line: of its first word.
    """

    kind: str
    values: dict[str, float]
    line: int


@dataclass(frozen=True)
class Part:
    """A `part` statement: one body.

    Attributes:
        kind: point, block, sphere, blod or cicl.
        component: grid for contact.
        material: its number.
        line: of the statement.
        numbers: density, dp and what the kind needs, by name; none for points.
        masses, points: of the particles of a `part point`.
    """

    kind: str
    component: int
    material: int
    line: int
    numbers: dict[str, float] = field(default_factory=dict)
    masses: Array | None = None
    points: Array | None = None


@dataclass(frozen=True)
class Wave:
    """The x component of `velo vsin`, v0 sin(pi y / 6), with the 6 in the file's unit of length."""

    v0: float


@dataclass
class Deck:
    """The statements of a file, each with its default.

    Attributes:
        source: the words, and the notes so far.
        title: of `mpm3`.
        lines: keyword to the line of its last statement.
        components, bodies, particles, material_count: nbco, nbbo, nbmp, nmat.
        bounds: of the grid by axis.
        cell: dcel.
        factor, end, interval: dtsc, endt, outt.
        faces: codes of fixe.
        schemes: what musl, usf, usl were set to.
        bulk: quadratic and linear factor.
        gimp: whether it was asked for.
        contact: friction and whose normal; None without.
        separate: whether each component has a grid of its own, as with any `cont`.
        materials, eos: by number.
        detonations: points, with their lines.
        parts: the bodies, in their order.
        gravity, force, velocity: by number of the body, with the line; force on each particle.
        particle_force: by number of the particle, with the line.
        damping, rise: Damp and QuLo; 0 without.
        variables: of outr, curv and curx, with their lines.
    """

    source: Source
    title: str = ""
    lines: dict[str, int] = field(default_factory=dict)
    components: int = 1
    bodies: int = 0
    particles: int = 0
    material_count: int = 0
    bounds: dict[int, tuple[float, float]] = field(default_factory=dict)
    cell: float = 0.0
    factor: float = 0.9
    end: float = 0.0
    interval: float = 0.0
    faces: tuple[int, ...] = (0,) * 6
    schemes: dict[str, bool] = field(default_factory=dict)
    bulk: tuple[float, float] = (1.5, 0.06)
    gimp: bool = False
    contact: tuple[float, int] | None = None
    separate: bool = False
    materials: dict[int, Record] = field(default_factory=dict)
    eos: dict[int, Record] = field(default_factory=dict)
    detonations: list[tuple[list[float], int]] = field(default_factory=list)
    parts: list[Part] = field(default_factory=list)
    gravity: dict[int, tuple[list[float], int]] = field(default_factory=dict)
    force: dict[int, tuple[list[float], int]] = field(default_factory=dict)
    velocity: dict[int, tuple[Sequence[float | Wave], int]] = field(default_factory=dict)
    particle_force: dict[int, tuple[list[float], int]] = field(default_factory=dict)
    damping: float = 0.0
    rise: float = 0.0
    variables: list[tuple[str, int]] = field(default_factory=list)

    def error(self, keyword: str, rule: str, remedy: str = "", line: int | None = None) -> Any:
        """Return the mistake that a rule is broken by the last statement of a keyword."""
        return self.source.error(rule, remedy, line or self.lines.get(keyword, 1), keyword)

    def refuse(self, keyword: str, rule: str, remedy: str, line: int) -> None:
        """Add the mistake that a rule is broken, and let the reading go on."""
        self.source.problems.add(keyword, rule, remedy, line)

    def note(self, sentence: str) -> None:
        """Add a sentence about what is not the same as in MPM3D-F90; each once."""
        if sentence not in self.source.notes:
            self.source.notes.append(sentence)

# SPDX-License-Identifier: BSD-3-Clause
"""What the paper says of its examples: Ma, Zhang & Huang, CMES 55 (1), 2010, section 4.

Its figures are described from its text and captions; they are not shown, for they are not ours.
"""

from __future__ import annotations

from dataclasses import dataclass

MACHINE = "Intel Q6600 at 2.4 GHz, 4 GB of memory, Microsoft Windows XP"  # Section 4.


@dataclass(frozen=True)
class Program:
    """A program's columns of a table: without contact and with it.

    Attributes:
        seconds: average time of a step [s].
        memory: most memory, in the paper's M, which we take as 2^20 bytes.
    """

    seconds: tuple[float, float]
    memory: tuple[float, float]


@dataclass(frozen=True)
class Table:
    """A table of the paper.

    Attributes:
        number, title: as there.
        particles, cells: counts.
        programs: by name, ours last.
        used: most cells in use, as a share of all; None where the paper does not say.
        speed: residual speed of the projectile [m/s], computed and measured; None without one.
        ratios: of the first program over the last, as printed there: of times and of memory, each
            without contact and with it; None without a comparison.
        contacts: how many contact surfaces there are; None where the paper does not say.
    """

    number: int
    title: str
    particles: int
    cells: int
    programs: dict[str, Program]
    used: float | None = None
    speed: tuple[float, float] | None = None
    ratios: tuple[tuple[float, float], tuple[float, float]] | None = None
    contacts: int | None = None


PENETRATION = Table(
    1,
    "Computational performance and memory consumed in penetration simulation",
    particles=200_864,
    cells=170_688,
    programs={
        "MPM3D": Program((0.5455, 0.8146), (73.18, 109.36)),
        "MPM3Dpp": Program((0.4064, 0.4313), (54.25, 55.02)),
    },
    used=0.1313,  # Section 4.1, of figure 10.
    speed=(441.0, 455.0),  # Section 4.1; the experiment: Piekutowski et al. (1996).
    ratios=((1.342, 1.888), (1.349, 1.988)),
)

SPHERES = Table(
    2,
    "Computational performance and memory consumed in the simulation of spheres under pressure",
    particles=652_000,
    cells=137_500,
    programs={"MPM3Dpp": Program((1.4263, 2.2187), (288.60, 305.19))},
    contacts=810,  # Section 4.2.
)


RING_PARTICLES = 29_760  # Section 4.4, which leaves open whether that is each ring or both.


@dataclass(frozen=True)
class Figure:
    """A figure of the paper.

    Attributes:
        number, title: as there.
        shows: a sentence about it.
        differs: a sentence about what is not the same in our picture.
    """

    number: int
    title: str
    shows: str
    differs: str


FIGURES = {
    figure.number: figure
    for figure in (
        Figure(
            9,
            "Configuration after penetration",
            "The paper shows the plate with its hole and the projectile behind it; the residual "
            "speed is 441 m/s there, 455 m/s in the experiment.",
            "Ours is the half that is computed, coloured by the array named beside it; the paper "
            "names none.",
        ),
        Figure(
            10,
            "Time history of percentage of used cells",
            "The paper shows the share of cells in use over time, with a maximum of 13.13 %.",
            "Ours has the cells that hold a particle, and those of whole tiles of 4 x 4 x 4 cells, "
            "which is what the program keeps; the boxes are not of the same size.",
        ),
        Figure(
            12,
            "1000 spheres under pressure simulated with contact algorithm",
            "The paper shows the stress wave as it passes through the spheres, is reflected and "
            "dies away.",
            "Load, material and times are ours, since the paper does not give them.",
        ),
        Figure(
            13,
            "Simulation of shakes of grains",
            "The paper shows how three big grains come up through 207 small ones that are shaken.",
            "Sizes, materials and the shaking are ours, since the paper gives none.",
        ),
        Figure(
            14,
            "Collision simulation of elastic rings without improved contact detection method",
            "The paper shows that the rings act on each other while a gap is still between them.",
            "Ours is the moment of the first contact force, with the distance of the two surfaces.",
        ),
        Figure(
            15,
            "Collision simulation of elastic rings with improved contact detection method",
            "The paper shows that with the distance test the rings meet without a gap.",
            "Ours is the moment of the first contact force, with the distance of the two surfaces.",
        ),
    )
}

NOT_GIVEN = (
    "all: the number of threads, and whether a compared run without contact has one velocity field "
    "for all bodies or bodies that do not see each other.",
    "4.1: the constants of the materials, the size of the plate, the erosion or failure of the "
    "plate, the end time and the time step.",
    "4.2: the size of the spheres and the slab, the material's constants, the load, friction, the "
    "boundary conditions of the container and the end time.",
    "4.3: the size of the grains and the container, the materials, friction, the frequency and "
    "amplitude of the periodic force, the cells and the end time (it gives near 1,700,000 steps).",
    "4.4: the material of the rings, the cells and the time step.",
)

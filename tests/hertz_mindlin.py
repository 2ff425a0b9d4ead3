# SPDX-License-Identifier: BSD-3-Clause
"""An elastic ball that hits a plane aslant, sticking and slipping, without the program.

The method of dimensionality reduction: a row of springs that do not know of each other, E* dx
along the normal and G* dx along the surface, pressed by a parabola x^2 / R, has the forces of
Hertz and of Mindlin & Deresiewicz, each spring sticking or slipping by Coulomb's law (Popov & Hess
2015, *Method of Dimensionality Reduction in Contact Mechanics and Friction*; of hits Lyashenko &
Popov 2015). To that comes what a ball of a finite radius yields besides (`finite_ball`).
"""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from scipy.optimize import brentq

from finite_ball import own_part

SPRINGS = 400
"""On half of the row, which is symmetric: each stands for two."""


def kappa(nu: float) -> float:
    """G* / E*, of two bodies of the same matter or against a stiff plane."""
    return 2 * (1 - nu) / (2 - nu)


def chi(nu: float) -> float:
    """Maw, Barber & Fawcett's number of a ball: (1 - nu) (1 + 5/2) / (2 - nu)."""
    return 3.5 * (1 - nu) / (2 - nu)


@dataclass
class Springs:
    """The contact of a radius 1 with E* = 1 and a friction of 1, sticking and slipping."""

    G: float
    reach: float  # the largest half-width that is met
    borne: np.ndarray = field(default_factory=lambda: np.zeros(SPRINGS))

    def __post_init__(self) -> None:
        self.width = self.reach / SPRINGS
        self.x = (np.arange(SPRINGS) + 0.5) * self.width

    def press(self, deep: float) -> tuple[np.ndarray, float]:
        """The most that each may bear along the surface, and the force along the normal."""
        pressed = np.maximum(deep - self.x**2, 0.0)
        return pressed, 2 * self.width * pressed.sum()

    def slide(self, along: float, most: np.ndarray) -> tuple[np.ndarray, float]:
        """What they bear after going this far along the surface, and their sum."""
        borne = np.clip(self.borne + self.G * along, -most, most)
        return borne, 2 * self.width * borne.sum()


@dataclass
class Ball:
    """What a ball yields besides the half-space, in units of E* = R = 1."""

    normal: float = 0.0
    circles: tuple[float, ...] = (0.0,)
    along: tuple[float, ...] = (0.0,)
    turned: bool = False  # the arm of friction is R less the depth

    @classmethod
    def finite(cls, circle: float, nu: float) -> Ball:
        """A ball that is pressed up to this circle."""
        circles = tuple(share * circle for share in (0.4, 0.7, 1.0))
        E = 1 - nu**2  # where E* = 1
        along = tuple(own_part(c, nu, along=True) / E for c in circles)
        return cls(own_part(circle, nu, along=False) / E, circles, along, True)


def oblique_hit(
    psi: float, nu: float, ball: Ball | None = None, circle: float = 0.1, steps: int = 2000
) -> float:
    """The impulse along the surface over friction times the normal one.

    Args:
        psi: 2 (1 - nu) / (friction (2 - nu)) times the tangent of the angle to the normal, as Maw,
            Barber & Fawcett (1976) have it.
        nu: Poisson's ratio.
        ball: what it yields besides; none for the half-space, where psi and nu are all that counts.
        circle: largest radius of contact by Hertz, over that of the ball.
        steps: in the duration of Hertz's hit.
    """
    ball = ball or Ball()
    speed = first = np.sqrt(16 / 15 * circle**5)  # of a mass 1
    dt = 2.943 * circle**2 / speed / steps
    springs = Springs(kappa(nu), 1.1 * circle)
    slip, deep, forces, impulse = (
        psi / kappa(nu) * first,
        0.5 * dt * speed,
        np.zeros(2),
        np.zeros(2),
    )
    ahead = 0.5 * dt * slip
    while deep > 0.0:
        own = ball.normal * 4 / 3
        local = brentq(lambda d, own=own, deep=deep: d + own * d**1.5 - deep, 0.0, 2 * deep)
        most, forces[0] = springs.press(local)
        yields = np.interp(np.sqrt(local), ball.circles, ball.along)
        borne, along = springs.slide(ahead, most)
        for _ in range(4):
            borne, along = springs.slide(ahead - yields * (along - forces[1]), most)
        springs.borne, forces[1] = borne, along
        impulse += dt * forces
        arm = 1.0 - deep if ball.turned else 1.0
        speed -= dt * forces[0]
        slip -= (1 + 2.5 * arm**2) * dt * forces[1]
        deep += dt * speed
        ahead = dt * slip
    return float(impulse[1] / impulse[0])

# SPDX-License-Identifier: BSD-3-Clause
"""Cases whose exact motion is known: forces made for it, and a ring that flies apart."""

from __future__ import annotations

import math

import numpy as np

from mpm3dpp import Case

from ..scene import Array

HEAD = """
[grid]
dimension = 2
cell_size = {cell}
basis = "gimp"
{box}
[run]
end_time = {end}
energy_growth_limit = 100.0
[material.solid]
density = {density}
strength = {{ {strength} }}
[body.body]
material = "solid"
shape = {{ {shape} }}
velocity = [{{ expression = "{vx}" }}, {{ expression = "{vy}" }}]
"""
FORCE = 'body_force = [{{ expression = "{bx}" }}, {{ expression = "{by}" }}]\n'


def vortex(cell: float, turn: float = 1.0) -> Case:
    """A ring turned by alpha(R, t) = turn sin(pi t) h(R), h = 1 - 8 s^2 + 16 s^4, s = 2 (R - 1).

    Kamojjala, Brannon, Sadeghirad & Guilkey (2015), section 5. Radii stay, and shells of one radius
    turn as rigid: in polar axes tau = G R alpha' and s_tt = G (R alpha')^2, so that
    b_r = -R alpha_tt^2 + G R alpha'^2 / rho, b_t = R alpha_t - G (3 alpha' + R alpha'') / rho
    with alpha_tt and alpha_t the first and second derivative by time.
    """
    E, nu, rho = 1000.0, 0.3, 1000.0
    G, K = E / (2 + 2 * nu), E / (3 - 6 * nu)
    r = "sqrt(X^2 + Y^2)"
    s = f"(2*({r} - 1))"
    shape, first = f"(1 - 8*{s}^2 + 16*{s}^4)", f"(2*(-16*{s} + 64*{s}^3))"
    second = f"(4*(-16 + 192*{s}^2))"
    sine, cosine = f"({turn}*sin(pi*t))", f"({turn * math.pi!r}*cos(pi*t))"
    outward = f"(-{r}*({cosine}*{shape})^2 + {G / rho!r}*{r}*({sine}*{first})^2)"
    inertia = f"(-{math.pi**2!r}*{r}*{sine}*{shape})"
    around = f"({inertia} - {G / rho!r}*{sine}*(3*{first} + {r}*{second}))"
    start = f"{turn * math.pi!r}*{shape}"
    # The particle's own axes: its radius has turned by alpha.
    along = f"((X*cos({sine}*{shape}) - Y*sin({sine}*{shape}))/{r})"
    across = f"((X*sin({sine}*{shape}) + Y*cos({sine}*{shape}))/{r})"
    text = HEAD.format(
        cell=cell, box="", end=1.0, density=rho, strength=f"neo_hookean = {{ K = {K}, G = {G} }}",
        shape="ring = { centre = [0, 0], inner_radius = 0.75, outer_radius = 1.25 }",
        vx=f"-y*{start}".replace("X", "x").replace("Y", "y"),
        vy=f"x*{start}".replace("X", "x").replace("Y", "y"),
    ) + FORCE.format(
        bx=f"{outward}*{along} - {around}*{across}", by=f"{outward}*{across} + {around}*{along}"
    )  # fmt: skip
    return Case.from_text(text)


K_, G_, RHO = 2e6, 1e6, 1000.0
SPEED = math.sqrt((K_ + 4 / 3 * G_) / RHO)
END = 0.8  # [1 / (pi SPEED)] of half a period


def manufactured(cells: int, amplitude: float) -> Case:
    """A square moves by u_i = A sin(pi X_i) sin(c pi t + phi_i), phi = 0, pi: to 0.8 of the period.

    P = lambda ln J F^-T + G (F - F^-T) with a diagonal F (Bonet & Wood 2008, eq. 6.27), so that
    rho_0 b_i = rho_0 u_i'' - dP_ii/dX_i (Wallstedt & Guilkey 2008, section 6, with this material).
    """
    lame = K_ - 2 / 3 * G_
    turn = {"X": f"sin({SPEED!r}*pi*t)", "Y": f"(-sin({SPEED!r}*pi*t))"}
    stretch = {a: f"(1 + {amplitude}*pi*cos(pi*{a})*{turn[a]})" for a in "XY"}
    volume = f"log({stretch['X']} * {stretch['Y']})"
    force = {}
    for a, f in stretch.items():
        u = f"{amplitude} * pi^2 * sin(pi*{a})*{turn[a]}"
        stiffness = f"({lame!r} * (1 - {volume})/{f}^2 + {G_} * (1 + 1/{f}^2)) / {RHO}"
        force[a] = f"({stiffness} - {SPEED!r}^2) * {u}"
    rate = f"{amplitude * SPEED!r} * pi"
    text = HEAD.format(
        cell=1 / cells, box='box = { lower = [0, 0], upper = [1, 1], walls = "slip" }',
        end=END / SPEED, density=RHO, strength=f"neo_hookean = {{ K = {K_}, G = {G_} }}",
        shape="box = { lower = [0, 0], upper = [1, 1] }",
        vx=f"{rate} * sin(pi*x)", vy=f"-{rate} * sin(pi*y)",
    )  # fmt: skip
    return Case.from_text(text + FORCE.format(bx=force["X"], by=force["Y"]))


def manufactured_place(start: Array, amplitude: float) -> Array:
    """Where the particles of `manufactured` are at its end [m]."""
    moved = amplitude * np.sin(np.pi * start) * math.sin(END * math.pi)
    return start + moved * np.array([1.0, -1.0])


YIELD, FLYING, DENSITY = 300e6, 133.33, 8930.0
# rho v^2 / 2 is the work of the hoop stress 2 Y / sqrt(3) of plane strain on ln(r / r_0); without
# elasticity, thin. What is elastic gives back (Y / E of some thousandth).
EXPANDED = math.exp(DENSITY * FLYING**2 / 2 / (2 * YIELD / math.sqrt(3)))


def expanding() -> Case:
    """A ring of mean radius 20 mm, 1 mm thick, of copper that yields at 300 MPa, in 4 cells."""
    text = HEAD.format(
        cell=0.25e-3, box="", end=100e-6, density=DENSITY,
        strength='j2 = { E = "117 GPa", nu = 0.35, Y0 = "300 MPa", H = 0 }',
        shape='ring = { centre = [0, 0], inner_radius = "19.5 mm", outer_radius = "20.5 mm" }',
        vx=f"{FLYING} * x / sqrt(x^2 + y^2)", vy=f"{FLYING} * y / sqrt(x^2 + y^2)",
    )  # fmt: skip
    return Case.from_text(text)

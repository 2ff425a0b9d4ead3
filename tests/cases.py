# SPDX-License-Identifier: BSD-3-Clause
"""Small cases for the tests: blocks alone, three that meet at a node, nearly all there can be."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from mpm3dpp import Body, Case, Contact, Grid, Material, Run, _core, load_case, shapes

CELL = 2.0**-7
"""Cell size [m]: a power of two, so that cells add up without rounding."""

SCHEMES = ("usf", "usl", "musl")
BASES = tuple(_core.bases)
_QUICK = (("usf", "quadratic_bspline"), ("musl", "gimp"), ("usl", "linear"))
each_numerics = pytest.mark.parametrize(
    ("scheme", "basis"),
    [
        pytest.param(scheme, basis, marks=() if (scheme, basis) in _QUICK else pytest.mark.slow)
        for scheme in SCHEMES
        for basis in BASES
    ],
)
"""Every scheme with every basis, for what takes seconds; each of them once, and the default, else
is slow: the unit test `stages` has every pair against the reference step."""
DENSITY, YOUNG = 1000.0, 1e6


def materials() -> dict[str, Material]:
    """Return two soft materials, waves of about 40 m/s."""
    return {
        "solid": Material(density=DENSITY, strength={"elastic": {"E": YOUNG, "nu": 0.3}}),
        "rubber": Material(density=800.0, strength={"neo_hookean": {"K": 1e6, "G": 4e5}}),
    }


def block(lower: tuple[int, ...], cells: tuple[int, ...], **body: Any) -> Body:
    """Return a block of whole cells, given in cells from the origin."""
    corners = np.array(lower), np.array(lower) + np.array(cells)
    low, high = (tuple(CELL * c for c in corner.tolist()) for corner in corners)
    return Body(shape=shapes.Box(lower=low, upper=high), **body)


def three_blocks(
    dimension: int,
    scheme: str = "musl",
    shift: tuple[int, int, int] = (0, 0, 0),
    order: tuple[str, ...] = ("bottom", "left", "right"),
    grid: dict[str, Any] | None = None,
    run: dict[str, Any] | None = None,
    friction: float = 0.3,
    apart: int = 0,
) -> Case:
    """Return a case of two blocks that slide together and fall on a third: three bodies at a node.

    All lie between 1 m and 2 m along each axis, where numbers are equally fine, so that a shift
    by whole cells there loses no bit.

    Args:
        dimension: 2 or 3.
        scheme: usf, usl or musl.
        shift: of all blocks, in cells.
        order: in which the bodies stand in the case.
        grid, run: more keys of these tables.
        friction: of all pairs.
        apart: cells between the upper blocks and the lower one at the start.
    """
    d = dimension
    at = np.array((140, 140, 140)) + np.array(shift)
    deep = 5 if d == 2 else 3
    above = deep + apart

    def part(lower: tuple[int, ...], cells: tuple[int, ...], v: tuple[float, ...], m: str) -> Body:
        low = tuple((at + np.array(lower))[:d].tolist())
        velocity = v[:d]
        return block(low, cells[:d], velocity=velocity, material=m)

    bodies = {
        "bottom": part((0, 0, 0), (17, deep, 6), (0.5, 6.0, 2.0), "solid"),
        "left": part((0, above, 0), (8, 5, 6), (4.0, -3.0, 1.0), "rubber"),
        "right": part((9, above, 0), (8, 5, 6), (-3.0, -2.0, -1.0), "solid"),
    }
    return Case(
        grid=Grid(dimension=d, cell_size=CELL, **(grid or {})),
        run=Run(**{"end_time": 1.0, "scheme": scheme, "cfl": 0.3} | (run or {})),
        contact=Contact(friction=friction),
        material=materials(),
        body={name: bodies[name] for name in order},
    )


def in_free_fall(
    dimension: int, scheme: str, basis: str, contact: Contact, bodies: dict[str, Body], **run: Any
) -> Case:
    """Return a case of bodies under gravity, without a box."""
    return Case(
        grid=Grid(dimension=dimension, cell_size=CELL, basis=basis),
        run=Run(
            end_time=1.0,
            scheme=scheme,
            cfl=0.2,
            gravity=(0.0, 0.0, -2.0)[3 - dimension :],
            energy_growth_limit=1e9,
            **run,
        ),
        contact=contact,
        material=materials(),
        body=bodies,
    )


def cut_block(dimension: int) -> tuple[dict[str, Body], dict[str, Body]]:
    """Return a block that is pulled apart and bent, and the same cut into three."""
    d = dimension
    # By formulas: the gradient of velocities that are set one by one is that of a part alone.
    field = [{"expression": e} for e in ("0.1 * x", f"0.1 * y^2 / {CELL}", "0.1 * z")][:d]
    common: dict[str, Any] = {"material": "solid", "velocity": field}
    cuts = {"a": (3, 2), "b": (5, 1), "c": (6, 3)}
    parts = {
        name: block((at, *(3,) * (d - 1)), (wide, 4, 4)[:d], **common)
        for name, (at, wide) in cuts.items()
    }
    return {"all": block((3,) * d, (6, 4, 4)[:d], **common)}, parts


def one_block(dimension: int, grid: dict[str, Any], run: dict[str, Any], **body: Any) -> Case:
    """Return a case of one elastic block, 4 cells wide, from cell 3 on."""
    cells = (4,) * dimension
    return Case(
        grid=Grid(dimension=dimension, cell_size=CELL, **grid),
        run=Run(**{"end_time": 1.0} | run),
        material={"solid": materials()["solid"]},
        body={"block": block((3,) * dimension, cells, material="solid", **body)},
    )


def box(dimension: int, cells: int, walls: Any) -> dict[str, Any]:
    """Return the keys of `Grid` for a box of so many cells along each axis."""
    upper = (cells * CELL,) * dimension
    return {"box": {"lower": (0.0,) * dimension, "upper": upper, "walls": walls}}


# Nearly all that a step can hold: walls that mirror and that absorb, gravity, contact with
# friction, a load, a body force, viscosity, damping, a rigid body that is free and one that is led.
EVERYTHING = """
[grid]
dimension = {dimension}
cell_size = "10 mm"
basis = "{basis}"
box = {{ lower = {zero}, upper = {box}, walls = {{ y_min = "{floor}", x_min = "{left}" }} }}
[run]
scheme = "{scheme}"
end_time = "1 s"
cfl = 0.3
energy_growth_limit = 1e9
gravity = {gravity}
viscosity = {{}}
transfer = {{ flip = 1.0, pic_rate = "5 1/s" }}
[contact]
friction = 0.3
[material.soft]
density = 1000.0
strength = {{ elastic = {{ E = "1 MPa", nu = 0.3 }} }}
damping = {{ stiffness = "20 us" }}
[material.metal]
density = 2000.0
strength = {{ j2 = {{ E = "4 MPa", nu = 0.3, Y0 = "2 kPa" }} }}
[material.stone]
density = 3000.0
strength = {{ rigid = {{}} }}
[body.bed]
material = "soft"
particles_per_cell = {per_axis}
damping = {{ mass = {{ ramp = {{ from = 0, to = 20, end = "10 ms" }} }}, local = 0.2 }}
shape = {{ box = {{ lower = {zero}, upper = {bed} }} }}
[body.block]
material = "metal"
velocity = {falling}
body_force = {forcing}
damping = {{ mass = 3 }}
shape = {{ box = {{ lower = {low_block}, upper = {high_block} }} }}
[body.ball]
material = "stone"
velocity = {falling}
shape = {{ {ball} = {{ centre = {centre}, radius = "25 mm" }} }}
[body.press]
material = "stone"
motion = {{ velocity = {pressing} }}
shape = {{ box = {{ lower = {low_press}, upper = {high_press} }} }}
[load.side]
body = "bed"
side = "x_max"
pressure = "1 kPa"
"""


WAVING = '{ expression = "9 * sin(80 * x + 50 * Y - 300 * t)" }'


def everything(tmp_path: Path, dimension: int, scheme: str, basis: str, left: str) -> Case:
    """Return a case of nearly all that a step can hold, its left wall "absorbing" or "slip"."""

    def vector(*values: float) -> str:
        return str(list(values[:dimension]))

    text = EVERYTHING.format(
        dimension=dimension,
        scheme=scheme,
        basis=basis,
        left=left,
        floor="contact" if left == "slip" else "slip",
        per_axis=7 - dimension if left == "slip" else 2,  # More than are laid out at once.
        zero=vector(0.0, 0.0, 0.0),
        box=vector(0.4, 0.3, 0.08),
        gravity=vector(1.0, -10.0, 2.0),
        bed=vector(0.2, 0.06, 0.08),
        forcing=f"[{', '.join([WAVING, '1.5', '-0.3'][:dimension])}]",
        falling=vector(0.5, -2.0, 0.2),
        low_block=vector(0.02, 0.061, 0.01),
        high_block=vector(0.07, 0.11, 0.07),
        ball="disc" if dimension == 2 else "sphere",
        centre=vector(0.1, 0.087, 0.04),
        pressing=vector(0.0, -1.0, 0.0),
        low_press=vector(0.14, 0.061, 0.01),
        high_press=vector(0.18, 0.1, 0.07),
    )
    file = tmp_path / "case.toml"
    file.write_text(text)
    return load_case(file)


HUNG = """
[grid]
dimension = 2
cell_size = "5 mm"
[run]
end_time = "0.4 s"
gravity = [0, -10]
[material.soft]
density = 1000
strength = { elastic = { E = "1 MPa", nu = 0.2 } }
[contact]
friction = 0.3
[[contact.pair]]
bodies = ["roof", "lamp"]
bonded = true
[body.roof]
material = "soft"
shape = { box = { lower = [-0.1, 0.0], upper = [0.1, 0.02] } }
motion = "fixed"
[body.lamp]
material = "soft"
shape = { box = { lower = [-0.02, -0.08], upper = [0.02, 0.0] } }
damping = { mass = "30 1/s" }
"""
"""A body that hangs from a fixed one to which it is bonded."""

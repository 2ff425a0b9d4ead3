# SPDX-License-Identifier: BSD-3-Clause
"""Keys that other programs have and this version has not, with what to do instead."""

from __future__ import annotations

from collections.abc import Iterable

from .errors import nearest

_UNITS = 'write each number with its unit, "30 mm"; a plain number is in SI units'
_TURNED = (
    "turn the shape, shape = { rotate = { shape = ..., angle = ... } }; a body that turns as it "
    "moves has angular_velocity"
)
_PERIODIC = (
    "walls that are slip on both sides make planes of symmetry, and a wider region keeps what "
    "leaves one side from what enters the other"
)
_ROUND = (
    "compute a quarter in 3D, between two slip walls, grid.box.walls = { x_min, y_min } = slip, "
    "with cut_at_box = true"
)
_PLANE_STRESS = "2D is plane strain; for a thin plate compute a layer in 3D with free faces"
_HEAT = (
    "heat is not conducted; johnson_cook and the equations of state warm what is deformed, and "
    "body.NAME.initial.state gives a temperature at the start"
)
_MESH = 'no body is made of a mesh: give a shape, or points, particles = "points.csv"'
_FACES = "grid.box.walls holds the faces of the box, and body.NAME.motion moves a body"
_OPTIONS = "it is an option of the command: `mpm3dpp run CASE --out DIR --threads N --resume`"
_INCLUDE = "put all tables into one file; `--set KEY=VALUE` changes a key for one run"

_INSTEAD = {
    **dict.fromkeys(("units", "unit", "unit_system"), _UNITS),
    **dict.fromkeys(("rotation", "orientation", "rotated", "euler_angles"), _TURNED),
    **dict.fromkeys(("periodic", "periodicity", "periodic_boundary"), _PERIODIC),
    **dict.fromkeys(("axisymmetric", "axisymmetry", "axisymmetrical", "axial_symmetry"), _ROUND),
    "plane_stress": _PLANE_STRESS,
    **dict.fromkeys(("thermal", "heat", "conductivity", "thermal_conductivity"), _HEAT),
    **dict.fromkeys(("stl", "mesh", "mesh_file", "geometry"), _MESH),
    **dict.fromkeys(("boundary", "boundaries", "boundary_conditions", "constraints"), _FACES),
    **dict.fromkeys(("threads", "out", "output_folder", "restart", "resume"), _OPTIONS),
    **dict.fromkeys(("include", "includes"), _INCLUDE),
}

# What stands in another table here.
_OF_PAIRS = (
    "it is of two bodies, or of a body and walls: give contact.{0}, or one of its own to a pair, "
    "[[contact.pair]] with bodies = [..., ...] and {0}"
)
_ELSEWHERE = {
    **{key: _OF_PAIRS.format(key) for key in ("restitution", "friction")},
    "frame": "it is of a body or an entry of grains: body.NAME.frame, grains.NAME.frame",
}
# What keys are named elsewhere.
_OTHER_NAMES = dict.fromkeys(("mu", "cof", "friction_coefficient"), "friction")


def unknown_key(key: str, known: Iterable[str]) -> tuple[str, str]:
    """Return rule and remedy of a key that is not known; `known` are valid in its place."""
    instead = _INSTEAD.get(key.lower().replace("-", "_"))
    if instead is not None:
        return "is not in this version", instead
    elsewhere = _ELSEWHERE.get(key.lower())
    if elsewhere is not None:
        return "is not a key of this table", elsewhere
    return "is not a known key", nearest(_OTHER_NAMES.get(key.lower(), key), known)

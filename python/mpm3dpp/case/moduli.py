# SPDX-License-Identifier: BSD-3-Clause
"""Elastic moduli of a material, by whichever of them its strength model is given."""

from __future__ import annotations

from typing import NamedTuple

from mpm3dpp.base.frames import MATERIAL, UPDATED

from .material import Material


class Moduli(NamedTuple):
    """E: Young's modulus [Pa]; nu: Poisson's ratio; G: shear modulus [Pa]."""

    E: float
    nu: float
    G: float


def moduli_of(material: Material) -> Moduli | None:
    """Return the moduli of a solid that has two of them; None for others."""
    given = material.strength.parameters
    if "E" in given and "nu" in given:
        E, nu = given["E"], given["nu"]
        return Moduli(E, nu, E / (2.0 * (1.0 + nu)))
    if given.get("K") and "G" in given:
        K, G = given["K"], given["G"]
        return Moduli(9.0 * K * G / (3.0 * K + G), (3.0 * K - 2.0 * G) / (6.0 * K + 2.0 * G), G)
    return None


def damping_viscosity(material: Material, frame: str = UPDATED) -> float:
    """Return by what its damping, in proportion to the stiffness, resists pressure waves [Pa s].

    With volumes averaged over cells that is of the shape alone; see docs/theory/damping.md.
    """
    if frame == MATERIAL or not material.volume_averaging:
        return material.beta * material.density * material.sound_speed() ** 2
    moduli = moduli_of(material)
    G = moduli.G if moduli else material.strength.parameters.get("G", 0.0)
    return material.beta * 4.0 / 3.0 * G

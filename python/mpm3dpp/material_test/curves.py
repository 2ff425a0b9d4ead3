# SPDX-License-Identifier: BSD-3-Clause
"""What a test should give: closed forms and published lines, computed without the core."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from mpm3dpp.case.case import Material

from .options import Options
from .triaxial import failure_deviator


@dataclass(frozen=True)
class Curve:
    """A line to compare with.

    Attributes:
        label: what it is.
        x, y: its points, in the units of the test's axes (strain or m/s, Pa or m/s).
    """

    label: str
    x: np.ndarray
    y: np.ndarray


def moduli(material: Material) -> tuple[float, float, float] | None:
    """Return (E, K, G) [Pa] of a strength with E and nu; None for others."""
    given = material.strength.parameters
    if "E" not in given or "nu" not in given:
        return None
    E, nu = given["E"], given["nu"]
    return E, E / (3.0 * (1.0 - 2.0 * nu)), E / (2.0 * (1.0 + nu))


def flow_stress(material: Material, rate: float) -> Callable[[float, float], float] | None:
    """Return the yield stress Y(plastic strain, temperature) [Pa] at a rate [1/s], or None."""
    p, model = material.strength.parameters, material.strength.model
    if model == "j2":
        return lambda ep, _: p["Y0"] + p["H"] * ep
    if model == "voce":
        return lambda ep, _: p["Y0"] + p["Q"] * (1.0 - math.exp(-p["b"] * ep))
    if model == "swift":
        return lambda ep, _: p["Y0"] * (1.0 + ep / p["e0"]) ** p["n"]
    if model not in ("johnson_cook", "simplified_johnson_cook"):
        return None
    faster = 1.0 + p["C"] * math.log(max(rate / p["rate0"], 1.0))

    def johnson_cook(ep: float, temperature: float) -> float:
        hard = (p["A"] + p["B"] * ep ** p["n"]) * faster
        if model != "johnson_cook":
            return hard
        star = (temperature - p["T_room"]) / (p["T_melt"] - p["T_room"])
        return hard * (1.0 - min(max(star, 0.0), 1.0) ** p["m"])

    return johnson_cook


def heated_flow(
    material: Material, rate: float, strains: np.ndarray
) -> tuple[np.ndarray, np.ndarray] | None:
    """Return yield stress [Pa] and temperature [K] over plastic strain, heated by its own work.

    dT/dep = chi Y / (rho0 cp), by Heun's rule between the given plastic strains.
    """
    law, p = flow_stress(material, rate), material.strength.parameters
    if law is None:
        return None
    heat = p["chi"] / (material.density * p["cp"]) if "chi" in p else 0.0
    temperature = [p.get("T0", 0.0)]
    for a, b in pairwise(strains):
        first = heat * law(a, temperature[-1])
        second = heat * law(b, temperature[-1] + first * (b - a))
        temperature.append(temperature[-1] + 0.5 * (first + second) * (b - a))
    stress = np.array([law(e, t) for e, t in zip(strains, temperature, strict=True)])
    return stress, np.array(temperature)


def known_curves(material: Material, options: Options) -> list[Curve]:
    """Return what is known in closed form or published about a test; may be empty."""
    to, rate = float(options.to or 0.0), float(options.rate or 1.0)
    if options.test == "hugoniot":
        return _published_line(material, to)
    if options.test == "uniaxial-stress":
        return _tension(material, to, rate)
    if options.test == "triaxial":
        return _triaxial(material, to, rate, float(options.pressure or 0.0))
    if options.test == "shear":
        return _shear(material, to)
    return _uniaxial_strain(material, to) if options.test == "uniaxial-strain" else []


def _published_line(material: Material, fastest: float) -> list[Curve]:
    if material.eos is None or material.eos.model != "mie_gruneisen":
        return []
    c0, s = material.eos.parameters["c0"], material.eos.parameters["s"]
    up = np.linspace(0.0, fastest, 3)
    return [Curve(f"Us = {c0:g} m/s + {s:g} up, as published", up, c0 + s * up)]


def _tension(material: Material, to: float, rate: float) -> list[Curve]:
    known = moduli(material)
    if known is None:
        return []
    if material.strength.model == "elastic":
        return [Curve("E x strain", np.array([0.0, to]), known[0] * np.array([0.0, to]))]
    plastic = abs(to) * np.linspace(0.0, 1.0, 401) ** 2  # closer where it hardens most
    heated = heated_flow(material, rate, plastic)
    if heated is None:
        return []
    strain = plastic + heated[0] / known[0]
    stress = np.concatenate([[0.0], heated[0]])
    strain = np.concatenate([[0.0], strain])
    sign = math.copysign(1.0, to)
    label = f"{material.strength.model}: E x strain, then its yield stress"
    return [Curve(label, sign * strain, sign * stress)]


def _triaxial(material: Material, to: float, rate: float, pressure: float) -> list[Curve]:
    """E x strain up to the deviator at failure; a metal's is its yield stress at any pressure."""
    known, limit = moduli(material), failure_deviator(material, pressure)
    if known is None:
        return []
    if material.strength.model not in ("mohr_coulomb", "drucker_prager"):
        return [Curve(c.label, c.x, -c.y) for c in _tension(material, to, rate)]
    if limit is None:
        return []
    last = min(limit / known[0], -to)
    x, y = np.array([0.0, -last, to]), known[0] * np.array([0.0, last, last])
    return [Curve(f"E x strain, then {material.strength.model} in closed form", x, y)]


def _shear(material: Material, to: float) -> list[Curve]:
    gamma = np.linspace(0.0, to, 201)
    known = moduli(material)
    if material.strength.model == "elastic" and known is not None:
        return [Curve("G sin(shear), Jaumann", gamma, known[2] * np.sin(gamma))]
    if material.strength.model == "neo_hookean":
        return [Curve("G x shear", gamma, material.strength.parameters["G"] * gamma)]
    return []


def _uniaxial_strain(material: Material, to: float) -> list[Curve]:
    """Slope K + 4G/3 up to the elastic limit; then, with hardening H, K + 4G/3 H / (3G + H)."""
    known = moduli(material)
    if known is None or material.eos is not None:
        return []
    _, K, G = known
    model, p = material.strength.model, material.strength.parameters
    steep = K + 4.0 * G / 3.0
    if model == "elastic":
        return [Curve("(K + 4G/3) x strain", np.array([0.0, to]), steep * np.array([0.0, to]))]
    if model != "j2":
        return []
    limit = math.copysign(min(p["Y0"] / (2.0 * G), abs(to)), to)
    later = K + 4.0 * G / 3.0 * p["H"] / (3.0 * G + p["H"])
    y = np.array([0.0, steep * limit, steep * limit + later * (to - limit)])
    slope = "K + 4G/3 H / (3G + H)" if p["H"] > 0.0 else "K"
    return [Curve(f"slopes K + 4G/3, then {slope}", np.array([0.0, limit, to]), y)]

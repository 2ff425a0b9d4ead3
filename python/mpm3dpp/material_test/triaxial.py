# SPDX-License-Identifier: BSD-3-Clause
"""The triaxial compression of a soil laboratory: when it fails, and when it should."""

from __future__ import annotations

import math

import numpy as np

from mpm3dpp.case.case import Material
from mpm3dpp.plots.labels import scaled

CELL_PRESSURE = 100e3  # [Pa], unless the user says

_FLAT = 1e-3  # a deviator that grows with less than this share of its first slope has failed


def failure_deviator(material: Material, pressure: float) -> float | None:
    """Return the deviator at which a material fails at a cell pressure [Pa], in closed form.

    Mohr and Coulomb: (N - 1) p + 2 c sqrt(N), N = tan^2(45 deg + phi / 2) (Terzaghi 1943, sec. 7).
    Drucker and Prager: tau = q / sqrt(3) and sm = -(p + q / 3) in tau + q_phi sm = k_phi.
    None for other models, and where the cone is so wide that it never fails.
    """
    p, model = material.strength.parameters, material.strength.model
    if model == "mohr_coulomb":
        sine = math.sin(p["friction_angle"])
        N = (1.0 + sine) / (1.0 - sine)
        return (N - 1.0) * pressure + 2.0 * p["cohesion"] * math.sqrt(N)
    if model == "drucker_prager" and p["q_phi"] < math.sqrt(3.0):
        slope = 1.0 / math.sqrt(3.0) - p["q_phi"] / 3.0
        return (p["k_phi"] + p["q_phi"] * pressure) / slope
    if model == "j2" and p["H"] == 0.0:
        return p["Y0"]
    return None


def verdict(material: Material, pressure: float, columns: dict[str, np.ndarray]) -> str:
    """Return at which deviator it failed, beside the closed form, or that it has not.

    Args:
        material: that was tested.
        pressure: in the cell [Pa].
        columns: of the test, `strain` and `deviator`.
    """
    strain, deviator = columns["strain"], columns["deviator"]
    largest = float(deviator.max())
    slope = -np.diff(deviator) / np.diff(strain)  # compression is negative
    if largest <= deviator[-1] and slope[-1] > _FLAT * slope[0]:
        reached = scaled(largest, "Pa", 6)
        return f"has not failed: the deviator still grows at the end, where it is {reached}"
    axial = scaled(pressure + largest, "Pa", 6)
    cell = scaled(pressure, "Pa", 6)
    found = f"fails at a deviator of {scaled(largest, 'Pa', 6)}"
    found += f" (axial pressure {axial}, cell pressure {cell})"
    exact = failure_deviator(material, pressure)
    if exact is None or exact <= 0.0:
        return found
    off = abs(largest - exact) / exact
    return f"{found}; in closed form {scaled(exact, 'Pa', 6)}, off by {off:.1e}"

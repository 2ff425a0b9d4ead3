# SPDX-License-Identifier: BSD-3-Clause
"""E3 and E4: rigid motion, free fall, spin, and simple shear of one point."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np

from mpm3dpp.materials.point import drive_point

from .figure import Figure, judge, report
from .points import ball, block
from .scene import Array, Scene

E = 1e6


def translation_figures(
    fly: Callable[[float], tuple[Array, Array, Array]], h: float
) -> list[Figure]:
    """Return the figures of a flight by `fly(shift)`: places without the shift, v, and stresses."""
    x, v, stress = fly(0.0)
    _, v_far, stress_far = fly(8 * h)
    return [
        judge("E3", "translation: largest stress over E", np.abs(stress).max() / E),
        judge("E3", "shift by whole cells: largest difference of velocity",
              np.abs(v - v_far).max()),
        judge("E3", "shift by whole cells: largest difference of stress",
              np.abs(stress - stress_far).max()),
        report("translation across", float(np.abs(x - 10.0).max() / h), "cells"),
    ]  # fmt: skip


def rigid_translation(
    scheme: str, dimension: int, basis: str, cells: int = 4, factor: float = 0.5
) -> list[Figure]:
    """E3: a block flies across cells in an oblique direction; then the same, whole cells away."""
    h = 0.125  # A power of two, so that whole cells shift coordinates without rounding.

    def fly(shift: float) -> tuple[Array, Array, Array]:
        scene = Scene(scheme, dimension, basis, h, factor=factor, contact=False)
        x, volume = block([10.0] * dimension, [10.0 + cells * h] * dimension, h / 2)
        a = scene.body(
            scene.material(1000.0, "elastic", E=E, nu=0.3), x + shift, [3.0, 2.0, -1.0], volume
        )
        scene.start().run(0.4)
        return scene.x(a) - shift, scene.v(a), scene.stress(a)

    return translation_figures(fly, h)


def free_fall(
    scheme: str, dimension: int, basis: str, cells: int = 4, factor: float = 0.5
) -> list[Figure]:
    """E3: a block falls in an oblique direction."""
    h, g = 0.1, np.array([3.0, -9.0, 2.0])
    scene = Scene(scheme, dimension, basis, h, factor=factor, contact=False, gravity=g)
    x0, volume = block([0.03] * dimension, [0.03 + cells * h] * dimension, h / 2)
    a = scene.body(scene.material(1000.0, "elastic", E=E, nu=0.3), x0, [0.0] * 3, volume)
    scene.start().run(0.5)
    g, t = g[:dimension], scene.time
    dt = scene.history()["dt"]
    # The position of eq. (18) is moved with the velocity at the end of the step.
    discrete = (np.cumsum(dt) * dt).sum()
    fall = 0.5 * t * t
    return [
        judge("E3", "fall: velocity against g t, over g t",
              np.abs(scene.v(a) - g * t).max() / (np.abs(g).max() * t)),
        judge("E3", "fall: displacement against the sum of v dt, over g t^2/2",
              np.abs(scene.x(a) - x0 - g * discrete).max() / (np.abs(g).max() * fall)),
        judge("E3", "fall: largest stress over E", np.abs(scene.stress(a)).max() / E),
        report("fall: displacement over g t^2/2", discrete / fall),
    ]  # fmt: skip


def spin(
    scheme: str, dimension: int, basis: str, cells: int = 10, factor: float = 0.5,
    model: str = "neo_hookean",
) -> list[Figure]:  # fmt: skip
    """E3: a disc (in 3D a sphere) spins, its rim at 5 % of the speed of sound."""
    h, rho = 1.0 / cells, 1.0
    parameters = {"E": 1e4, "nu": 0.3}
    sound = math.sqrt(1e4 * 0.7 / (1.3 * 0.4) / rho)
    if model == "neo_hookean":
        parameters = {"K": 1e4 / 1.2, "G": 1e4 / 2.6}
    omega = 0.05 * sound
    scene = Scene(scheme, dimension, basis, h, factor=factor, contact=False)
    x, volume = ball([0.0] * dimension, 1.0, h / 2)
    v = np.zeros_like(x)
    v[:, 0], v[:, 1] = -omega * x[:, 1], omega * x[:, 0]
    a = scene.body(scene.material(rho, model, **parameters), x, v, volume)
    scene.start().run(2 * math.pi * 3.2 / omega)

    def angular(x: Array, v: Array) -> float:
        return float((volume * (x[:, 0] * v[:, 1] - x[:, 1] * v[:, 0])).sum())

    h_ = scene.history()
    energy = (h_["kinetic"] + h_["internal"])[-1] / h_["kinetic"][0]
    left = angular(scene.x(a), scene.v(a)) / angular(x, v)
    return spin_figures(left, energy, cells, scheme == "musl" and basis == "gimp")


def spin_figures(momentum: float, energy: float, cells: int, judged: bool) -> list[Figure]:
    """Return what is left of angular momentum and energy after 3.2 turns, over the start."""
    figures = []
    for name, left in (("angular momentum", momentum), ("energy", energy)):
        name = f"spin: {name} after over before, {cells} cells a radius"
        figures.append(judge("E3", name, left) if judged else report(name, left))
    return figures


def simple_shear(steps: int = 10_000) -> list[Figure]:
    """E4: one point to gamma = 2 pi; figures at `steps`, and the order from a tenth of them."""
    error = {n: _shear_errors(n) for n in (steps // 10, steps)}
    figures = [judge("E4", name, worst) for name, worst in error[steps].items()]
    for name, worst in error[steps].items():
        coarse = error[steps // 10][name]
        order = math.log10(coarse / worst) if min(worst, coarse) > 1e-13 else math.nan
        remark = f"{coarse:.2g} at {steps // 10} steps"
        if order == order:
            figures.append(report(f"order of {name}", order, "", remark))
    return figures


def _shear_errors(steps: int) -> dict[str, float]:
    increments = np.zeros((steps, 3, 3))
    increments[:, 0, 1] = 2 * math.pi / steps
    gamma = np.linspace(0.0, 2 * math.pi, steps + 1)[1:]
    worst = {}
    jaumann = drive_point(1.0, "elastic", {"E": 2.6, "nu": 0.3}, increments, True)[0]
    solid = drive_point(1.0, "neo_hookean", {"K": 2.0, "G": 1.0}, increments, True)[0]
    for name, stress, tau, s11 in (
        ("Jaumann", jaumann, np.sin(gamma), 1 - np.cos(gamma)),
        ("neo-Hookean", solid, gamma, gamma**2),
    ):
        got = stress[-steps:]
        worst[f"{name}: largest error of tau over G"] = float(np.abs(got[:, 5] - tau).max())
        worst[f"{name}: largest error of s11 over G"] = float(np.abs(got[:, 0] - s11).max())
    return worst

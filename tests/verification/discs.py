# SPDX-License-Identifier: BSD-3-Clause
"""E5, E6 and E7: Sulsky's discs, the two rings of the first example, and the gap at first touch."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from .figure import Figure, judge, report
from .points import annulus, ball
from .scene import Scene, on_time

ANGLES, OFFSETS = (0.0, 30.0, 45.0), (0.0, 0.2, 0.4, 0.6, 0.8)


def sulsky_discs(
    scheme: str, dimension: int, basis: str, cells: int = 40, factor: float = 0.25,
    model: str = "neo_hookean", points: int = 2,
) -> list[Figure]:  # fmt: skip
    """E5: two discs meet along the diagonal; cells of 1/`cells`."""
    h, E, nu = 1.0 / cells, 1000.0, 0.3
    parameters = {"E": E, "nu": nu}
    if model == "neo_hookean":
        parameters = {"K": E / (3 - 6 * nu), "G": E / (2 + 2 * nu)}
    scene = Scene(scheme, dimension, basis, h, factor=factor)
    material = scene.material(1000.0, model, **parameters)
    for centre, speed in ((0.2, 0.1), (0.8, -0.1)):
        x, volume = annulus([centre] * 2, 0.0, 0.2, h / points)
        scene.body(material, x, [speed] * 2, volume)
    return sulsky_figures(scene.start(), model)


def sulsky_figures(scene: Scene, model: str) -> list[Figure]:
    """Let the discs of E5 meet and part, and return the figures."""
    said = scene.run(
        3.4, lambda s: [s.time, np.abs(s.impulse()).sum(), s.mean_velocity(0).mean()], 2
    )
    kinetic = scene.history()["kinetic"]
    begin, end = on_time(said[:, 0], said[:, 1])
    return [
        judge("E5", "first contact", scene.core.contact_pairs()[0].first_time),
        judge("E5", "restitution", -said[-1, 2] / 0.1),
        judge("E5", f"least kinetic energy, {model}", kinetic.min() / kinetic[0]),
        judge("E5", "contact lasts", end - begin),
        scene.energy_figure(),
    ]


def rings(
    scheme: str, dimension: int, basis: str, cell_mm: float = 0.8, factor: float = 0.5,
    detection: str = "gap", points: int = 3, model: str = "neo_hookean",
) -> list[Figure]:  # fmt: skip
    """E6: two rings of radii 30 and 40 mm meet at 60 m/s."""

    h, K, G = cell_mm * 1e-3, 121.7e6, 26.1e6
    parameters = {"K": K, "G": G}
    if model == "elastic":
        parameters = {"E": 9 * K * G / (3 * K + G), "nu": (3 * K - 2 * G) / (6 * K + 2 * G)}
    scene = Scene(scheme, dimension, basis, h, factor=factor, detection=detection, threads=2)
    material = scene.material(1010.0, model, **parameters)
    for centre, speed in ((0.05, 30.0), (0.15, -30.0)):
        x, volume = annulus([centre, 0.05], 0.03, 0.04, h / points)
        scene.body(material, x, [speed, 0.0], volume)
    return ring_figures(scene.start(), h / points)


def ring_figures(scene: Scene, spacing: float) -> list[Figure]:
    """Let the rings of E6 meet and part, and return the figures; `spacing` of their points [m]."""

    def watch(s: Scene) -> list[float]:
        x = s.x(0)[:, 0]
        return [s.time, abs(s.impulse()[0]), x.max() - x.min(), s.mean_velocity(0)[0]]

    said = scene.run(3.6e-3, watch, 10)
    history, pair = scene.history(), scene.core.contact_pairs()[0]
    kinetic = history["kinetic"]
    momentum = np.abs(history["momentum_x"]).max() / (scene.core.total_mass / 2 * 30.0)
    return [
        judge("E6", "contact lasts", on_time(said[:, 0], said[:, 1])[1] - pair.first_time),
        judge("E6", "rebound", -said[-1, 3]),
        judge("E6", "least kinetic energy", kinetic.min() / kinetic[0]),
        judge("E6", "least height", 1e3 * (said[:, 2].min() + spacing)),
        report("gap at the first contact", pair.first_gap / scene.cell_size, "cells"),
        scene.energy_figure(),
        report("momentum, largest change over one ring's", momentum),
    ]


def first_touch(
    scheme: str, dimension: int, basis: str, cells: int = 8, detection: str = "gap",
    angles: Sequence[float] = ANGLES, offsets: Sequence[float] = OFFSETS,
) -> list[Figure]:  # fmt: skip
    """E7: true gap, from the centres, when two discs (spheres) of `cells` radii first touch."""

    h, radius, speed = 1.0 / cells, 1.0, 0.05
    gaps = []
    for angle in np.radians(angles):
        direction = np.array([math.cos(angle), math.sin(angle), 0.0])[:dimension]
        for offset in offsets:
            scene = Scene(scheme, dimension, basis, h, factor=0.5, detection=detection)
            material = scene.material(1.0, "elastic", E=1.0, nu=0.3)
            apart = (1.0 + 1.5 * h) * direction
            for side in (-1.0, 1.0):
                x, volume = ball(side * apart + offset * h, radius, h / 2)
                scene.body(material, x, -side * speed * direction, volume)
            scene.start()
            while not scene.core.contact_pairs():
                scene.step(1)
            between = np.linalg.norm(scene.x(1).mean(0) - scene.x(0).mean(0))
            gaps.append((between - 2 * radius) / h)
    if detection == "velocity":
        return [judge("E7", "velocity rule: mean gap", float(np.mean(gaps)),
                      remark=f"largest {max(gaps):.2f}")]  # fmt: skip
    remark = f"from {min(gaps):.2f} to {max(gaps):.2f}"
    return [
        judge("E7", "largest gap at the first contact", max(gaps, key=abs), remark=remark),
        judge("E7", "mean gap at the first contact", float(np.mean(gaps))),
    ]

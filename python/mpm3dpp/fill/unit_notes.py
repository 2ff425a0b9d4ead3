# SPDX-License-Identifier: BSD-3-Clause
"""Densities, wave speeds and velocities that are perhaps in another unit than is meant."""

from __future__ import annotations

from mpm3dpp.base.errors import key_text
from mpm3dpp.case.case import Case

from .parts import Filled

_FASTEST = 10.0  # Times the speed of sound; the fastest impacts in laboratories are at 2 to 3.
_LIGHTEST = 20.0  # [kg/m^3]; metals have up to that in g/cm^3, and few foams are lighter.
_HEAVIEST = 25_000.0  # [kg/m^3]; osmium has 22,590.
_FASTEST_WAVE = 20_000.0  # [m/s]; diamond has 18,000.
_SOFTEST, _TOUGHEST = 1e-6, 1.0  # Yield stress over E; pure metals have 1e-5, glass 0.05.
_YIELDS = ("Y0", "A")  # Of soils a cohesion may be as little as one likes.
_GASEOUS = ("fluid",)  # Strengths of what may be as light as a gas.


def unit_notes(case: Case, bodies: Filled) -> list[str]:
    """Return a sentence for each number that no material or experiment has."""
    return [*_densities(case), *_yields(case), *_waves(case), *_speeds(case, bodies)]


def _densities(case: Case) -> list[str]:
    found = []
    for name in case.materials_used:
        material = case.material[name]
        least = 0.0 if material.strength.model in _GASEOUS else _LIGHTEST
        if least <= material.density <= _HEAVIEST:
            continue
        rule = "more than any solid has" if material.density > least else "little for a solid"
        found.append(
            f"material.{name}.density = {material.density:.4g} kg/m^3 is {rule}; look at its unit "
            "(a plain number is in kg/m^3)"
        )
    return found


def _yields(case: Case) -> list[str]:
    """Yield stresses that no solid has beside its stiffness."""
    found = []
    for name in case.materials_used:
        strength = case.material[name].strength
        stiffness = strength.parameters.get("E", 0.0)
        for key in _YIELDS if stiffness else ():
            share = strength.parameters.get(key, 0.0) / stiffness
            if share <= 0.0 or _SOFTEST <= share <= _TOUGHEST:
                continue
            found.append(
                f"material.{name}.strength.{strength.model}.{key} is {share:.3g} of E = "
                f"{stiffness:.4g} Pa, {'less' if share < _SOFTEST else 'more'} than in any solid; "
                "look at the units of both (a plain number is in Pa)"
            )
    return found


def _waves(case: Case) -> list[str]:
    found = []
    rigid = {part.material for name, part in case.parts().items() if case.is_rigid(name)}
    for name in case.materials_used:
        if name in rigid:
            continue
        speed = case.material[name].sound_speed()
        if speed > _FASTEST_WAVE:
            found.append(
                f"waves in material.{name} run at {speed:.4g} m/s, faster than in any known "
                "material; look at the units of its density and its stiffness"
            )
    return found


def _speeds(case: Case, bodies: Filled) -> list[str]:
    parts = case.parts()
    sound = {name: case.material[part.material].sound_speed() for name, part in parts.items()}
    quickest = max(c for name, c in sound.items() if not case.is_rigid(name))
    found = []
    for name, part in bodies.parts.items():
        speed = float(part.survey.speeds.max())
        own = quickest if case.is_rigid(name) else sound[name]
        if speed > _FASTEST * own:
            whose = "the other materials" if case.is_rigid(name) else "its material"
            found.append(
                f"{key_text(case.part_path(name))} moves at {speed:.4g} m/s, {speed / own:.3g} "
                f"times the speed of sound in {whose} ({own:.4g} m/s); look at the unit of its "
                "velocity (a plain number is in m/s) and at the stiffness"
            )
    return found

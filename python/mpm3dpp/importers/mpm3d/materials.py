# SPDX-License-Identifier: BSD-3-Clause
"""Materials of a deck as tables of a case, in SI units."""

from __future__ import annotations

import itertools
from typing import Any

from .deck import Deck, Record
from .units import UnitSystem

Table = dict[str, Any]
NEEDS_EOS = ("sjc", "sjcf", "jcf", "hiex", "null")
LINEAR_VISCOSITY = ("elas", "neoh", "null")  # Only for these has bulk a linear term.
MAYBE_GASES = ("hiex", "null")
START_TEMPERATURE = 293.0  # Of every particle in MPM3D-F90.

_UNITS = {
    "rho": "density",
    **dict.fromkeys(("E", "Y", "Et", "A", "B", "K", "kphi", "tenf"), "stress"),
    "eps0": "rate",
    "cv": "specific heat",
    "D": "velocity",
    "mu": "viscosity",
}
_EOS_UNITS = {
    "1": dict.fromkeys(("c0", "c1", "c2", "c3", "E0"), "stress"),
    "2": {"c0": "velocity", "E0": "stress"},
    "3": dict.fromkeys(("A", "B", "E0"), "stress"),
    "4": {"c": "velocity"},
}


def material_name(deck: Deck, number: int) -> str:
    """Return the name of a material in the case: its type and its number."""
    return f"{deck.materials[number].kind}_{number}"


def material_tables(deck: Deck, units: UnitSystem) -> dict[str, Table] | None:
    """Return all materials by name.

    None if one needs an equation of state that is not there, or has numbers that cannot be, which
    are among `deck.source.problems` then.

    Raises:
        CaseError: there are not those materials that the file speaks of.
    """
    if len(deck.materials) < deck.material_count:
        number = next(n for n in itertools.count(1) if n not in deck.materials)
        rule = f"does not give material {number} of {deck.material_count}"
        raise deck.error("mate", rule, "give all of them in one mate statement")
    for number, eos in deck.eos.items():
        if number not in deck.materials:
            rule = f"is for material {number}, which is not given"
            raise deck.error("seos", rule, "number the materials from 1", eos.line)
    caught = deck.source.problems.caught
    found = {material_name(deck, n): caught(_table, deck, n, units) for n in sorted(deck.materials)}
    tables = {name: table for name, table in found.items() if table is not None}
    return tables if len(tables) == len(found) else None


def _table(deck: Deck, number: int, units: UnitSystem) -> Table:
    record = deck.materials[number]
    given = _si(record, units, _UNITS)
    table: Table = {"density": given["rho"], "strength": _strength(deck, record, given)}
    if record.kind in NEEDS_EOS:
        if number not in deck.eos:
            rule = f"gives material {number} ({record.kind}) but no seos follows for it"
            raise deck.error("mate", rule, "add seos, its equation of state", record.line)
        table["eos"] = _eos(deck, record, deck.eos[number], given, units)
    elif number in deck.eos:
        deck.note(
            f"line {deck.eos[number].line}: seos for material {number} ({record.kind}) is left "
            "out: that material has an elastic pressure, in MPM3D-F90 too"
        )
    if "epf" in given:
        table["failure"] = {"plastic_strain": {"limit": given["epf"]}}
        deck.note(
            f"{record.kind}: a particle that fails at epf bears compression only from then on "
            "(action no_tension)"
        )
    quadratic, linear = deck.bulk
    if linear and record.kind not in LINEAR_VISCOSITY:
        table["artificial_viscosity"] = {"quadratic": quadratic, "linear": 0.0}
    elif record.kind in MAYBE_GASES and not quadratic and not linear:
        # What a gas has here by default, it has not there.
        table["artificial_viscosity"] = {"quadratic": 0.0, "linear": 0.0}
    return table


def _si(record: Record, units: UnitSystem, kinds: dict[str, str]) -> dict[str, float]:
    return {n: units.si(value, kinds.get(n, "1")) for n, value in record.values.items()}


def _strength(deck: Deck, record: Record, v: dict[str, float]) -> Table:
    """Return `{model: parameters}` of a material's record; `v` are its values in SI units."""
    kind = record.kind
    elastic = {"E": v.get("E", 0.0), "nu": v.get("nu", 0.0)}
    if kind == "elas":
        return {"elastic": elastic}
    if kind == "pla1":
        return {"j2": {**elastic, "Y0": v["Y"], "H": 0.0}}
    if kind == "pla2":
        if not v["Et"] < v["E"]:
            rule = "has a tangent modulus Et >= E in pla2"
            raise deck.error("mate", rule, "give Et < E", record.line)
        modulus = v["E"] * v["Et"] / (v["E"] - v["Et"])
        return {"j2": {**elastic, "Y0": v["Y"], "H": modulus}}
    if kind in ("john", "jcf", "sjc", "sjcf"):
        cook = {**elastic, **{name: v[name] for name in "ABnC"}, "rate0": v["eps0"]}
        if kind.startswith("sjc"):
            return {"simplified_johnson_cook": cook}
        deck.note(
            f"{kind}: particles start at {START_TEMPERATURE:g}, as in MPM3D-F90; Troom = "
            f"{v['Troom']:g} and Tmelt = {v['Tmelt']:g} are taken as they are given"
        )
        heat = {"m": v["m"], "T_room": v["Troom"], "T_melt": v["Tmelt"], "T0": START_TEMPERATURE}
        return {"johnson_cook": {**cook, **heat, "cp": v["cv"], "chi": 1.0}}
    if kind == "hiex":
        deck.note(
            "hiex: the burn rises over one and a half cells behind the front; in MPM3D-F90 it "
            "jumps from 0 to 1 when the front passes a particle"
        )
        return {"high_explosive": {"D": v["D"]}}
    if kind == "null":
        return {"fluid": {"viscosity": v["mu"]}}
    if kind == "dpm":
        soil = {"q_phi": v["qphi"], "k_phi": v["kphi"], "q_psi": v["qpsi"], "tension": v["tenf"]}
        return {"drucker_prager": {**elastic, **soil}}
    if not -1 < v["nu"] < 0.5:
        rule = f"has nu = {v['nu']:g} in neoh"
        raise deck.error("mate", rule, "it must obey -1 < nu < 0.5", record.line)
    bulk, shear = v["E"] / (3 * (1 - 2 * v["nu"])), v["E"] / (2 * (1 + v["nu"]))
    return {"neo_hookean": {"K": bulk, "G": shear}}


def _eos(
    deck: Deck, record: Record, eos: Record, material: dict[str, float], units: UnitSystem
) -> Table:
    """Return `{model: parameters}` of a `seos` statement for a material's record."""
    v = _si(eos, units, _EOS_UNITS[eos.kind])
    if eos.kind == "1":
        if v["c2"] or v["c6"]:
            deck.note(
                f"line {eos.line}: polynomial leaves out c2 and c6 in tension, which MPM3D-F90 "
                "takes there too"
            )
        return {"polynomial": v}
    if eos.kind == "2":
        deck.note(
            "seos 2: the Hugoniot itself, where MPM3D-F90 has a cubic fit to it (0.8 % low at "
            "48 GPa in copper)"
        )
        return {"mie_gruneisen": v}
    if eos.kind == "3":
        names = {"w": "omega"}
        return {"jwl": {names.get(name, name): value for name, value in v.items()}}
    if record.kind == "null":
        deck.note("seos 4 of null: its c is replaced by sqrt(K/rho), as in MPM3D-F90")
        return {"linear": {"K": material["K"]}}
    return {"linear": {"K": material["rho"] * v["c"] ** 2}}

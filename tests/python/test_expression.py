# SPDX-License-Identifier: BSD-3-Clause
"""Formulas of place in a case: their values, units, what is refused, and velocities by them."""

from __future__ import annotations

import numpy as np
import pytest

from mpm3dpp import Case, CaseError, Simulation
from mpm3dpp.base.expression import FUNCTIONS, Expression

CASE = """
[grid]
dimension = {dimension}
cell_size = "1 mm"
[run]
end_time = "1 us"
[material.soft]
density = 1000.0
strength = {{ elastic = {{ E = "1 MPa", nu = 0.3 }} }}
[body.block]
frame = "updated"
material = "soft"
velocity = {velocity}
angular_velocity = {spin}
shape = {{ box = {{ lower = {lower}, upper = {upper} }} }}
"""


def case(velocity: str, spin: str = "0", dimension: int = 2) -> Case:
    lower, upper = ([value] * dimension for value in (0.002, 0.012))
    spin = "[0, 0, 0]" if spin == "0" and dimension == 3 else spin
    return Case.from_text(
        CASE.format(dimension=dimension, velocity=velocity, spin=spin, lower=lower, upper=upper)
    )


def start(found: Case) -> tuple[np.ndarray, np.ndarray]:
    """Positions and velocities of the block at the start."""
    simulation = Simulation(found, threads=1)
    return simulation.column("block", "position"), simulation.column("block", "velocity")


def values(text: str, **places: object) -> np.ndarray:
    return Expression.parse({"expression": text}, "m/s", ("x", "y")).at(places)


# What Python makes of the same text, in numpy's words.
NUMPY = {name: getattr(np, f"arc{name[1:]}", None) for name in ("asin", "acos", "atan", "atan2")}
NUMPY |= {"abs": np.abs, "min": np.minimum, "max": np.maximum, "pow": np.power}


@pytest.mark.parametrize(
    "text",
    [
        *(f"{name}(x)" for name in FUNCTIONS if name not in ("atan2", "min", "max", "pow")),
        *("atan2(x, y)", "min(x, y, 0.3)", "max(x, y)", "pow(x, y)", "-x^2 + +y", "2 - 3 - x"),
        *("x / y / 2", "2^x^y", "(1 + x) * (y - 2.5e-1)", " x +\n y ", "pi * e", "-x ** -2"),
    ],
)
def test_values_are_those_that_python_finds(text: str) -> None:
    x, y = np.linspace(0.05, 0.95, 200), np.linspace(0.9, 0.1, 200)
    known = {name: NUMPY.get(name) or getattr(np, name) for name in FUNCTIONS}
    known["min"] = lambda *v: np.min(np.broadcast_arrays(*v), axis=0)
    names = {**known, "pi": np.pi, "e": np.e, "x": x, "y": y}
    wanted = eval(" ".join(text.split()).replace("^", "**"), {"__builtins__": {}}, names)
    assert values(text, x=x, y=y) == pytest.approx(wanted + 0 * x, rel=4e-15, abs=1e-16)


def test_units_of_value_and_lengths() -> None:
    given = {"expression": "2 * x + 1", "unit": "mm/s", "length": "mm"}
    found = Expression.parse(given, "m/s", ("x",))
    assert found.at({"x": [0.003]}) == pytest.approx(0.007, rel=1e-15)
    assert found.table() == {"expression": "2*x+1", "unit": "mm/s", "length": "mm"}
    assert Expression.parse(found.table(), "m/s", ("x",)) == found


BAD = [
    ("q * x", "", 'has the name "q", which is not known', "valid here: x, y, z, r, pi, e"),
    ("sine(x)", "", 'has the function "sine", which is not known', 'did you mean "sin"'),
    ("__import__(1)", "", "which is not known", "valid here"),
    ("sin(x", "", "is not a formula that can be read", "for example"),
    ("x # y", "", "is not a formula that can be read", "for example"),
    ("2x", "", "is not a formula that can be read", "for example"),
    ("", "", "must be a formula", "for example"),
    ("x.real", "", "neither a number nor a name", "valid here"),
    ("x if x else 1", "", "neither a number nor a name", "valid here"),
    ("[k for k in x]", "", "neither a number nor a name", "valid here"),
    ("x % 2", "", "neither a number nor a name", "valid here"),
    ("sin(*x)", "", "neither a number nor a name", "valid here"),
    ("sin(x, 2)", "", "gives sin 2 numbers, and it takes 1", "sin(x)"),
    ("atan2(x)", "", "gives atan2 1 numbers, and it takes 2", "atan2(x, 2)"),
    ("1j", "", "is no finite number", "another number"),
    ("True", "", "is no finite number", "another number"),
    ("1e999", "", "is no finite number", "another number"),
    ("9" * 900, "", "is no finite number", "another number"),
    ("9" * 1001, "", "has 1,001 characters", "shorter"),
    ("+".join(["(x"] * 40) + ")" * 40, "", "is nested too deeply", "simpler"),
    ("(" * 300 + "x" + ")" * 300, "", "is not a formula|is nested", ""),
    ("z", "", "is a formula of z, and grid.dimension = 2", "leave z out"),
    ("t", "", 'has the name "t"', "valid here"),
    ("1 / (x - x)", "", "gives inf at x = 0.00225 m", "has a value there"),
    ("sqrt(-r)", "", "gives -?nan at x = 0.00225 m", "has a value there"),
    ("x", ', length = "s"', "is no unit of length", "mm"),
    ("x", ', unit = "mm"', "is no unit that fits m/s", "m/s"),
    ("x", ", unit = 3", "must be text", "m/s"),
    ("x", ', units = "m"', "is not a known key", 'did you mean "unit"'),
]


@pytest.mark.parametrize(("text", "more", "rule", "remedy"), BAD)
def test_one_sentence_names_key_and_remedy(text: str, more: str, rule: str, remedy: str) -> None:
    with pytest.raises(CaseError, match=rule) as caught:
        start(case(f'[0, {{ expression = "{text}"{more} }}]'))
    error = caught.value
    assert error.key.startswith("body.block.velocity[1]") and error.place.startswith("case.toml:")
    assert remedy in error.remedy and "\n" not in str(error)


def test_a_table_that_is_no_formula() -> None:
    with pytest.raises(CaseError, match="is not a known key"):
        case("[0, { sine = 3 }]")
    with pytest.raises(CaseError, match=r"velocity\[0\]\.expression is missing"):
        case("[{}, 0]")
    with pytest.raises(CaseError, match=r"velocity\[0\]\.expression = 3 must be a formula"):
        case("[{ expression = 3 }, 0]")
    with pytest.raises(CaseError, match="must have 2 numbers") as caught:
        case('[{ expression = "x" }, 0, 1]')
    assert '[{"expression": "x"}, 0.0, 1.0]' in str(caught.value)


def test_a_velocity_by_formulas() -> None:
    """Each component by itself; r is the distance from the mass centre."""
    x, v = start(case('[{ expression = "sin(x / 7)", length = "mm" }, { expression = "r" }]'))
    assert v[:, 0] == pytest.approx(np.sin(x[:, 0] / 0.007), rel=1e-14)
    assert v[:, 1] == pytest.approx(np.hypot(*(x - 0.007).T), rel=1e-12)


@pytest.mark.parametrize("dimension", [2, 3])
def test_a_spin_is_the_field_that_it_stands_for(dimension: int) -> None:
    """A rigid turn as a number, and as a formula of place for each component."""
    flat = dimension == 2
    field = ["-30 * (y - 0.007)", "30 * (x - 0.007)", "0 * z"][:dimension]
    tables = ", ".join(f'{{ expression = "{text}" }}' for text in field)
    _, by_field = start(case(f"[{tables}]", dimension=dimension))
    still = str([0] * dimension)
    _, by_spin = start(case(still, "30" if flat else "[0, 0, 30]", dimension))
    formula = '{ expression = "30 + 0 * x" }'
    _, by_formula = start(case(still, formula if flat else f"[0, 0, {formula}]", dimension))
    assert by_field == pytest.approx(by_spin, abs=1e-12)  # of the mean of 8000 places
    assert (by_formula == by_spin).all() and np.abs(by_spin).max() > 0.1


def test_a_spin_field() -> None:
    x, v = start(case("[1, 0]", '{ expression = "1000 * x" }'))
    arm = x - 0.007
    assert v[:, 0] == pytest.approx(1 - 1000 * x[:, 0] * arm[:, 1], rel=1e-12)
    assert v[:, 1] == pytest.approx(1000 * x[:, 0] * arm[:, 0], rel=1e-12)


def test_grains_have_the_field_at_their_places() -> None:
    text = CASE.partition("[body.block]")[0].format(dimension=2)
    text += """
    [grains.sand]
    material = "soft"
    frame = "updated"
    lattice = { lower = [0, 0], count = [3, 1], radius = "2 mm" }
    velocity = [{ expression = "100 * x" }, { expression = "1 / (0.014 - x)" }]
    angular_velocity = { expression = "r" }
    """
    simulation = Simulation(Case.from_text(text.replace("1 / (0.014 - x)", "0")), threads=1)
    for name in simulation.bodies:
        x = simulation.column(name, "position")
        arm = x - x.mean(axis=0)
        wanted = 100 * x[:, 0] - np.hypot(*arm.T) * arm[:, 1]
        assert simulation.column(name, "velocity")[:, 0] == pytest.approx(wanted, rel=1e-12)
    with pytest.raises(CaseError, match="gives inf at x = ") as caught:
        Simulation(Case.from_text(text.replace("0.014", repr(x[0, 0].item()))))
    assert caught.value.key == "grains.sand.velocity[1].expression"


def test_the_hash_is_that_of_the_formula() -> None:
    hashes = {
        case(f'[{{ expression = "{text}"{more} }}, 0]').case_hash
        for text, more in [("2*x", ""), (" 2 * x ", ', unit = "m/s"'), ("2*y", "")]
    }
    assert len(hashes) == 2


def test_a_prescribed_body_has_no_field() -> None:
    text = CASE.format(
        dimension=2, velocity='[{ expression = "x" }, 0]', spin="0", lower=[0, 0], upper=[1, 1]
    )
    with pytest.raises(CaseError, match="must not be given together with motion"):
        Case.from_text(text.replace("[body.block]", '[body.block]\nmotion = "fixed"'))

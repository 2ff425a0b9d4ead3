# SPDX-License-Identifier: BSD-3-Clause
"""Bodies on nodes of their own that are bonded: by springs between their surfaces."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from cases import HUNG
from in_body import CELL, SPEED, blocks, energies, frame_tables, period, run_to_end
from mpm3dpp import Case, CaseError, Simulation, _core, run_case
from same_bits import check_same_bits
from worlds import check_worlds

BONDED = {"pair": [{"bodies": ["a", "b"], "bonded": True}]}


def bar(cells: int, cut: int | None, contact: Any = None) -> dict[str, Any]:
    """Return a free bar in its first mode, 4 cells thick; whole, or cut and bonded."""
    length = cells * CELL

    def part(begin: int, end: int) -> dict[str, Any]:
        return {
            "material": "m",
            "frame": "material",
            "shape": {"box": {"lower": [begin * CELL, 0.0], "upper": [end * CELL, 4 * CELL]}},
            "velocity": [{"expression": f"cos({np.pi / length} * x)"}, 0.0],
        }

    tables = frame_tables(2, part(0, cut or cells), 10.0 * 2.0 * length / SPEED, nu=0.0)
    if cut is not None:
        tables["body"]["b"] = part(cut, cells)
        tables["contact"] = contact or BONDED
    return tables


def first_period(tables: dict[str, Any]) -> float:
    case = Case.model_validate(tables)
    simulation = Simulation(case)
    length = max(float(simulation.column(name, "position")[:, 0].max()) for name in case.body)
    names = list(case.body)

    def column(name: str) -> np.ndarray:
        return np.concatenate([simulation.column(body, name)[:, 0] for body in names])

    form = np.cos(np.pi / length * column("position"))
    columns, (times, values) = run_to_end(
        simulation, 2, lambda _: float((form * column("velocity")).mean())
    )
    total = energies(columns) + columns["springs"] / columns["kinetic"][0]
    assert np.abs(total - 1.0).max() < 2e-3
    assert np.abs(columns["residual"]).max() < 1e-12 * columns["kinetic"][0]
    return period(times, values)


@pytest.mark.parametrize("cells", [24, 12])
def test_a_bond_bears_as_half_a_cell_more(cells: int) -> None:
    """Of a bar cut in the middle, where it bears most: that of one half a cell longer, for which
    the springs stand, a quarter of each part."""
    whole, cut = first_period(bar(cells, None)), first_period(bar(cells, cells // 2))
    assert cells * (cut / whole - 1.0) == pytest.approx(0.5, abs=0.05)
    among = {"pair": [{"materials": ["m", "m"], "bonded": True}]}
    assert first_period(bar(cells, cells // 2, among)) == pytest.approx(cut, rel=1e-9)


def test_what_hangs_pulls_with_its_weight() -> None:
    """From a body held by its motion, 32 N/m within 1 %, as in the updated frame."""
    text = HUNG.replace('material = "soft"', 'material = "soft"\nframe = "material"')
    text = text.replace(
        'frame = "material"\nshape = { box = { lower = [-0.1', "shape = { box = { lower = [-0.1"
    )
    hung = Simulation(Case.from_text(text))
    hung.advance(10**6)
    (pair,) = hung.core.contact_pairs()
    assert pair.force == pytest.approx((0.0, -32.0, 0.0), abs=0.32)  # on the roof
    assert 0.0 < -hung.column("lamp", "position")[:, 1].max() < 0.0026


def test_a_bond_is_no_first_contact(tmp_path: Path) -> None:
    run_case(Case.model_validate(bar(12, 6)), tmp_path, threads=1)
    names = [path.name for path in tmp_path.glob("*.png")]
    assert "frame.png" in names and "first_contact.png" not in names


def angular_momentum(simulation: Simulation) -> float:
    """Of all bodies about the origin, along z [N m s]."""
    totals = simulation.core.part_sums()[0]
    return float(totals[list(_core.total_columns).index("angular_momentum_z")])


@pytest.mark.parametrize("rigid", [False, True])
def test_bonded_bodies_spin_as_one(rigid: bool) -> None:
    """Two turns: momentum, angular momentum and energy stay, and the two stay together."""
    spin, case = 500.0, bar(12, 6)
    for body in case["body"].values():
        body["velocity"] = [{"expression": f"-{spin} * y"}, {"expression": f"{spin} * x"}]
    case["run"]["end_time"] = 2.0 * 2.0 * np.pi / spin
    if rigid:
        case["material"]["r"] = {"density": 3000.0, "strength": {"rigid": {}}}
        case["body"]["b"] = {k: v for k, v in case["body"]["b"].items() if k != "frame"}
        case["body"]["b"]["material"] = "r"
    simulation = Simulation(Case.model_validate(case))
    start = angular_momentum(simulation)
    columns, _ = run_to_end(simulation, 100)
    energy = columns["kinetic"] + columns["internal"] + columns["springs"]
    assert np.abs(energy / energy[0] - 1.0).max() < 2e-3
    for axis in "xy":
        momentum = columns[f"momentum_{axis}"]
        assert np.abs(momentum - momentum[0]).max() < 1e-11 * np.abs(columns["momentum_y"][0])
    assert angular_momentum(simulation) == pytest.approx(start, rel=1e-10)
    places = [simulation.column(name, "position") for name in ("a", "b")]
    gap = np.min(np.linalg.norm(places[0][:, None] - places[1][None], axis=2))
    assert gap == pytest.approx(0.5 * CELL, rel=0.05)


def test_bodies_that_do_not_touch_are_not_bonded() -> None:
    case = bar(12, 6)
    case["body"]["b"]["shape"]["box"]["lower"] = [6.3 * CELL, 0.0]
    with pytest.raises(CaseError, match=r"pair\[0\].bonded of a and b, .* apart, holds nothing"):
        Simulation(Case.model_validate(case))


def bonded_blocks(dimension: int) -> Case:
    """Three blocks, one rigid, of which the first two and the last two are bonded; on a wall."""
    pairs = "".join(
        f'[[contact.pair]]\nbodies = ["{a}", "{b}"]\nbonded = true\n'
        for a, b in (("one", "two"), ("two", "three"))
    )
    return Case.from_text(blocks(dimension).replace("[material.soft]", f"{pairs}[material.soft]"))


@pytest.mark.parametrize("dimension", [2, 3])
def test_another_world_is_the_same(dimension: int) -> None:
    check_worlds(bonded_blocks(dimension), 150 if dimension == 2 else 60, "", meet=False)


@pytest.mark.parametrize("dimension", [2, pytest.param(3, marks=pytest.mark.slow)])
def test_the_same_bits(dimension: int, tmp_path: Path) -> None:
    """With any number of threads, stages fused or not, and after a restart."""
    check_same_bits(bonded_blocks(dimension), tmp_path)

# SPDX-License-Identifier: BSD-3-Clause
"""What `mpm3dpp bench` counts: bytes that a step moves, and its operations."""

import pytest

from mpm3dpp import _core, bench
from mpm3dpp.bench import Numerics, cases, operations, report, traffic


def test_what_is_not_counted_is_said(capsys):
    result = bench.measure("elastic2d", 4, steps=2, numerics=Numerics(transfer="xpic"))
    assert result["bandwidth_fraction"] is None and result["arithmetic_fraction"] is None
    report.show(result)
    report.show_series([result, result])
    shown = capsys.readouterr().out
    assert 'bandwidth  not counted for transfer = "xpic"' in shown
    assert 'arithmetic not counted for transfer = "xpic"' in shown
    assert set(_core.transfers) - set(operations.TAKES) == {"xpic"}


@pytest.mark.parametrize("dimension", [2, 3])
def test_columns_of_the_traffic_are_those_of_the_core(dimension):
    name = "elastic3d" if dimension == 3 else "elastic2d"
    simulation = cases.make(cases.BENCHES[name], size=2, numerics=Numerics(frame="updated"))
    components = {column.name: column.components for column in simulation.columns(0)}
    used = {c for parts in traffic.STAGES.values() for part in parts for c in part}
    assert components.pop("affine_velocity") == traffic.numbers("affine part", dimension)
    used.remove("affine part")
    assert {column: traffic.numbers(column, dimension) for column in used} == components


def test_operations_are_those_of_the_stages():
    """Whatever is fused, the operations are those of the single stages, but for those shared."""

    def made(*stages):
        return operations.operations_per_particle_step(stages, 3, "linear", "flip", "elastic")

    single = made("map momentum", "map forces")
    assert sum(single.values()) == made("map momentum and forces")["map momentum and forces"]
    assert single["map momentum"] == 8 * (2 + 2 + 6)  # N_ip, m N_ip, m v N_ip of eight nodes
    assert made("advance nodes") == {"advance nodes": 0}
    both = made("advance particles", "move particles")
    shared = 8 * 2  # N_ip
    assert sum(both.values()) == made("advance and move particles").popitem()[1] + shared


def test_operations_and_traffic_of_an_affine_part_by_hand():
    """In the plane with the quadratic B-spline: nine nodes, and C_p of four numbers."""
    stages = ["map momentum", "advance particles", "move particles"]
    made = {
        word: operations.operations_per_particle_step(
            stages, 2, "quadratic_bspline", word, "elastic"
        )
        for word in ("flip", "pic", "apic", "aflip")
    }
    momentum, take, move = (
        {word: counts[stage] for word, counts in made.items()} for stage in stages
    )
    # N_ip, m N_ip and its sum, and two components; then C_p (x_i - x_p): 4 products and sums.
    assert momentum["flip"] == momentum["pic"] == 9 * (1 + 2 + 4)
    assert momentum["apic"] == momentum["aflip"] == momentum["flip"] + 9 * 8
    assert take["pic"] == 9 * (1 + 4) and take["flip"] == take["pic"] + 2
    assert take["apic"] == take["pic"] + 9 * 8 + 4  # C_p, and the division by its second moment
    assert take["aflip"] == take["apic"] + 9 * 4 + 2 * 4  # dv, and alpha of two components
    assert move["flip"] == 9 * (1 + 4) + 4
    # C : C; C C and its transpose, symmetric; what it takes from C_p.
    assert move["aflip"] == move["flip"] + 8 + 24 + 8

    moved = {
        word: traffic.bytes_per_particle_step(stages, 2, word) for word in ("flip", "pic", "aflip")
    }
    assert moved["pic"] == moved["flip"]
    more = {stage: moved["aflip"][stage] - moved["flip"][stage] for stage in stages}
    # It is read to be mapped, and read and written by each of the others.
    size = {"float64": 8, "float32": 4}[_core.build_info()["velocity_and_stress"]]
    assert list(more.values()) == [4 * size, 2 * 4 * size, 2 * 4 * size]


def test_operations_of_every_stage_of_particles_are_counted():
    for stage in traffic.STAGES:
        made = operations.operations_per_particle_step([stage], 2, "gimp", "flip", "elastic")[stage]
        assert (made > 0) == traffic.moves_particles(stage)
    with pytest.raises(KeyError):
        operations.operations_per_particle_step(["dance"], 2, "gimp", "flip", "elastic")


def test_arithmetic_of_the_machine_is_that_of_a_processor():
    """One thread makes more than a hundred million and less than ten million million."""
    assert 0.1 < _core.measure_arithmetic(1) < 1e4

# SPDX-License-Identifier: BSD-3-Clause
"""What a finished run prints."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import pytest

from mpm3dpp.io.records import ContactRecord
from mpm3dpp.run.report import body_lines, contact_table, energy_line, warning_lines


def manifest(initial: dict[str, float], final: dict[str, float]) -> Any:
    zero = dict.fromkeys(("kinetic", "internal", "external", "numerical", "contact"), 0.0)
    energies = {"initial": {**zero, **initial}, "final": {**zero, **final}}
    return SimpleNamespace(energies=energies, case={})


@pytest.mark.parametrize(
    ("initial", "final", "words"),
    [
        (
            {"kinetic": 100.0},
            {"numerical": 2.0, "contact": -1.0},
            "numerical terms lost 2.00%, contact made 1.00% of what came in",
        ),
        ({}, {"external": -50.0, "numerical": -1.0}, "made 2.00% of what came in"),
        # A gas or an explosive brings its energy with it.
        ({"internal": 400.0}, {"numerical": 2.0}, "lost 0.50% of the energy at the start"),
        ({"internal": 300.0, "kinetic": 100.0}, {"numerical": 2.0}, "lost 0.50% of the energy"),
        # A plate with little internal energy at the start is judged by its motion.
        ({"internal": 10.0, "kinetic": 100.0}, {"numerical": 2.0}, "lost 2.00% of what came in"),
        ({}, {}, "none came in"),
    ],
)
def test_share_of_energy(initial: dict[str, float], final: dict[str, float], words: str) -> None:
    assert words in energy_line(manifest(initial, final))


def test_work_that_has_gone_out_again_came_in() -> None:
    """A load that a body springs back against ends with little work; the most of it counts."""
    found = manifest({}, {"external": 10.0, "numerical": -1.0})
    found.energies["external_max"] = 100.0
    assert "made 1.00% of what came in" in energy_line(found)


def test_three_warnings_of_a_kind_are_shown() -> None:
    """A hundred bodies may lie outside; what is only a note has been told already."""
    left = [
        SimpleNamespace(kind="outside walls", message=f"grain {k}", count=2, is_error=True)
        for k in range(100)
    ]
    note = SimpleNamespace(kind="left box", message="one left", count=9, is_error=False)
    step = SimpleNamespace(kind="time step", message="it fell", count=7, is_error=True)
    found: Any = SimpleNamespace(warnings=[*left, note, step])
    lines = warning_lines(found)
    assert lines == [
        *(f"warning: grain {k}; seen 2 times" for k in range(3)),
        "warning: it fell; seen 7 times",
        "warning: 97 more of outside walls, in manifest.json",
    ]


def test_what_restitution_has_taken() -> None:
    """It is told apart; in runs of older versions it is in `contact`, which is no error there."""
    found = manifest({"kinetic": 100.0}, {"kinetic": 36.0, "restitution": 64.0})
    assert energy_line(found).endswith("; restitution has taken 64.00%")
    old = manifest({"kinetic": 100.0}, {"kinetic": 36.0, "contact": 64.0})
    assert energy_line(old).startswith("warning: ")
    old.case = {"contact": {"restitution": 0.6}}
    assert energy_line(old).startswith("energy: ")


def test_what_pic_takes_is_no_reason_for_smaller_steps() -> None:
    told = manifest({"kinetic": 100.0}, {"kinetic": 50.0, "numerical": 50.0})
    assert energy_line(told).endswith("; a smaller run.cfl or smaller cells may help")
    told.case = {"run": {"transfer": "pic"}, "body": {"a": {"material": "m"}}}
    assert energy_line(told).endswith("; what run.transfer takes is in it")


def test_where_no_node_lies_in_space_no_transfer_takes_anything() -> None:
    """Bodies that do not deform have none either, free ones and those that are moved."""
    told = manifest({"kinetic": 100.0}, {"kinetic": 99.0, "numerical": 1.0})
    soft = {"material": "soft", "frame": "material"}
    table: dict[str, Any] = {
        "run": {"transfer": "aflip"},
        "material": {"soft": {"strength": {"elastic": {}}}, "stone": {"strength": {"rigid": {}}}},
        "body": {"a": soft, "b": {"material": "stone"}, "c": {"material": "soft", "motion": {}}},
        "grains": {"all": soft},
    }
    told.case = table
    assert "run.transfer" not in energy_line(told)
    told.case = {**table, "grains": {"all": {"material": "soft"}}}
    assert energy_line(told).endswith("; what run.transfer takes is in it")


def of_body(
    velocity: tuple[float, float, float], kinetic: float, eroded: float = 0.0
) -> dict[str, float]:
    return {
        **dict(zip(("velocity_x", "velocity_y", "velocity_z"), velocity, strict=True)),
        "kinetic": kinetic,
        "eroded_mass": eroded,
    }


def test_a_line_for_each_body_that_moves_freely() -> None:
    ball = {
        "initial": of_body((0, 0, -800), 3200.0),
        "final": of_body((321, 1e-11, -537), 1957.3, 2e-3),
    }
    rest = {"initial": of_body((0, 0, 0), 0.0), "final": of_body((0, 0, -1e-3), 1e-9)}
    case = {"body": {"tool": {"motion": {}}, "ball": {"motion": None}}}
    found: Any = SimpleNamespace(bodies={"ball": ball, "tool": rest, "plate": rest}, case=case)
    assert body_lines(found) == [
        "ball: 800 -> 625.6 m/s (321, 0, -537), kinetic energy 3200 -> 1957 J, eroded 0.002 kg",
        "plate: 0 -> 0.001 m/s (0, 0, -0.001), kinetic energy 0 -> 1e-09 J",
    ]
    case["grid"] = {"dimension": 2}
    assert (
        body_lines(found)[0]
        == "ball: 0 -> 321 m/s (321, 0), kinetic energy 3200 -> 1957 J/m, eroded 0.002 kg/m"
    )
    found.bodies = {f"grain {k}": rest for k in range(12)}
    assert body_lines(found)[-1] == "... and 2 more bodies, in manifest.json"
    assert len(body_lines(found)) == 11


def test_spins_are_told_of_whole_bodies_that_turn() -> None:
    """A disc that has begun to roll; rounding at the start is none."""

    def rolls(spin: float, angular_momentum: float, kinetic: float) -> dict[str, float]:
        found = of_body((kinetic, 0, 0), kinetic)
        for name, last in (("spin", spin), ("angular_momentum", angular_momentum)):
            found |= {f"{name}_x": 0.0, f"{name}_y": 0.0, f"{name}_z": last}
        return found

    disc = {"initial": rolls(1e-14, 0.0, 0.0), "final": rolls(-20.0, -0.02, 1.0)}
    case: dict[str, Any] = {"grid": {"dimension": 2}}
    found: Any = SimpleNamespace(bodies={"disc": disc}, case=case)
    [line] = body_lines(found)
    assert line == "disc: 0 -> 1 m/s (1, 0), spin 0 -> -20 rad/s, kinetic energy 0 -> 1 J/m"
    case["grid"] = {"dimension": 3}
    assert "spin 0 -> 20 rad/s (0, 0, -20)" in body_lines(found)[0]
    case["grid"]["box"] = {"walls": {"x_min": "slip"}}  # half of it, before a plane of symmetry
    assert "spin" not in body_lines(found)[0]
    case["grid"].clear()
    disc["final"] = rolls(-1e-3, -1e-6, 1.0)
    assert "spin" not in body_lines(found)[0]


@pytest.mark.parametrize(
    ("response", "bodies", "time", "is_said"),
    [
        ("impulses", 8, 95, True),
        ("impulses", 4, 95, False),
        ("impulses", 8, 50, False),
        ("springs", 8, 95, False),
    ],
)
def test_sweeps_of_impulses_that_take_the_time_are_told(
    response: str, bodies: int, time: int, is_said: bool
) -> None:
    """The remedy is in the same sentence."""
    contact = ContactRecord(bodies=9, overlapped_nodes_max=1, bodies_per_node_max=bodies)
    given = SimpleNamespace(
        contact=contact,
        stages={"contact forces": time, "others": 100 - time},
        case={"contact": {"response": response}},
        cell_size=1.0,
    )
    said = [line for line in contact_table(given) if "sweeps" in line]  # type: ignore[arg-type]
    assert bool(said) == is_said
    if said:
        assert said[0].startswith(
            "warning: contact took 95% of the step's time: nodes with up to 8"
        )
        assert 'give contact.response = "springs"' in said[0]

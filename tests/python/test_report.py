# SPDX-License-Identifier: BSD-3-Clause
"""What a finished run prints."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import pytest

from mpm3dpp.run.report import energy_line, warning_lines


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


def test_what_pic_takes_is_no_reason_for_smaller_steps() -> None:
    told = manifest({"kinetic": 100.0}, {"kinetic": 50.0, "numerical": 50.0})
    assert energy_line(told).endswith("; a smaller run.cfl or smaller cells may help")
    told.case = {"run": {"transfer": "pic"}}
    assert energy_line(told).endswith("; what run.transfer takes is in it")

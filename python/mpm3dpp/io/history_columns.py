# SPDX-License-Identifier: BSD-3-Clause
"""What the columns of `history.csv` are: the source of docs/reference/history.md."""

from __future__ import annotations

MEANINGS: dict[str, tuple[str, str]] = {
    "step": ("1", "steps made"),
    "time": ("s", "reached after the step"),
    "dt": ("s", "the step's length; 0 at the start"),
    "kinetic": ("J", "kinetic energy"),
    "internal": ("J", "energy in the material but for what `plastic` and `viscous` hold"),
    "plastic": ("J", "work of plastic and viscous flow so far"),
    "viscous": ("J", "work of artificial viscosity so far"),
    "friction": ("J", "work of friction so far"),
    "contact": ("J", "energy that normal contact has lost, negative: made; an error"),
    "external": ("J", "work so far of gravity, loads and prescribed motions"),
    "absorbed": ("J", "energy that absorbing walls have taken up"),
    "eroded": ("J", "kinetic and recoverable energy that eroded particles took with them"),
    "left": ("J", "the same of particles that left `grid.keep`"),
    "bounded": ("J", "energy that the bounds of equations of state have taken, negative: given"),
    "numerical": ("J", "energy that the method has lost, negative: made; an error"),
    "residual": ("J", "what the terms above leave unexplained: rounding"),
    "momentum_x": ("N s", "momentum of the particles that take part"),
    "momentum_y": ("N s", "likewise"),
    "momentum_z": ("N s", "likewise; 0 in 2D"),
    "numerical_mapping": ("J", "the part of `numerical` that mapping to nodes and back has"),
    "numerical_time": ("J", "its other part, of the integration in time"),
    "load_work": ("J", "the part of `external` that loads on surfaces have done"),
    "cell_size": ("m", "edge of the cells; it grows where `grid.doubling` is given"),
    "tiles": ("1", "tiles of 4 x 4 x 4 cells (8 x 8 in 2D) in use, those of each body counted"),
    "motion_work": ("J", "the part of `external` that prescribed motions have done"),
    "motion_impulse_x": ("N s", "impulse that prescribed motions have given"),
    "motion_impulse_y": ("N s", "likewise"),
    "motion_impulse_z": ("N s", "likewise; 0 in 2D"),
    "energy_floor": ("J", "the part of `bounded` that energies below absolute zero were given"),
}
"""Unit and meaning of each column of every run, in their order."""

PAIR_MEANINGS: dict[str, tuple[str, str]] = {
    "contact_force_A_B_x": ("N", "force of the step on body A from body B; `_y`, `_z` follow"),
    "contact_impulse_A_B_x": ("N s", "its impulse so far; `_y`, `_z` follow"),
}
"""Likewise, for each pair of bodies A and B of a run with contact."""

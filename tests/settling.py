# SPDX-License-Identifier: BSD-3-Clause
"""A block that settles on a wall, and a hammer in the air above it."""

from __future__ import annotations

HIT = """
title = "settle, then hit"
[grid]
dimension = 2
cell_size = "10 mm"
box = { lower = ["-200 mm", 0], upper = ["200 mm", "600 mm"], walls = { y_min = "contact" } }
[run]
end_time = "10 ms"
gravity = [0, "-9.81 m/s^2"]
settle = { longest = "0.2 s" }
[material.rubber]
density = "1000 kg/m^3"
strength = { elastic = { E = "1 MPa", nu = 0.3 } }
[material.iron]
density = "7800 kg/m^3"
strength = { rigid = {} }
[body.block]
material = "rubber"
shape = { box = { lower = ["-100 mm", 0], upper = ["100 mm", "60 mm"] } }
"""
HAMMER = """
[body.hammer]
material = "{material}"
shape = {{ box = {{ lower = ["-50 mm", "400 mm"], upper = ["50 mm", "450 mm"] }} }}
{motion}
"""
FALL = 'velocity = [0, "-5 m/s"]'


def hammer(motion: str = FALL, material: str = "rubber", more: str = "") -> str:
    """Return a block that settles on a wall, and a hammer in the air above it."""
    return HIT + HAMMER.format(material=material, motion=motion) + more


ONLY_LOAD = """
[load.push]
body = "hammer"
side = "y_max"
pressure = "1 kPa"
"""

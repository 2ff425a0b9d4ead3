# SPDX-License-Identifier: BSD-3-Clause
"""Bodies that are drawn into each other: what is said of it, and the stress of a press fit."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from mpm3dpp import Case, CaseError, Simulation, load_case
from mpm3dpp.fill.advisories import notes
from mpm3dpp.fill.build import build

HEAD = """
[grid]
dimension = 2
cell_size = "10 mm"
[run]
end_time = "0.1 s"
[material.e]
density = 1000
strength = { elastic = { E = "1 MPa", nu = 0.3 } }
"""
BLOCKS = (
    HEAD
    + """
[body.a]
material = "e"
shape = { box = { lower = ["-100 mm", "0 mm"], upper = ["0 mm", "60 mm"] } }
[body.b]
material = "e"
shape = { box = { lower = ["-2 mm", "0 mm"], upper = ["96 mm", "60 mm"] } }
"""
)
DISCS = (
    HEAD
    + """
[body.a]
material = "e"
shape = { disc = { centre = [0, 0], radius = "60 mm" } }
[body.b]
material = "e"
shape = { disc = { centre = ["119 mm", 0], radius = "60 mm" } }
"""
)
PLUG = (
    HEAD
    + """
[body.a]
material = "e"
shape = { difference = [
  { box = { lower = ["-100 mm", "-100 mm"], upper = ["100 mm", "100 mm"] } },
  { box = { lower = ["-40 mm", "-40 mm"], upper = ["40 mm", "40 mm"] } } ] }
[body.b]
material = "e"
shape = { box = { lower = ["-40.5 mm", "-40 mm"], upper = ["40 mm", "40 mm"] } }
"""
)
SETTLED = '[run.settle]\nlongest = "0.1 s"\n'
PRESSED = '[contact]\ninterference = "pressed"\n'


DRAWN = {"blocks": (BLOCKS, 0.002), "discs": (DISCS, 0.001), "plug": (PLUG, 0.0005)}


@pytest.mark.parametrize(("text", "depth"), DRAWN.values(), ids=DRAWN)
def test_no_interference_is_set_back_without_a_word(text: str, depth: float) -> None:
    simulation = Simulation(Case.from_text(text), threads=1)
    [note] = [note for note in simulation.notes if "drawn" in note]
    assert f"body.b is drawn {depth:.3g} m into body.a" in note
    assert 'contact.interference = "pressed"' in note
    for body in build(simulation.case):
        assert body.mass_error == pytest.approx(0.0, abs=1e-9)  # Nothing is cut away.
    simulation.advance(50)
    assert np.abs(simulation.column("a", "stress")).max() < 1e-6 * 1e6


def test_what_touches_or_is_bonded_has_no_interference() -> None:
    for text in (
        BLOCKS.replace('"-2 mm"', '"0 mm"'),
        DISCS.replace('"119 mm"', '"120 mm"'),
        BLOCKS + '[[contact.pair]]\nbodies = ["a", "b"]\nbonded = true\n',
    ):
        assert build(Case.from_text(text)).interferences == []


def test_what_fills_the_same_place_is_refused() -> None:
    """Whether or not particles happen to be near each other: here rows lie between rows."""
    with pytest.raises(CaseError, match=r"body\.b\.shape overlaps body\.a"):
        build(Case.from_text(BLOCKS.replace('"-2 mm"', '"-22.5 mm"')))


def test_pressed_is_for_springs_and_runs_that_settle() -> None:
    with pytest.raises(CaseError, match="is for contact by springs"):
        Case.from_text(BLOCKS + PRESSED + 'response = "impulses"\n')
    with pytest.raises(CaseError, match="needs a run that settles"):
        Case.from_text(BLOCKS + PRESSED)


SLOT = 'box = { lower = ["-100 mm", 0], upper = ["96 mm", "60 mm"], walls = "slip" }\n'


def pressure(text: str) -> float:
    """Return the mean pressure along x of two blocks in a slot when they have come to rest [Pa]."""
    text = text.replace("10 mm", "4 mm").replace("-2 mm", "-1 mm")
    text = text.replace("[run]", SLOT + '[run]\nsettle = { longest = "0.2 s" }')
    simulation = Simulation(Case.from_text(text), threads=1)
    while simulation.time < 0.0:
        simulation.advance(64, 0.0)
    return float(np.mean([-simulation.column(b, "stress")[:, 0].mean() for b in "ab"]))


def test_pressed_blocks_have_the_stress_of_the_excess() -> None:
    """197 mm of blocks in a slot of 196 mm that holds all sides: M / 197, M = 1.346 MPa.

    The springs of the contact are as soft as two edges of particles, 4 mm of these 197.
    """
    exact = 1e6 * 0.7 / (1.3 * 0.4) * 0.001 / 0.197
    assert pressure(BLOCKS + PRESSED) == pytest.approx(exact, rel=0.03)
    pair = '[[contact.pair]]\nbodies = ["a", "b"]\ninterference = "pressed"\n'
    assert pressure(BLOCKS + pair) == pytest.approx(exact, rel=0.03)


def test_what_flows_is_not_pressed_without_a_word() -> None:
    """A gas has no springs against what holds it."""
    gas = "strength = { fluid = {} }\neos = { ideal_gas = { gamma = 1.4, E0 = 2.5e5 } }"
    text = BLOCKS.replace("[body.b]", f"[material.air]\ndensity = 1.2\n{gas}\n[body.b]")
    start = text.index("[body.b]")
    air = text[:start] + text[start:].replace('"e"', '"air"')
    air = air.replace("[run]", "[run]\ngravity = [0, -1]")
    case = Case.from_text(air + SETTLED + PRESSED)
    [found] = build(case).interferences
    assert not found.pressed
    [note] = [note for note in notes(case, build(case)) if "is drawn" in note]
    assert "makes no stress: one of them flows, and their approach is stopped" in note


def test_what_is_drawn_beyond_a_wall_is_said() -> None:
    walls = 'box = { lower = ["-110 mm", 0], upper = ["110 mm", "100 mm"], walls = WALLS }\n'
    text = BLOCKS.replace('"-2 mm"', '"0 mm"').replace(
        '"0 mm"], upper = ["96', '"-1 mm"], upper = ["96'
    )
    text = text.replace("[run]", walls + "[run]")

    def told(kind: str, case: str) -> list[str]:
        found = Case.from_text(case.replace("WALLS", kind))
        return [note for note in notes(found, build(found)) if "beyond" in note]

    for kind in ('{ y_min = "contact" }', '{ y_min = "slip" }'):
        [note] = told(kind, text)
        assert note.startswith("body.b is drawn 0.001 m beyond grid.box.walls.y_min")
        assert told(kind, text + "cut_at_box = true\n") == []
    assert told("{ }", text) == []


FIT = """
[grid]
dimension = 2
cell_size = "1 mm"
[run]
end_time = "1 us"
settle = { longest = "0.3 ms" }
[material.steel]
density = "7850 kg/m^3"
strength = { elastic = { E = "210 GPa", nu = 0.3 } }
[body.shaft]
material = "steel"
shape = { disc = { centre = [0, 0], radius = "10.05 mm" } }
[body.hub]
material = "steel"
shape = { ring = { centre = [0, 0], inner_radius = "10 mm", outer_radius = "20 mm" } }
[contact]
interference = "pressed"
"""


def test_a_press_fit_has_the_pressure_of_lame() -> None:
    """A shaft 0.05 mm larger on the radius than its hub (plane strain): 433 MPa (394 in plane
    stress), and what Lame's solution has of it within the hub. The springs take up the depth of
    p / (rho c^2) of an edge on each side, 2 % of it.
    """
    simulation = Simulation(Case.from_text(FIT), threads=1)
    while simulation.time < 0.0:
        simulation.advance(200, 0.0)
    modulus, nu, a, b = 210e9 / (1 - 0.3**2), 0.3 / (1 - 0.3), 0.01, 0.02
    hub = (b**2 + a**2) / (b**2 - a**2) + nu
    pressure = modulus * 5e-5 / a / (hub + 1 - nu)
    assert pressure == pytest.approx(432.7e6, rel=1e-3)
    x, stress = simulation.column("shaft", "position"), simulation.column("shaft", "stress")
    inner = np.hypot(*x[:, :2].T) < 0.008
    assert -0.5 * stress[inner, :2].sum(axis=1).mean() == pytest.approx(pressure, rel=0.05)
    x, stress = simulation.column("hub", "position"), simulation.column("hub", "stress")
    radius = np.hypot(*x[:, :2].T)
    ring = (radius > 0.012) & (radius < 0.016)
    e = x[:, :2] / radius[:, None]
    radial = stress[:, 0] * e[:, 0] ** 2 + stress[:, 1] * e[:, 1] ** 2
    radial += 2 * stress[:, -1] * e[:, 0] * e[:, 1]
    lame = -pressure * a**2 / (b**2 - a**2) * (b**2 / radius**2 - 1)
    assert radial[ring].mean() == pytest.approx(lame[ring].mean(), rel=0.05)


def test_points_are_not_pressed_without_a_word(tmp_path: Path) -> None:
    """A body of particles has no surface that is drawn: no interference is known of it."""
    points = "x,y\n" + "".join(f"{-0.0975 + 0.005 * k},0.0025\n" for k in range(21))
    (tmp_path / "points.csv").write_text(points)
    start, end = BLOCKS.index("shape"), BLOCKS.index("[body.b]")
    text = BLOCKS[:start] + 'particles = "points.csv"\nspacing = "5 mm"\n' + BLOCKS[end:]
    file = tmp_path / "case.toml"
    file.write_text(text + SETTLED + PRESSED)
    with pytest.raises(CaseError, match=r"needs a force .* none is drawn into another"):
        build(load_case(file))
    file.write_text(text.replace("[run]", "[run]\ngravity = [0, -1]") + SETTLED + PRESSED)
    case = load_case(file)
    [note] = [note for note in notes(case, build(case)) if "one by one" in note]
    assert note.startswith('contact.interference = "pressed" does not hold for body.a')
    pair = '[[contact.pair]]\nbodies = ["a", "b"]\ninterference = "pressed"\n'
    file.write_text(text + SETTLED + pair)
    with pytest.raises(CaseError, match=r"contact\.pair\[0\]\.interference = .* body\.a has part"):
        load_case(file)

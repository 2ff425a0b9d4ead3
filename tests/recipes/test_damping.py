# SPDX-License-Identifier: BSD-3-Clause
"""Damping of motions against closed forms: fall with drag, decay of a mode, rest under gravity."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

from cases import BASES, SCHEMES
from mpm3dpp import Case, CaseError, Simulation
from mpm3dpp.fill.build import build
from mpm3dpp.run.summary import echo, time_step

LENGTH, SPEED_OF_SOUND = 0.2, math.sqrt(1000.0)  # [m], [m/s]: E = 1 MPa, 1000 kg/m^3, nu = 0
FREQUENCY = math.pi * SPEED_OF_SOUND / LENGTH  # of the first mode of a free bar [rad/s]

BAR = """
[grid]
dimension = 2
cell_size = "5 mm"
{grid}
[run]
scheme = "{scheme}"
end_time = "1 s"
{run}
[material.soft]
density = 1000
strength = {{ elastic = {{ E = "1 MPa", nu = 0 }} }}
{material}
[body.bar]
material = "soft"
shape = {{ box = {{ lower = [0, 0], upper = ["200 mm", "10 mm"] }} }}
{body}
"""
MODE = f'velocity = [{{ expression = "0.01 * cos(pi * x / {LENGTH})" }}, 0]'


def bar(scheme: str = "musl", **lines: str) -> Simulation:
    """Return a bar of 40 x 2 cells, filled as by default."""
    given = {"grid": "", "run": "", "material": "", "body": ""} | lines
    return Simulation(Case.from_text(BAR.format(scheme=scheme, **given)), threads=1)


def rows_to(simulation: Simulation, end: float) -> dict[str, np.ndarray]:
    """Advance to a time [s]; return the history, whose damping never gives and whose sum closes."""
    core, parts = simulation.core, []
    while simulation.time < end:
        simulation.advance(1000, end_time=end)
        parts.append(core.history())
    rows = dict(zip(core.history_columns, np.concatenate(parts).T, strict=True))
    size = np.abs([rows["kinetic"], rows["external"]]).max()
    # Sums over some hundred particles, exact but for the rounding of each term, over the steps.
    assert np.abs(rows["residual"]).max() <= 1e-12 * size
    assert np.diff(rows["damped"]).min() >= 0.0
    return rows


def peaks(rows: dict[str, np.ndarray]) -> tuple[np.ndarray, np.ndarray]:
    """Return times and values of the largest kinetic energies, of parabolas through three rows."""
    t, k = rows["time"], rows["kinetic"]
    wide = 20  # rows to each side: noise has no peaks of its own
    found = [n for n in range(wide, len(k) - wide) if k[n] == k[n - wide : n + wide + 1].max()]
    fits = [np.polyfit(t[n - 2 : n + 3] - t[n], k[n - 2 : n + 3], 2) for n in found]
    times = [t[n] - fit[1] / (2 * fit[0]) for n, fit in zip(found, fits, strict=True)]
    values = [fit[2] - fit[1] ** 2 / (4 * fit[0]) for fit in fits]
    return np.array(times), np.array(values)


@pytest.mark.parametrize("transfer", ["flip", "apic", "xpic"])
@pytest.mark.parametrize("scheme", SCHEMES)
def test_falls_with_drag(scheme: str, transfer: str) -> None:
    """v = g / alpha (1 - exp(-alpha t)), and the drag has taken what gravity gave beyond it."""
    alpha, g, end = 400.0, 10.0, 0.01
    grid = 'basis = "quadratic_bspline"' if transfer == "apic" else ""
    run = f'gravity = [0, {-g}]\ntransfer = "{transfer}"'
    sim = bar(scheme, grid=grid, run=run, body='damping = { mass = "400 1/s" }')
    rows = rows_to(sim, end)
    t = rows["time"]
    v = g / alpha * (1.0 - np.exp(-alpha * t))
    mass = sim.core.total_mass
    # The velocity of the middle of the step takes (1 - a) / (1 + a) of the velocity with a = alpha
    # dt / 2: exp(-2 a) but for a^3 2 / 3, so over the fall alpha t a^2 / 3 of it at most.
    a = 0.5 * alpha * rows["dt"].max()
    assert -rows["momentum_y"] == pytest.approx(mass * v, abs=mass * g / alpha * a**2 * 4 / 3)
    given = np.abs(rows["external"]).max()
    drag = (
        alpha
        * mass
        * (g / alpha) ** 2
        * (t - 2 * (1 - np.exp(-alpha * t)) / alpha + (1 - np.exp(-2 * alpha * t)) / (2 * alpha))
    )
    # Of the sum over the steps beside the integral, second order likewise.
    assert rows["damped"] == pytest.approx(drag, abs=given * 4 * a**2)
    assert rows["damped"][-1] > 0.3 * given  # it is a good part of all


def test_drag_as_a_function_of_time() -> None:
    """A bar that flies: v = v0 exp(-integral of alpha), here of a ramp, 1 in all; none after it."""
    damping = 'damping = { mass = { times = [0, "5 ms", "5.001 ms"], values = [0, 400, 0] } }'
    sim = bar(body=f"velocity = [3, 0]\n{damping}")
    rows = rows_to(sim, 0.008)
    v = rows["momentum_x"] / sim.core.total_mass
    # (alpha dt)^2 / 12 of alpha t = 1, the ramp's end being within a step or two.
    assert v[-1] == pytest.approx(3.0 * math.exp(-1.0002), rel=1e-3)
    assert v[-1] == pytest.approx(v[rows["time"] > 0.0055][0], rel=1e-12)


@pytest.mark.parametrize("rate", [20.0, 100.0])
@pytest.mark.parametrize("scheme", ["usf", "musl"])
def test_mass_damping_of_a_mode(scheme: str, rate: float) -> None:
    """A mode decays as exp(-alpha t / 2), whatever its frequency: its energy as exp(-alpha t)."""
    sim = bar(scheme, body=f"{MODE}\ndamping = {{ mass = {rate} }}")
    t, k = peaks(rows_to(sim, 0.03))
    assert len(t) >= 4
    found = -np.log(k[-1] / k[0]) / (t[-1] - t[0])
    # What the undamped bar loses by itself in this time is below a hundredth.
    assert found == pytest.approx(rate, abs=0.5)


@pytest.mark.parametrize("beta", ["40 us", "0.4 ms"])
@pytest.mark.parametrize("scheme", ["usf", "musl"])
def test_stiffness_damping_of_a_mode(scheme: str, beta: str) -> None:
    """A mode of the angular frequency w decays as exp(-beta w^2 t / 2)."""
    seconds = {"40 us": 4e-5, "0.4 ms": 4e-4}[beta]
    material = f'damping = {{ stiffness = "{beta}" }}'
    rows = rows_to(bar(scheme, material=material, body=MODE), 0.04)
    assert np.array_equal(rows["damped"], rows["damped_stiffness"])
    t, k = peaks(rows)
    assert len(t) >= 5
    found = -np.log(k[-1] / k[0]) / (t[-1] - t[0])
    # Cells of a fortieth of the bar, whose ends end within them: the frequency is theirs.
    assert found == pytest.approx(seconds * FREQUENCY**2, rel=0.03)


def test_stiffness_damping_is_a_stress_of_its_own() -> None:
    """A bar that is drawn out evenly: damping_stress is beta C : D, stress the elastic one."""
    body = 'velocity = [{ expression = "0.5 * x" }, { expression = "0.25 * y" }]'
    sim = bar("musl", material='damping = { stiffness = "0.1 ms" }', body=body)
    sim.advance(1)
    # E = 1 MPa and nu = 0: C : D = E D. Both are of the first step's D, inside the bar.
    inside = np.abs(sim.column("bar", "position")[:, 0] - LENGTH / 2) < LENGTH / 4
    rates = np.array([0.5, 0.25])
    dt = sim.time
    damping = sim.column("bar", "damping_stress")[inside, :2]
    stress = sim.column("bar", "stress")[inside, :2]
    # The strain of a step is of the order 1e-5, by which finite strains differ.
    assert damping[:, 0] == pytest.approx(1e-4 * 1e6 * rates[0] + 0 * damping[:, 0], rel=1e-9)
    assert stress[:, 0] == pytest.approx(1e6 * rates[0] * dt + 0 * damping[:, 0], rel=1e-4)


def test_with_averaged_volumes_it_is_of_the_shape() -> None:
    """The same bar: 2 beta G (D - tr D / 2), without trace; and the ledger closes."""
    body = 'velocity = [{ expression = "0.5 * x" }, { expression = "0.25 * y" }]'
    material = 'damping = { stiffness = "0.1 ms" }\nvolume_averaging = true'
    sim = bar("musl", material=material, body=body)
    sim.advance(1)
    inside = np.abs(sim.column("bar", "position")[:, 0] - LENGTH / 2) < LENGTH / 4
    damping = sim.column("bar", "damping_stress")[inside, :2]
    assert damping == pytest.approx(1e-4 * 1e6 * np.array([0.125, -0.125]) + 0 * damping, rel=1e-4)
    rows = rows_to(sim, 0.01)
    assert rows["damped_stiffness"][-1] > 0.01 * rows["kinetic"][0]
    assert np.abs(rows["residual"]).max() < 1e-12 * rows["kinetic"][0]


@pytest.mark.parametrize(("averages", "of_shape"), [("", 1.0), ("volume_averaging = true", 2 / 3)])
@pytest.mark.parametrize("beta", [1e-5, 1e-3])
def test_stiffness_damping_shortens_the_step(beta: float, averages: str, of_shape: float) -> None:
    """By sqrt(1 + xi^2) - xi with xi = beta c / h: the exact limit of central differences.

    (Belytschko, Liu & Moran 2000, eq. 6.2.25, for the largest frequency 2 c / h.) With averaged
    volumes 4 G / 3 counts in place of rho c^2, which is 2 G without contraction.
    """
    damped = f"damping = {{ stiffness = {beta} }}\n{averages}"
    steps = [bar(material=line).core.dt for line in ("", damped)]
    xi = of_shape * beta * SPEED_OF_SOUND / 0.005
    assert steps[1] / steps[0] == pytest.approx(math.sqrt(1.0 + xi**2) - xi, rel=1e-12)
    case = Case.from_text(lines_of("", material=damped))
    first = Simulation(case, threads=1).core.dt
    assert time_step(case, build(case)) == pytest.approx(first, rel=1e-12)  # `check` says so too


@pytest.mark.parametrize("scheme", ["usf", "musl"])
def test_stiffness_damping_is_stable(scheme: str) -> None:
    """Noise in a bar that is damped strongly, xi = 6.3, dies away with the step that is chosen."""
    sim = bar(scheme, run="cfl = 0.5", material='damping = { stiffness = "1 ms" }')
    velocity = np.random.default_rng(1).uniform(-1e-3, 1e-3, sim.column("bar", "velocity").shape)
    sim.set_velocity("bar", velocity)
    rows = rows_to(sim, 0.01)
    later = rows["time"] > 0.001
    assert np.diff(rows["kinetic"][later] + rows["internal"][later]).max() <= 0.0


@pytest.mark.parametrize("share", [0.1, 0.5])
@pytest.mark.parametrize("scheme", ["usf", "musl"])
def test_local_damping_of_a_mode(scheme: str, share: float) -> None:
    """Against the motion the stiffness is 1 + k, with it 1 - k: so from peak to peak of the energy,

    half a period, (1 - k) / (1 + k) is left, 4 k of a period being lost for a small k (D = k / pi).
    Half a period lasts pi / (2 omega) (1 / sqrt(1 - k) + 1 / sqrt(1 + k)).
    """
    sim = bar(scheme, body=f"{MODE}\ndamping = {{ local = {share} }}")
    t, k = peaks(rows_to(sim, 0.03))
    assert len(t) >= 3
    left = (1.0 - share) / (1.0 + share)
    assert k[1:] / k[:-1] == pytest.approx(np.full(len(k) - 1, left), rel=0.02)
    half = 0.5 * math.pi / FREQUENCY * ((1 - share) ** -0.5 + (1 + share) ** -0.5)
    assert np.diff(t) == pytest.approx(np.full(len(t) - 1, half), rel=0.02)


def test_local_damping_leaves_a_steady_speed() -> None:
    """A bar that flies keeps its speed to rounding: no force is out of balance."""
    sim = bar(body="velocity = [3, 1]\ndamping = { local = 0.8 }")
    rows = rows_to(sim, 0.005)
    assert rows["momentum_x"] == pytest.approx(np.full(len(rows["time"]), rows["momentum_x"][0]))
    assert rows["damped"][-1] <= 1e-12 * rows["kinetic"][0]


COLUMN = """
[grid]
dimension = 2
cell_size = "5 mm"
basis = "{basis}"
box = {{ lower = [0, "{bottom}"], upper = ["20 mm", "1 m"], walls = "slip" }}
[run]
scheme = "{scheme}"
end_time = "1 s"
gravity = [0, -10]
[material.soft]
density = 1000
strength = {{ elastic = {{ E = "1 MPa", nu = 0.3 }} }}
[body.lower]
material = "soft"
shape = {{ box = {{ lower = [0, 0], upper = ["20 mm", "{height} mm"] }} }}
damping = {{ {damping} }}
{more}
"""


def column(more: str = "", **given: Any) -> Case:
    """Return a column between slip walls, 0.2 m high, that stands on one."""
    known = {"basis": "gimp", "scheme": "musl", "height": 200, "bottom": "0 m"}
    known |= {"damping": "local = 0.7"}
    return Case.from_text(COLUMN.format(**known | given, more=more))


UPPER = """
[body.upper]
material = "soft"
shape = { box = { lower = [0, "100 mm"], upper = ["20 mm", "200 mm"] } }
damping = { local = 0.5 }
"""


@pytest.mark.parametrize("basis", BASES)
@pytest.mark.parametrize("bodies", [1, 2])
def test_a_column_comes_to_rest(bodies: int, basis: str) -> None:
    """sigma_yy = -rho g (H - y) within 1 % of the largest, of one body and of two in contact.

    The particles at the free surface know their stress to half their spacing: 0.6 %.
    """
    case = column(basis=basis) if bodies == 1 else column(UPPER, basis=basis, height=100)
    sim = Simulation(case, threads=1)
    rows = rows_to(sim, 0.4)
    # Where bodies meet is noise that the grid does not see, and so does not damp: about 2 % then.
    assert rows["kinetic"][-1] <= (1e-6 if bodies == 1 else 0.05) * rows["kinetic"].max()
    y = np.concatenate([sim.column(body, "position")[:, 1] for body in sim.bodies])
    stress = np.concatenate([sim.column(body, "stress")[:, 1] for body in sim.bodies])
    largest = 1000.0 * 10.0 * 0.2
    assert np.abs(stress + 1000.0 * 10.0 * (0.2 - y)).max() <= 0.01 * largest


def lines_of(text: str, **other: Any) -> str:
    return BAR.format(
        **{"scheme": "musl", "grid": "", "run": "", "material": "", "body": text} | other
    )


@pytest.mark.parametrize(
    ("body", "message"),
    [
        ("damping = {}", "must have mass or local"),
        ("damping = { mass = -1 }", "must be >= 0"),
        ("damping = { local = 1 }", "must be < 1"),
        ('damping = { local = { times = [0, "1 s"], values = [0.5, 1.5] } }', "must be < 1"),
        ('damping = { mass = "3 m" }', "1/s"),
        ("damping = { alpha = 3 }", "not a known key"),
    ],
)
def test_refuses(body: str, message: str) -> None:
    """What makes no sense gets a sentence."""
    with pytest.raises(CaseError, match=message):
        Case.from_text(lines_of(body))


def test_refuses_bodies_that_do_not_deform() -> None:
    """One that is led has no motion of its own to be damped."""
    with pytest.raises(CaseError, match=r"body\.upper\.damping is of a body that does not deform"):
        column(UPPER + 'motion = "fixed"\n', height=100)


LIFT = """
[body.lift]
material = "soft"
shape = { box = { lower = [0, "-20 mm"], upper = ["20 mm", 0] } }
motion = { velocity = [0, "0.5 m/s"] }
[contact]
friction = 0
"""


@pytest.mark.parametrize("scheme", ["usf", "musl"])
def test_contact_carries_drag(scheme: str) -> None:
    """What stands on a lift that moves steadily weighs m (g + alpha V)."""
    case = column(LIFT, scheme=scheme, height=60, bottom="-1 m", damping="mass = 60")
    case.body["lower"].velocity = (0.0, 0.5)
    sim = Simulation(case, threads=1)
    rows = rows_to(sim, 0.25)
    later = rows["time"] > 0.15
    t, impulse = rows["time"][later], rows["motion_impulse_y"][later]
    push = (impulse[-1] - impulse[0]) / (t[-1] - t[0])
    # What is left of the vibration after it, exp(-60 0.15 / 2) of it, over several periods.
    assert push == pytest.approx(sim.column("lower", "mass").sum() * (10 + 60 * 0.5), rel=3e-3)


def test_bonded_bodies_have_one() -> None:
    """Bodies that are bonded move as one: all have the same damping, or none."""
    more = UPPER + "[contact]\nbonded = true\n"
    with pytest.raises(CaseError, match=r"must be the same for all where contact\.bonded = true"):
        column(more, height=100)
    rows_to(Simulation(column(more, height=100, damping="local = 0.5"), threads=1), 0.01)


def test_the_summary_tells_it() -> None:
    """It stands among what acts on the bodies."""
    case = Case.from_text(lines_of("damping = { mass = 3, local = 0.5 }"))
    assert "damping of bar: 3 1/s and local 0.5" in echo(case, build(case))


@pytest.mark.parametrize(
    ("material", "message"),
    [
        ("damping = { stiffness = -1 }", "must be >= 0"),
        ("damping = { stiffness = 3, mass = 1 }", "not a known key"),
        ("damping = {}", "must have stiffness"),
    ],
)
def test_refuses_of_materials(material: str, message: str) -> None:
    """Likewise."""
    with pytest.raises(CaseError, match=message):
        Case.from_text(lines_of("", material=material))


def test_what_does_not_deform_is_not_damped() -> None:
    """A rigid material has no stress of strain."""
    text = (
        LIFT.replace('"soft"', '"stone"').replace("motion", "#")
        + """
[material.stone]
density = 3000
strength = { rigid = {} }
damping = { stiffness = "1 ms" }
"""
    )
    with pytest.raises(CaseError, match=r"material\.stone\.damping is of a material that does not"):
        column(text, bottom="-1 m")

# SPDX-License-Identifier: BSD-3-Clause
"""Laws of every transfer: momentum stays, the ledger closes, a rigid translation is kept."""

from __future__ import annotations

import io
from pathlib import Path

import numpy as np
import pytest

from cases import CELL, SCHEMES, block, everything, materials
from mpm3dpp import Case, CaseError, Contact, Grid, Run, Simulation, _core
from mpm3dpp.io import result_hash

TRANSFERS = tuple(_core.transfers)


def bases_of(transfer: str) -> list[str]:
    """Return the bases that go with a transfer."""
    affine = _core.transfers[transfer]["affine"]
    return [name for name, row in _core.bases.items() if row["second_moment"] or not affine]


def simulation(dimension: int, scheme: str, transfer: str, basis: str) -> Simulation:
    """Return a block at rest, 4 cells along each edge, two particles a cell along each axis."""
    run = Run(end_time=1.0, scheme=scheme, transfer=transfer, energy_growth_limit=1e9)
    case = Case(
        grid=Grid(dimension=dimension, cell_size=CELL, basis=basis),
        run=run,
        contact=Contact(),
        material=materials(),
        body={"body": block((0,) * dimension, (4,) * dimension, material="solid")},
    )
    return Simulation(case, threads=1)


@pytest.mark.parametrize("transfer", TRANSFERS)
@pytest.mark.parametrize("scheme", SCHEMES)
@pytest.mark.parametrize("dimension", [2, 3])
def test_laws(dimension: int, scheme: str, transfer: str) -> None:
    for basis in bases_of(transfer):
        sim = simulation(dimension, scheme, transfer, basis)
        v = np.random.default_rng(1).uniform(-1.0, 1.0, sim.column("body", "velocity").shape)
        sim.set_velocity("body", v)
        sim.advance(5)
        rows = dict(zip(sim.core.history_columns, sim.core.history().T, strict=True))
        mass = sim.column("body", "mass")[:, 0]
        scale = float(0.5 * np.sum(mass[:, None] * v**2))
        # Sums over at most 512 particles of terms of these sizes: some thousand roundings a step.
        assert np.abs(rows["residual"][1:]).max() <= 1e-11 * scale
        momentum = np.abs(rows["momentum_x"][1:] - mass @ v[:, 0]).max()
        assert momentum <= 1e-12 * float(mass @ np.abs(v[:, 0]))


@pytest.mark.parametrize("transfer", TRANSFERS)
def test_a_translation_is_kept(transfer: str) -> None:
    sim = simulation(2, "musl", transfer, bases_of(transfer)[0])
    v = np.broadcast_to([3.0, -2.0], sim.column("body", "velocity").shape)
    sim.set_velocity("body", v)
    sim.advance(50)
    assert np.abs(sim.column("body", "velocity") - v).max() <= 1e-12  # 50 steps of 20 roundings


@pytest.mark.parametrize("transfer", [*TRANSFERS, {"xpic": 3, "every": 4}], ids=str)
@pytest.mark.parametrize("dimension", [2, 3])
def test_bits_do_not_depend_on_threads_fusion_and_restarts(
    dimension: int, transfer: str | dict[str, int], tmp_path: Path
) -> None:
    """The restart comes after 15 steps, with one of a filter that three others go before."""
    basis = bases_of(transfer)[0] if isinstance(transfer, str) else "gimp"
    case = everything(tmp_path, dimension, "musl", basis, "absorbing")
    if transfer != "flip":  # Which has PIC damping there.
        case.run.transfer = transfer
    found = set()
    for threads, fused, restarts in ((1, True, False), (2, False, False), (2, True, True)):
        sim = Simulation(case, threads=threads, fused=fused)
        sim.core.advance(15, 1.0)
        if restarts:
            state = io.BytesIO()
            sim.core.save(state.write)
            size = state.tell()
            state.seek(0)
            sim = Simulation(case, threads=threads, fused=fused)
            sim.core.restore(state.readinto, size)
        sim.core.advance(15, 1.0)
        found.add(result_hash(sim.core))
    assert len(found) == 1


def test_pic_takes_the_velocity_of_the_grid() -> None:
    """What alternates from particle to particle is not seen by the grid, and gone after a step."""
    left = {}
    for transfer in ("flip", "pic"):
        sim = simulation(2, "musl", transfer, "linear")
        place = np.rint(sim.column("body", "position") / (CELL / 2) - 0.5).astype(int)
        v = np.zeros_like(sim.column("body", "velocity"))
        v[:, 0] = np.prod(1 - 2 * (place % 2), axis=1)
        sim.set_velocity("body", v)
        sim.advance(1)
        inner = np.all((place > 1) & (place < 6), axis=1)
        left[transfer] = np.abs(sim.column("body", "velocity")[inner, 0]).max()
    assert left["flip"] > 0.9 and left["pic"] < 0.1


@pytest.mark.parametrize("transfer", TRANSFERS)
def test_particles_take_no_part_in_the_correction_of_contact(transfer: str) -> None:
    """The momentum that bodies gain is what the records of their contact say."""
    blocks = {name: block((x, 0), (x + 4, 4), material="solid") for name, x in (("a", 0), ("b", 4))}
    grid = Grid(dimension=2, cell_size=CELL, basis=bases_of(transfer)[0])
    run = Run(end_time=1.0, transfer=transfer)
    case = Case(grid=grid, run=run, material=materials(), body=blocks)
    sim = Simulation(case, threads=1)
    for name, speed in (("a", 3.0), ("b", -3.0)):
        sim.set_velocity(name, np.tile([speed, 0.5 * speed], (len(sim.column(name, "mass")), 1)))
    sim.advance(30)
    mass = sim.column("a", "mass")[:, 0]
    gained = mass @ sim.column("a", "velocity") - mass.sum() * np.array([3.0, 1.5])
    [pair] = sim.core.contact_groups()
    recorded = np.asarray(pair.impulse)[:2]
    assert np.linalg.norm(recorded) > 0.1 * mass.sum()
    assert np.abs(gained - recorded).max() <= 1e-11 * mass.sum()


@pytest.mark.parametrize(("transfer", "left"), [("apic", 1e-12), ("aflip", 0.05)])
@pytest.mark.parametrize("scheme", SCHEMES)
def test_affine_transfers_keep_turning(scheme: str, transfer: str, left: float) -> None:
    """A free block that turns once, 4 cells wide: APIC to rounding, AFLIP loses 2 % in it."""
    sim = simulation(2, scheme, transfer, "quadratic_bspline")
    x, mass = sim.column("body", "position"), sim.column("body", "mass")[:, 0]
    arm = x - mass @ x / mass.sum()
    spin = 0.02 * sim.core.dt**-1  # A turn in 300 steps.
    sim.set_velocity("body", spin * np.column_stack([-arm[:, 1], arm[:, 0]]))

    def turning() -> float:
        x, v = sim.column("body", "position"), sim.column("body", "velocity")
        C = sim.column("body", "affine_velocity")
        cross = x[:, 0] * v[:, 1] - x[:, 1] * v[:, 0]
        return float(mass @ (cross + 0.25 * CELL**2 * (C[:, 2] - C[:, 1])))

    C = sim.column("body", "affine_velocity")
    assert np.abs(C - spin * np.array([0, -1, 1, 0])).max() <= 1e-11 * spin
    before = turning()
    sim.advance(300)
    assert abs(turning() / before - 1) <= left


def test_a_velocity_given_on_the_way_is_that_of_one_body() -> None:
    """After steps that have moved the particles out of their cells: it is the field's gradient."""
    case = Case(
        grid=Grid(dimension=2, cell_size=CELL, basis="quadratic_bspline"),
        run=Run(end_time=1.0, transfer="apic", cfl=0.9),
        material=materials(),
        body={
            name: block((k, 0), (4, 4), material="solid")
            for k, name in ((0, "turned"), (9, "kept"))
        },
    )
    sim = Simulation(case, threads=1)
    for name in sim.bodies:
        sim.set_velocity(name, np.tile([400.0, 300.0], (len(sim.column(name, "mass")), 1)))
    sim.advance(7)
    x = sim.column("turned", "position")
    kept = sim.column("kept", "affine_velocity").tobytes()
    gradient = np.array([[3.0, -50.0], [20.0, -7.0]])
    sim.set_velocity("turned", (x - x[0]) @ gradient.T)
    C = sim.column("turned", "affine_velocity")
    assert np.abs(C - gradient.ravel()).max() <= 1e-10 * 50.0
    assert sim.column("kept", "affine_velocity").tobytes() == kept


@pytest.mark.parametrize("transfer", ["flip", "apic", "aflip"])
def test_nothing_is_made_by_a_disc_that_rests(transfer: str) -> None:
    """On a floor, for ten of its vibrations: what numerics make is a share of gravity's work.

    A share of a node's change of velocity that no particle has would be many times that work.
    """
    case = Case.from_text(RESTING.format(transfer=transfer))
    sim = Simulation(case, threads=1)
    sim.advance(10**6)
    rows = dict(zip(sim.core.history_columns, sim.core.history().T, strict=True))
    assert -rows["numerical_time"][-1] < 0.75 * np.abs(rows["external"]).max()


RESTING = """
[grid]
dimension = 2
cell_size = 0.0125
basis = "quadratic_bspline"
[run]
end_time = 0.4
scheme = "usf"
cfl = 0.5
gravity = [0, -9.81]
transfer = "{transfer}"
[material.rubber]
density = 1000.0
strength = {{ elastic = {{ E = 1e6, nu = 0.3 }} }}
[body.disc]
material = "rubber"
shape = {{ disc = {{ centre = [0, 0.1], radius = 0.1 }} }}
[body.floor]
material = "rubber"
shape = {{ box = {{ lower = [-0.2, -0.05], upper = [0.2, 0] }} }}
motion = "fixed"
"""


def test_what_goes_with_a_transfer() -> None:
    """A basis without a constant second moment, numbers of other transfers: a sentence each."""
    body = {"a": block((0, 0), (4, 4), material="solid")}
    grid = Grid(dimension=2, cell_size=CELL, basis="gimp")
    with pytest.raises(CaseError, match=r'run\.transfer = "apic" does not go with grid\.basis'):
        Case(grid=grid, run=Run(end_time=1, transfer="apic"), material=materials(), body=body)


@pytest.mark.parametrize(
    ("given", "said"),
    [
        ({"aflip": 0.9, "flip": 1}, r"run\.transfer must be a word, .*\{ aflip = 0\.97 \}"),
        ({"pic_rate": 1}, r"run\.transfer must be a word, .*\{ aflip = 0\.97 \}"),
        (3, r"run\.transfer = 3 must be a word, .*\{ aflip = 0\.97 \}"),
        ("flipp", r'run\.transfer = "flipp" is not a known choice; did you mean "flip"'),
        ({"apic": 1}, r'run\.transfer\.apic = 1 has no number; write transfer = "apic"'),
        ({"flip": 1.5}, r"run\.transfer\.flip = 1\.5 must obey 0 <= f <= 1"),
        ({"flip": 1, "pic_rate": -1}, r"run\.transfer\.pic_rate = -1 must be >= 0"),
        ({"xpic": 0}, r"run\.transfer\.xpic = 0 must be >= 1"),
        ({"xpic": 2.5}, r"run\.transfer\.xpic = 2\.5 must be a whole number"),
        ({"xpic": 2, "every": 0}, r"run\.transfer\.every = 0 must be >= 1"),
        (
            {"flip": 1, "aflip_of_gases": 0.5},
            r"aflip_of_gases = 0\.5 is of another transfer than flip",
        ),
        ({"flip": 1, "every": 2}, r"transfer\.every = 2 goes with xpic, and not with flip; remove"),
        ({"flip": 1, "rate": 1}, r"run\.transfer\.rate is not a known key; did you mean"),
    ],
)
def test_mistakes_in_a_transfer(given: object, said: str) -> None:
    with pytest.raises(CaseError, match=said):
        Run(end_time=1.0, transfer=given)


def test_a_transfer_is_written_as_it_is_given() -> None:
    of_gases = {"aflip": 0.97, "aflip_of_gases": 0.9}
    both = [{"flip": 1.0, "pic_rate": 5.0}, {"xpic": 4, "every": 2}, of_gases]
    forms = ["pic", "aflip", {"flip": 0.9}, {"aflip": 0.9}, *both]
    for form in forms:
        run = Run(end_time=1.0, transfer=form)
        assert run.table()["transfer"] == form
        assert run.transfer.word == (form if isinstance(form, str) else next(iter(form)))
    assert Run(end_time=1.0, transfer={"aflip": 0.97}).table()["transfer"] == "aflip"
    run = Run(end_time=1.0, transfer="pic")
    with pytest.raises(CaseError, match=r"pic_rate = 5\.0 goes with flip and aflip, and not with"):
        run.transfer.pic_rate = 5.0


def test_gases_never_keep_more_of_their_own_than_was_asked() -> None:
    """`aflip` alone is for all matter: gases have the smaller of it and their default."""
    for given, wanted in [({"aflip": 0.5}, 0.5), ({"aflip": 0.9}, 0.7), ("aflip", 0.7)]:
        assert Run(end_time=1.0, transfer=given).transfer.aflip_of_gases == wanted
    more = Run(end_time=1.0, transfer={"aflip": 0.5, "aflip_of_gases": 0.9})
    assert more.transfer.aflip_of_gases == 0.9


@pytest.mark.parametrize(
    ("key", "form"), [("pic_damping", r"\{ flip = 1\.0, pic_rate"), ("flip_share", r"\{ flip = ")]
)
def test_keys_of_before_name_the_table(key: str, form: str) -> None:
    said = rf"run\.{key} = 0\.5 is a number of run\.transfer now; write transfer = {form}"
    with pytest.raises(CaseError, match=said):
        Run(end_time=1.0, **{key: 0.5})

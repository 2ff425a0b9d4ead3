# SPDX-License-Identifier: BSD-3-Clause
"""The numerics of `mpm3dpp bench` are those of a case file."""

import operator

import numpy as np
import pytest

from mpm3dpp import Case, CaseError, _core, bench
from mpm3dpp.bench import Numerics, cases, report
from mpm3dpp.bench.numerics import words_of
from mpm3dpp.run.core_settings import core_settings

TABLES = {
    "run": {"end_time": 1.0},
    "material": {"its": cases.ALUMINIUM},
    "body": {"its": {"material": "its", "shape": {"disc": {"centre": [0, 0], "radius": 0.01}}}},
}


@pytest.mark.parametrize("preset", [None, "paper"])
@pytest.mark.parametrize("name", cases.BENCHES)
def test_numerics_are_those_of_a_case_that_says_nothing_of_them(name, preset):
    """Field by field, but for what is the benchmark's own."""
    chosen = cases.BENCHES[name]
    made = core_settings(chosen.case(4, Numerics(preset=preset)), 1)
    grid = {"dimension": 2, "cell_size": cases.CELL}
    said = {"preset": preset} if preset else {}
    user = core_settings(Case(grid=grid, **TABLES, **said), 1)
    own = {"run.outside_limit": 1.0, "run.volume_limit": 1.0, "grid.dimension": chosen.dimension}
    own |= {"contact.enabled": chosen.contact, "contact.friction": cases.FRICTION}
    for table in ("grid", "run", "contact", "run.transfer"):
        theirs, ours = (operator.attrgetter(table)(each) for each in (user, made))
        names = [key for key in _core.settings[table] if key != "gravity"]
        for key in [*names, "word"] if table == "run.transfer" else names:
            expected = own.get(f"{table}.{key}", getattr(theirs, key))
            assert getattr(ours, key) == expected, f"{table}.{key}"


def test_what_is_said_is_taken_and_the_rest_follows():
    chosen = cases.BENCHES["two_cubes"]
    case = chosen.case(4, Numerics(basis="gimp"))
    assert words_of(case) == {
        "basis": "gimp",
        "transfer": "flip",
        "scheme": "musl",
        "preset": None,
        "frame": "updated",
    }
    assert (case.run.cfl, case.contact.response) == (0.25, "impulses")
    case = chosen.case(4, Numerics(transfer="apic", scheme="musl"))
    assert (case.grid.basis, case.run.scheme, case.run.cfl) == ("quadratic_bspline", "musl", 0.5)


@pytest.mark.parametrize(
    ("numerics", "sentence"),
    [
        ({"basis": "bspline"}, '^--basis = "bspline" is not a known choice; did you mean "quad'),
        ({"transfer": "flop"}, '^--transfer = "flop" is not a known choice; did you mean "flip"'),
        ({"preset": "thesis"}, '^--preset = "thesis" is not a known choice; valid here: paper$'),
        ({"basis": "gimp", "transfer": "apic"}, '^--transfer = "apic" does not go with grid.basis'),
        ({"frame": "materiel"}, '^--frame = "materiel" is not a known choice; did you mean "mater'),
        ({"frame": "material", "basis": "linear"}, '^--frame = "material" needs gradients without'),
    ],
)
def test_wrong_words_are_refused_as_in_a_case_file(numerics, sentence):
    with pytest.raises(CaseError, match=sentence):
        bench.main("elastic2d", [4], steps=2, numerics=Numerics(**numerics))


IN_BODY = Numerics(frame="material")


@pytest.mark.parametrize("name", [name for name, each in cases.BENCHES.items() if not each.loose])
def test_every_benchmark_but_debris_runs_in_the_material_frame(name):
    """Its bodies touch each other by their surfaces, as those of a user's case."""
    chosen = cases.BENCHES[name]
    size = 2 if chosen.bodies else 8
    case = chosen.case(size, IN_BODY)
    frames = {of.frame for part, of in case.parts().items() if not case.is_rigid(part)}
    assert frames == {"material"}
    simulation = cases.make(chosen, size, numerics=IN_BODY)
    count = simulation.particle_count - (0 if chosen.flies else simulation.body_particle_count(0))
    # A lattice meets the volume of a ball of 7.5 particles to 7 %.
    assert count == pytest.approx(chosen.particles(size, "material"), rel=0.07)
    last = simulation.body_count - 1
    before = simulation.column(last, "position")
    simulation.advance(20, 1.0)
    assert simulation.failure is None
    assert np.ptp(simulation.column(last, "position") - before, axis=0).min() > 0  # It is strained.
    assert bool(simulation.contact_pairs()) == chosen.contact
    assert (simulation.bytes()["contact"] > 0) == chosen.contact


def test_the_frame_is_told(capsys):
    result = bench.measure("spheres", 8, steps=12, numerics=IN_BODY)
    assert result["frame"] == "material"
    assert result["stages"]["update in the body"] > 0
    assert result["bytes_per_particle"]["contact"] > 0 and result["touching_points"] > 0
    assert result["bandwidth_fraction"] is None and result["arithmetic_fraction"] is None
    report.show(result)
    report.show_series([result, result])
    shown = capsys.readouterr().out
    assert "quadratic_bspline, material frame; 1 thread" in shown
    assert "quadratic_bspline, material frame; 12 steps" in shown
    assert 'bandwidth  not counted for frame = "material"' in shown
    assert f"{result['touching_points']:,} points of surfaces touch" in shown


def test_what_is_not_in_the_material_frame_is_refused():
    with pytest.raises(CaseError, match=r'^--frame = "material" does not go with debris, .*leave'):
        bench.main("debris", [2], numerics=IN_BODY)
    with pytest.raises(CaseError, match=r'^--frame = "material" does not go with --device cuda'):
        bench.main("elastic2d", [2], numerics=IN_BODY, device="cuda")

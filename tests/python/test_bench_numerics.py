# SPDX-License-Identifier: BSD-3-Clause
"""The numerics of `mpm3dpp bench` are those of a case file."""

import operator

import pytest

from mpm3dpp import Case, CaseError, _core, bench
from mpm3dpp.bench import Numerics, cases
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
    ],
)
def test_wrong_words_are_refused_as_in_a_case_file(numerics, sentence):
    with pytest.raises(CaseError, match=sentence):
        bench.main("elastic2d", [4], steps=2, numerics=Numerics(**numerics))

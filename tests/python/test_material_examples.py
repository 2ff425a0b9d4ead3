# SPDX-License-Identifier: BSD-3-Clause
"""Every line for a case file that `mpm3dpp materials NAME` prints is accepted in a case."""

from __future__ import annotations

import re

import pytest

from mpm3dpp import Case
from mpm3dpp.materials import catalogue, library, listing
from mpm3dpp.materials.catalogue import KINDS
from mpm3dpp.materials.chosen import ACTIONS, Failure

CASE = """
grid = { dimension = 3, cell_size = "100 mm" }
run = { end_time = 1 }
body.cube = { material = "any", shape.box = { lower = [0, 0, 0], upper = [1, 1, 1] } }
body.soft = { material = "soft", shape.box = { lower = [2, 0, 0], upper = [3, 1, 1] } }
material.soft = { density = 1, strength.elastic = { E = 1, nu = 0 } }
[material.any]
"""
COPPER = 'eos = { mie_gruneisen = { c0 = "3940 m/s", s = 1.49, gamma0 = 1.96 } }'
METAL = 'strength = { j2 = { E = "70 GPa", nu = 0.3, Y0 = "300 MPa" } }'
MODELS = [(kind, name) for kind in KINDS for name in catalogue(kind)]


@pytest.mark.parametrize(("kind", "name"), MODELS, ids=[name for _, name in MODELS])
def test_example_of_a_model(kind: str, name: str) -> None:
    [line] = [x for x in listing(name).splitlines() if x.startswith("  case file: ")]
    lines = ["density = 1000", line.removeprefix("  case file: ")]
    if kind == "eos":
        lines.append("strength = { fluid = {} }")
    elif kind == "failure":
        lines += [METAL, COPPER]
    elif catalogue("strength")[name].eos == "must":
        lines.append(COPPER)
    case = Case.from_text(CASE + "\n".join(lines))
    assert name in case.material["any"].models
    # What has no default is given, and what tells materials apart is not a mere 0.3.
    assert case.material["any"].sound_speed() > 10.0 or name == "rigid"


@pytest.mark.parametrize("name", library())
def test_lines_of_a_named_material(name: str) -> None:
    text = listing(name)
    lines = text[text.index("  case file:\n") :].splitlines()[1:]
    toml = "\n".join(line.strip() for line in lines if line.startswith("    "))
    assert toml.startswith("[material.")
    used = toml.partition("]")[0].removeprefix("[material.")
    body = CASE[: CASE.index("[material")].replace('"any"', f'"{used}"')
    assert Case.from_text(f"{body}{toml}").material[used].density > 0.0


@pytest.mark.parametrize("name", catalogue("failure"))
def test_the_detail_of_a_failure_model_says_what_failing_does(name: str) -> None:
    text = listing(name)
    for action in ACTIONS:
        assert f"\n    {action}  " in text
    default = Failure(model=name, parameters=dict.fromkeys(required(name), 1.0)).action
    assert re.search(rf"    {default} +.*\(the default\)", text)
    assert text.count("the default") == 1


def required(name: str) -> list[str]:
    return [p.name for p in catalogue("failure")[name].parameters if p.default is None]

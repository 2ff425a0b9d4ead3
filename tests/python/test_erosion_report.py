# SPDX-License-Identifier: BSD-3-Clause
"""What a user sees of erosion: the summary counts it, and pictures leave eroded particles out."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from typer.testing import CliRunner

from mpm3dpp import open_results
from mpm3dpp.cli.app import app
from mpm3dpp.io import read_manifest
from mpm3dpp.plots.frames import draw_frame, drawn, view_of

# A disc that spins so fast that its middle tears: rho w^2 r^2 (3 + nu) / 8 is 160 kPa there.
CASE = """\
[grid]
dimension = 2
cell_size = "2 mm"
[run]
end_time = "2 ms"
[output]
frames = 2
[material.soft]
density = "1000 kg/m^3"
strength = { elastic = { E = "1 MPa", nu = 0.3 } }
failure = { principal_stress = { limit = "20 kPa", action = "ACTION" } }
[body.disc]
material = "soft"
shape = { disc = { centre = [0, 0], radius = "20 mm" } }
angular_velocity = "1000 rad/s"
[body.still]
material = "hard"
shape = { disc = { centre = ["100 mm", 0], radius = "4 mm" } }
[material.hard]
density = "1000 kg/m^3"
strength = { elastic = { E = "1 MPa", nu = 0.3 } }
"""


def run(folder: Path, action: str) -> str:
    (folder / "case.toml").write_text(CASE.replace("ACTION", action))
    line = ["run", str(folder / "case.toml"), "--out", str(folder), "--threads", "1"]
    done = CliRunner().invoke(app, [*line, "--no-pictures"])
    assert done.exit_code == 0, done.output
    return done.output


def shown(figure: Any) -> bool:
    """Whether any particle is drawn."""
    axes = figure.axes[0]
    return bool(axes.images or axes.collections)


def test_the_summary_counts_what_has_eroded(tmp_path: Path) -> None:
    output = run(tmp_path, "erode")
    manifest = read_manifest(tmp_path)
    gone, energy = manifest["eroded"], manifest["energies"]["final"]["eroded"]
    assert 0 < gone["count"] < manifest["particles"]
    found = re.search(
        r"^eroded: (.*) of (.*) particles, (.*) kg/m \((.*)%.*, (.*) J/m$", output, re.M
    )
    assert found is not None, output
    count, total, mass, share, joule = (float(x.replace(",", "")) for x in found.groups())
    assert (count, total) == (gone["count"], manifest["particles"])
    assert mass == pytest.approx(gone["mass"], rel=1e-3)  # four digits
    assert share == pytest.approx(100 * gone["mass"] / manifest["mass"], abs=0.01)
    assert joule == pytest.approx(energy, rel=1e-3)


def test_pictures_leave_eroded_particles_out(tmp_path: Path) -> None:
    run(tmp_path, "erode")
    with open_results(tmp_path) as results:
        every, kept = results.arrays(-1), drawn(results, -1)
        gone = np.nan_to_num(every["failed"]) >= 3
        assert gone.any() and not gone.all()
        assert len(kept["position"]) == (~gone).sum()
        assert (kept["body"] == 1).sum() == (every["body"] == 1).sum()  # it cannot fail: NaN
        assert shown(draw_frame(results, -1))
        results.arrays = lambda frame, names=None: every | {"failed": np.full(len(gone), 3.0)}
        assert np.isfinite(view_of(results, [-1], "von_mises").upper).all()
        assert not shown(draw_frame(results, -1))


def test_without_erosion_nothing_is_said_of_it(tmp_path: Path) -> None:
    assert "eroded" not in run(tmp_path, "no_tension")
    with open_results(tmp_path) as results:
        assert "failed" not in results.fields
        assert len(drawn(results, -1)["position"]) == len(results.arrays(-1)["position"])

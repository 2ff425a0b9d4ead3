# SPDX-License-Identifier: BSD-3-Clause
"""Probes: what they see against the particles, a closed form, and the same run done otherwise."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from commands import CASE, interrupted, mpm3dpp, one_sentence, write
from mpm3dpp import Case, Probe, ProbeRegion, Simulation, load_case, open_results, run_case
from mpm3dpp.base.errors import CaseError
from mpm3dpp.io import read_history, read_manifest
from mpm3dpp.io.probe_tables import probe_path, read_probe
from mpm3dpp.plots.probes import draw_probes, save_probes
from mpm3dpp.run.probes import next_look

DOCS = Path(__file__).resolve().parents[2] / "docs" / "how-to"
PROBES = """
[probe.gauge]
point = ["45 mm", "30 mm"]
fields = ["velocity", "pressure"]
every = "0.1 ms"
[probe.tip]
particle = ["50 mm", "26 mm"]
body = "left"
fields = ["position", "stress"]
every = "0.2 ms"
[probe.box]
region = { lower = ["0 mm", "0 mm"], upper = ["25 mm", "60 mm"] }
fields = ["von_mises"]
every = "0.2 ms"
[probe.right]
body = "right"
"""


@pytest.fixture(scope="module")
def run(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("run")
    write(folder, CASE + PROBES)
    done = mpm3dpp("run", "case.toml", "--out", "out", cwd=folder, pictures=True)
    assert done.returncode == 0, done.stderr
    return folder / "out"


def at_frames(run: Path, name: str) -> list[tuple[dict[str, float], dict[str, np.ndarray]]]:
    """Return the rows of a probe that were made in the step of a frame, with the frame."""
    table, found = read_probe(run, name), []
    with open_results(run) as results:
        for k, step in enumerate(results.steps):
            for row in np.flatnonzero(table["step"] == step):
                found.append(({n: float(v[row]) for n, v in table.items()}, results.arrays(k)))
    assert len(found) >= 2
    return found


def test_a_particle_wherever_it_goes(run: Path) -> None:
    with open_results(run) as results:
        start = results.arrays(0)
        left = np.flatnonzero(start["body"] == results.bodies.index("left"))
    nearest = left[np.argmin(np.linalg.norm(start["position"][left] - [0.05, 0.026, 0], axis=1))]
    for row, frame in at_frames(run, "tip"):
        assert row["particles"] == 1
        place = [row["position_x"], row["position_y"]]
        assert place == pytest.approx(frame["position"][nearest][:2], rel=1e-6)
        assert row["stress_xy"] == pytest.approx(frame["stress"][nearest][5], rel=1e-6)
    assert "position_x_min" not in read_probe(run, "tip")


def test_a_region_and_a_body(run: Path) -> None:
    for row, frame in at_frames(run, "box"):
        x = frame["position"]
        inside = (x[:, 0] >= 0) & (x[:, 0] <= 0.025) & (x[:, 1] >= 0) & (x[:, 1] <= 0.06)
        seen = frame["von_mises"][inside]
        assert row["particles"] == inside.sum() > 10
        ours = [row["von_mises"], row["von_mises_min"], row["von_mises_max"]]
        # Particles of one mass.
        assert ours == pytest.approx([seen.mean(), seen.min(), seen.max()], rel=1e-5, abs=1e-3)
    for row, frame in at_frames(run, "right"):
        velocity = frame["velocity"][frame["body"] == 1]
        assert row["velocity_x"] == pytest.approx(velocity[:, 0].mean(), rel=1e-5, abs=1e-6)
        assert row["velocity_y_max"] == pytest.approx(velocity[:, 1].max(), rel=1e-5, abs=1e-6)


def test_rows_are_where_they_should_be(run: Path) -> None:
    """At the first step at or after each time; by default a 500th of the run, or each step."""
    history, gauge = read_history(run), read_probe(run, "gauge")
    times = history["time"]
    firsts = {float(times[np.searchsorted(times, k * 1e-4 - 1e-15)]) for k in range(81)}
    assert set(gauge["time"].tolist()) == firsts and gauge["time"][-1] == times[-1]
    assert np.array_equal(read_probe(run, "right")["time"], times)  # steps are longer than that


def test_probes_change_nothing_else(tmp_path: Path) -> None:
    """Neither rows of the history nor frames, nor the bits of the result."""
    text = CASE.replace("frames = 4", "frames = 4\nhistory_every = 20")
    found = []
    for name, more in (("with", PROBES), ("without", "")):
        run_case(write(tmp_path, text + more), tmp_path / name, threads=1, pictures=False)
        with open_results(tmp_path / name) as results:
            times = results.times.tolist()
        history = (tmp_path / name / "history.csv").read_bytes()
        found.append((history, times, read_manifest(tmp_path / name)["result_hash"]))
    assert found[0] == found[1]


@pytest.mark.parametrize("end", [6e-5, 0.3, 0.1 + 0.2, 1 / 3, 7e-3])
def test_the_last_look_is_at_the_end(end: float) -> None:
    probe, time, looks = Probe(body="a"), 0.0, 0
    while time < end:
        time, looks = next_look(probe, end, time), looks + 1
    assert time == end and looks == 500


def test_they_are_drawn_and_read(run: Path) -> None:
    assert (run / "probes.png").read_bytes().startswith(b"\x89PNG")
    with open_results(run) as results:
        assert [*results.probe("gauge")][:5] == ["time", "step", "particles", "mass", "velocity_x"]
        with pytest.raises(CaseError, match=r'"gauge2" is no probe .*; did you mean "gauge"'):
            results.probe("gauge2")


def test_pictures_keep_the_signs_of_what_probes_saw() -> None:
    """Of vectors, of tensors and of the way; what is nil all the time is no curve."""
    time = np.linspace(0.0, 1.0, 5)
    table = {"time": time, "step": time, "particles": time, "mass": time}
    table |= {"velocity_x": -3.0 * time, "velocity_y": time, "velocity_z": 0.0 * time}
    table |= {f"stress_{c}": 0.0 * time for c in ("xx", "yy", "zz", "yz", "xz")}
    table |= {"stress_xy": -7.0 * time, "pressure": -time, "pressure_min": -2.0 * time}
    table |= {"pressure_max": 0.0 * time, "position_x": 5.0 - 2.0 * time, "position_y": 0.0 * time}
    figure = draw_probes({"gauge": table}, {"velocity": "m/s", "stress": "Pa"})
    assert figure is not None
    drawn = {
        axes.get_ylabel().partition(" [")[0]: {
            str(line.get_label()): float(line.get_ydata()[-1]) for line in axes.lines
        }
        for axes in figure.axes
    }
    assert drawn["velocity"] == {"gauge x": -3.0, "gauge y": 1.0}
    assert drawn["stress"] == {"gauge xy": -7.0}
    assert drawn["pressure"] == {"gauge": -1.0}
    assert drawn["way from the start"] == {"gauge x": -2.0}


def test_a_point_sees_a_linear_field() -> None:
    """Its weights fall linearly, so that on a lattice a linear field is seen as it is."""
    text = (
        CASE.partition("[body.left]")[0]
        + """
[body.left]
material = "soft"
frame = "updated"
shape = { box = { lower = ["0 mm", "0 mm"], upper = ["50 mm", "50 mm"] } }
velocity = [{ expression = "3*x - y" }, { expression = "2 + y" }]
"""
    )
    sim = Simulation(Case.from_text(text), threads=1)
    for place in ([0.02, 0.03], [0.025, 0.015]):
        _, _, *seen = sim.core.probe("point", [0], place, [], 0, ["velocity"])
        expected = [3 * place[0] - place[1], 2 + place[1]]
        assert seen[0] == pytest.approx(expected[0], abs=1e-12)
        assert seen[3] == pytest.approx(expected[1], abs=1e-12)
    count, mass, *seen = sim.core.probe("point", [0], [1.0, 1.0], [], 0, ["velocity"])
    assert count == mass == 0 and np.isnan(seen).all()


def test_a_gauge_in_a_bar_sees_the_wave_of_an_impact(tmp_path: Path) -> None:
    """The case of the how-to: a bar meets a wall, and behind the wave there is no velocity.

    The stress is sigma = rho c v (d'Alembert), along the bar; across it nu / (1 - nu) of that.
    The mean of the plateau to 2 %, as the verification of such bars has it; the arrival, the time
    at half of it, to two cells of 30: short waves are slow on a grid, and the front is wide.
    """
    text = (DOCS / "use-probes.md").read_text().partition("```toml\n")[2].partition("```")[0]
    run_case(write(tmp_path, text), tmp_path / "out", threads=1, pictures=False, quiet=True)
    table = read_probe(tmp_path / "out", "gauge")
    modulus = 20e9 * (1 - 0.25) / ((1 + 0.25) * (1 - 0.5))
    c = np.sqrt(modulus / 8000)
    stress = 8000 * c * 1.0
    came, back = 0.03 / c, 0.17 / c  # the wave, and what the free end sends back
    plateau = (table["time"] > 1.3 * came) & (table["time"] < 0.9 * back)
    pressure = stress * (1 + 2 * 0.25 / (1 - 0.25)) / 3  # of a bar that cannot widen
    assert table["pressure"][plateau].mean() == pytest.approx(pressure, rel=0.02)
    assert abs(table["velocity_x"][plateau].mean()) < 0.02
    arrival = table["time"][np.flatnonzero(table["pressure"] > 0.5 * pressure)[0]]
    assert arrival == pytest.approx(came, abs=0.002 / c)


def test_any_number_of_ranks_and_threads_sees_the_same() -> None:
    case = Case.from_text(CASE + PROBES)
    found = []
    for ranks, threads in ((1, 1), (1, 2), (3, 1)):
        sim = Simulation(case, threads=threads, ranks=ranks)
        sim.advance(60)
        core = sim.core
        assert core.nearest_particle([0, 1], [0.05, 0.02]) is not None
        found.append(
            [
                *core.probe("point", [0, 1], [0.045, 0.03], [], 0, ["velocity", "stress"]),
                *core.probe("region", [0, 1], [0, 0], [0.03, 0.03], 0, ["pressure"]),
                *core.probe("bodies", [1], [], [], 0, ["von_mises", "volume"]),
                *core.nearest_particle([0, 1], [0.05, 0.02]),
                *core.probe("particle", [1], [], [], 7, ["position", "affine_velocity"]),
            ]
        )
    assert found[0] == found[1] == found[2]


def test_a_run_that_goes_on_writes_the_same_tables(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    path = write(tmp_path, CASE + PROBES)
    run_case(path, tmp_path / "whole", threads=1, pictures=False, quiet=True)
    interrupted(load_case(path), tmp_path / "parts", 20, monkeypatch)
    run_case(path, tmp_path / "parts", threads=1, pictures=False, quiet=True, resume=True)
    for name in ("gauge", "tip", "box", "right"):
        files = [probe_path(tmp_path / folder, name) for folder in ("whole", "parts")]
        assert files[0].read_bytes() == files[1].read_bytes()
    table = tmp_path / "parts" / "probes" / "tip.csv"
    table.write_text(table.read_text().replace(",", ";", 1))
    done = mpm3dpp("run", path, "--out", tmp_path / "parts", "--resume", cwd=tmp_path)
    # What does not begin as a table of ours does is somebody else's.
    assert done.returncode == 2 and "tip.csv' is there already" in one_sentence(done.stderr)
    table.unlink()
    for note in ("note: the table of probe tip was gone: a new one begins", ""):
        done = mpm3dpp("run", path, "--out", tmp_path / "parts", "--resume", cwd=tmp_path)
        assert done.returncode == 0 and table.exists() and note in done.stderr


@pytest.mark.parametrize(
    ("old", "new", "sentence"),
    [
        ('body = "right"\n', "", "probe.right looks at nothing; give point, particle, region or"),
        (
            'body = "right"\n',
            'body = "rigth"\n',
            'is not a body of this case; did you mean "right"',
        ),
        ('point = ["45 mm", "30 mm"]', 'point = ["45 mm"]', "must have two numbers in 2D"),
        ('point = ["45 mm", "30 mm"]', "point = [0, 0, 0]", "must have 2 numbers, as grid.dim"),
        ('"pressure"]', '"velocity"]', "is given twice; leave one out"),
        (
            '"pressure"',
            '"presure"',
            'is no field of what the probe looks at; did you mean "pressure"',
        ),
        ('upper = ["25 mm"', 'upper = ["-25 mm"', "must be > lower; exchange the two corners"),
        (
            'body = "left"\nfields',
            "point = [0, 0]\nfields",
            "must not be given together with point",
        ),
        ('every = "0.1 ms"', 'every = "0 ms"', "probe.gauge.every"),
        ("[probe.box]", '[probe."a/b"]', "cannot be the name of a file"),
        ("[probe.box]", "[probe.box]\npiont = [0, 0]", 'did you mean "point"'),
    ],
)
def test_mistakes(tmp_path: Path, old: str, new: str, sentence: str) -> None:
    text = CASE + PROBES
    assert old in text
    path = write(tmp_path, text.replace(old, new))
    with pytest.raises(CaseError) as caught:
        load_case(path)
    assert sentence in str(caught.value) and "case.toml:" in str(caught.value)


def test_a_new_run_forgets_the_probes_of_another(tmp_path: Path) -> None:
    run_case(write(tmp_path, CASE + PROBES), tmp_path / "out", threads=1, pictures=False)
    run_case(write(tmp_path), tmp_path / "out", threads=1, pictures=False)
    assert not (tmp_path / "out" / "probes").exists()


SOIL = """
[grid]
dimension = 3
cell_size = "10 mm"
[grid.box]
lower = [0, 0, 0]
upper = ["40 mm", "40 mm", "80 mm"]
walls = "slip"
[run]
end_time = "2 ms"
gravity = [0, 0, "-9.81 m/s^2"]
settle = { longest = "0.5 s" }
[material.soil]
density = "2000 kg/m^3"
strength = { elastic = { E = "1 MPa", nu = 0.3 } }
[body.soil]
material = "soil"
frame = "updated"
shape = { box = { lower = [0, 0, 0], upper = ["40 mm", "40 mm", "60 mm"] } }
[probe.foot]
point = ["20 mm", "20 mm", "20 mm"]
fields = ["stress", "affine_velocity"]
"""


def test_a_gauge_in_a_column_that_has_settled(tmp_path: Path) -> None:
    """In 3D: the weight of what is above it, from the time 0 on, and no row before.

    The settled column is in balance to 0.1 %; the probe's cell has the mean of its depths.
    """
    run_case(write(tmp_path, SOIL), tmp_path / "out", threads=1, pictures=False)
    table = read_probe(tmp_path / "out", "foot")
    assert table["time"][0] == 0.0 and np.all(np.diff(table["time"]) > 0)
    assert table["stress_zz"] == pytest.approx(-2000 * 9.81 * 0.04, rel=0.01)
    assert len([name for name in table if name.startswith("affine_velocity_")]) == 9


def test_a_particle_that_erodes_is_seen_no_more(tmp_path: Path) -> None:
    failure = 'failure = { plastic_strain = { limit = 0.01, action = "erode" } }'
    soft = 'strength = { elastic = { E = "1 MPa", nu = 0.3 } }'
    plastic = 'strength = { j2 = { E = "1 MPa", nu = 0.3, Y0 = "1 kPa" } }'
    case = CASE.replace(soft, f"{plastic}\n{failure}") + PROBES
    run_case(write(tmp_path, case), tmp_path / "out", threads=1, pictures=False)
    table = read_probe(tmp_path / "out", "tip")
    gone = table["particles"] == 0
    assert table["particles"][0] == 1 and gone[-1]
    assert np.isnan(table["position_x"][gone]).all() and not np.isnan(table["stress_xx"][0])
    with open_results(tmp_path / "out") as results:
        picture = save_probes({"tip": table}, results.units, tmp_path / "tip.png")
    assert picture is not None and picture.exists()


@pytest.mark.slow
def test_processes_see_what_one_does(run: Path, tmp_path: Path) -> None:
    pytest.importorskip("mpi4py")
    write(tmp_path, CASE + PROBES)
    words = ("run", "case.toml", "--out", "out", "--no-pictures", "--ranks", 2, "--threads", 1)
    done = mpm3dpp(*words, cwd=tmp_path)
    assert done.returncode == 0, done.stderr
    for name in ("gauge", "tip", "box", "right"):
        files = [probe_path(folder, name) for folder in (run, tmp_path / "out")]
        assert files[0].read_bytes() == files[1].read_bytes()


def test_a_probe_from_python(tmp_path: Path) -> None:
    case = Case.from_text(CASE)
    probe = Probe(region=ProbeRegion(lower=(0, 0), upper=(1, 1)), fields=["mass"])
    case = case.model_copy(update={"probe": {"all": probe}})
    run_case(case, tmp_path, threads=1, pictures=False, quiet=True)
    table = read_probe(tmp_path, "all")
    assert table["mass"][0] > 0.0 and len(table["time"]) > 10

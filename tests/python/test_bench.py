# SPDX-License-Identifier: BSD-3-Clause
"""`mpm3dpp bench`: what it measures and prints. Nothing here depends on how fast the machine is."""

import csv
import importlib
import json
import sys
from pathlib import Path

import numpy as np
import pytest

import mpm3dpp
from mpm3dpp import CaseError, bench
from mpm3dpp.bench import Numerics, cases, drum, report, spheres, traffic

KEYS = {
    *("particles", "threads", "ns_per_particle_step", "stages"),
    *("bytes_per_particle", "bandwidth_GBps", "bandwidth_fraction"),
    *("arithmetic_GFLOPS", "arithmetic_fraction"),
}


IN_SPACE = Numerics(frame="updated")
BENCHMARKS = Path(__file__).parents[2] / "benchmarks"


@pytest.fixture
def script(monkeypatch):
    """Import a script of benchmarks/ by name."""
    monkeypatch.syspath_prepend(BENCHMARKS)
    yield importlib.import_module
    for name in ("record", "compare"):
        sys.modules.pop(name, None)


@pytest.fixture(scope="module")
def cubes():
    """Two cubes with contact, of 4 cells along the edge, and how the progress was told."""
    told = []
    result = bench.measure(
        "two_cubes", 4, numerics=IN_SPACE, steps=7, told=lambda *part: told.append(part)
    )
    return result, told


def test_keys_that_other_tools_rely_on(cubes):
    result, _ = cubes
    assert set(result) >= KEYS
    assert set(result["bytes_per_particle"]) == {"particles", "grid", "contact", "other", "total"}
    assert result["particles"] == 2 * 8**3
    assert json.loads(json.dumps(result)) == result


def test_figures_agree_with_one_another(cubes):
    result, _ = cubes
    memory, total = result["bytes_per_particle"], result["ns_per_particle_step"]
    parts = sum(value for key, value in memory.items() if key != "total")
    assert parts == pytest.approx(memory["total"])
    assert memory["particles"] > 8 * 14  # 14 numbers a particle: x, v, mass, volume, stress
    assert memory["contact"] > 0
    assert total in result["blocks"]
    assert 0 < sum(result["stages"].values()) <= total  # Stages are a part of the step.
    assert result["contact_ratio"] > 0
    assert result["overlapped_nodes"] >= 5 * 5  # The cubes share at least a face of nodes.


def test_grains_are_balls_of_552_particles_that_touch():
    assert cases.BENCHES["spheres"].particles(1000) == 552_000
    assert np.ptp(spheres.centres(1000), axis=0) == pytest.approx([9 * 5 * cases.CELL] * 3)
    assert len(np.unique(spheres.centres(100), axis=0)) == 100
    simulation = cases.make(cases.BENCHES["spheres"], size=8, numerics=IN_SPACE)
    assert simulation.particle_count == 8 * spheres.PARTICLES
    simulation.advance(20, 1.0)
    pairs = {pair.bodies for pair in simulation.contact_pairs()}
    assert len(pairs) == 12  # The edges of a cube: neighbours touch, no others.


def test_progress_is_told_to_the_end(cubes):
    _, told = cubes
    parts = told[-1][1]
    assert told == [(done, parts) for done in range(parts + 1)]


def test_table_names_every_stage(cubes, capsys):
    report.show(cubes[0])
    shown = capsys.readouterr().out
    for stage in cubes[0]["stages"]:
        assert stage in shown
    assert "without contact" in shown


def test_help_names_the_benchmarks():
    from mpm3dpp.cli.bench import BENCH_NAMES

    named = BENCH_NAMES.rstrip(".").replace(" or ", ", ").split(", ")
    assert named == list(cases.BENCHES)


def test_what_memory_cannot_hold_is_refused():
    sentence = r"--size = 100000 is too large: elastic3d would need some 1,117,587,090 GiB of "
    with pytest.raises(CaseError, match=sentence + r"memory, and this machine has [\d,.]+ GiB; "):
        bench.main("elastic3d", [10**5])
    for name, sizes in (("jc", [10**5]), ("elastic3d", [10, 10**5])):  # One has a twin.
        with pytest.raises(CaseError, match=r"--size = 100000 is too large: 2 benchmarks at once"):
            bench.main(name, sizes)
    for call in (bench.measure, lambda name, size: bench.series(name, [size], [1])):
        with pytest.raises(CaseError, match=r"^size = 100000 is too large: "):
            call("elastic3d", 10**5)


def test_the_folder_of_the_picture_is_made_before_measuring(tmp_path):
    (tmp_path / "file").write_text("no folder")
    with pytest.raises(CaseError, match="a part of this path is a file"):
        bench.main("elastic2d", [10**9], plot=tmp_path / "file" / "in" / "one.png")
    bench.main("elastic2d", [2], steps=1, plot=tmp_path / "new" / "one.png", json=True)
    assert (tmp_path / "new" / "one.png").is_file()


def test_a_picture_of_another_kind_is_refused_before_measuring(tmp_path):
    with pytest.raises(CaseError, match=r"--plot = .* ends in .png"):
        bench.main("elastic2d", [10**9], plot=tmp_path / "one.pdf")


def test_json_is_all_that_is_printed(capsys):
    bench.main("elastic2d", [4], steps=2, numerics=Numerics(scheme="usl"), json=True)
    result = json.loads(capsys.readouterr().out)
    assert (result["particles"], result["scheme"], result["steps"]) == (64, "usl", 2)
    assert (result["basis"], result["transfer"]) == ("quadratic_bspline", "aflip")
    assert result["preset"] is None
    assert "find remapped velocities" not in result["stages"]


def test_series_has_every_size_with_every_number_of_threads(tmp_path, capsys):
    told = []
    found = bench.series("two_cubes", [3, 4], [1], steps=2, told=lambda *part: told.append(part))
    assert [(result["size"], result["threads"]) for result in found] == [
        (3, 1),
        (4, 1),
    ]
    assert all(set(result) >= KEYS and "contact_ratio" not in result for result in found)
    assert told[-1][0] == told[-1][1]
    picture = tmp_path / "growth.png"
    bench.main("elastic2d", [3, 4], [1, 2], steps=2, plot=picture)
    rows = [line for line in capsys.readouterr().out.splitlines() if line.strip()[:1].isdigit()]
    assert len(rows) == 4
    assert picture.read_bytes().startswith(b"\x89PNG")
    bench.main("elastic2d", [3], [1, 2], steps=2, json=True, plot=tmp_path / "threads.png")
    assert [result["threads"] for result in json.loads(capsys.readouterr().out)] == [1, 2]


def test_one_measurement_has_a_picture_too(tmp_path, capsys):
    bench.main("elastic2d", [4], steps=2, plot=tmp_path / "stages.png")
    assert (tmp_path / "stages.png").is_file()
    assert "stages.png" in capsys.readouterr().out


def test_unknown_name_lists_the_known_ones():
    with pytest.raises(CaseError) as caught:
        bench.main("elastic4d")
    for name in cases.BENCHES:
        assert name in str(caught.value)


def test_blocks_hold_all_steps():
    for steps in (1, 4, 5, 7, 400):
        lengths = bench.block_lengths(steps)
        assert sum(lengths) == steps
        assert len(lengths) == min(5, steps)
        assert max(lengths) - min(lengths) <= 1


@pytest.mark.parametrize(
    "numerics",
    [
        IN_SPACE,
        Numerics(preset="paper"),
        Numerics(scheme="usl"),
        Numerics(basis="gimp"),
        Numerics(transfer="apic", scheme="musl"),
    ],
    ids=lambda numerics: "_".join(numerics.words()),
)
@pytest.mark.parametrize("name", [name for name, each in cases.BENCHES.items() if each.flies])
def test_every_benchmark_strains_and_crosses_cells(name, numerics):
    chosen = cases.BENCHES[name]
    if chosen.loose and numerics.scheme == "usl":
        with pytest.raises(CaseError, match="cannot be measured with USL"):
            bench.measure(name, size=2, numerics=numerics)
        return
    simulation = cases.make(chosen, size=2, numerics=numerics)
    dimension = chosen.dimension
    before = [simulation.column(body, "position") for body in range(chosen.body_count(2))]
    simulation.advance(300, 1.0)  # Two steps of the shorter ones take as long as one of the others.
    assert simulation.failure is None
    for body, start in enumerate(before):
        moved = simulation.column(body, "position") - start
        assert np.ptp(moved, axis=0).min() > 0  # It is strained ...
        if numerics.scheme != "usl":
            assert moved[:, 0].min() > cases.CELL  # ... and every particle has changed cell.
    stages = list(simulation.timers())
    moved = [
        sum(traffic.bytes_per_particle_step(stages, dimension, "aflip", n).values()) for n in (0, 3)
    ]
    assert moved[0] > 0
    assert moved[1] == moved[0] + 3 * 16  # A number of the state is read and written once.


def test_discs_in_a_drum_touch_and_turn_with_it():
    chosen = cases.BENCHES["drum"]
    simulation = cases.make(chosen, size=30, numerics=IN_SPACE)
    discs = simulation.particle_count - simulation.body_particle_count(0)
    assert discs == pytest.approx(chosen.particles(30), rel=0.02)
    before = simulation.column(3, "position")
    simulation.advance(400, 1.0)
    assert simulation.failure is None
    assert len(list(simulation.contact_pairs())) > 30  # Of a heap in which each has six neighbours.
    # As much as 400 steps turn what goes with the drum, but for how far it falls meanwhile.
    after, angle = simulation.column(3, "position"), drum.TURNING * simulation.time
    turn = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
    fall = 0.5 * 9.81 * simulation.time**2
    assert np.abs((after - before @ turn.T).mean(axis=0)).max() < 1.1 * fall
    assert angle > 0.05  # rad, which is two thirds of a cell at the wall of a drum of 1000.


def test_debris_is_sparse_and_fast():
    size = 10
    chosen = cases.BENCHES["debris"]
    simulation = cases.make(chosen, size=size)
    assert simulation.particle_count == (2 * size) ** 3
    places = simulation.column(0, "position") / cases.CELL
    edge = 16  # 1.6 x 10 cells
    assert places.min() >= 0.0 and places.max() <= edge
    occupied = len(np.unique(np.floor(places).astype(int), axis=0)) / edge**3
    # Poisson's law for (2 x 10)^3 / 16^3 a cell; four standard deviations of a share of 16^3 cells.
    empty = np.exp(-((2 * size / edge) ** 3))
    assert 1.0 - occupied == pytest.approx(empty, abs=4 * np.sqrt(empty * (1 - empty) / edge**3))
    simulation.advance(10, 1.0)
    moved = simulation.column(0, "position") / cases.CELL - places
    assert moved[:, 0].mean() > 1.0  # A cell along x in fewer than ten steps.


def test_lattice_fills_the_cells_evenly():
    places = cases.make(cases.BENCHES["two_cubes"], size=3).column(1, "position") / cases.CELL
    cells, counts = np.unique(np.floor(places).astype(int), axis=0, return_counts=True)
    assert len(cells) == 27
    assert set(counts) == {8}
    assert cells[:, 0].min() == 3  # The second cube begins where the first one ends.


def test_breathing_has_no_momentum():
    speeds = cases.make(cases.BENCHES["elastic3d"], size=3).column(0, "velocity")
    rounding = np.finfo(float).eps * cases.SPEED * len(speeds)
    assert abs(np.linalg.norm(speeds.mean(axis=0)) - cases.SPEED) < rounding
    assert np.ptp(speeds, axis=0).min() > cases.BREATHING


def test_history_takes_a_row(script, cubes, tmp_path):
    history = tmp_path / "history.csv"
    head = (BENCHMARKS / "history.csv").read_text().splitlines()[0]
    history.write_text(head + "\n")
    record = script("record")
    record.append(history, record.row(cubes[0], "0123456789", "a note, with a comma"))
    with history.open(newline="") as file:
        [entry] = csv.DictReader(file)
    assert all(entry.values())
    assert (entry["bench"], entry["commit"]) == ("two_cubes", "0123456789")
    assert (entry["basis"], entry["transfer"]) == ("quadratic_bspline", "aflip")
    assert float(entry["ns_per_particle_step"]) > 0
    assert entry["note"].endswith("a note, with a comma")


def test_comparison_takes_the_median_of_the_ratios(script):
    """Over the turns of a round, then over the rounds."""

    def blocks(*ns):
        return [{"moves": 1.0, "idle": 0.0, "step": each} for each in ns]

    one = [blocks(10.0, 20.0, 40.0), blocks(5.0, 30.0, 20.0)]
    two = [blocks(10.0, 10.0, 10.0), blocks(20.0, 20.0, 20.0)]
    three = [blocks(8.0, 8.0, 8.0), blocks(8.0, 8.0, 8.0)]
    lines = script("compare").table([one, two, three])
    [step] = [line for line in lines if line.startswith("step")]
    assert step.split() == ["step", "10.00", "20.00", "1.000", "0.500", "to", "2.000"]
    assert not [line for line in lines if line.startswith("idle")]


@pytest.mark.parametrize("numerics", [[], ["preset=paper"]])
def test_comparison_of_a_build_with_itself(script, numerics):
    """Two processes take steps in turns."""
    here = str(Path(mpm3dpp.__file__).parents[1])
    rounds = [script("compare").one_round([here, here], ["elastic2d", "4", "1", "-"], 3, numerics)]
    assert [len(blocks) for blocks in rounds[0]] == [3, 3]
    assert ("find remapped velocities" in rounds[0][0][0]) == bool(numerics)  # Of MUSL alone.
    assert all(block["step"] > 0.0 for blocks in rounds[0] for block in blocks)

# SPDX-License-Identifier: BSD-3-Clause
"""Whatever the files of a run hold instead of what was written: a sentence, and no traceback."""

from __future__ import annotations

import copy
import csv
import json
import shutil
from collections.abc import Callable, Iterator
from functools import partial
from pathlib import Path
from typing import Any

import h5py
import numpy as np
import pytest

from commands import write
from mpm3dpp import CaseError, load_case, open_results, report
from mpm3dpp.base.markup import Html
from mpm3dpp.io import read_history
from mpm3dpp.io.export import export
from mpm3dpp.io.stored_manifest import read_manifest, stored_manifest
from mpm3dpp.plots import draw_results, first_contact, plot_results
from mpm3dpp.plots.energies import draw_energies
from mpm3dpp.plots.probes import draw_probes
from mpm3dpp.reports import figures
from mpm3dpp.run.resume import refuse_to_begin_anew
from mpm3dpp.sweep.numbers import numbers_of

# Contact, grains, a wall, a load, a probe and particles that erode: every table has rows.
RICH = """\
title = "All there is"
[grid]
dimension = 2
cell_size = "10 mm"
box = { lower = [0, "-100 mm"], upper = ["400 mm", "300 mm"], walls = { y_min = "slip" } }
[run]
end_time = "8 ms"
gravity = [0, "-9.81 m/s^2"]
[output]
frames = 2
[contact]
friction = 0.3
[material.soft]
density = "1000 kg/m^3"
strength = { elastic = { E = "0.2 MPa", nu = 0.3 } }
failure = { principal_stress = { limit = "20 kPa", action = "erode" } }
[body.block]
material = "soft"
shape = { box = { lower = [0, "-100 mm"], upper = ["40 mm", "-50 mm"] } }
[load.press]
body = "block"
side = "y_max"
pressure = "1 kPa"
[grains.discs]
material = "soft"
lattice = { lower = [0, "-50 mm"], count = [6, 2], radius = "10 mm" }
velocity = [0, "-5 m/s"]
[probe.middle]
point = ["20 mm", "-70 mm"]
every = "0.5 ms"
fields = ["velocity", "pressure", "stress"]
"""
WRONG: list[Any] = [None, "x", -1, 0, 1.5, True, [], [1], {}, {"x": 1}, float("nan"), 1e300]
GONE = object()


@pytest.fixture(scope="module")
def whole(tmp_path_factory: pytest.TempPathFactory) -> Path:
    from mpm3dpp import run_case

    folder = tmp_path_factory.mktemp("whole")
    run_case(load_case(write(folder, RICH)), folder / "out", threads=1, pictures=False)
    return folder / "out"


@pytest.fixture
def out(whole: Path, tmp_path: Path) -> Path:
    shutil.copytree(whole, tmp_path / "out")
    return tmp_path / "out"


@pytest.fixture(autouse=True)
def quick(monkeypatch: pytest.MonkeyPatch) -> None:
    """Leave out writing the curves as SVG; they are drawn."""
    monkeypatch.setattr(figures, "inline_svg", lambda *_: Html("<svg></svg>"))


def places(value: Any, path: tuple[Any, ...] = ()) -> Iterator[tuple[Any, ...]]:
    """Give the way to each entry of plain data."""
    if path:
        yield path
    items = value.items() if isinstance(value, dict) else ()
    for key, item in items or (enumerate(value[:2]) if isinstance(value, list) else ()):
        yield from places(item, (*path, key))


def changed(data: Any, path: tuple[Any, ...], value: Any) -> Any:
    data = copy.deepcopy(data)
    table = data
    for key in path[:-1]:
        table = table[key]
    if value is GONE:
        del table[path[-1]]
    else:
        table[path[-1]] = value
    return data


def mutations(data: Any, each: int) -> Iterator[tuple[Any, ...]]:
    """Give data with one entry changed: of each entry so many of the wrong values, in turn."""
    values = [*WRONG, GONE]
    for number, path in enumerate(places(data)):
        for k in range(each):
            value = values[(number + k * 5) % len(values)]
            yield path, value, changed(data, path, value)


def in_a_sentence(what: Any, read: Callable[[], Any]) -> bool:
    """Return whether something reads; if not, that it is said in a sentence."""
    try:
        read()
    except CaseError as error:
        assert "\n" not in str(error) and len(str(error)) < 3000, (what, error)
        return False
    except Exception as error:
        raise AssertionError(f"{what}: {type(error).__name__}: {error}") from error
    return True


@pytest.mark.parametrize("each", [1, pytest.param(3, marks=pytest.mark.slow)])
def test_manifests_of_a_wrong_form(out: Path, each: int) -> None:
    """Of 12 wrong values and a missing one every entry gets so many; what is read is told."""
    file, case = out / "manifest.json", load_case(write(out.parent, RICH))
    (out / "history.csv").unlink()  # So that the page is of the manifest.
    (out / "results.vtkhdf").unlink()
    refused = 0
    for number, (path, value, data) in enumerate(mutations(json.loads(file.read_text()), each)):
        file.write_text(json.dumps(data))
        what = ("manifest", path, value)
        reads = in_a_sentence(what, lambda: stored_manifest(out))
        refused += not reads
        if reads:
            assert in_a_sentence(what, lambda: numbers_of(read_manifest(out)))
            assert number % 5 or in_a_sentence(what, lambda: report(out, out / "page.html"))
        in_a_sentence(what, lambda: refuse_to_begin_anew(out, case))
    assert refused > 70 * each


def test_pictures_by_a_manifest_of_a_wrong_form(out: Path) -> None:
    file = out / "manifest.json"
    data = json.loads(file.read_text())
    pair = ("contact", "pairs", 0)
    for key in (("bodies", 0), ("first_node",), ("first_gap",), ("first_normal",)):
        for value in ("x", -1, [1], None):
            file.write_text(json.dumps(changed(data, (*pair, *key), value)))
            in_a_sentence((key, value), lambda: first_contact(out))
    file.write_text(json.dumps(changed(data, ("case", "output", "picture"), "x")))
    assert not in_a_sentence("picture", lambda: plot_results(out))


@pytest.mark.parametrize("every", [4, pytest.param(1, marks=pytest.mark.slow)])
def test_histories_of_a_wrong_form(out: Path, every: int) -> None:
    """Each column, or every fourth."""
    file = out / "history.csv"
    (out / "manifest.json").unlink()
    rows = list(csv.reader(file.read_text().splitlines()))
    cells = ["", "x", "nan", "inf", "-1e300", "0", "1,2", '"']
    for k in (*range(7), *range(7, len(rows[0]), every)):
        for number, cell in enumerate(cells[k % 4 :: 4] if k > 6 else cells):
            mine = [list(row) for row in rows]
            mine[0 if number == 1 else -1][k] = cell
            file.write_text("".join(",".join(row) + "\n" for row in mine))
            what = ("history", rows[0][k], cell)
            reads = in_a_sentence(what, lambda: read_history(out))
            if reads and (k + number) % 5 == 0:
                in_a_sentence(what, lambda: draw_energies(read_history(out), 2, ["block"]))
                in_a_sentence(what, lambda: report(out, out / "page.html"))


def test_tables_of_probes_of_a_wrong_form(out: Path) -> None:
    file = out / "probes" / "middle.csv"
    rows = list(csv.reader(file.read_text().splitlines()))
    with open_results(out) as results:
        for k in range(len(rows[0])):
            for cell in ("", "x", "nan", "inf", "-1e300", "1,2"):
                mine = [list(row) for row in rows]
                mine[0 if k % 2 else -1][k] = cell
                file.write_text("".join(",".join(row) + "\n" for row in mine))
                what = ("probe", rows[0][k], cell)
                if in_a_sentence(what, lambda: results.probe("middle")):
                    seen = results.probe("middle")
                    tables = {"middle": {name: np.asarray(seen[name]) for name in seen}}
                    in_a_sentence(what, partial(draw_probes, tables, results.units))


def look_at(out: Path, pictures: bool) -> None:
    with open_results(out) as results:
        export(results, -1, out / "x.csv", where="body=block, velocity_x < 1", strain=True)
        results.surface(-1)
        results.solid_fraction((0, 0), (1, 1), -1)
        results.grains(-1)
        results.contacts(-1)
        results.coordination_number(-1)
        results.track(0)
        results.line((0, 0), (1, 1), "pressure")
        results._repr_html_()
        if pictures:
            draw_results(results, -1, "body")
            draw_results(results, -1, "pressure")


def test_results_of_a_wrong_form(out: Path) -> None:
    """The attribute `run` and the tables of frames of results.vtkhdf."""
    file = out / "results.vtkhdf"
    kept = file.read_bytes()
    with h5py.File(file) as h5:
        told = json.loads(h5["mpm3dpp"].attrs["run"])
    for number, (path, value, data) in enumerate(mutations(told, 6)):
        with h5py.File(file, "a") as h5:
            h5["mpm3dpp"].attrs["run"] = json.dumps(data)
        in_a_sentence(("results", path, value), partial(look_at, out, number % 7 == 0))
        file.write_bytes(kept)
    for name, values in {
        "VTKHDF/Steps/Values": [np.array(["a", "b", "c"], dtype="S1"), [1.0], [[0.0, 1.0, 2.0]], 3],
        "VTKHDF/FieldData/step": [[0.5, 1.0, 2.0], [1], np.nan],
        "VTKHDF/PointData": [[1.0]],
        "VTKHDF/FieldData": [[1.0]],
        "VTKHDF/Steps": [[1.0]],
    }.items():
        for value in values:
            with h5py.File(file, "a") as h5:
                del h5[name]
                h5[name] = value
            in_a_sentence(("results", name), partial(look_at, out, False))
            file.write_bytes(kept)
    for count in ("x", -1, 10**6, np.nan, [1, 2]):
        with h5py.File(file, "a") as h5:
            h5["VTKHDF/Steps"].attrs["NSteps"] = count
        in_a_sentence(("results", "NSteps", count), partial(look_at, out, False))
        file.write_bytes(kept)


def test_frames_of_a_wrong_form(out: Path) -> None:
    """The attribute `frame` and the arrays of the last frame's file."""
    file = sorted((out / "results.frames").glob("*.h5"))[-1]
    kept = file.read_bytes()
    with h5py.File(file) as h5:
        told = json.loads(h5.attrs["frame"])
        arrays = list(h5["arrays"])
        tables = list(h5["tables"])
    refused = 0
    for number, (path, value, data) in enumerate(mutations(told, 6)):
        with h5py.File(file, "a") as h5:
            h5.attrs["frame"] = json.dumps(data)
        refused += not in_a_sentence(("frame", path, value), partial(look_at, out, number % 9 == 0))
        file.write_bytes(kept)
    assert refused > 60
    odd = [np.array([b"x"]), [1.0, 2.0], 3, np.zeros((2, 2, 2)), None]
    for name in [*(f"arrays/{a}" for a in arrays), *(f"tables/{t}" for t in tables)]:
        for value in odd:
            with h5py.File(file, "a") as h5:
                del h5[name]
                if value is not None:
                    h5[name] = value
            assert not in_a_sentence(("frame", name), partial(look_at, out, False)), name
            file.write_bytes(kept)
    with h5py.File(file, "a") as h5:  # A group where an array was.
        del h5["arrays/position"]
        h5.create_group("arrays/position")
    assert not in_a_sentence("a group", partial(look_at, out, False))


def test_a_damaged_manifest_keeps_no_picture_from_being_drawn(out: Path) -> None:
    """What is told names the file; and the other pictures are there."""
    (out / "manifest.json").write_text('{"case": [1], "contact": 3}')
    with pytest.raises(CaseError, match=r"manifest.json' is not a manifest of mpm3dpp, or damaged"):
        plot_results(out)
    assert {"frame.png", "energies.png", "probes.png"} <= {p.name for p in out.glob("*.png")}


def test_who_reads_is_told_which_entry_is_wrong(out: Path) -> None:
    data = json.loads((out / "manifest.json").read_text())
    data["warnings"] = [{"kind": 3}]
    (out / "manifest.json").write_text(json.dumps(data))
    with pytest.raises(
        CaseError, match=r"damaged \(warnings\.0\.kind: .* valid string\); remove it"
    ):
        stored_manifest(out)

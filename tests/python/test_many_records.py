# SPDX-License-Identifier: BSD-3-Clause
"""Runs with very much of something: bodies, probes, frames; and what a resume leaves as it was."""

from __future__ import annotations

import resource
import tracemalloc
from pathlib import Path

import numpy as np
import pytest

from commands import CASE, write
from mpm3dpp import CaseError, load_case, run_case
from mpm3dpp.fill.advisories import notes
from mpm3dpp.fill.build import build
from mpm3dpp.io import HistoryWriter, read_manifest
from mpm3dpp.io.pair_columns import pairs_of
from mpm3dpp.ranks import launch
from mpm3dpp.run.probes import _MOST_OPEN
from mpm_text import GOOD, PART, of

SHORT = CASE.replace("8 ms", "0.5 ms")


@pytest.mark.parametrize("more", ["", "gravity = [0, -9.81]\n"])
def test_bodies_keep_their_bits_where_a_resume_makes_no_step(tmp_path: Path, more: str) -> None:
    """A rotating block leaves cells in its last step: in other lists its sums round otherwise."""
    text = CASE.replace("[output]", f"{more}[output]").replace("8 ms", "3 ms")
    case = load_case(write(tmp_path, text + 'angular_velocity = "40 rad/s"\n'))
    run_case(case, tmp_path / "out", threads=1, pictures=False, quiet=True)
    before = read_manifest(tmp_path / "out")
    run_case(case, tmp_path / "out", threads=1, pictures=False, quiet=True, resume=True)
    again = read_manifest(tmp_path / "out")
    assert again["bodies"] == before["bodies"]
    for name in ("energies", "result_hash", "mass", "steps"):
        assert again[name] == before[name], name
    assert again["contact"]["pairs"] == before["contact"]["pairs"]
    assert again["resumed_step"] == before["steps"]


def test_pairs_of_many_bodies_are_not_listed(tmp_path: Path) -> None:
    """5,000 have 12.5 million pairs, a gigabyte; the lists of their names take a megabyte."""
    bodies = [f"body_{k}" for k in range(5000)]
    columns = ["step", "time", "dt"]
    tracemalloc.start()
    with HistoryWriter(tmp_path / "history.csv", columns=columns, bodies=bodies):
        pass
    header = {"contact_force_body_7_body_4999_x": np.zeros(1)}
    assert [*pairs_of(header, bodies)] == [("body_7", "body_4999", next(iter(header))[:-2])]
    most = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert most < 20e6


def test_names_with_underscores_are_told_apart() -> None:
    found = [*pairs_of(["contact_force_a_b_c_x", "contact_force_no_one_x"], ["a_b", "c", "b"])]
    assert found == [("a_b", "c", "contact_force_a_b_c")]


def test_more_probes_than_files_may_be_open(tmp_path: Path) -> None:
    count = _MOST_OPEN + 40
    probes = "".join(f'[probe.p{k}]\npoint = ["{k % 50} mm", "20 mm"]\n' for k in range(count))
    case = load_case(write(tmp_path, SHORT + probes))
    soft, hard = resource.getrlimit(resource.RLIMIT_NOFILE)
    opened = len(list(Path("/proc/self/fd").iterdir()))
    resource.setrlimit(resource.RLIMIT_NOFILE, (opened + count // 2, hard))
    try:
        run_case(case, tmp_path / "out", threads=1, pictures=False, quiet=True)
        with_few = load_case(write(tmp_path, SHORT + '[probe.p9]\npoint = ["9 mm", "20 mm"]\n'))
        run_case(with_few, tmp_path / "few", threads=1, pictures=False, quiet=True)
    finally:
        resource.setrlimit(resource.RLIMIT_NOFILE, (soft, hard))
    tables = sorted((tmp_path / "out" / "probes").glob("*.csv"))
    assert len(tables) == count
    one = (tmp_path / "few" / "probes" / "p9.csv").read_text()
    assert (tmp_path / "out" / "probes" / "p9.csv").read_text() == one and one.count("\n") > 5


def test_more_frames_than_steps(tmp_path: Path) -> None:
    """One at a step at most, and `check` counts those."""
    from mpm3dpp.run.summary import frames_in_words

    case = load_case(write(tmp_path, SHORT.replace("frames = 4", "frames = 100000")))
    done = run_case(case, tmp_path / "out", threads=1, pictures=False, quiet=True)
    files = list((tmp_path / "out" / "results.frames").glob("*.h5"))
    assert len(files) == done.steps + 1 < 20
    assert int(frames_in_words(case, build(case)).split()[0]) <= done.steps + 2


def test_advice_to_resume_only_where_there_is_a_checkpoint(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(launch, "command_of", lambda *_: (["false"], {}))
    monkeypatch.setattr(launch._Job, "run", lambda *_: 1)
    for can, words in ((True, "--resume goes on"), (False, "no checkpoint to go on from")):
        with pytest.raises(launch.RunError, match=words):
            launch.launch(2, ["run"], 1, lambda can=can: can)  # type: ignore[misc]


def test_an_mpm_file_with_gravity_and_no_particles() -> None:
    load = "load\n grav 1 0 0 -9.8\nendl\nendi"
    for old in (load, load.replace("grav", "body"), "endi"):
        text = GOOD.replace(PART, "").replace("velo\n body 1 0.0 0.0 -100.0\nendv\n", "")
        with pytest.raises(CaseError, match="part is missing; add a part statement"):
            of(text.replace("endi", old))


def told(folder: Path, text: str) -> list[str]:
    case = load_case(write(folder, text))
    return notes(case, build(case))


def test_a_grain_in_another_unit_is_noted(tmp_path: Path) -> None:
    grains = CASE[: CASE.index("[body.left]")] + '[grains.g]\nmaterial = "soft"\nfile = "g.csv"\n'
    rows = [f"{0.1 * k},0,0.02" for k in range(9)]
    for odd, words in (("9,0,1.6", "g_0009 has a radius of 1.6 m, 80 times"), ("9,0,0.02", "")):
        (tmp_path / "g.csv").write_text("\n".join(["x,y,radius", *rows, odd]) + "\n")
        found = [note for note in told(tmp_path, grains) if "radius" in note]
        assert len(found) == bool(words) and words in "".join(found)


def test_nearly_incompressible_is_told_as_it_is(tmp_path: Path) -> None:
    """sqrt((1 - nu) / (1 + nu) / (1 - 2 nu)) is 12.9 with 0.499 and 1291 with 0.4999999."""
    found = told(tmp_path, CASE.replace("nu = 0.3", "nu = 0.4999999"))
    assert [note for note in found if "nu = 0.4999999: waves are 99.9 times as fast" in note], found
    assert not [note for note in told(tmp_path, CASE.replace("0.3 }", "0.49 }")) if "waves" in note]

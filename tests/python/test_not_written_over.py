# SPDX-License-Identifier: BSD-3-Clause
"""Only what mpm3dpp has written is written over: no file of the user's, by any command."""

from __future__ import annotations

import shutil
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest
from matplotlib.figure import Figure

from commands import CASE, mpm3dpp, one_sentence, write
from mpm3dpp import Case, CaseError, Simulation, load_case, open_results, record, report, run_case
from mpm3dpp.plots import plot_results, preview
from mpm3dpp.sweep.plan import plan_of

SHORT = CASE.replace("8 ms", "0.2 ms")
PROBED = SHORT + '[probe.tip]\npoint = ["25 mm", "25 mm"]\nfields = ["velocity"]\n'
MINE = "of the user\n"
NO_RUN = "is there already, and no run of mpm3dpp has written it; move it away"
NOT_OURS = "is there already, and is none that mpm3dpp has written here; give another name"


def state_of(folder: Path) -> dict[str, bytes]:
    files = (path for path in sorted(folder.rglob("*")) if path.is_file())
    return {str(path.relative_to(folder)): path.read_bytes() for path in files}


@pytest.fixture(scope="module")
def made(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("made")
    run_case(load_case(write(folder, SHORT)), folder / "out", threads=1, pictures=False)
    return folder / "out"


@pytest.fixture
def out(tmp_path: Path, made: Path) -> Iterator[Path]:
    """The folder of a run, to be changed."""
    shutil.copytree(made, tmp_path / "out")
    yield tmp_path / "out"


@pytest.mark.parametrize(
    "name",
    [
        *("history.csv", "manifest.json", "results.vtkhdf", "checkpoint.zip", "frame.png"),
        *("energies.png", "report.html", "contact_pairs.csv", "probes/tip.csv", "animation.gif"),
        "results.frames/000000.h5",
    ],
)
@pytest.mark.parametrize("more", [(), ("--anew",)], ids=["run", "anew"])
def test_a_run_in_a_folder_with_such_a_file(
    tmp_path: Path, name: str, more: tuple[str, ...]
) -> None:
    """Also `--anew`, which is about runs."""
    case, mine = write(tmp_path, PROBED), tmp_path / "out" / name
    mine.parent.mkdir(parents=True)
    mine.write_text(MINE)
    before = state_of(tmp_path)
    done = mpm3dpp("run", case, "--out", "out", *more, cwd=tmp_path)
    assert done.returncode == 2
    assert f"'out/{name}' {NO_RUN}" in one_sentence(done.stderr)
    assert state_of(tmp_path) == before


def test_a_run_beside_other_files(tmp_path: Path) -> None:
    """In the folder of its case, and again there."""
    write(tmp_path, PROBED)
    (tmp_path / "notes.txt").write_text(MINE)
    (tmp_path / "probes").mkdir()
    (tmp_path / "probes" / "mine.csv").write_text(MINE)
    for more in ((), (), ("--anew",)):
        done = mpm3dpp("run", "case.toml", "--out", ".", *more, cwd=tmp_path)
        assert done.returncode == 0, done.stderr
    assert (tmp_path / "case.toml").read_text() == PROBED
    assert (tmp_path / "notes.txt").read_text() == MINE
    assert (tmp_path / "probes" / "mine.csv").read_text() == MINE


def test_a_probe_of_the_name_of_a_table(tmp_path: Path, out: Path) -> None:
    """In the folder of a run, with a table of the user's among those of probes."""
    (out / "probes").mkdir()
    (out / "probes" / "tip.csv").write_text(MINE)
    with pytest.raises(CaseError, match=NO_RUN):
        run_case(load_case(write(tmp_path, PROBED)), out, threads=1, pictures=False)
    with (
        pytest.raises(CaseError, match=NO_RUN),
        record(Simulation(load_case(tmp_path / "case.toml"), threads=1), out),
    ):
        pass
    assert (out / "probes" / "tip.csv").read_text() == MINE


def test_a_run_whose_points_have_the_name_of_its_history(tmp_path: Path) -> None:
    """An input as an output."""
    points = "x,y\n0.0005,0.0005\n0.0015,0.0005\n"
    (tmp_path / "history.csv").write_text(points)
    text = SHORT[: SHORT.index("[body.left]")] + '[body.rod]\nmaterial = "soft"\n'
    write(tmp_path, text.replace("10 mm", "1 mm") + 'particles = "history.csv"\n')
    done = mpm3dpp("run", "case.toml", "--out", ".", "--anew", cwd=tmp_path)
    assert done.returncode == 2 and NO_RUN in one_sentence(done.stderr)
    assert (tmp_path / "history.csv").read_text() == points


def test_a_run_that_was_killed_may_begin_anew(tmp_path: Path, out: Path) -> None:
    """Of which nothing may be left but a part of a table."""
    case = load_case(write(tmp_path, SHORT))
    for left in ("history.csv", "results.vtkhdf", "manifest.json"):
        text = (out / left).read_bytes()
        for path in [*out.iterdir()]:
            shutil.rmtree(path) if path.is_dir() else path.unlink()
        (out / left).write_bytes(text if left != "history.csv" else text[: len(text) // 2])
        (out / "results.frames").mkdir()
        run_case(case, out, threads=1, pictures=False)
    (out / "history.csv").write_text("")
    run_case(case, out, threads=1, pictures=False)


# Commands that write a file that the user names.
NAMED = {
    "csv": ("export", "out", "--out"),
    "vtu": ("export", "out", "--format", "vtu", "--out"),
    "vtp": ("export", "out", "--format", "vtp", "--out"),
    "png": ("preview", "case.toml", "--out"),
    "svg": ("preview", "case.toml", "--out"),
    "pdf": ("preview", "case.toml", "--out"),
    "html": ("report", "out", "--output"),
    "gif": ("plot", "out", "--movie"),
}


@pytest.mark.parametrize(
    "ending",
    # The others are written by the same commands.
    [e if e in ("csv", "png", "html") else pytest.param(e, marks=pytest.mark.slow) for e in NAMED],
)
def test_a_file_that_the_user_names(tmp_path: Path, out: Path, ending: str) -> None:
    """Refused where it is the user's; replaced where the same command has written it."""
    if ending in ("vtu", "vtp"):
        pytest.importorskip("pyvista")
    write(tmp_path, SHORT)
    name = f"named.{ending}"
    (tmp_path / name).write_text(MINE)
    done = mpm3dpp(*NAMED[ending], name, cwd=tmp_path)
    assert done.returncode == 2 and f"{name} {NOT_OURS}" in one_sentence(done.stderr)
    assert (tmp_path / name).read_text() == MINE
    (tmp_path / name).unlink()
    for _ in range(2):
        done = mpm3dpp(*NAMED[ending], name, cwd=tmp_path)
        assert done.returncode == 0, done.stderr
        assert (tmp_path / name).stat().st_size > 500


@pytest.mark.parametrize(
    "name", ["case.toml", "points.csv", "out/history.csv", "out/manifest.json"]
)
@pytest.mark.parametrize("kind", ["csv", "vtu"])
def test_an_export_over_another_file(tmp_path: Path, out: Path, name: str, kind: str) -> None:
    if kind == "vtu":
        pytest.importorskip("pyvista")
    write(tmp_path, SHORT)
    (tmp_path / "points.csv").write_text("x,y\n1,2\n")
    before = state_of(tmp_path)
    done = mpm3dpp("export", "out", "--format", kind, "--out", name, cwd=tmp_path)
    assert done.returncode == 2 and f"{name} {NOT_OURS}" in one_sentence(done.stderr)
    assert state_of(tmp_path) == before


def test_files_for_vtk_with_our_mark_are_read(tmp_path: Path, out: Path) -> None:
    pyvista = pytest.importorskip("pyvista")
    for kind in ("vtu", "vtp"):
        done = mpm3dpp("export", "out", "--format", kind, "--out", f"x.{kind}", cwd=tmp_path)
        assert done.returncode == 0, done.stderr
        cloud = pyvista.read(tmp_path / f"x.{kind}")
        with open_results(out) as results:
            points = results.arrays(-1)["position"]
        assert np.array_equal(np.asarray(cloud.points), points)
        assert {"velocity", "stress"} <= set(cloud.point_data)


def test_pictures_of_the_user(tmp_path: Path, out: Path) -> None:
    """One of matplotlib's is not ours for that; in the folder of a run `frame.png` is."""
    figure = Figure()
    figure.savefig(tmp_path / "mine.png")
    mine = (tmp_path / "mine.png").read_bytes()
    (tmp_path / "frame.png").write_bytes(mine)
    for draw, sentence in (
        (lambda: preview(load_case(write(tmp_path, SHORT)), tmp_path / "mine.png"), NOT_OURS),
        (lambda: plot_results(out, out=tmp_path), NOT_OURS),
        (lambda: report(out, tmp_path / "mine.png"), "must end in .html"),
    ):
        with pytest.raises(CaseError, match=sentence):
            draw()
    assert (tmp_path / "mine.png").read_bytes() == (tmp_path / "frame.png").read_bytes() == mine
    (out / "frame.png").write_bytes(mine)  # As that of an earlier version, without a mark.
    plot_results(out)
    assert (out / "frame.png").read_bytes() != mine


def test_other_tables_and_states(tmp_path: Path) -> None:
    (tmp_path / "results" / "material_test").mkdir(parents=True)
    words = ("material-test", "copper_ofhc", "--test", "uniaxial-stress", "--rate", "1")
    table = tmp_path / "results" / "material_test" / "copper_ofhc_uniaxial_stress.csv"
    table.write_text("strain,stress\n0,0\n")
    done = mpm3dpp(*words, cwd=tmp_path)
    assert done.returncode == 2 and NOT_OURS in one_sentence(done.stderr), done.stderr
    assert table.read_text() == "strain,stress\n0,0\n"
    simulation = Simulation(Case.from_text(SHORT), threads=1)
    with pytest.raises(CaseError, match=NOT_OURS):
        simulation.save(table)
    for _ in range(2):
        simulation.save(tmp_path / "state.zip")


def test_pages_of_the_paper(tmp_path: Path) -> None:
    (tmp_path / "out").mkdir()
    (tmp_path / "out" / "reproduce.md").write_text(MINE)
    done = mpm3dpp("reproduce", "--only", "rings", "--out", "out", cwd=tmp_path)
    assert done.returncode == 2 and NOT_OURS in one_sentence(done.stderr)


def test_folders_of_sweeps_over_keys_of_one_last_word() -> None:
    box = 'box = { lower = [0, 0], upper = ["20 cm", "20 cm"], walls = "contact", friction = 0.1 }'
    case = Case.from_text(SHORT.replace("[grid]", f"[grid]\n{box}"))
    keys = ("contact.friction", "grid.box.friction")
    names = [plan_of(case, [f"{key}=0,0.1"], Path())[1].folder.name for key in keys]
    assert names == ["contact.friction=0.1", "grid.box.friction=0.1"]
    long = [f"body.left.velocity=[1,0.{'0' * 90}{k}]" for k in range(1, 3)]
    found = [plan_of(case, [word], Path())[0].folder.name for word in long]
    assert len(set(found)) == 2 and max(map(len, found)) < 100
    signs = [plan_of(case, [f"body.left.velocity={v}"], Path())[0] for v in ("[1,2]", "[1, 2]")]
    assert len({planned.folder for planned in signs}) == 2


def test_a_sweep_over_runs_of_another_case(tmp_path: Path) -> None:
    """In a folder that it was told, or by chance: two files of one name have one default folder."""
    words = ("--set", "contact.friction=0", "--out", "out")
    for name in ("a", "b"):
        (tmp_path / name).mkdir()
        write(tmp_path / name, SHORT.replace("Two blocks", name))
    assert mpm3dpp("sweep", "a/case.toml", *words, cwd=tmp_path).returncode == 0
    before = state_of(tmp_path / "out" / "contact.friction=0")
    done = mpm3dpp("sweep", "b/case.toml", *words, cwd=tmp_path)
    assert done.returncode == 2
    assert "holds the run of another case, " in one_sentence(done.stderr)
    assert state_of(tmp_path / "out" / "contact.friction=0") == before
    (tmp_path / "out" / "contact.friction=1").mkdir()
    (tmp_path / "out" / "contact.friction=1" / "history.csv").write_text(MINE)
    more = ("--set", "contact.friction=1", "--out", "out")
    done = mpm3dpp("sweep", "a/case.toml", *more, cwd=tmp_path)
    assert done.returncode == 2 and NO_RUN in one_sentence(done.stderr)
    # A case that has been edited is the same one: its runs are made again.
    write(tmp_path / "a", SHORT.replace("Two blocks", "edited"))
    assert mpm3dpp("sweep", "a/case.toml", *words, cwd=tmp_path).returncode == 0


def test_pictures_of_sweeps_and_benchmarks(tmp_path: Path) -> None:
    """Before anything is run."""
    write(tmp_path, SHORT)
    (tmp_path / "sweep.png").write_text(MINE)
    words = ("sweep", "case.toml", "--set", "contact.friction=0", "--out", ".")
    done = mpm3dpp(*words, cwd=tmp_path)
    assert done.returncode == 2 and NOT_OURS in one_sentence(done.stderr)
    done = mpm3dpp("bench", "elastic2d", "--size", "8", "--plot", "sweep.png", cwd=tmp_path)
    assert done.returncode == 2 and NOT_OURS in one_sentence(done.stderr)
    assert not (tmp_path / "contact.friction=0").exists()
    assert (tmp_path / "sweep.png").read_text() == MINE


LINKS = ["history.csv", "results.vtkhdf", "manifest.json", "frame.png", "checkpoint.zip"]


@pytest.mark.parametrize("name", [*LINKS, "results.frames", "probes", "probes/tip.csv"])
@pytest.mark.parametrize("there", [True, False], ids=["there", "dangling"])
def test_links_are_not_followed(tmp_path: Path, made: Path, name: str, there: bool) -> None:
    """Not even to what is a run's: it may be that of another."""
    target, out = tmp_path / "target", tmp_path / "out"
    (out / name).parent.mkdir(parents=True)
    if there and (made / name).exists():
        copy = shutil.copytree if (made / name).is_dir() else shutil.copyfile
        copy(made / name, target)
    elif there:
        target.mkdir() if name == "probes" else target.write_text(MINE)
    (out / name).symlink_to(target)
    before = state_of(tmp_path)
    done = mpm3dpp("run", write(tmp_path, PROBED), "--out", "out", "--anew", cwd=tmp_path)
    assert done.returncode == 2
    assert f"out/{name} is a link, which is not followed when something is written" in (
        one_sentence(done.stderr)
    )
    (tmp_path / "case.toml").unlink()
    assert state_of(tmp_path) == before and target.exists() == there


@pytest.mark.parametrize("ending", ["csv", "png", "html", "gif"])
def test_a_link_that_the_user_names(tmp_path: Path, out: Path, ending: str) -> None:
    write(tmp_path, SHORT)
    (tmp_path / f"named.{ending}").symlink_to(tmp_path / "target")
    (tmp_path / "target").write_text("")
    done = mpm3dpp(*NAMED[ending], f"named.{ending}", cwd=tmp_path)
    assert done.returncode == 2 and "is a link, which is not followed" in one_sentence(done.stderr)
    assert (tmp_path / "target").read_text() == ""


def test_links_of_unfinished_files_are_not_followed(tmp_path: Path, out: Path) -> None:
    """They may have been put where a file is about to be written."""
    (tmp_path / "target").write_text(MINE)
    for name in ("manifest.json", "checkpoint.zip", "results.vtkhdf", "frame.png"):
        (out / f".{name}.new").symlink_to(tmp_path / "target")
    (out / "export").symlink_to(tmp_path)
    run_case(load_case(write(tmp_path, SHORT)), out, threads=1)
    done = mpm3dpp("export", "out", cwd=tmp_path)
    assert done.returncode == 2 and "is a link, which is not followed" in one_sentence(done.stderr)
    assert (tmp_path / "target").read_text() == MINE

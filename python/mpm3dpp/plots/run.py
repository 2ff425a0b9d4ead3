# SPDX-License-Identifier: BSD-3-Clause
"""The pictures of a finished (or broken off) run from its output folder."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

from mpm3dpp.base.errors import CaseError, first_of
from mpm3dpp.io.probe_tables import probe_names, read_probe
from mpm3dpp.io.read_history import read_history
from mpm3dpp.io.results import Results, open_results
from mpm3dpp.io.stored_manifest import read_manifest

from .contact import first_contact
from .look import PLAIN, Look
from .paint import default_colour

_A_HEAP = 10  # Grains of a name, from which their forces are drawn.


def draw_all(
    folder: Path,
    frame: int,
    animation: bool | None,
    colour: str | None,
    out: Path | None,
    look: Look = PLAIN,
    movie: Path | None = None,
    quiet: bool = True,
) -> Iterator[Path]:
    """See `mpm3dpp.plots.plot_results`; gives each picture when it is there.

    With a movie that alone is made, with progress on standard error unless `quiet`.
    """
    from .frames import save_frame

    source = folder if folder.is_dir() else folder.parent
    out = out or source
    wishes = _output(source)
    wished = colour or wishes.get("picture")
    animation = bool(wishes.get("animation")) if animation is None else animation
    with open_results(folder) as results:
        count = len(results)
        if count == 0:
            raise CaseError(
                f"'{results.path}' has no frame yet: wait for the run to write one, or "
                "let one that was stopped go on with `mpm3dpp run CASE --resume`"
            )
        if not -count <= frame < count:
            raise CaseError(
                f"frame {frame} does not exist in '{results.path}': "
                f"give 0 to {count - 1}, or -1 for the last"
            )
        colour = wished or default_colour(results)
        if movie is not None:
            from .movie import save_movie

            yield save_movie(results, movie, colour, look, quiet)
            return
        name = "frame.png" if frame == -1 else f"frame_{frame % count:04d}.png"
        yield save_frame(results, frame, out / name, colour, look=look)
        others: list[Callable[[], Path | None]] = [lambda: _energies(results, source, out)]
        others.append(lambda: _probes(results, source, out))
        others.append(lambda: _forces(results, frame, out))
        if animation:
            others.append(lambda: _animation(results, out, colour, look))
        others.append(lambda: first_contact(folder, out / "first_contact.png"))
        refused = []
        for make in others:
            try:
                picture = make()
            except CaseError as error:  # It is no reason to leave out the others.
                refused.append(error)
            else:
                if picture is not None:
                    yield picture
    if refused:
        raise first_of(refused)


def _energies(results: Results, source: Path, out: Path) -> Path | None:
    if not (source / "history.csv").is_file():
        return None
    from .energies import save_energies

    history = read_history(source)
    if len(history["time"]) == 0:
        return None
    return save_energies(history, out / "energies.png", results.dimension, results.bodies)


def _probes(results: Results, source: Path, out: Path) -> Path | None:
    tables = {name: read_probe(source, name) for name in probe_names(source)}
    if not any(len(table["time"]) for table in tables.values()):
        return None
    from .probes import save_probes

    return save_probes(tables, results.units, out / "probes.png")


def _forces(results: Results, frame: int, out: Path) -> Path | None:
    if "grains" not in results.tables(frame):
        return None
    if max(Counter(results.grains(frame)["name"]).values()) < _A_HEAP:
        return None
    from .force_network import save_force_network

    return save_force_network(results, frame, out / "force_network.png")


def _animation(results: Results, out: Path, colour: str, look: Look) -> Path:
    from .animation import save_animation

    return save_animation(results, out / "animation.gif", colour, look)


def _output(folder: Path) -> dict[str, Any]:
    """The table `output` of the case that was run; empty where there is no manifest."""
    try:
        case = read_manifest(folder).get("case") or {}
    except CaseError:
        return {}
    return case.get("output") or {}

# SPDX-License-Identifier: BSD-3-Clause
"""The pictures of a finished (or broken off) run from its output folder."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from mpm3dpp.errors import CaseError
from mpm3dpp.io.history import read_history
from mpm3dpp.io.manifest import read_manifest
from mpm3dpp.io.results import open_results


def plot_results(
    folder: Path, frame: int, animation: bool | None, colour: str | None, out: Path | None
) -> list[Path]:
    """See `mpm3dpp.plots.plot_results`."""
    from mpm3dpp.plots.frames import save_frame

    source = folder if folder.is_dir() else folder.parent
    out = out or source
    wishes = _output(source)
    colour = colour or wishes.get("picture") or "von_mises"
    animation = bool(wishes.get("animation")) if animation is None else animation
    made = []
    with open_results(folder) as results:
        count = len(results)
        if count == 0:
            raise CaseError(f"'{results.path}' has no frame yet: wait for the run to write one")
        if not -count <= frame < count:
            raise CaseError(
                f"frame {frame} does not exist in '{results.path}': "
                f"give 0 to {count - 1}, or -1 for the last"
            )
        name = "frame.png" if frame == -1 else f"frame_{frame % count:04d}.png"
        made.append(save_frame(results, frame, out / name, colour))
        if (source / "history.csv").is_file():
            from mpm3dpp.plots.energies import save_energies

            history = read_history(source)
            if len(history["time"]):
                made.append(
                    save_energies(history, out / "energies.png", results.dimension, results.bodies)
                )
        if animation:
            from mpm3dpp.plots.animation import save_animation

            made.append(save_animation(results, out / "animation.gif", colour))
    return made


def _output(folder: Path) -> dict[str, Any]:
    """The table `output` of the case that was run; empty where there is no manifest."""
    try:
        case = read_manifest(folder).get("case") or {}
    except CaseError:
        return {}
    return case.get("output") or {}

# SPDX-License-Identifier: BSD-3-Clause
"""Pictures of a run: frames, energies, animation, first contact, and a case before it runs.

Every function writes a PNG (or GIF) and returns its path; matplotlib is loaded when one is called.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

from mpm3dpp.base import arguments


def plot_results(
    folder: str | Path,
    frame: int = -1,
    animation: bool | None = None,
    colour: str | None = None,
    out: str | Path | None = None,
) -> list[Path]:
    """Make the pictures of a run: one frame, the energies, the first contact, maybe an animation.

    Args:
        folder: output folder of the run.
        frame: number of the frame; negative numbers count from the end.
        animation: also write `animation.gif` with all frames; default the case's
            `output.animation`.
        colour: array that colours the particles ("von_mises", "pressure", "speed", "body",
            "velocity_x", "stress_xy", ... or any stored field); default the case's
            `output.picture`, else "von_mises".
        out: folder for the pictures; default `folder`.

    Returns:
        paths of the pictures: `frame.png` (the last frame) or `frame_0012.png`,
        `energies.png` when there is a history, `probes.png` of probes, `first_contact.png` when
        bodies touched, `animation.gif`.

    Raises:
        CaseError: there are no results, no such frame or no such array; or a picture could not be
            drawn, after all others have been.
    """
    from .run import draw_all

    folder, frame = arguments.path("folder", folder), arguments.whole_number("frame", frame)
    colour = None if colour is None else arguments.text("colour", colour)
    out = None if out is None else arguments.path("out", out)
    return list(draw_all(folder, frame, animation, colour, out))


def first_contact(folder: str | Path, out: str | Path | None = None) -> Path | None:
    """Picture of the moment of first contact force, with the true gap between the surfaces.

    Args:
        folder: output folder of the run.
        out: the picture; default `first_contact.png` in `folder`.

    Returns:
        path of the picture; None when no bodies touched.
    """
    from .contact import first_contact as make

    out = None if out is None else arguments.path("out", out)
    return make(arguments.path("folder", folder), out)


def preview(case: Any, out: str | Path) -> Path:
    """Picture of the particles of a case before it runs, coloured by body, with box and cells.

    Args:
        case: a checked `mpm3dpp.case.Case`.
        out: the picture, or a folder for `preview.png`.
    """
    from .case_view import preview as make

    return make(case, arguments.path("out", out))


__all__ = ["first_contact", "plot_results", "preview"]

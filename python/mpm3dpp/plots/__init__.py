# SPDX-License-Identifier: BSD-3-Clause
"""Pictures of a run: frames, energies, animation, first contact, and a case before it runs.

Every function writes a picture and returns its path, but `draw_results`, which returns a figure;
matplotlib is loaded when one is called.
"""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

from mpm3dpp.base import arguments

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from mpm3dpp.io.results import Results


def plot_results(
    folder: str | Path,
    frame: int = -1,
    animation: bool | None = None,
    colour: str | None = None,
    out: str | Path | None = None,
    *,
    section: Any = None,
    view: Any = None,
    crop: Any = None,
    range: Any = None,
    size: Any = None,
    arrows: bool = False,
    movie: str | Path | None = None,
    quiet: bool = True,
) -> list[Path]:
    """Make the pictures of a run: one frame, the energies, the first contact, maybe an animation.

    Args:
        folder: output folder of the run.
        frame: number of the frame; negative numbers count from the end.
        animation: also write `animation.gif` with all frames; default the case's
            `output.animation`.
        colour: array that colours the particles ("von_mises", "pressure", "speed", "body",
            "velocity_x", "stress_xy", ... or any stored field); default the case's
            `output.picture`, else "von_mises", or "pressure" where no particle has a shear stress.
        out: folder for the pictures; default `folder`.
        section: a plane, in 3D: `{"y": 0.005}` or "y=5 mm". What lies on the viewer's side of it is
            cut away.
        view: from where one looks, in 3D: azimuth and elevation in degrees, `(-30, 20)` or
            "-30,20". From the azimuth 0 one looks along -x, from -90 along y; from the elevation 90
            down.
        crop: region that is drawn, `(x0, x1, y0, y1)` and, in 3D, z0, z1 if you like [m]; or text,
            "0,10 mm,0,5 mm".
        range: lowest and highest value of the colours, `(0, 20e6)` in SI units or "0,20 MPa".
        size: of the picture of the frame and of the movie [pixels], `(1920, 1080)` or "1920x1080".
        arrows: whether arrows show velocities.
        movie: write all frames to this file alone, .mp4 or .webm (by ffmpeg:
            `pip install imageio-ffmpeg`) or .gif.
        quiet: no progress of the movie on standard error.

    Returns:
        paths of the pictures: `frame.png` (the last frame) or `frame_0012.png`,
        `energies.png` when there is a history, `probes.png` of probes, `first_contact.png` when
        bodies touched, `animation.gif`; or of the movie.

    Raises:
        CaseError: there are no results, no such frame or no such array; an argument is wrong or
            does not suit these results; or a picture could not be drawn, after all others have
            been.
    """
    from .look import look_of
    from .run import draw_all

    folder, frame = arguments.path("folder", folder), arguments.whole_number("frame", frame)
    colour = None if colour is None else arguments.text("colour", colour)
    out = None if out is None else arguments.path("out", out)
    look = look_of(section, view, crop, range, size, arrows)
    film = None if movie is None else arguments.path("movie", movie)
    return list(draw_all(folder, frame, animation, colour, out, look, film, quiet))


def draw_results(
    results: Results,
    frame: int = -1,
    colour: str | None = None,
    **look: Any,
) -> Figure:
    """Return a picture of a frame as a matplotlib figure; see `Results.plot`.

    Args:
        results: of `open_results`.
        frame: its number; negative numbers count from the end.
        colour: see `plot_results`; by default as without a manifest there.
        look: section, view, crop, range, size and arrows, see `plot_results`.
    """
    from .frames import draw_frame
    from .look import look_of
    from .paint import default_colour

    colour = default_colour(results) if colour is None else arguments.text("colour", colour)
    return draw_frame(results, frame, colour, dpi=_DPI_INLINE, look=look_of(**look))


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
    """Picture of the particles of a case before it runs: bodies, grains, box, walls and cells.

    Args:
        case: a checked `mpm3dpp.case.Case`.
        out: the picture, or a folder for `preview.png`.
    """
    from .case_view import preview as make

    return make(case, arguments.path("out", out))


_DPI_INLINE = 110  # Pixels per inch of a figure that a notebook shows.

__all__ = ["draw_results", "first_contact", "plot_results", "preview"]

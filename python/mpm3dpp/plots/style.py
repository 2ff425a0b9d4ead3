# SPDX-License-Identifier: BSD-3-Clause
"""The look of all pictures: fonts, lines, colours of bodies, saving."""

from __future__ import annotations

import contextlib
from collections.abc import Iterator, Mapping, Sequence
from itertools import cycle
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from mpm3dpp.base.disk import make_folder, replacing, writing
from mpm3dpp.base.errors import CaseError
from mpm3dpp.base.ours import MARK
from mpm3dpp.base.reading import refuse_nul
from mpm3dpp.io.foreign import refuse_to_draw

from .labels import short

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from .inline import InlineFigure

DPI = 200

# Colours that colour-blind readers can tell apart (Okabe & Ito, 2008), darkest contrasts first.
PALETTE = (
    *("#0072B2", "#E69F00", "#009E73", "#CC79A7", "#D55E00", "#56B4E9", "#8C6BB1"),
    *("#B2A300", "#7F7F7F"),
)

MOST_NAMES = 12
"""Bodies that a legend names at most."""

MAPS = {"speed": "plasma", "velocity": "plasma"}
"""Colour maps of some arrays; signed arrays get a map that is white at zero, others viridis."""

_LETTER, _SQUARE = 0.065, 0.45  # Inches of a legend: a letter's width, and what a name needs more.
_NOISE = 0.02  # a range that passes zero by less than this share counts as one-sided

_SETTINGS: Any = {
    "font.family": "sans-serif",
    "font.sans-serif": ["DejaVu Sans"],
    "font.size": 9,
    "axes.titlesize": 10,
    "axes.labelsize": 9,
    "axes.linewidth": 0.8,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.axisbelow": True,
    "axes.formatter.limits": (-3, 4),
    "axes.formatter.use_mathtext": True,
    "xtick.labelsize": 8,
    "ytick.labelsize": 8,
    "xtick.direction": "out",
    "legend.fontsize": 8,
    "legend.frameon": False,
    "lines.linewidth": 1.4,
    "grid.color": "#e3e3e3",
    "grid.linewidth": 0.6,
    "mathtext.default": "regular",
    "savefig.facecolor": "white",
}


_PROGRAM = {"png": "Software", **dict.fromkeys(("pdf", "ps", "eps", "svg"), "Creator")}
"""Where formats of pictures have the name of the program that has made them."""


@contextlib.contextmanager
def styled() -> Iterator[None]:
    """Our settings of matplotlib inside the block; the user's own stay untouched."""
    import matplotlib

    with matplotlib.rc_context(_SETTINGS):
        yield


def new_figure(width: float, height: float, dpi: float = DPI) -> InlineFigure:
    """A figure of a size in inches that draws to a file and never opens a window."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg

    from .inline import InlineFigure

    figure = InlineFigure(figsize=(width, height), dpi=dpi, layout="constrained")
    figure.settings = _SETTINGS
    FigureCanvasAgg(figure)
    return figure


def picture_path(path: Path) -> Path:
    """Return a picture's path if a picture can be written there.

    Raises:
        CaseError: its ending is of no picture, or something stands there that is no file.
    """
    from matplotlib.backend_bases import FigureCanvasBase

    refuse_nul(path)
    endings = FigureCanvasBase.get_supported_filetypes()
    ending = path.suffix.removeprefix(".").lower()
    if ending not in endings:
        rule = f'has the ending "{path.suffix}", which is of no picture'
        raise CaseError(rule, f"valid here: {', '.join(endings)}", key=str(path))
    with writing(path):
        if path.exists() and not path.is_file():
            raise CaseError("is no file", "choose another name for the picture", key=str(path))
    return path


def save(figure: Figure, path: Path, whole: bool = False) -> Path:
    """Write a picture, the white margin cut off unless it is wanted whole.

    Raises:
        CaseError: that fails, or a file is there that is not ours.
    """
    picture_path(path)
    make_folder(path.parent)
    refuse_to_draw(path)
    with replacing(path) as file:
        form = path.suffix.lstrip(".")
        cut: dict[str, Any] = {} if whole else {"bbox_inches": "tight", "pad_inches": 0.06}
        if program := _PROGRAM.get(form.lower()):
            cut["metadata"] = {program: MARK}
        figure.savefig(file, format=form, dpi="figure", **cut)
    return path


def body_colours(bodies: np.ndarray) -> np.ndarray:
    """Colour of each particle by its body, shape (n, 3), values 0 to 1."""
    from matplotlib.colors import to_rgb

    table = np.array([to_rgb(colour) for colour in PALETTE], dtype=np.float32)
    return table[np.asarray(bodies, dtype=int) % len(PALETTE)]


def colour_scale(name: str, low: float, high: float, exact: bool = False) -> tuple[Any, Any]:
    """Colour map and norm for an array and its range.

    Signed ranges are made symmetric about zero, with white there. A range from near zero
    starts at zero. An exact range stays as it is, with white at zero if it is signed.
    """
    import matplotlib
    from matplotlib.colors import Normalize

    if not (np.isfinite(low) and np.isfinite(high)):
        low, high = 0.0, 1.0
    most = max(abs(low), abs(high))
    if exact:
        return _exact_scale(name, low, high)
    if low < -_NOISE * most and high > _NOISE * most:
        return matplotlib.colormaps["RdBu_r"], Normalize(-most, most)
    if -_NOISE * most <= low < 0.5 * high:
        low = 0.0
    if high <= _NOISE * most:
        high = 0.0
    if high <= low:
        high = low + (abs(low) * 1e-3 or 1.0)
    return matplotlib.colormaps[MAPS.get(name, "viridis")], Normalize(low, high)


def legend_of_bodies(
    figure: Figure,
    names: list[str],
    notes: list[str] | None = None,
    grains: Mapping[int, np.ndarray] | None = None,
    others: Sequence[Any] = (),
) -> None:
    """A legend with one coloured square per body, below all else, where it hides nothing.

    Args:
        figure: gets the legend, unless there are too many bodies, or one alone without a note.
        names: of the bodies; long ones are cut.
        notes: what to say behind the names.
        grains: colours of the grains of a name, by its number, shape (grains, 3).
        others: what else the legend explains, with labels.
    """
    from matplotlib.legend_handler import HandlerTuple
    from matplotlib.patches import Patch

    if len(names) > MOST_NAMES or (len(names) == 1 and notes is None):
        names = []
    if not names and not others:
        return
    labels = [short(name) + note for name, note in zip(names, notes or cycle([""]), strict=False)]
    handles: list[Any] = []
    for k in range(len(names)):
        own = (grains or {}).get(k, [PALETTE[k % len(PALETTE)]])
        handles.append(tuple(Patch(facecolor=colour) for colour in _first_colours(own)))
    handles += others
    labels += [other.get_label() for other in others]
    wide = _LETTER * max(map(len, labels)) + _SQUARE
    columns = max(1, min(len(labels), int(figure.get_figwidth() / wide)))
    figure.legend(
        handles, labels, handlelength=2.2 if others else 1.0, handleheight=1.0, ncols=columns,
        loc="outside lower center", handler_map={tuple: HandlerTuple(ndivide=None, pad=0.0)},
    )  # fmt: skip


def _first_colours(colours: Any) -> list[Any]:
    """Return the first three different ones of some colours."""
    every = [one if isinstance(one, str) else tuple(map(float, one)) for one in colours]
    return list(dict.fromkeys(every))[:3]


def _exact_scale(name: str, low: float, high: float) -> tuple[Any, Any]:
    """See `colour_scale`: the part of the signed colours that a range about zero needs."""
    import matplotlib
    from matplotlib.colors import ListedColormap, Normalize

    if not low < 0.0 < high:
        return matplotlib.colormaps[MAPS.get(name, "viridis")], Normalize(low, high)
    most = max(-low, high)
    places = np.linspace(0.5 + 0.5 * low / most, 0.5 + 0.5 * high / most, 256)
    colours = matplotlib.colormaps["RdBu_r"](places)
    return ListedColormap(colours, name="signed"), Normalize(low, high)

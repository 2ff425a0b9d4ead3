# SPDX-License-Identifier: BSD-3-Clause
"""All frames of a run as an animated GIF."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from mpm3dpp.base.disk import make_folder, replacing
from mpm3dpp.base.ours import MARK

from .frames import View, draw_frame, view_of
from .look import PLAIN, Look
from .style import styled

if TYPE_CHECKING:
    from mpm3dpp.io.results import Results

Told = Callable[[int, int], None]
"""Is called after each frame with the number of those drawn and of all."""

LENGTH = 6.0  # seconds that the animation lasts, within the limits of the frame rate
_DPI = 110
_MOST_FRAMES = 150


def save_animation(
    results: Results,
    path: Path,
    colour: str = "von_mises",
    look: Look = PLAIN,
    most: int = _MOST_FRAMES,
    told: Told | None = None,
) -> Path:
    """Write the frames, evenly spaced in time, with one view and one range of colours.

    Args:
        results: of `open_results`.
        path: the GIF.
        colour: array that colours the particles, see `labels.choose`.
        look: what else was asked for.
        most: frames.
        told: see `Told`.

    Raises:
        CaseError: there is no such array, or the file cannot be written.
    """
    frames = evenly(results.times, most)
    view = view_of(results, frames, colour, look)
    few = dict(pictures(results, _spread(frames, 4), colour, look, view))
    palette = _palette(list(few.values()))
    rest = pictures(results, [k for k in frames if k not in few], colour, look, view)
    shown, inked = [], []
    for frame in frames:  # A byte a pixel stays of each.
        picture = few.pop(frame) if frame in few else next(rest)[1]
        inked.append(_inked(picture))
        shown.append(picture.quantize(palette=palette, dither=0))
        if told is not None:
            told(len(shown), len(frames))
    if look.size is None:
        shown = _without_margins(shown, [box for box in inked if box])
    milliseconds = int(np.clip(1e3 * LENGTH / len(shown), 40, 250))
    durations = [milliseconds] * len(shown)
    durations[-1] = 1200
    make_folder(path.parent)
    with replacing(path) as file:
        shown[0].save(
            file,
            format="GIF",
            save_all=True,
            append_images=shown[1:],
            duration=durations,
            loop=0,
            comment=MARK.encode(),
        )
    return path


def evenly(times: np.ndarray, most: int) -> list[int]:
    """Frames nearest to evenly spaced times: extra frames must not make the motion falter."""
    count = min(len(times), most)
    wanted = np.linspace(times[0], times[-1], count)
    nearest = [int(np.argmin(np.abs(times - time))) for time in wanted]
    return list(dict.fromkeys(nearest))


def pictures(
    results: Results, frames: list[int], colour: str, look: Look, view: View
) -> Iterator[tuple[int, Any]]:
    """Yield the number and the picture of each frame, all of one size."""
    from PIL import Image

    for frame in frames:
        figure = draw_frame(results, frame, colour, view, _DPI, look)
        with styled():
            figure.canvas.draw()
        pixels = np.asarray(figure.canvas.buffer_rgba())  # type: ignore[attr-defined]
        yield frame, Image.fromarray(pixels[..., :3].copy())


def _spread(frames: list[int], count: int) -> list[int]:
    """Some of the frames, from the first to the last."""
    some = np.linspace(0, len(frames) - 1, count).astype(int)
    return [frames[k] for k in dict.fromkeys(some.tolist())]


def _palette(pictures: list[Any]) -> Any:
    """One set of colours for the whole animation, from a few of its pictures side by side."""
    from PIL import Image

    width, height = pictures[0].size
    sheet = Image.new("RGB", (width * len(pictures), height))
    for k, picture in enumerate(pictures):
        sheet.paste(picture, (k * width, 0))
    colours = sheet.quantize(colors=254, method=Image.Quantize.MEDIANCUT)
    table = np.array(colours.getpalette() or [], dtype=np.uint8).reshape(-1, 3)[:254]
    table[(table >= 246).all(axis=1)] = 255  # the paper stays white
    colours.putpalette([*table.ravel().tolist(), 0, 0, 0, 255, 255, 255])
    return colours


def _inked(picture: Any) -> tuple[int, int, int, int] | None:
    """The box of a picture that is not white: left, top, right, low; None if there is none."""
    from PIL import Image, ImageChops

    white = Image.new("RGB", picture.size, "white")
    box: tuple[int, int, int, int] | None = ImageChops.difference(picture, white).getbbox()
    return box


def _without_margins(pictures: list[Any], inked: list[tuple[int, int, int, int]]) -> list[Any]:
    """All pictures cut alike, so that only a thin white margin remains."""
    used = np.array(inked)
    width, height = pictures[0].size
    left, top = np.maximum(used[:, :2].min(axis=0) - 8, 0).tolist()
    right, low = np.minimum(used[:, 2:].max(axis=0) + 8, [width, height]).tolist()
    return [picture.crop((left, top, right, low)) for picture in pictures]

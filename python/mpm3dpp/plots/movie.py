# SPDX-License-Identifier: BSD-3-Clause
"""All frames of a run as a movie: MP4 or WebM by ffmpeg, or a GIF, with the time that is left."""

from __future__ import annotations

import contextlib
import dataclasses
import importlib
import shutil
import subprocess
import tempfile
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from mpm3dpp.base.disk import cannot_write, make_folder, unfinished, writing
from mpm3dpp.base.errors import CaseError
from mpm3dpp.base.ours import MARK
from mpm3dpp.base.progress import ProgressLine
from mpm3dpp.io.foreign import refuse_to_draw

from .animation import LENGTH, evenly, pictures, save_animation
from .frames import view_of
from .look import PLAIN, Look

if TYPE_CHECKING:
    from mpm3dpp.io.results import Results

_SIZE = (1280, 720)  # Pixels, if the user says nothing.
_RATES = (4.0, 30.0)  # Frames per second, between which a movie lasts `LENGTH`.
_CODECS = {
    ".mp4": ("mp4", "-c:v", "libx264", "-preset", "medium", "-crf", "18"),
    ".webm": ("webm", "-c:v", "libvpx-vp9", "-crf", "30", "-b:v", "0"),
}
"""By the ending of the file: the format, and what ffmpeg is told of the codec."""


def save_movie(
    results: Results,
    path: Path,
    colour: str = "von_mises",
    look: Look = PLAIN,
    quiet: bool = True,
) -> Path:
    """Write all frames, evenly spaced in time, with one view and one range of colours.

    Args:
        results: of `open_results`.
        path: the movie: its ending, .mp4, .webm or .gif, chooses what it is.
        colour: array that colours the particles, see `labels.choose`.
        look: what else was asked for.
        quiet: no progress on standard error.

    Raises:
        CaseError: the ending is of no movie, ffmpeg is missing or fails, the file cannot be
            written; or see `draw_frame`.
    """
    check_movie(path)
    refuse_to_draw(path)
    with ProgressLine(quiet=quiet) as line:

        def told(count: int, total: int) -> None:
            line.show(count / total, lambda: f"{path.name}  frame {count} of {total}")

        if path.suffix.lower() == ".gif":
            return save_animation(results, path, colour, look, len(results), told)
        frames = evenly(results.times, len(results))
        if look.size is None:
            look = dataclasses.replace(look, size=_SIZE)
        view = view_of(results, frames, colour, look)
        rate = float(np.clip(len(frames) / LENGTH, *_RATES))
        with _Encoder(path, rate) as encoder:
            drawn = pictures(results, frames, colour, look, view)
            for count, (_, picture) in enumerate(drawn, 1):
                encoder.add(picture)
                told(count, len(frames))
    return path


def check_movie(path: Path) -> None:
    """Raise `CaseError` if a movie of this name cannot be made here."""
    ending = path.suffix.lower()
    if ending not in (*_CODECS, ".gif"):
        rule = "must be a movie by its ending"
        raise CaseError(
            rule, "write movie.mp4, movie.webm or movie.gif", key="movie", value=str(path)
        )
    if ending != ".gif":
        _ffmpeg(path)


def _ffmpeg(path: Path) -> str:
    """Return the program ffmpeg: of the package imageio-ffmpeg, else the machine's."""
    with contextlib.suppress(ImportError, RuntimeError):
        found: str = importlib.import_module("imageio_ffmpeg").get_ffmpeg_exe()
        return found
    if installed := shutil.which("ffmpeg"):
        return installed
    rule = f"needs ffmpeg for {path.suffix}, which is not installed"
    remedy = "install it (pip install imageio-ffmpeg), or name a .gif"
    raise CaseError(rule, remedy, key="movie", value=str(path))


class _Encoder:
    """ffmpeg, which is given pictures and writes a file beside `path` that takes its place.

    Args:
        path: of the movie.
        rate: frames per second.
    """

    def __init__(self, path: Path, rate: float) -> None:
        self._path, self._new, self._rate = path, unfinished(path), rate
        self._program = _ffmpeg(path)
        self._process: subprocess.Popen[bytes] | None = None
        self._said = tempfile.TemporaryFile()  # noqa: SIM115, closed at the end.

    def __enter__(self) -> _Encoder:
        make_folder(self._path.parent)
        return self

    def add(self, picture: Any) -> None:
        """Add a picture; all have the size of the first."""
        if self._process is None:
            self._start(picture.size)
        assert self._process is not None and self._process.stdin is not None
        try:
            self._process.stdin.write(picture.tobytes())
        except OSError:  # It has ended.
            self._refuse()

    def __exit__(self, kind: object, *about: object) -> None:
        try:
            if self._process is not None:
                self._finish(kind is not None)
        finally:
            self._said.close()
            self._new.unlink(missing_ok=True)

    def _start(self, size: tuple[int, int]) -> None:
        self._new.unlink(missing_ok=True)  # It might be a link.
        kind, *codec = _CODECS[self._path.suffix.lower()]
        # Players want numbers of pixels that are even.
        even = ["-vf", "pad=ceil(iw/2)*2:ceil(ih/2)*2:color=white", "-pix_fmt", "yuv420p"]
        given = ["-f", "rawvideo", "-pix_fmt", "rgb24", "-s", f"{size[0]}x{size[1]}"]
        given += ["-r", f"{self._rate:g}", "-i", "-"]
        command = [self._program, "-loglevel", "error", "-y", *given, "-an", *even, *codec]
        command += ["-metadata", f"comment={MARK}"]
        try:
            self._process = subprocess.Popen(
                [*command, "-f", kind, str(self._new.absolute())],
                stdin=subprocess.PIPE,
                stdout=subprocess.DEVNULL,
                stderr=self._said,
            )
        except OSError as error:
            rule = f"cannot start {self._program} ({error})"
            raise CaseError(rule, "name a .gif", key="movie", value=str(self._path)) from error

    def _finish(self, broken: bool) -> None:
        """Let ffmpeg end, and put the movie where it belongs."""
        process = self._process
        assert process is not None and process.stdin is not None
        if broken:
            process.kill()
        with contextlib.suppress(OSError):
            process.stdin.close()
        code = process.wait()
        if broken:
            return
        if code != 0:
            self._refuse()
        with writing(self._path):
            self._new.replace(self._path)

    def _refuse(self) -> None:
        """Raise `CaseError` with the last line that ffmpeg has said."""
        assert self._process is not None
        self._process.wait()
        self._said.seek(0)
        lines = self._said.read().decode(errors="replace").strip().splitlines()
        why = lines[-1] if lines else "ffmpeg ended without a word"
        raise cannot_write(self._path, Exception(why))

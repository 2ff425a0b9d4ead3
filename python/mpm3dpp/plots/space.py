# SPDX-License-Identifier: BSD-3-Clause
"""Three-dimensional particles as a picture: PyVista on a graphics card, else our own balls."""

from __future__ import annotations

import dataclasses
import functools
import subprocess
import sys
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from .labels import length_unit
from .raster import FINER, balls, coarser

if TYPE_CHECKING:
    from matplotlib.axes import Axes

PIXELS = 1100  # longer side of the image, as many as it is shown with

_BLOCK = 65536  # particles that are turned at a time

_PROBE = """
import pyvista
p = pyvista.Plotter(off_screen=True, window_size=(64, 64))
p.add_mesh(pyvista.Sphere(), color="red")
image = p.screenshot(return_img=True)
raise SystemExit(0 if image.std() > 0 else 1)
"""


@dataclasses.dataclass
class Camera:
    """A parallel projection that looks at a box from its front, right and above; z is up.

    Attributes:
        right, up, towards: unit vectors of the image and to the viewer.
        centre: middle of the box [m].
        width, height: of the image [m].
    """

    right: np.ndarray
    up: np.ndarray
    towards: np.ndarray
    centre: np.ndarray
    width: float
    height: float


def camera_for(lower: np.ndarray, upper: np.ndarray) -> Camera:
    """The camera that just holds a box given by two corners [m]."""
    towards = np.array([0.55, -1.0, 0.55])
    towards /= np.linalg.norm(towards)
    right = np.cross([0.0, 0.0, 1.0], towards)
    right /= np.linalg.norm(right)
    up = np.cross(towards, right)
    half = 0.5 * (upper - lower)
    width = 2.0 * float(np.abs(right) @ half)
    height = 2.0 * float(np.abs(up) @ half)
    return Camera(right, up, towards, 0.5 * (lower + upper), width, height)


def render(
    points: np.ndarray,
    sizes: np.ndarray,
    colours: np.ndarray,
    lower: np.ndarray,
    upper: np.ndarray,
    pixels: int | None = None,
) -> tuple[np.ndarray, Camera]:
    """Balls of the particles' sizes, seen from `camera_for` the box.

    Args:
        points: (n, 3) [m].
        sizes: edge of each particle's cube (n,) [m]; the ball has this diameter.
        colours: (n, 3), 0 to 1.
        lower, upper: corners of the box in view [m].
        pixels: of the image's longer side; default `PIXELS`.

    Returns:
        image (height, width, 4), 0 to 255, transparent background, row 0 the highest; camera.
    """
    camera, pixels = camera_for(lower, upper), pixels or PIXELS
    seen = np.isfinite(points).all(axis=1)
    if not seen.all():
        points, sizes, colours = points[seen], sizes[seen], colours[seen]
    if len(points) == 0:
        empty = (100, round(100 * camera.width / camera.height), 4)
        return np.zeros(empty, dtype=np.uint8), camera
    if _pyvista_works():
        return _with_pyvista(points, sizes, colours, camera, pixels), camera
    scale = pixels / max(camera.width, camera.height)
    shape = (round(camera.height * scale), round(camera.width * scale))
    axes = scale * np.column_stack([camera.right, camera.up, camera.towards])
    corner = 0.5 * np.array([shape[1], shape[0], 0.0])
    places = np.empty((len(points), 3), dtype=np.float32)
    for first in range(0, len(points), _BLOCK):
        block = slice(first, first + _BLOCK)
        places[block] = (points[block] - camera.centre) @ axes + corner
    # a ball of the cube's volume leaves no slits between neighbours
    radii = np.maximum(0.62 * scale * sizes, 1.0 / FINER)
    image = balls(places[:, :2], places[:, 2], radii, colours, shape, FINER)
    return image[::-1], camera


def draw_box_axes(
    axes: Axes, image: np.ndarray, camera: Camera, lower: np.ndarray, upper: np.ndarray
) -> None:
    """Show the image with a scale bar and the directions of x, y, z instead of axes."""
    factor, unit = length_unit(float((upper - lower).max()))
    half = factor * np.array([camera.width, camera.height]) / 2
    axes.imshow(
        image, extent=(-half[0], half[0], -half[1], half[1]), interpolation="hanning", zorder=2
    )
    foot = 0.20 * max(half)
    axes.set_xlim(-half[0], half[0])
    axes.set_ylim(-half[1] - foot, half[1])
    axes.set_axis_off()
    bar = _round_length(0.5 * half[0])
    left, low = half[0] - bar, -half[1] - 0.75 * foot
    axes.plot([left, left + bar], [low, low], color="black", lw=2.0, solid_capstyle="butt")
    axes.text(left + bar / 2, low + 0.12 * foot, f"{bar:g} {unit}", ha="center", va="bottom")
    origin = np.array([-half[0] + 0.5 * foot, -half[1] - 0.45 * foot])
    for name, direction in zip("xyz", np.eye(3), strict=True):
        arrow = 0.5 * foot * np.array([direction @ camera.right, direction @ camera.up])
        axes.annotate(
            "",
            tuple(origin + arrow),
            tuple(origin),
            arrowprops={
                "arrowstyle": "-|>",
                "lw": 0.8,
                "color": "black",
                "shrinkA": 0,
                "shrinkB": 0,
                "mutation_scale": 6,
            },
        )
        x, y = origin + 1.35 * arrow
        axes.text(x, y, name, ha="center", va="center", fontsize=8)


def _has_graphics_card() -> bool:
    """Whether there may be one: on Linux a card has a device that draws.

    Without one PyVista draws with the processor, which takes 300 MiB before there is a particle and
    is no faster than our own balls.
    """
    if sys.platform != "linux":
        return True
    names = ("dri/renderD*", "nvidia[0-9]*", "dxg")
    return any(True for name in names for _ in Path("/dev").glob(name))


@functools.cache
def _pyvista_works() -> bool:
    """Whether PyVista can draw without a display; tried in a process of its own, it may crash."""
    if not _has_graphics_card():
        return False
    try:
        probe = subprocess.run(
            [sys.executable, "-c", _PROBE], capture_output=True, timeout=60, check=False
        )
        works = probe.returncode == 0
    except (OSError, subprocess.TimeoutExpired):
        works = False
    if not works:
        print(
            "note: PyVista is missing or cannot draw off-screen; the built-in renderer is used"
            " (for PyVista: pip install pyvista, and libegl1 libegl-mesa0 libgl1-mesa-dri)",
            file=sys.stderr,
        )
    return works


def _with_pyvista(
    points: np.ndarray, sizes: np.ndarray, colours: np.ndarray, camera: Camera, pixels: int
) -> np.ndarray:
    import pyvista
    from vtkmodules.vtkCommonCore import vtkLogger

    # without a display VTK warns of it, then draws all the same
    vtkLogger.SetStderrVerbosity(vtkLogger.VERBOSITY_OFF)
    scale = FINER * pixels / max(camera.width, camera.height)
    window = (round(camera.width * scale), round(camera.height * scale))
    unit = 1.0 / max(camera.width, camera.height)  # lengths near 1 suit the depth buffer
    plotter = pyvista.Plotter(off_screen=True, window_size=list(window))
    cloud = pyvista.PolyData(((points - camera.centre) * unit).astype(np.float32))
    cloud.point_data["rgb"] = np.round(255 * colours[:, :3]).astype(np.uint8)
    cloud.point_data["radius"] = (0.62 * sizes * unit).astype(np.float32)
    actor = plotter.add_mesh(
        cloud,
        scalars="rgb",
        rgb=True,
        style="points_gaussian",
        render_points_as_spheres=True,
        emissive=False,
    )
    actor.mapper.scale_array = "radius"
    actor.mapper.scale_factor = 1.0
    plotter.camera.focal_point = (0.0, 0.0, 0.0)
    plotter.camera.position = tuple(3.0 * camera.towards)
    plotter.camera.up = tuple(camera.up)
    plotter.camera.parallel_projection = True
    plotter.camera.parallel_scale = 0.5 * camera.height * unit
    plotter.camera.clipping_range = (0.5, 6.0)
    image = plotter.screenshot(transparent_background=True, return_img=True)
    plotter.close()
    assert image is not None  # for it was asked for
    rows, columns = (FINER * (size // FINER) for size in image.shape[:2])
    return coarser(np.asarray(image, dtype=np.uint8)[:rows, :columns], FINER)


def _round_length(about: float) -> float:
    """The largest of 1, 2, 5 x 10^k that is not above `about`."""
    power = 10.0 ** np.floor(np.log10(about))
    return float(max(m * power for m in (1, 2, 5) if m * power <= about * (1 + 1e-9)))


def draw_box(
    axes: Axes, camera: Camera, lower: np.ndarray, upper: np.ndarray, factor: float
) -> None:
    """Thin lines along the edges of a box [m], on axes of `draw_box_axes`."""
    corners = np.array([[x, y, z] for x in (0, 1) for y in (0, 1) for z in (0, 1)])
    places = (lower + corners * (upper - lower) - camera.centre) * factor
    flat = np.column_stack([places @ camera.right, places @ camera.up])
    hidden = int(np.argmin(places @ camera.towards))
    for i in range(8):
        for j in range(i + 1, 8):
            if np.abs(corners[i] - corners[j]).sum() == 1:
                behind = hidden in (i, j)
                axes.plot(
                    *flat[[i, j]].T,
                    color="#555555",
                    lw=0.8,
                    ls=":" if behind else "-",
                    zorder=1 if behind else 3,
                )

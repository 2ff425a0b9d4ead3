# SPDX-License-Identifier: BSD-3-Clause
"""Three-dimensional particles as a picture: balls, found by a graphics card where there is one."""

from __future__ import annotations

import dataclasses
import functools
import subprocess
import sys
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from mpm3dpp.base import child

from .labels import length_unit
from .look import directions
from .raster import FINER, balls, balls_of_owners

if TYPE_CHECKING:
    from matplotlib.axes import Axes

PIXELS = 1100  # longer side of the image, as many as it is shown with

_BLOCK = 65536  # particles that are turned at a time
_MOST_OWNERS = 2**24 - 1  # balls that have numbers in the colours of a card


@dataclasses.dataclass
class Camera:
    """A parallel projection that looks at a box; z is never turned.

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


def camera_for(
    lower: np.ndarray, upper: np.ndarray, view: tuple[float, float] | None = None
) -> Camera:
    """The camera that just holds a box given by two corners [m]; `view`: see `look.directions`."""
    right, up, towards = directions(view)
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
    view: tuple[float, float] | None = None,
) -> tuple[np.ndarray, Camera]:
    """Balls of the particles' sizes, seen from `camera_for` the box.

    Args:
        points: (n, 3) [m].
        sizes: edge of each particle's cube (n,) [m]; the ball has this diameter.
        colours: (n, 3), 0 to 1.
        lower, upper: corners of the box in view [m].
        pixels: of the image's longer side; default `PIXELS`.
        view: azimuth and elevation, see `look.directions`.

    Returns:
        image (height, width, 4), 0 to 255, transparent background, row 0 the highest; camera.
    """
    camera, pixels = camera_for(lower, upper, view), pixels or PIXELS
    seen = np.isfinite(points).all(axis=1)
    if not seen.all():
        points, sizes, colours = points[seen], sizes[seen], colours[seen]
    if len(points) == 0:
        empty = (100, round(100 * camera.width / camera.height), 4)
        return np.zeros(empty, dtype=np.uint8), camera
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
    if len(points) < _MOST_OWNERS and _pyvista_works():
        owners = _owners_by_pyvista(points, radii / scale, camera, scale, shape)
        image = balls_of_owners(owners, places[:, :2], places[:, 2], radii, colours, FINER)
    else:
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
        if np.hypot(*arrow) < 0.05 * foot:  # It points to the viewer.
            continue
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
        words = child.command("plots.probe_card")
        probe = subprocess.run(words, capture_output=True, timeout=60, check=False)
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


def _owners_by_pyvista(
    points: np.ndarray, radii: np.ndarray, camera: Camera, scale: float, shape: tuple[int, int]
) -> np.ndarray:
    """Return which ball is in front at each finer pixel, as `balls_of_owners` wants it.

    The card draws balls whose colours are their numbers; light is ours, so that pictures look
    alike with and without a card.

    Args:
        points, radii: (n, 3) and (n,) [m].
        scale: pixels per metre.
        shape: height and width of the image [pixels].
    """
    import pyvista
    from vtkmodules.vtkCommonCore import vtkLogger
    from vtkmodules.vtkRenderingCore import vtkActor
    from vtkmodules.vtkRenderingOpenGL2 import vtkOpenGLSphereMapper

    # without a display VTK warns of it, then draws all the same
    vtkLogger.SetStderrVerbosity(vtkLogger.VERBOSITY_OFF)
    unit = 1.0 / max(camera.width, camera.height)  # lengths near 1 suit the depth buffer
    number = np.arange(1, len(points) + 1)
    # A card looks at the middle of a pixel, we at its lower left corner.
    centre = camera.centre - 0.5 / (FINER * scale) * (camera.right + camera.up)
    cloud = pyvista.PolyData(((points - centre) * unit).astype(np.float32))
    digits = np.column_stack([number >> 16, number >> 8 & 255, number & 255])
    cloud.point_data["number"] = digits.astype(np.uint8)
    cloud.point_data["radius"] = (radii * unit).astype(np.float32)
    mapper, actor = vtkOpenGLSphereMapper(), vtkActor()
    mapper.SetInputData(cloud)
    mapper.SetScaleArray("radius")
    mapper.SetScalarModeToUsePointFieldData()
    mapper.SelectColorArray("number")
    mapper.SetColorModeToDirectScalars()
    actor.SetMapper(mapper)
    actor.GetProperty().LightingOff()
    plotter: Any = pyvista.Plotter(
        off_screen=True, window_size=[FINER * shape[1], FINER * shape[0]]
    )
    plotter.disable_anti_aliasing()
    plotter.set_background("black")
    plotter.add_actor(actor, reset_camera=False)
    plotter.camera.focal_point = (0.0, 0.0, 0.0)
    plotter.camera.position = tuple(3.0 * camera.towards)
    plotter.camera.up = tuple(camera.up)
    plotter.camera.parallel_projection = True
    plotter.camera.parallel_scale = 0.5 * shape[0] / scale * unit
    plotter.camera.clipping_range = (0.5, 6.0)
    image = plotter.screenshot(return_img=True)
    plotter.close()
    assert image is not None  # for it was asked for
    red, green, blue = (np.asarray(image)[::-1, :, k].astype(np.int32) for k in range(3))
    owners: np.ndarray = (red << 16 | green << 8 | blue) - 1
    return np.where(owners < len(points), owners, -1)


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

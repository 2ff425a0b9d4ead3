# SPDX-License-Identifier: BSD-3-Clause
"""Whether PyVista can draw here without a display: exit code 0. It may crash, so it is a process.

`space.py` asks.
"""

from __future__ import annotations


def main() -> int:
    """Draw a ball; return 0 if it can be seen."""
    import pyvista

    plotter = pyvista.Plotter(off_screen=True, window_size=[64, 64])
    plotter.add_mesh(pyvista.Sphere(), color="red")
    image = plotter.screenshot(return_img=True)
    return 0 if image is not None and image.std() > 0 else 1


if __name__ == "__main__":
    raise SystemExit(main())

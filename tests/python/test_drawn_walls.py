# SPDX-License-Identifier: BSD-3-Clause
"""What pictures of a run tell beside its particles: walls, and terms of the ledger by colour."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

from mpm3dpp import Case, open_results, run_case
from mpm3dpp.io.read_history import read_history
from mpm3dpp.plots.case_walls import _STYLES
from mpm3dpp.plots.energies import draw_energies
from mpm3dpp.plots.frames import draw_frame


def block(out: Path, **run: Any) -> Path:
    """Run a block that lies on a contact wall, far from a fixed one, for some steps."""
    walls = {"y_min": "contact", "x_max": "fixed"}
    case = Case.model_validate(
        {
            "grid": {
                "dimension": 2,
                "cell_size": 1e-3,
                "box": {"lower": [-0.02, 0.0], "upper": [0.05, 0.03], "walls": walls},
            },
            "run": {"end_time": 2e-4, "gravity": [0.0, -100.0], **run},
            "material": {"m": {"density": 1000.0, "strength": {"elastic": {"E": 1e6, "nu": 0.3}}}},
            "body": {
                "b": {
                    "material": "m",
                    "shape": {"box": {"lower": [0.0, 0.0], "upper": [6e-3, 4e-3]}},
                }
            },
            "output": {"history_every": 1},
        }
    )
    run_case(case, out)
    return out


def test_walls_that_are_near_are_drawn(tmp_path: Path) -> None:
    results = open_results(block(tmp_path / "out"))
    assert results.walls[:4] == ("free", "fixed", "contact", "free")
    assert results.box is not None
    np.testing.assert_array_equal(results.box, [[-0.02, 0.0], [0.05, 0.03]])
    axes = draw_frame(results, -1).axes[0]
    colours = [line.get_color() for line in axes.lines]
    assert _STYLES["contact"][0] in colours and _STYLES["fixed"][0] not in colours
    [floor] = [line for line in axes.lines if line.get_color() == _STYLES["contact"][0]]
    assert np.all(np.asarray(floor.get_ydata()) == 0.0)
    low, high = axes.get_xlim()
    assert low <= min(floor.get_xdata()) < max(floor.get_xdata()) <= high  # in the picture alone
    results.close()


def test_terms_have_one_colour_and_time_begins_with_the_run(tmp_path: Path) -> None:
    settle = {"longest": 2e-4, "ratio": 1e-12}
    out = block(tmp_path / "out", settle=settle)
    history = read_history(out / "history.csv")
    assert history["time"][0] < 0.0
    axes = draw_energies(history, 2).axes
    shown = [{line.get_label(): line.get_color() for line in a.lines} for a in axes[:2]]
    both = set(shown[0]) & set(shown[1])
    assert both and all(shown[0][name] == shown[1][name] for name in both)
    assert all(np.min(line.get_xdata()) >= 0.0 for a in axes for line in a.lines)

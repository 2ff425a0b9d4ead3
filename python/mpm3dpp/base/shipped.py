# SPDX-License-Identifier: BSD-3-Clause
"""Files that come with the package beside its modules: the examples and the documentation."""

from __future__ import annotations

from pathlib import Path


def shipped(name: str) -> Path:
    """Return a folder that comes with the package: installed with it, else the source's.

    Args:
        name: "examples" or "docs".
    """
    package = Path(__file__).parents[1]
    installed = package / name
    return installed if installed.is_dir() else Path(__file__).resolve().parents[3] / name

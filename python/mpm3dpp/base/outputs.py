# SPDX-License-Identifier: BSD-3-Clause
"""The fields that every frame has: of the core's columns, derived from them, and numbers."""

from __future__ import annotations

from mpm3dpp import _core

COLUMNS = {"position": "m", "velocity": "m/s", "stress": "Pa"}
"""Columns of the core that are always written, with their units."""

DERIVED: dict[str, dict[str, str]] = _core.derived_fields
"""Fields that the core derives of them: `unit`, `meaning`, and whether they are `constant`."""

CHANGING = [name for name, field in DERIVED.items() if not field["constant"]]
"""Those of them that every frame has anew."""

NUMBERS = ("body", "grain", "material")
"""Whole numbers of each particle."""

STANDARD = (*COLUMNS, *CHANGING, "body", "material")
"""Fields that every run writes."""

UNITS = COLUMNS | {n: field["unit"] for n, field in DERIVED.items()} | dict.fromkeys(NUMBERS, "")
"""Unit of each of them; further columns of the core bring their own."""

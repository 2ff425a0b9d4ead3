# SPDX-License-Identifier: BSD-3-Clause
"""The fields that every frame has: of the core's columns, derived from them, and numbers."""

from __future__ import annotations

from typing import Any

from mpm3dpp import _core

COLUMNS = {"position": "m", "velocity": "m/s", "stress": "Pa"}
"""Columns of the core that are always written, with their units."""

DERIVED: dict[str, dict[str, Any]] = _core.derived_fields
"""Fields that the core derives of them: `unit`, `meaning`, `components`, and whether they are
`constant` or come only `on_request`."""

ON_REQUEST = [name for name, field in DERIVED.items() if field["on_request"]]
"""Those of them that a case must ask for."""

CONSTANT = [name for name, field in DERIVED.items() if field["constant"]]
"""Those of them that are written once."""

CHANGING = [name for name in DERIVED if name not in (*CONSTANT, *ON_REQUEST)]
"""Those of them that every frame has anew."""

NUMBERS = ("id", "body", "grain", "material")
"""Whole numbers of each particle."""

STANDARD = (*COLUMNS, *CHANGING, "id", "body", "material")
"""Fields that every run writes."""

UNITS = COLUMNS | {n: field["unit"] for n, field in DERIVED.items()} | dict.fromkeys(NUMBERS, "")
"""Unit of each of them; further columns of the core bring their own."""

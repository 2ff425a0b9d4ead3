# SPDX-License-Identifier: BSD-3-Clause
"""Where the nodes of a body lie."""

from __future__ import annotations

UPDATED = "updated"
"""In space: particles pass them."""
MATERIAL = "material"
"""In the body: they keep its motion."""
FRAMES = (UPDATED, MATERIAL)

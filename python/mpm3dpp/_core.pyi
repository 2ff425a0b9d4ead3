# SPDX-License-Identifier: BSD-3-Clause
# What the compiled core gives is not typed: its names and shapes are those of bindings/, and the
# tests call them. Written down here they would be one copy more.
from typing import Any

def __getattr__(name: str) -> Any: ...

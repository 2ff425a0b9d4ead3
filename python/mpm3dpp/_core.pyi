# What the compiled core gives is not typed: its names and shapes are those of bindings/, and the
# tests call every one of them. Written down here they would be a fourth copy (ARCHITECTURE.md, warts).
from typing import Any

def __getattr__(name: str) -> Any: ...

# SPDX-License-Identifier: BSD-3-Clause
"""Input files of MPM3D-F90 (`.mpm`) as cases.

`lexer` makes words of the text, `statements` and `blocks` make a `Deck` of the words, in the units
of the file; `materials`, `particles` and `to_case` make a case of the deck, in SI units.
"""

from .to_case import read
from .units import SYSTEMS

__all__ = ["SYSTEMS", "read"]

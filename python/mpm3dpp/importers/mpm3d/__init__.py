# SPDX-License-Identifier: BSD-3-Clause
"""Input files of MPM3D-F90 (`.mpm`) as cases.

`lexer` makes words of the text, `statements` and `blocks` make a `Deck` of the words, in the units
of the file; `materials`, `particles` and `to_case` make a case of the deck, in SI units; `write`
writes it as a case file.
"""

from .to_case import Imported, import_mpm
from .units import SYSTEMS
from .write import write_case

__all__ = ["SYSTEMS", "Imported", "import_mpm", "write_case"]

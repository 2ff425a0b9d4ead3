# SPDX-License-Identifier: BSD-3-Clause
"""Many round bodies from one entry of a case: where they stand and how they are filled."""

from .centres import GrainCentres
from .filling import GrainFilling
from .packed import GrainPacking
from .table import GrainLattice, Grains

__all__ = ["GrainCentres", "GrainFilling", "GrainLattice", "GrainPacking", "Grains"]

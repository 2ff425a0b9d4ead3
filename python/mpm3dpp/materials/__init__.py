# SPDX-License-Identifier: BSD-3-Clause
"""Materials: models of the core's catalogue, chosen with parameters, and named materials."""

from .catalogue import catalogue, state_columns
from .chosen import AnyEos, AnyFailure, AnyStrength, Eos, Failure, Strength
from .describe import listing
from .library import NamedMaterial, library, named

__all__ = [
    "AnyEos",
    "AnyFailure",
    "AnyStrength",
    "Eos",
    "Failure",
    "NamedMaterial",
    "Strength",
    "catalogue",
    "library",
    "listing",
    "named",
    "state_columns",
]

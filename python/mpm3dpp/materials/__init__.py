# SPDX-License-Identifier: BSD-3-Clause
"""Materials: models of the core's catalogue, chosen with parameters."""

from .catalogue import catalogue, listing, state_columns
from .chosen import AnyEos, AnyFailure, AnyStrength, Eos, Failure, Strength

__all__ = [
    "AnyEos",
    "AnyFailure",
    "AnyStrength",
    "Eos",
    "Failure",
    "Strength",
    "catalogue",
    "listing",
    "state_columns",
]

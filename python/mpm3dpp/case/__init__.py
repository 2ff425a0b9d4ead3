# SPDX-License-Identifier: BSD-3-Clause
"""The case: its tables, checked, in SI units."""

from .case import Case as Case
from .case import load_case as load_case
from .material import Material as Material

# SPDX-License-Identifier: BSD-3-Clause
"""What all others stand on: errors, units, numbers of the core, reading, the machine."""

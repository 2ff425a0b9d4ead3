# SPDX-License-Identifier: BSD-3-Clause
"""From a case to particles: bodies and grains filled, and whether they fit."""

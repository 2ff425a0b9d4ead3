# SPDX-License-Identifier: BSD-3-Clause
"""A dozen problems with every basis, transfer, scheme and step: what the defaults are chosen by."""

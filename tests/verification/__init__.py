# SPDX-License-Identifier: BSD-3-Clause
"""Problems with exact, published or independently computed answers, and how close we come.

`python -m verification` (from `tests/`) runs them all and writes the table `docs/verification.md`.
"""

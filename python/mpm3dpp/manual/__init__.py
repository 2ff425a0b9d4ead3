# SPDX-License-Identifier: BSD-3-Clause
"""What comes with the package to read and to try: pages of the documentation, and examples."""

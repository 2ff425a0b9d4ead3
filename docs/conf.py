# SPDX-License-Identifier: BSD-3-Clause
"""The documentation site: sphinx-build -W --keep-going -b html docs build/docs."""

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parent / "_ext"))

project = "MPM3Dpp"
author = "The MPM3Dpp developers"
copyright = author
extensions = ["myst_parser", "repository_pages"]
exclude_patterns = ["_ext"]

myst_enable_extensions = ["dollarmath"]
myst_heading_anchors = 3  # levels of headings that links may name, as on GitHub

html_theme = "furo"
html_title = project
html_static_path = ["_ext/static"]
html_css_files = ["site.css"]
html_show_sphinx = False
html_show_copyright = False

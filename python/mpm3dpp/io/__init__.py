# SPDX-License-Identifier: BSD-3-Clause
"""Reading and writing of results: `results.vtkhdf`, `history.csv`, `manifest.json`.

Nothing heavy is imported here; h5py is loaded when a file is opened, vtk never.
"""

from mpm3dpp.io.background import BackgroundWriter
from mpm3dpp.io.fields import Frame, frame_of
from mpm3dpp.io.history import HistoryWriter, read_history
from mpm3dpp.io.manifest import Manifest, build_manifest, read_manifest
from mpm3dpp.io.result_hash import result_hash
from mpm3dpp.io.results import Results, open_results
from mpm3dpp.io.vtkhdf import ResultsWriter

__all__ = [
    "BackgroundWriter",
    "Frame",
    "HistoryWriter",
    "Manifest",
    "Results",
    "ResultsWriter",
    "build_manifest",
    "frame_of",
    "open_results",
    "read_history",
    "read_manifest",
    "result_hash",
]

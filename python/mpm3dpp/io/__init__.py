# SPDX-License-Identifier: BSD-3-Clause
"""Reading and writing of results: `results.vtkhdf`, `history.csv`, `manifest.json`.

Nothing heavy is imported here; h5py is loaded when a file is opened, vtk never.
"""

from .background import BackgroundWriter
from .fields import Frame, frame_of
from .history import HistoryWriter
from .manifest import Manifest, build_manifest
from .read_history import read_history
from .result_hash import result_hash
from .results import Results, open_results
from .stored_manifest import read_manifest
from .vtkhdf import ResultsWriter

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

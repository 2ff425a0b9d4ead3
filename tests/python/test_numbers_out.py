# SPDX-License-Identifier: BSD-3-Clause
"""Numbers out of a run: tables of pandas, one particle over time."""

from __future__ import annotations

import sys

import numpy as np
import pytest

from commands import CASE, write
from mpm3dpp import open_results, run_case
from mpm3dpp.base.errors import CaseError
from mpm3dpp.io import Results, read_history


@pytest.fixture(scope="module")
def results(tmp_path_factory: pytest.TempPathFactory) -> Results:
    folder = tmp_path_factory.mktemp("run")
    run_case(write(folder, CASE), folder / "out", threads=1, pictures=False)
    return open_results(folder / "out")


def test_a_frame_as_a_table(results: Results) -> None:
    pytest.importorskip("pandas")
    table, arrays = results.to_pandas(-1), results.arrays(-1)
    assert len(table) == len(arrays["position"])
    np.testing.assert_array_equal(table["velocity_y"], arrays["velocity"][:, 1])
    np.testing.assert_array_equal(table["stress_yz"], arrays["stress"][:, 3])
    np.testing.assert_array_equal(table["pressure"], arrays["pressure"])
    some = results.to_pandas(0, ["body"])
    assert [*some.columns] == ["position_x", "position_y", "position_z", "body"]
    left = some[some.body == results.bodies.index("left")]
    assert len(left) == np.sum(arrays["body"] == 0)


def test_the_history_as_a_table(results: Results, monkeypatch: pytest.MonkeyPatch) -> None:
    pytest.importorskip("pandas")
    table, expected = results.history(), read_history(results.path.parent)
    assert [*table.columns] == [*expected]
    np.testing.assert_array_equal(table["kinetic"], expected["kinetic"])
    monkeypatch.setattr("mpm3dpp.io.results.has_pandas", lambda: False)
    plain = results.history()
    assert isinstance(plain, dict) and plain.keys() == expected.keys()


def test_without_pandas(results: Results, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "pandas", None)
    with pytest.raises(CaseError, match="install it: pip install pandas"):
        results.to_pandas(0)


def test_one_particle_over_time(results: Results) -> None:
    track = results.track(7, ["velocity"])
    assert [*track] == ["time", "position", "velocity"]
    np.testing.assert_array_equal(track["time"], results.times)
    for k in range(len(results)):
        for name in ("position", "velocity"):
            np.testing.assert_array_equal(track[name][k], results.arrays(k)[name][7])
    count = int(np.sum(results.arrays(0)["body"] == 0))
    of_body, plain = results.track(-1, body="left"), results.track(count - 1)
    np.testing.assert_array_equal(of_body["stress"], plain["stress"])
    with pytest.raises(IndexError, match=f"body left: it has {count} particles"):
        results.track(count, body="left")
    with pytest.raises(IndexError, match=r"it has \d+ particles"):
        results.track(10**6)
    with pytest.raises(
        CaseError, match='"lift" is not a body of these results; did you mean "left"'
    ):
        results.track(0, body="lift")

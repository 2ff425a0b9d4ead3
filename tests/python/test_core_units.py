# SPDX-License-Identifier: BSD-3-Clause
"""The C++ unit tests (tests/unit), one pytest test each."""

import pytest

try:
    from mpm3dpp import _testing
except ImportError as error:
    TESTS, MISSING = {}, str(error)
else:
    TESTS, MISSING = _testing.tests, ""


def test_module_is_built():
    assert not MISSING, (
        f"the C++ unit tests are not built ({MISSING}): install with "
        "pip install '.[test]' --config-settings=cmake.define.MPM_TESTING=ON"
    )


SLOW = {"two_and_eight_ranks", "stages_in_space", "rows_in_space"}
"""Half a minute and more: with three ranks the same is in `ranks`, in a plane in the others."""


@pytest.mark.parametrize(
    "name",
    [pytest.param(k, marks=[pytest.mark.slow] if k in SLOW else []) for k in sorted(TESTS)],
)
def test_unit(name):
    checks, failures = TESTS[name]()
    assert not failures, "\n" + "\n".join(failures)
    assert checks > 0, f"test_{name} checked nothing"

# SPDX-License-Identifier: BSD-3-Clause
"""What each Python process of ours begins with (`child.command`): nothing of the user's is run.

    python .../base/start.py PARENT MODULE ARGUMENTS

runs `mpm3dpp.MODULE`, which ends when its parent has, PARENT; with 0 nobody looks after that.
Python looks for modules in the current folder, or in that of the file that it is given, before all
others: a `numpy.py` there would be run. So neither is looked at, and this package is loaded by its
place. It needs no option of Python: that which leaves the folder out came with Python 3.11.
"""

import os
import site
import sys


def forget_folder() -> None:
    """Let no more modules come from the current folder, unless PYTHONPATH names it in words.

    An empty word there, as `PYTHONPATH=$PYTHONPATH:/lib` makes it, is the current folder for
    Python, whatever folder that is.
    """
    try:
        here = os.getcwd()
    except OSError:  # It has been removed.
        here = ""
    words = os.environ.get("PYTHONPATH", "").split(os.pathsep)
    kept = {os.path.dirname(os.__file__), *site.getsitepackages(), site.getusersitepackages()}
    kept |= {os.path.abspath(word) for word in words if word}
    sys.path[:] = [p for p in sys.path if p and (os.path.abspath(p) != here or here in kept)]


def _main() -> None:
    own = os.path.dirname(os.path.abspath(__file__))
    sys.path[:] = [p for p in sys.path if os.path.realpath(p) != os.path.realpath(own)]
    forget_folder()
    import importlib.util
    import runpy

    folder = os.path.dirname(own)
    spec = importlib.util.spec_from_file_location(
        "mpm3dpp", os.path.join(folder, "__init__.py"), submodule_search_locations=[folder]
    )
    assert spec is not None and spec.loader is not None
    package = sys.modules["mpm3dpp"] = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(package)
    parent, name = int(sys.argv[1]), sys.argv[2]
    del sys.argv[1:3]
    from mpm3dpp.base.starter import end_with

    if parent:
        end_with(parent, is_parent=True)
    runpy.run_module(f"mpm3dpp.{name}", run_name="__main__", alter_sys=True)


if __name__ == "__main__":
    _main()

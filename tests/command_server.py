# SPDX-License-Identifier: BSD-3-Clause
"""The command in forks of a process that has its modules loaded: a start of its own takes a second.

Without arguments it is that process: for each line of standard input, a JSON object with `words`,
`cwd`, `environ`, `out` and `err`, it runs the command, and prints its exit code. What modules read
of the environment when they are loaded is that of the first call.
"""

from __future__ import annotations

import functools
import json
import os
import select
import signal
import subprocess
import sys
import tempfile
from pathlib import Path

WARM_UP = """\
[grid]
dimension = 2
cell_size = 1
[run]
end_time = 1
[material.soft]
density = 1
strength = { elastic = { E = 1, nu = 0.3 } }
[body.left]
material = "soft"
shape = { box = { lower = [0, 0], upper = [2, 2] } }
"""


def run(words: list[str], cwd: Path | str, timeout: float) -> subprocess.CompletedProcess[str]:
    """Run `mpm3dpp WORDS` in a folder; as `subprocess.run`, with what it printed as text."""
    with tempfile.TemporaryFile() as out, tempfile.TemporaryFile() as err:
        server = _server()
        assert server.stdin and server.stdout
        files = {"out": f"/proc/{os.getpid()}/fd/{out.fileno()}"}
        files["err"] = f"/proc/{os.getpid()}/fd/{err.fileno()}"
        job = {"words": words, "cwd": str(cwd), "environ": dict(os.environ), **files}
        server.stdin.write(json.dumps(job) + "\n")
        server.stdin.flush()
        if not select.select([server.stdout], [], [], timeout)[0]:
            os.killpg(server.pid, signal.SIGKILL)
            _server.cache_clear()
            raise subprocess.TimeoutExpired(words, timeout)
        told = server.stdout.readline()
        if not told:
            _server.cache_clear()
            raise RuntimeError(f"the server of commands has ended with {server.wait()}")
        code = int(told)
        texts = []
        for file in (out, err):
            file.seek(0)
            texts.append(file.read().decode())
    return subprocess.CompletedProcess(words, code, *texts)


@functools.cache
def _server() -> subprocess.Popen[str]:
    line = [sys.executable, __file__]
    pipes = {"stdin": subprocess.PIPE, "stdout": subprocess.PIPE}
    return subprocess.Popen(line, text=True, start_new_session=True, **pipes)  # type: ignore[call-overload, no-any-return]


def _serve() -> bool:
    """Serve until the input ends; return true in a fork that is to run the command."""
    for line in sys.stdin:
        job = json.loads(line)
        child = os.fork()
        if child == 0:
            os.chdir(job["cwd"])
            os.environ.clear()
            os.environ.update(job["environ"])
            sys.argv[:] = ["mpm3dpp", *job["words"]]
            files = [
                (os.devnull, os.O_RDONLY),
                (job["out"], os.O_WRONLY),
                (job["err"], os.O_WRONLY),
            ]
            for number, (path, how) in enumerate(files):
                os.dup2(os.open(path, how), number)
            return True
        status = os.waitpid(child, 0)[1]
        print(os.waitstatus_to_exitcode(status), flush=True)
    return False


if __name__ == "__main__":
    import mpm3dpp.cli.app
    import mpm3dpp.cli.command
    import mpm3dpp.run.run
    from mpm3dpp import Case

    Case.from_text(WARM_UP)
    if _serve():
        mpm3dpp.cli.command.main()

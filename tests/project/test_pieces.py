"""numba compiles each kernel separately: after a change in one kernel it compiles only that one again."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

INNER = """from mdlgen.program.kernel import njit


@njit(cache=True)
def inner(x):
    return {result}


@njit(cache=True)
def beside(x):
    return 2.0 * x
"""
OUTER = """from kernels.inner import beside, inner
from mdlgen.program.kernel import njit


@njit(cache=True, fastmath={"contract"}, _nrt=False)
def middle(x):
    return inner(x) + beside(x)


@njit(cache=True)
def outer(x):
    if x < -1e9:
        beside(x)
    return middle(x) + 0.5
"""
CALL = """
from numba.core import event
from kernels.outer import outer

compiled = []

class Listener(event.Listener):
    def on_start(self, event):
        compiled.append(event.data["dispatcher"].py_func.__name__)

    def on_end(self, event):
        pass

with event.install_listener("numba:compile", Listener()):
    print(outer(3.0))
print(*sorted(set(compiled)))
"""


def called(folder: Path, result: str) -> tuple[float, list[str]]:
    """The value of `outer` in a new process if `inner` returns `result`, and what numba compiled."""
    rooms = folder / "kernels"
    rooms.mkdir(exist_ok=True)
    (rooms / "__init__.py").write_text("")
    (rooms / "inner.py").write_text(INNER.format(result=result))
    (rooms / "outer.py").write_text(OUTER)
    surroundings = {**os.environ, "PYTHONPATH": os.pathsep.join([str(folder), *sys.path])}
    surroundings |= {"MDLGEN_CACHE": str(folder / "cache"), "PYTHONDONTWRITEBYTECODE": "1"}
    done = subprocess.run(
        [sys.executable, "-c", CALL], env=surroundings, capture_output=True, text=True, check=False
    )
    assert done.returncode == 0, done.stderr
    value, names = done.stdout.splitlines()
    return float(value), names.split()


def test_after_a_change_one_piece_is_compiled_again(tmp_path: Path) -> None:
    """It is `inner`, and `outer`, which Python calls; `middle` only where `inner` returns another type.

    `inner` inherits options from `middle`, also where numba does not compile `middle` again.
    """
    assert called(tmp_path, "x * x") == (15.5, ["beside", "inner", "middle", "outer"])
    assert called(tmp_path, "x * x") == (15.5, [])
    assert called(tmp_path, "x + 1.0") == (10.5, ["inner", "outer"])
    assert called(tmp_path, "x > 1.0") == (7.5, ["inner", "middle", "outer"])
    assert called(tmp_path, "x * x") == (15.5, [])

"""Commands in processes of their own that do not begin with loading Python and the command line: one process
has loaded them, and each command is a fork of it."""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path
from typing import NamedTuple

from mdlgen.paths import samples

# Reads a command for each line, and answers with its exit code, CPU time [s] and greatest memory [MB]. What a
# child does is what `mdlgen` does as a program.
_PARENT = """
import contextlib, gc, io, json, os, sys, time
import mdlgen.__main__
import mdlgen.cli
app = mdlgen.cli.app
with contextlib.redirect_stdout(io.StringIO()), contextlib.suppress(SystemExit):
    app(["mdl", sys.argv[1], "-o", os.devnull, "-q"], prog_name="mdlgen")  # what commands load as they go
gc.freeze()
start = time.process_time()
for line in sys.stdin:
    asked = json.loads(line)
    child = os.fork()
    if child == 0:
        for number, name in enumerate((os.devnull, asked["out"], asked["err"])):
            opened = os.open(name, os.O_RDONLY if number == 0 else os.O_WRONLY | os.O_CREAT | os.O_TRUNC)
            os.dup2(opened, number)
        os.chdir(asked["folder"])
        sys.argv = ["mdlgen", *asked["args"]]
        code = 1
        try:
            mdlgen.__main__.main()
        except SystemExit as end:
            code = end.code or 0
        except BaseException:
            sys.excepthook(*sys.exc_info())
        for stream in (sys.stdout, sys.stderr):
            stream.flush()
        os._exit(code)
    _, status, used = os.wait4(child, 0)
    code = os.waitstatus_to_exitcode(status)
    print(json.dumps([code, start + used.ru_utime + used.ru_stime, used.ru_maxrss / 1024]), flush=True)
"""


class Ended(NamedTuple):
    code: int
    out: str
    err: str
    cpu: float  # [s], with what loading took
    memory: float  # greatest [MB]


class Commands:
    """Runs them; files of what they print are kept in a folder of its own for so long."""

    def __init__(self, folder: Path):
        self._files = [folder / "stdout", folder / "stderr"]
        self._parent = subprocess.Popen(
            [sys.executable, "-c", _PARENT, str(samples() / "transport_4x4.yaml")],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            text=True,
        )

    def run(self, folder: Path, *args: object) -> Ended:
        """A command in a folder."""
        out, err = map(str, self._files)
        asked = {"folder": str(folder), "args": [str(word) for word in args], "out": out, "err": err}
        stdin, stdout = self._parent.stdin, self._parent.stdout
        assert stdin is not None and stdout is not None
        stdin.write(json.dumps(asked) + "\n")
        stdin.flush()
        code, cpu, memory = json.loads(stdout.readline())
        return Ended(code, *(file.read_text("utf-8") for file in self._files), cpu, memory)

    def close(self) -> None:
        self._parent.communicate()

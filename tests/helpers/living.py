"""`mdlgen live` as a process, and its server as a page asks it."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from contextlib import closing, contextmanager
from http.client import HTTPConnection
from pathlib import Path
from typing import Any
from urllib.parse import urlsplit

from mdlgen.paths import samples

WAIT = 120.0  # seconds, of a machine that is busy
SMALL = ("boxes: [10, 20]", "boxes: [3, 4]"), ("duration: 50 ms", "duration: 6 ms")


def scene(folder: Path, sample: str = "transport_nips", *changes: tuple[str, str]) -> Path:
    """A sample in a folder of its own, with other texts in it; few boxes and a short run where left out."""
    text = (samples() / f"{sample}.yaml").read_text("utf-8")
    for old, new in changes or SMALL:
        assert old in text
        text = text.replace(old, new)
    path = folder / f"{Path(sample).name}.yaml"
    path.write_text(text, "utf-8")
    return path


class Live:
    """The running command."""

    def __init__(self, process: subprocess.Popen[str], address: str):
        self.process, self.address = process, address
        parts = urlsplit(address)
        assert parts.hostname and parts.port
        self.host, self.port, self.path = parts.hostname, parts.port, parts.path

    def request(
        self, path: str, method: str = "GET", body: bytes | None = None, **headers: str
    ) -> tuple[int, bytes, dict[str, str]]:
        """Status, body and headers of an answer; `_` in the name of a header stands for `-`."""
        with closing(HTTPConnection(self.host, self.port, timeout=WAIT)) as connection:
            connection.putrequest(method, path, skip_host="Host" in headers)
            for name, value in headers.items():
                connection.putheader(name.replace("_", "-"), value)
            if body is not None:
                connection.putheader("Content-Length", str(len(body)))
            connection.endheaders(body)
            answer = connection.getresponse()
            return answer.status, answer.read(), {k.lower(): v for k, v in answer.getheaders()}

    def get(self, name: str) -> Any:
        status, body, _ = self.request(self.path + name)
        assert status == 200, (name, status, body)
        return json.loads(body)

    def post(self, name: str, content: Any) -> tuple[int, Any]:
        body = json.dumps(content).encode()
        status, answer, _ = self.request(self.path + name, "POST", body, Content_Type="application/json")
        return status, json.loads(answer)

    def turn(self, **values: str | None) -> None:
        """By path, `__` for each point of it."""
        changed = {path.replace("__", "."): text for path, text in values.items()}
        assert self.post("turn", {"values": changed})[0] == 200

    def until(self, holds: Callable[[dict[str, Any]], bool]) -> dict[str, Any]:
        """The first state of which something holds."""
        end = time.monotonic() + WAIT
        while not holds(state := self.get("state")):
            assert time.monotonic() < end and self.process.poll() is None, state
            time.sleep(0.02)
        return state

    def quiet(self) -> dict[str, Any]:
        """The state once nothing runs any more."""
        return self.until(
            lambda state: state["busy"] is None and (state["errors"] or state["run"]["kind"] == "full")
        )

    def children(self) -> list[int]:
        """Processes that the command has started."""
        found = []
        for entry in Path("/proc").iterdir():
            if entry.name.isdigit():
                try:
                    fields = (entry / "stat").read_text().rpartition(")")[2].split()
                except OSError:
                    continue
                if int(fields[1]) == self.process.pid and fields[0] != "Z":
                    found.append(int(entry.name))
        return found

    def interrupt(self) -> int:
        """Ctrl-C; the exit code."""
        self.process.send_signal(signal.SIGINT)
        return self.process.wait(WAIT)


@contextmanager
def live(spec: Path, *options: str) -> Iterator[Live]:
    """The command on a scene, without a browser."""
    process = subprocess.Popen(
        [sys.executable, "-m", "mdlgen", "live", str(spec), "--no-browser", *options],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        env={**os.environ, "PYTHONPATH": os.pathsep.join(sys.path)},
    )
    try:
        assert process.stdout is not None and process.stderr is not None
        address = process.stdout.readline().strip()
        assert address, process.stderr.read()
        yield Live(process, address)
    finally:
        if process.poll() is None:
            process.terminate()
            process.wait(WAIT)
        for stream in (process.stdout, process.stderr):
            if stream is not None:
                stream.close()

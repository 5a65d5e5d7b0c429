"""A headless Chromium, spoken to over its debugging protocol: what a page says, asks for and shows."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import time
from base64 import b64decode
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import Any

WAIT = 60.0  # seconds, of a machine that is busy
NAMES = ("chromium", "chromium-browser", "google-chrome", "google-chrome-stable", "chrome")
OPTIONS = (
    "--headless=new",
    "--remote-debugging-port=0",
    "--no-sandbox",  # containers run as root
    "--disable-dev-shm-usage",
    "--no-first-run",
    "--disable-background-networking",
    "--use-angle=swiftshader",  # WebGL without a graphics card
    "--enable-unsafe-swiftshader",
    "--window-size=1400,1000",
)


def found() -> str | None:
    """Where a Chromium is: MDLGEN_CHROMIUM, or one on the path."""
    return os.environ.get("MDLGEN_CHROMIUM") or next(filter(None, map(shutil.which, NAMES)), None)


class Tab:
    """A page that is open."""

    def __init__(self, socket: Any, session: str):
        self._socket, self._session, self._number = socket, session, 0
        self.complaints: list[str] = []
        self.requests: list[str] = []
        for domain in ("Page", "Runtime", "Network", "Log"):
            self.call(f"{domain}.enable")

    def call(self, method: str, **parameters: Any) -> dict[str, Any]:
        """Send a command and return its result; what the page does meanwhile is kept."""
        self._number += 1
        asked = {"id": self._number, "method": method, "params": parameters, "sessionId": self._session}
        self._socket.send(json.dumps(asked))
        while True:
            record = json.loads(self._socket.recv(timeout=WAIT))
            if record.get("id") == self._number:
                assert "error" not in record, record["error"]
                return record["result"]
            self._heard(record)

    def _heard(self, record: dict[str, Any]) -> None:
        method, what = record.get("method"), record.get("params", {})
        if method == "Runtime.exceptionThrown":
            detail = what["exceptionDetails"]
            self.complaints.append(detail.get("exception", {}).get("description", detail["text"]))
        elif method == "Runtime.consoleAPICalled" and what["type"] in ("error", "warning", "assert"):
            self.complaints.append(" ".join(str(a.get("value", a.get("description"))) for a in what["args"]))
        elif method == "Log.entryAdded" and what["entry"]["level"] in ("error", "warning"):
            text = what["entry"]["text"]
            if "GL Driver Message (OpenGL, Performance" not in text:  # software GL says that it is slow
                self.complaints.append(text)
        elif method == "Network.requestWillBeSent":
            self.requests.append(what["request"]["url"])

    def open(self, path: Path, fragment: str = "") -> None:
        """Open a page from file:// and wait until it says that it is ready."""
        self.call("Page.navigate", url=path.resolve().as_uri() + fragment)
        self.until("document.documentElement?.dataset.ready === 'yes'")

    def ask(self, expression: str) -> Any:
        """The value of an expression, or of what it promises."""
        record = self.call("Runtime.evaluate", expression=expression, returnByValue=True, awaitPromise=True)
        assert "exceptionDetails" not in record, record["exceptionDetails"]
        return record["result"].get("value")

    def until(self, condition: str) -> None:
        end = time.monotonic() + WAIT
        while not self.ask(condition):
            assert time.monotonic() < end, f"never {condition}; {self.complaints}"
            time.sleep(0.05)

    def press(self, key: str, text: str = "") -> None:
        code = {"key": key, "text": text or (key if len(key) == 1 else "")}
        self.call("Input.dispatchKeyEvent", type="keyDown", **code)
        self.call("Input.dispatchKeyEvent", type="keyUp", key=key)

    def picture(self) -> bytes:
        return b64decode(self.call("Page.captureScreenshot", format="png")["data"])


@contextmanager
def tab(profile: Path, *options: str) -> Iterator[Tab]:
    """A tab of a Chromium of its own, whose settings and cache lie in `profile`."""
    from websockets.sync.client import connect

    program = found()
    assert program is not None
    process = subprocess.Popen(
        [program, *OPTIONS, *options, f"--user-data-dir={profile}", "about:blank"],
        stdout=subprocess.DEVNULL,
        stderr=subprocess.DEVNULL,
    )
    try:
        message, end = profile / "DevToolsActivePort", time.monotonic() + WAIT
        while not (message.exists() and len(message.read_text().split()) == 2):
            assert process.poll() is None and time.monotonic() < end, f"{program} did not start"
            time.sleep(0.05)
        port, path = message.read_text().split()
        with connect(f"ws://127.0.0.1:{port}{path}", max_size=None) as socket:
            target = _call(socket, "Target.createTarget", url="about:blank")["targetId"]
            joined = _call(socket, "Target.attachToTarget", targetId=target, flatten=True)
            yield Tab(socket, joined["sessionId"])
    finally:
        process.terminate()
        with suppress(subprocess.TimeoutExpired):
            process.wait(10)
        if process.poll() is None:
            process.kill()


def _call(socket: Any, method: str, **parameters: Any) -> dict[str, Any]:
    """A command to the browser itself, before there is a tab."""
    socket.send(json.dumps({"id": 0, "method": method, "params": parameters}))
    while True:
        record = json.loads(socket.recv(timeout=WAIT))
        if record.get("id") == 0:
            assert "error" not in record, record["error"]
            return record["result"]

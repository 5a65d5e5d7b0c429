"""`mdlgen live` as a server: what it answers, what it refuses, and what it leaves behind."""

from __future__ import annotations

import json
import os
import re
import socket
import subprocess
import sys
import time
from collections.abc import Iterator
from pathlib import Path

import pytest
from living import Live, live, scene
from typer.testing import CliRunner

from mdlgen.cli import app
from mdlgen.live.server import listening
from mdlgen.spec.load import load

SPEED = "parameters.speed"
LONG = ("boxes: [10, 20]", "boxes: [3, 4]"), ("duration: 50 ms", "duration: 200000 ms")


@pytest.fixture(scope="module")
def running(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Live]:
    folder = tmp_path_factory.mktemp("scene")
    (folder.parent / "secret.txt").write_text("not for all")
    with live(scene(folder)) as made:
        made.quiet()
        yield made


def test_its_own_page_is_answered(running: Live) -> None:
    status, body, headers = running.request(running.path)
    text = body.decode()
    assert status == 200 and "transport_nips" in text
    # all is in the page: nothing is loaded from elsewhere
    assert not re.findall(r"<(?:script|link|img|iframe)[^>]*?(?:src|href)=[\"'](?!data:)", text)
    rules = headers["content-security-policy"]
    assert "default-src 'none'" in rules and "connect-src 'self'" in rules and "unsafe" not in rules
    assert "frame-ancestors 'none'" in rules
    assert headers["cache-control"] == "no-store" and headers["referrer-policy"] == "no-referrer"
    own = {"Origin": f"http://{running.host}:{running.port}", "Sec_Fetch_Site": "same-origin"}
    assert running.request(f"{running.path}state", **own)[0] == 200
    assert len(running.path.strip("/")) >= 30  # the token cannot be guessed


def test_the_address_without_its_end_leads_to_it(running: Live) -> None:
    status, _, headers = running.request(running.path.rstrip("/"))
    assert (status, headers["location"]) == (307, running.path)
    assert running.request(running.path.rstrip("/"), Origin="http://evil.example")[0] == 403


@pytest.mark.parametrize(
    "headers",
    [
        {"Host": "localhost"},
        {"Host": "evil.example"},
        {"Host": "127.0.0.1"},
        {"Origin": "http://evil.example"},
        {"Origin": "null"},
        {"Origin": "http://127.0.0.1:1"},
        {"Sec_Fetch_Site": "cross-site"},
        {"Sec_Fetch_Site": "same-site", "Sec_Fetch_Mode": "cors"},
    ],
    ids=str,
)
@pytest.mark.parametrize("name", ["", "state", "run", "events", "text"])
def test_a_stranger_is_refused(running: Live, headers: dict[str, str], name: str) -> None:
    status, body, _ = running.request(running.path + name, **headers)
    assert status == 403 and b"transport" not in body


@pytest.mark.parametrize(
    "path", ["/", "/state", "//state", "/a/state", "/{short}/state", "/{token}x/state", "*"]
)
def test_an_address_without_the_token_is_refused(running: Live, path: str) -> None:
    token = running.path.strip("/")
    status, body, _ = running.request(path.format(token=token, short=token[:-1]))
    assert status == 403 and b"transport" not in body


@pytest.mark.parametrize(
    "path",
    [
        *(
            "../secret.txt",
            "%2e%2e/secret.txt",
            "..%2fsecret.txt",
            "./transport_nips.yaml",
            "transport_nips.yaml",
        ),
        *("run/../../secret.txt", "text?file=../secret.txt", "/etc/passwd", "file:///etc/passwd"),
    ],
)
def test_no_file_is_served(running: Live, path: str) -> None:
    status, body, _ = running.request(running.path + path)
    assert b"not for all" not in body and b"root:" not in body
    # a question behind the path changes nothing: it is the scene's own text
    assert status == 404 or (path.startswith("text?") and json.loads(body)["text"].startswith("# The note"))


@pytest.mark.parametrize("kind", ["text/plain", "application/x-www-form-urlencoded", ""])
def test_a_form_of_another_page_turns_nothing(running: Live, kind: str) -> None:
    body = json.dumps({"values": {SPEED: "500 mm/s"}}).encode()
    more = {"Content_Type": kind} if kind else {}
    assert running.request(f"{running.path}turn", "POST", body, **more)[0] == 403
    assert running.get("state")["turned"] == {}


@pytest.mark.parametrize(
    "content",
    [
        {"values": {"meshes.cam.file": "../secret.stl"}},
        {"values": {"sheets.note.material": "other"}},
        {"values": {"name": "other"}},
        {"values": {SPEED: 3}},
        {"values": {SPEED: "1" * 1000}},
        {"values": [SPEED]},
        {},
        [],
        "values",
    ],
    ids=str,
)
def test_what_is_no_value_of_the_scene_is_not_turned(running: Live, content: object) -> None:
    status, answer = running.post("turn", content)
    assert status in (400, 409) and answer["says"]
    assert running.get("state")["turned"] == {}


def test_it_listens_on_this_machine_alone() -> None:
    made = listening()
    try:
        host, port = made.getsockname()
        assert host == "127.0.0.1"
        with pytest.raises(Exception, match=f"port {port}: cannot be opened"):
            listening(port)
    finally:
        made.close()


def test_ctrl_c_ends_it_and_leaves_nothing(tmp_path: Path) -> None:
    spec = scene(tmp_path, "transport_nips", *LONG)
    before = sorted(tmp_path.iterdir())
    with live(spec) as made:
        made.until(lambda state: state["progress"] is not None)
        (worker,) = made.children()
        began = time.monotonic()
        assert made.interrupt() == 0
        assert time.monotonic() - began < 10.0
        assert not Path(f"/proc/{worker}").exists()
        with pytest.raises(OSError), socket.create_connection((made.host, made.port), timeout=1):
            pass
    assert sorted(tmp_path.iterdir()) == before


def test_a_worker_ends_with_a_server_that_is_killed(tmp_path: Path) -> None:
    with live(scene(tmp_path, "transport_nips", *LONG)) as made:
        made.until(lambda state: state["progress"] is not None)
        (worker,) = made.children()
        made.process.kill()
        made.process.wait()
        end = time.monotonic() + 20.0
        while Path(f"/proc/{worker}").exists() and time.monotonic() < end:
            time.sleep(0.05)
        assert not Path(f"/proc/{worker}").exists()


def test_the_address_is_one_line_on_standard_output(tmp_path: Path) -> None:
    with live(scene(tmp_path), "-q") as made:
        assert re.fullmatch(r"http://127\.0\.0\.1:\d+/[\w-]{32}/", made.address)
        assert made.interrupt() == 0
        assert made.process.stdout is not None and made.process.stderr is not None
        assert made.process.stdout.read() == "" and made.process.stderr.read() == ""


def test_a_missing_extra_is_one_line(tmp_path: Path) -> None:
    """In a process in which it cannot be found."""
    code = (
        "import sys, importlib.util as u; found = u.find_spec;"
        "u.find_spec = lambda name, *more: None if name == 'watchfiles' else found(name, *more);"
        "sys.argv = ['mdlgen', 'live', sys.argv[1]];"
        "from mdlgen.cli import main; main()"
    )
    done = subprocess.run(
        [sys.executable, "-c", code, str(scene(tmp_path))],
        capture_output=True,
        check=False,
        text=True,
        env={**os.environ, "PYTHONPATH": os.pathsep.join(sys.path)},
    )
    assert done.returncode == 3 and done.stdout == ""
    assert done.stderr == 'mdlgen live needs watchfiles: pip install "mdlgen[live]"\n'


def test_no_other_command_opens_a_port(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    spec, out = str(scene(tmp_path)), str(tmp_path / "out")
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr("webbrowser.open", lambda url: True)

    def refused(*_: object) -> None:
        raise AssertionError("a port is opened")

    monkeypatch.setattr("socket.socket.bind", refused)
    monkeypatch.setattr("socket.socket.listen", refused)
    for line in (
        ["check", spec],
        ["preview", spec],
        ["run", spec, "-o", out],
        ["report", out],
        ["view", out],
        ["mdl", spec, "-o", str(tmp_path / "a.mdl")],
        ["sweep", spec, "--over", "parameters.speed=[1 m/s, 2 m/s]", "--workers", "1", "-o", f"{out}/s"],
    ):
        done = CliRunner().invoke(app, line)
        assert done.exit_code == 0, f"{line}: {done.output} {done.exception}"
    done = CliRunner().invoke(app, ["live", spec, "--no-browser"])
    assert isinstance(done.exception, SystemExit) and "a port is opened" in done.output


@pytest.mark.parametrize("line", [["live", "none.yaml"], ["live", "{spec}", "--solver", "none"]])
def test_what_cannot_be_followed_ends_in_one_line(tmp_path: Path, line: list[str]) -> None:
    done = CliRunner().invoke(app, [word.format(spec=scene(tmp_path)) for word in line])
    assert done.exit_code in (2, 3) and len(done.stderr.splitlines()) == 1


def test_the_scene_that_is_written_is_the_one_that_is_shown(tmp_path: Path) -> None:
    spec = scene(tmp_path)
    text = spec.read_text("utf-8")
    with live(spec) as made:
        made.quiet()
        made.turn(parameters__speed="900 mm/s", sheets__note__thickness="0.12 mm")
        state = made.quiet()
        assert state["command"] == (
            f"mdlgen run {spec} --set 'parameters.speed=900 mm/s' --set 'sheets.note.thickness=0.12 mm'"
        )
        assert made.post("write", {}) == (200, {})
        state = made.quiet()
        assert state["turned"] == {} and state["command"] == f"mdlgen run {spec}"
    written = spec.read_text("utf-8")
    assert written == text.replace("speed: 1400.25 mm/s", "speed: 900 mm/s").replace(
        "0.1 mm, mass", "0.12 mm, mass"
    )
    assert load(spec).amounts["speed"].value == pytest.approx(0.9)

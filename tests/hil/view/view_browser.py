"""A real browser for tests: headless Chromium, driven through its DevTools protocol."""

import base64
import json
import os
import shutil
import signal
import subprocess
import time
import urllib.request
from contextlib import contextmanager
from pathlib import Path

from websockets.sync.client import connect

NAMES = ("chromium", "chromium-browser", "google-chrome")
FLAGS = (
    "--headless=new",
    "--no-sandbox",
    "--disable-quic",
    "--no-first-run",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-sync",
    "--use-angle=swiftshader",
    "--enable-unsafe-swiftshader",
    "--remote-debugging-port=0",
)
START_S = 60.0


def find_browser():
    return next((path for name in NAMES if (path := shutil.which(name))), None)


class Page:
    """One tab."""

    def __init__(self, socket):
        self._socket = socket
        self._number = 0

    def call(self, method, **parameters):
        self._number += 1
        order = {"id": self._number, "method": method, "params": parameters}
        self._socket.send(json.dumps(order))
        while True:
            answer = json.loads(self._socket.recv(timeout=60))
            if answer.get("id") == self._number:
                return answer.get("result", answer)

    def open(self, url):
        self.call("Page.navigate", url=url)

    def evaluate(self, script):
        result = self.call("Runtime.evaluate", expression=script, awaitPromise=True)
        return result["result"].get("value")

    def press(self, x, y):
        """Press and release where a finger would: a page draws few pictures a second here."""
        for kind in ("mouseMoved", "mousePressed", "mouseReleased"):
            self.call("Input.dispatchMouseEvent", type=kind, x=x, y=y, button="left", clickCount=1)
            time.sleep(0.5)

    def picture(self, path=None):
        answer = {}
        for _ in range(10):  # a page that is busy drawing may refuse
            answer = self.call("Page.captureScreenshot", format="png")
            if "data" in answer:
                break
            time.sleep(1.0)
        data = base64.b64decode(answer["data"])
        if path is not None:
            Path(path).write_bytes(data)
        return data


@contextmanager
def browser(profile, width, height):
    """A browser of its own with one tab; it is gone in the end."""
    command = [find_browser(), *FLAGS, f"--user-data-dir={profile}", "about:blank"]
    log = (Path(profile).parent / f"{Path(profile).name}.log").open("wb")
    process = subprocess.Popen(command, stdout=log, stderr=log, start_new_session=True)
    try:
        port = _port(Path(profile) / "DevToolsActivePort", process)
        with urllib.request.urlopen(f"http://127.0.0.1:{port}/json") as answer:
            pages = json.load(answer)
        address = next(p for p in pages if p["type"] == "page")["webSocketDebuggerUrl"]
        with connect(address, max_size=None, open_timeout=60) as socket:
            page = Page(socket)
            page.call(
                "Emulation.setDeviceMetricsOverride",
                width=width, height=height, deviceScaleFactor=1, mobile=False,
            )  # fmt: skip
            yield page
    finally:
        os.killpg(process.pid, signal.SIGKILL)
        process.wait()
        log.close()


def _port(file, process):
    end = time.monotonic() + START_S
    while time.monotonic() < end and process.poll() is None:
        if file.exists() and file.read_text().count("\n") >= 1:
            return int(file.read_text().split("\n")[0])
        time.sleep(0.1)
    raise RuntimeError("the browser did not start")

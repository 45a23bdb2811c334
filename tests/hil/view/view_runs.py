"""Runs with a view, in processes of their own."""

import re
import socket
import subprocess
import sys
import time
from pathlib import Path

CLI = "from hil.cli.main import main; main()"
WAIT_S = 60.0


class Run:
    """`stride walk --view web` in a process of its own."""

    def __init__(self, folder, *options):
        self.folder = folder
        self._log = (folder.parent / "stderr").open("w+")
        command = [sys.executable, "-c", CLI, "walk", "--view", "web", "--out", str(folder)]
        self.process = subprocess.Popen(
            [*command, *options], stdout=subprocess.PIPE, stderr=self._log, text=True
        )

    def said(self, pattern):
        """The first match in what it has said, waited for."""
        end = time.monotonic() + WAIT_S
        while time.monotonic() < end:
            found = re.search(pattern, self.text())
            if found:
                return found[1]
            time.sleep(0.1)
        raise AssertionError(f"no {pattern!r} in {self.text()}")

    def text(self):
        return Path(self._log.name).read_text()

    def tell(self, line):
        with socket.socket(socket.AF_UNIX) as client:
            client.connect(str(self.folder / "stop"))
            client.sendall(line)
            return client.recv(256)

    def await_socket(self):
        end = time.monotonic() + WAIT_S
        while not (self.folder / "stop").exists() and time.monotonic() < end:
            time.sleep(0.05)

    def view_pid(self):
        children = Path(f"/proc/{self.process.pid}/task/{self.process.pid}/children")
        for pid in children.read_text().split():
            if b"hil.view.process" in Path(f"/proc/{pid}/cmdline").read_bytes():
                return int(pid)
        return None

    def end(self):
        self.process.wait(WAIT_S)
        self._log.close()
        return self.process.returncode

    def kill(self):
        self.process.kill()
        self.process.wait()

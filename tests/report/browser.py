# SPDX-License-Identifier: Apache-2.0
"""Drives a headless Chromium through its debugging pipe, without further packages."""
import base64
import fcntl
import json
import os
import select
import shutil
import subprocess
import tempfile
import time

PROGRAM = shutil.which("chromium") or shutil.which("chromium-browser")
# A machine that compiles at the same time is slow, and a hanging browser must still end.
LONGEST = 120.0  # [s]


class Browser:
    """One page in one browser process. Messages of the page are kept.

    The network is off, except for pages that are served from this machine.
    """

    def __init__(self, webgl=True, offline=True):
        self.folder = tempfile.mkdtemp(prefix="navvy_page_")
        self.number = 0
        self.buffer = b""
        self.messages = []
        self.requests = []
        self.loaded = False
        self.session = None
        self._start(webgl)
        target = self._ask("Target.createTarget", {"url": "about:blank"})["targetId"]
        self.session = self._ask("Target.attachToTarget",
                                 {"targetId": target, "flatten": True})["sessionId"]
        for domain in ("Page", "Runtime", "Log", "Network"):
            self._ask(domain + ".enable", {})
        self._ask("Network.emulateNetworkConditions", {"offline": offline, "latency": 0,
                                                       "downloadThroughput": -1,
                                                       "uploadThroughput": -1})

    def _start(self, webgl):
        # The browser reads commands from descriptor 3 and writes answers to 4.
        command_out, self.commands = os.pipe()
        self.answers, answer_in = os.pipe()
        theirs = [fcntl.fcntl(one, fcntl.F_DUPFD, 10) for one in (command_out, answer_in)]
        os.close(command_out)
        os.close(answer_in)

        def connect():
            os.dup2(theirs[0], 3)
            os.dup2(theirs[1], 4)

        graphics = (["--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"]
                    if webgl else ["--disable-gpu", "--disable-3d-apis"])
        self.process = subprocess.Popen(
            [PROGRAM, "--headless", "--no-sandbox", "--disable-dev-shm-usage", "--no-first-run",
             "--disable-extensions", "--disable-background-networking", "--hide-scrollbars",
             "--remote-debugging-pipe", "--user-data-dir=" + self.folder] + graphics,
            stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
            close_fds=False, preexec_fn=connect)
        for one in theirs:
            os.close(one)

    def _receive(self, deadline):
        while b"\0" not in self.buffer:
            ready = select.select([self.answers], [], [], max(0.0, deadline - time.monotonic()))[0]
            part = os.read(self.answers, 1 << 20) if ready else b""
            if not part:
                raise TimeoutError("the browser ended" if ready else "the browser does not answer")
            self.buffer += part
        line, self.buffer = self.buffer.split(b"\0", 1)
        return json.loads(line)

    def _note(self, event):
        method, params = event.get("method"), event.get("params", {})
        if method == "Runtime.consoleAPICalled":
            self.messages.append(" ".join(str(one.get("value", one.get("description")))
                                          for one in params["args"]))
        elif method == "Runtime.exceptionThrown":
            details = params["exceptionDetails"]
            self.messages.append(details.get("exception", {}).get("description", details["text"]))
        elif method == "Log.entryAdded":
            self.messages.append(params["entry"]["text"])
        elif method == "Network.requestWillBeSent":
            self.requests.append(params["request"]["url"])
        elif method == "Page.loadEventFired":
            self.loaded = True

    def _ask(self, method, params):
        self.number += 1
        message = {"id": self.number, "method": method, "params": params}
        if self.session:
            message["sessionId"] = self.session
        os.write(self.commands, json.dumps(message).encode() + b"\0")
        deadline = time.monotonic() + LONGEST
        while True:
            answer = self._receive(deadline)
            if answer.get("id") != self.number:
                self._note(answer)
            elif "error" in answer:
                raise RuntimeError(f"{method}: {answer['error']['message']}")
            else:
                return answer["result"]

    def size(self, width, height):
        self._ask("Emulation.setDeviceMetricsOverride",
                  {"width": width, "height": height, "deviceScaleFactor": 1, "mobile": False})

    def scheme(self, name):
        self._ask("Emulation.setEmulatedMedia",
                  {"features": [{"name": "prefers-color-scheme", "value": name}]})

    def open(self, page):
        """Opens the text of a page from a file and waits until it shows its data."""
        path = os.path.join(self.folder, "page.html")
        with open(path, "w", encoding="utf-8") as file:
            file.write(page)
        self.visit("file://" + path)

    def visit(self, url):
        """Opens an address and waits until the page shows its data."""
        self.messages.clear()
        self.requests.clear()
        self.loaded = False
        self._ask("Page.navigate", {"url": url})
        deadline = time.monotonic() + LONGEST
        while not self.loaded:
            self._note(self._receive(deadline))
        self.run("navvy.ready.then(() => true)")
        # Two pictures later, what waits for a picture is drawn.
        self.run("new Promise(done => requestAnimationFrame(() => requestAnimationFrame("
                 "() => setTimeout(done, 50))))")

    def run(self, script):
        """Returns the value of a script in the page; waits for promises."""
        answer = self._ask("Runtime.evaluate", {"expression": script, "awaitPromise": True,
                                                "returnByValue": True})
        if "exceptionDetails" in answer:
            details = answer["exceptionDetails"]
            raise RuntimeError(details.get("exception", {}).get("description", details["text"]))
        return answer["result"].get("value")

    def picture(self, path, whole=True):
        """Writes a PNG of the page, or of the window only."""
        data = self._ask("Page.captureScreenshot",
                         {"format": "png", "captureBeyondViewport": whole})["data"]
        with open(path, "wb") as file:
            file.write(base64.b64decode(data))

    def close(self):
        try:
            self.session = None
            self._ask("Browser.close", {})
            self.process.wait(20)
        except (OSError, TimeoutError, RuntimeError, subprocess.TimeoutExpired):
            self.process.kill()
            self.process.wait()
        os.close(self.commands)
        os.close(self.answers)
        shutil.rmtree(self.folder, ignore_errors=True)

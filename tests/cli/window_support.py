# SPDX-License-Identifier: Apache-2.0
"""A viewer in a real window: a virtual X server of its own, keys and mouse as a person would send them."""
import os
import re
import shutil
import subprocess
import sys
import tempfile
import time

import support

TOOLS = ("Xvfb", "xdotool")
PATIENCE = float(os.environ.get("CATOPTRIC_TEST_PATIENCE", "120"))  # seconds; a loaded machine is slow, not wrong


def skip_without_tools():
    """ctest counts exit code 77 as skipped (CMakeLists.txt)."""
    missing = [tool for tool in TOOLS if shutil.which(tool) is None]
    if missing:
        print(f"skipped: {', '.join(missing)} not installed (apt-get install xvfb xdotool)")
        sys.exit(77)


def wait_for(condition, what, seconds=PATIENCE):
    end = time.monotonic() + seconds
    while time.monotonic() < end:
        result = condition()
        if result:
            return result
        time.sleep(0.05)
    raise AssertionError(f"no {what} within {seconds} s")


class Display:
    """An X server without a screen. `with Display() as name:`"""

    def __init__(self, width=800, height=600):
        self.size = f"{width}x{height}x24"

    def __enter__(self):
        read, write = os.pipe()
        # Without -noreset the server starts anew after its last client, and refuses the next one while it does.
        command = ["Xvfb", "-displayfd", str(write), "-screen", "0", self.size, "-nolisten", "tcp", "-noreset"]
        self.server = subprocess.Popen(command, pass_fds=(write,), stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        os.close(write)
        with os.fdopen(read) as number:
            self.name = ":" + number.readline().strip()
        return self.name

    def __exit__(self, *_):
        self.server.terminate()
        self.server.wait()


class Viewer:
    """`catoptric view` in a folder, on a display."""

    def __init__(self, folder, display, *arguments):
        self.environment = {**os.environ, "DISPLAY": display}
        self.environment.pop("WAYLAND_DISPLAY", None)
        self.errors = tempfile.TemporaryFile()
        self.output = tempfile.TemporaryFile()
        self.process = subprocess.Popen([support.CATOPTRIC, "view", *arguments, "--verbose"], cwd=folder, stdin=subprocess.PIPE,
                                        env=self.environment, stdout=self.output, stderr=self.errors)
        self.window = None

    def read(self, file):
        file.seek(0)
        return file.read().decode(errors="replace")

    def said(self):
        return self.read(self.errors)

    def count(self, pattern):
        return len(re.findall(pattern, self.said()))

    def do(self, *words):
        return subprocess.run(["xdotool", *map(str, words)], env=self.environment, stdout=subprocess.PIPE,
                              stderr=subprocess.DEVNULL, check=False).stdout.decode()

    def find_windows(self):
        return self.do("search", "--onlyvisible", "--name", "catoptric").split()

    def wait_for_window(self):
        def find():
            if self.process.poll() is not None:
                raise AssertionError(f"the viewer ended with {self.process.returncode}: {self.said()}")
            return self.find_windows()
        self.window = wait_for(find, "window")[-1]
        self.do("windowfocus", "--sync", self.window)

    def wait_for_line(self, pattern, times=1):
        wait_for(lambda: self.count(pattern) >= times or self.process.poll() is not None, f"'{pattern}'")
        if self.count(pattern) < times:
            raise AssertionError(f"the viewer ended with {self.process.returncode}: {self.said()}")

    def after(self, pattern, action):
        """Does it and waits until the viewer has said the line once more."""
        before = self.count(pattern)
        action()
        self.wait_for_line(pattern, before + 1)

    def drag(self, start, end, button=1):
        self.do("mousemove", *start)
        time.sleep(0.1)
        self.do("mousedown", button)
        for step in range(1, 6):
            time.sleep(0.05)
            self.do("mousemove", *(a + (b - a) * step // 5 for a, b in zip(start, end)))
        time.sleep(0.1)
        self.do("mouseup", button)

    def end(self):
        """Exit code after the window was closed."""
        self.process.wait(PATIENCE)
        return self.process.returncode

    def kill(self):
        if self.process.poll() is None:
            self.process.kill()
            self.process.wait()
        self.process.stdin.close()
        self.errors.close()
        self.output.close()

"""Serves a mission with `joulepath studio` and uses its page in headless Chromium, as a test or a benchmark does."""
import json
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import time
import urllib.request

SOURCE = pathlib.Path(__file__).resolve().parents[3]
sys.path.insert(0, str(SOURCE / "tests" / "app" / "report"))
from browser_test import SKIPPED, Browser, chromium  # noqa: E402  (the driver that the reports' test has)

MISSION = """\
schema: joulepath/mission/1
# A round in three drawn paths.
robot: robot.yaml
start: {x_m: 0.0, y_m: 0.0, heading_rad: 0.0, battery_fraction: 0.9}
legs:
  - {path: {bezier_m: [[[0, 0], [2.7, 0], [2.7, 0], [2.7, 2.7]]], frame: start}, payload_kg: 5.7, dwell_s: 4}  # out
  # across: two curves, drawn in the map
  - path: {bezier_m: [[[2.7, 2.7], [2.7, 4.0], [1.9, 5.0], [0.7, 5.2]], [[0.7, 5.2], [-0.6, 5.4], [-1.4, 4.6], [-1.6, 3.4]]], frame: map}
    payload_kg: {from: 8, to: 2}   # spraying
  - {path: {bezier_m: [[[0, 0], [1.8, 0], [1.8, 0], [1.8, 1.8]]]}, payload_kg: 0}
objective: {minimize: energy, deadline_s: 60}
"""


def write_mission(folder):
    """The mission above with its robot, in a folder; the mission's file."""
    folder = pathlib.Path(folder)
    shutil.copy(SOURCE / "scenarios/robots/nomad_super_scout.yaml", folder / "robot.yaml")
    (folder / "mission.yaml").write_text(MISSION)
    return folder / "mission.yaml"


class Served:
    """`joulepath studio` of a mission, until close()."""

    def __init__(self, program, mission, *options):
        self.process = subprocess.Popen([program, "studio", str(mission), *options], stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True)
        self.address = self.process.stdout.readline().strip()
        assert self.address.startswith("http://127.0.0.1:"), f"the studio said: {self.address!r}"

    def post(self, what, body, **headers):
        origin = re.match(r"http://[^/]*", self.address)[0]
        data = body if isinstance(body, bytes) else json.dumps(body).encode()
        request = urllib.request.Request(self.address + what, data, {"Content-Type": "application/json", "Origin": origin, **headers}, method="POST")
        with urllib.request.urlopen(request, timeout=300) as answer:
            return json.load(answer)

    def files(self):
        with urllib.request.urlopen(self.address + "files", timeout=60) as answer:
            return json.load(answer)

    def close(self):
        self.process.terminate()
        self.process.wait(10)

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.close()


class StudioPage(Browser):
    """The page in a browser."""

    def show(self, address, patience_s=300):
        self.call("POST", "/url", {"url": "about:blank"})
        self.call("POST", "/url", {"url": str(address)})
        self.until("return document.documentElement.dataset.ready === 'true'", patience_s)

    def until(self, condition, patience_s=300):
        end = time.monotonic() + patience_s
        while not self.run(condition):
            if time.monotonic() > end:
                raise AssertionError(f"not within {patience_s} s: {condition}; errors {self.run('return joulepath.errors')}; console {self.console()}")
            time.sleep(0.02)

    def settle(self):
        """Until the mission as it is now is planned."""
        self.until("return ['planned', 'certified', 'problem'].includes(document.documentElement.dataset.state)")

    def places(self):
        """Handles on the canvas: [name, x, y] in the window's pixels, those that lie inside of it."""
        return self.run("""const box = document.getElementById('floor').getBoundingClientRect();
          return studio.handles().map((one) => [one.name, ...studio.view.at(one.x, one.y)])
            .filter(([, x, y]) => x > 10 && y > 50 && x < box.width - 10 && y < box.height - 10)
            .map(([name, x, y]) => [name, Math.round(x + box.left), Math.round(y + box.top)]);""")

    def drag(self, begin, end, steps=4):
        moves = [{"type": "pointerMove", "duration": 15, "x": round(begin[0] + (end[0] - begin[0]) * k / steps), "y": round(begin[1] + (end[1] - begin[1]) * k / steps)} for k in range(1, steps + 1)]
        self.call("POST", "/actions", {"actions": [{"type": "pointer", "id": "mouse", "actions": [
            {"type": "pointerMove", "duration": 0, "x": begin[0], "y": begin[1]}, {"type": "pointerDown", "button": 0}, *moves, {"type": "pointerUp", "button": 0}]}]})

    def random_drag(self, random_numbers):
        """Drags a handle by up to 60 pixels; its name."""
        name, x, y = random_numbers.choice(self.places())
        self.drag((x, y), (x + random_numbers.randint(-60, 60), y + random_numbers.randint(-60, 60)))
        return name

    def messages(self):
        """Errors of the page; not Chromium's note that a test left a page with unsaved changes."""
        return [told for told in self.console() if "beforeunload" not in told] + self.run("return joulepath.errors")


def run_in_browser(check):
    """The exit code of a test: check(program, folder, page) with a folder of its own and a page in a browser."""
    if not chromium() or not shutil.which("chromedriver"):
        print("Chromium or chromedriver is not installed (Debian: chromium chromium-driver)")
        return 1 if os.environ.get("JOULEPATH_BROWSER") == "required" else SKIPPED
    with tempfile.TemporaryDirectory() as name:
        page = StudioPage(name)
        try:
            check(sys.argv[1], pathlib.Path(name), page)
        finally:
            page.close()
    return 0


__all__ = ["Served", "StudioPage", "run_in_browser", "write_mission", "SOURCE", "MISSION"]

#!/usr/bin/env python3
"""Opens reports from file:// in headless Chromium and uses them as a reader does.

usage: browser_test.py REPORT_SAMPLES_PROGRAM [REPORT.html ...]

Speaks W3C WebDriver to chromedriver with the standard library alone. Exit code 77 (skipped in CTest)
where Chromium or chromedriver is absent, unless JOULEPATH_BROWSER=required.
"""
import json
import os
import pathlib
import shutil
import socket
import subprocess
import sys
import tempfile
import time
import urllib.error
import urllib.request

SKIPPED = 77
FLAGS = ["--headless=new", "--no-sandbox", "--disable-gpu", "--disable-quic", "--no-first-run", "--disable-dev-shm-usage",
         "--disable-background-networking", "--disable-component-update", "--disable-sync", "--window-size=1280,1000"]
ELEMENT = "element-6066-11e4-a52e-4f735466cecf"


class Browser:
    def __init__(self, folder):
        with socket.socket() as probe:
            probe.bind(("127.0.0.1", 0))
            self.port = probe.getsockname()[1]
        self.driver = subprocess.Popen([shutil.which("chromedriver"), f"--port={self.port}", "--silent"],
                                       stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        self.base = f"http://127.0.0.1:{self.port}"
        for _ in range(150):
            try:
                if self.call("GET", "/status")["ready"]:
                    break
            except OSError:
                time.sleep(0.1)
        options = {"args": FLAGS + [f"--user-data-dir={folder}/profile"], "binary": chromium()}
        wanted = {"browserName": "chrome", "goog:chromeOptions": options, "goog:loggingPrefs": {"browser": "ALL"}}
        self.base += "/session/" + self.call("POST", "/session", {"capabilities": {"alwaysMatch": wanted}})["sessionId"]

    def call(self, method, path, body=None):
        data = None if body is None else json.dumps(body).encode()
        request = urllib.request.Request(self.base + path, data, {"Content-Type": "application/json"}, method=method)
        try:
            with urllib.request.urlopen(request, timeout=60) as answer:
                return json.load(answer)["value"]
        except urllib.error.HTTPError as error:
            raise AssertionError(error.read().decode()[:600]) from error

    def open(self, file, theme):
        self.call("POST", "/url", {"url": "about:blank"})
        self.call("POST", "/url", {"url": pathlib.Path(file).resolve().as_uri() + "#" + theme})
        for _ in range(100):
            if self.run("return document.documentElement.dataset.ready === 'true'"):
                return
            time.sleep(0.05)
        raise AssertionError(f"{file}: the page did not become ready; console: {self.console()}")

    def run(self, script, *arguments):
        return self.call("POST", "/execute/sync", {"script": script, "args": list(arguments)})

    def console(self):
        return [entry["message"] for entry in self.call("POST", "/se/log", {"type": "browser"})
                if entry["level"] in ("SEVERE", "WARNING")]

    def hover(self, selector, right, down):
        """Moves the mouse to a fraction of an element's box."""
        element = self.call("POST", "/element", {"using": "css selector", "value": selector})
        self.run("arguments[0].scrollIntoView({block: 'center'})", element)
        width, height = self.run("const b = arguments[0].getBoundingClientRect(); return [b.width, b.height]", element)
        moves = [{"type": "pointerMove", "duration": 20, "origin": element, "x": round((right - 0.5) * width) + shift,
                  "y": round((down - 0.5) * height)} for shift in (0, 2)]
        self.call("POST", "/actions", {"actions": [{"type": "pointer", "id": "mouse", "actions": moves}]})

    def press(self, selector, key):
        element = self.call("POST", "/element", {"using": "css selector", "value": selector})
        self.call("POST", f"/element/{element[ELEMENT]}/value", {"text": key})

    def close(self):
        try:
            self.call("DELETE", "")
        finally:
            self.driver.terminate()
            self.driver.wait(10)


def chromium():
    return next((path for name in ("chromium", "chromium-browser", "google-chrome") if (path := shutil.which(name))), None)


# Pixels of a canvas that differ from its first one: 0 for a canvas that nothing was drawn on.
DRAWN = """return [...document.querySelectorAll('.plot canvas, .map canvas')].map((canvas) => {
  const p = canvas.getContext('2d').getImageData(0, 0, canvas.width, canvas.height).data;
  let n = 0;
  for (let k = 4; k < p.length; k += 4) n += p[k] !== p[0] || p[k + 1] !== p[1] || p[k + 3] !== p[3];
  return [canvas.parentElement.closest('.map') ? 'map' : canvas.style.zIndex || 'plot', n];
});"""


def check_page(browser, file, theme, plots):
    browser.open(file, theme)
    messages = browser.console() + browser.run("return joulepath.errors")
    assert not messages, f"console: {messages}"
    count = browser.run("return document.querySelectorAll('.plot').length")
    assert count >= plots, f"{count} plots, expected at least {plots}"
    # dygraphs lays two canvases over one another: one of each pair carries the drawing.
    drawn = browser.run(DRAWN)
    with_ink = sum(n > 50 for _, n in drawn)
    assert with_ink >= count, f"canvases with ink: {drawn}"
    wide = browser.run("return document.documentElement.scrollWidth - document.documentElement.clientWidth")
    assert wide <= 0, f"the page is {wide} px wider than the window"
    unnamed = browser.run("return [...document.querySelectorAll('button, select, input, canvas[role], [role=img]')]"
                          ".filter((e) => e.offsetParent && !(e.textContent.trim() || e.ariaLabel || e.getAttribute('aria-label'))).map((e) => e.outerHTML.slice(0, 120))")
    assert not unnamed, f"controls or figures without a name: {unnamed}"
    requests = browser.run("return performance.getEntriesByType('resource').map((r) => r.name).filter((n) => !n.startsWith('data:'))")
    assert not requests, f"the page fetched {requests}"
    ground = browser.run("return getComputedStyle(document.body).backgroundColor")
    light = sum(int(part) for part in ground[4:-1].split(",")) > 380
    assert light == (theme == "light"), f"background {ground} in the {theme} theme"


def check_cursor(browser):
    """The cursor moves from a plot, from the slider's keys and (where there is one) from the map."""
    read = "return document.querySelector('.readout').textContent"
    value = "return Number(document.querySelector('#cursor').value)"
    texts = [browser.run(read)]
    browser.hover(".plot", 0.5, 0.5)
    texts.append(browser.run(read))
    browser.hover(".plot", 0.8, 0.5)
    texts.append(browser.run(read))
    assert len(set(texts)) == 3, f"hovering left the readout at {texts}"
    shown = browser.run("return [...document.querySelector('.cursor').closest('section').querySelectorAll('.plot-head .now')].map((e) => e.textContent)")
    assert all(shown), f"plots that did not follow the cursor: {shown}"
    before = browser.run(value)
    browser.press("#cursor", "\ue012")  # left arrow
    assert browser.run(value) == before - 1, "the arrow key did not move the cursor"
    browser.press("#cursor", "\ue011")  # home
    assert browser.run(value) == 0, "the home key did not move the cursor to the start"


def check_plan(browser, file):
    check_page(browser, file, "light", 5)
    check_cursor(browser)
    ink = "const c = document.querySelector('.map canvas'); return c.toDataURL().length + c.toDataURL().slice(-4000)"
    before = browser.run(ink)
    browser.hover(".plot", 0.6, 0.5)
    assert browser.run(ink) != before, "the cursor did not move on the map"
    browser.run("document.querySelector('.map canvas').scrollIntoView()")
    row = browser.run("return joulepath.plots[0].graph.getSelection()")
    browser.press(".map canvas", "\ue014")  # right arrow
    moved = browser.run("return joulepath.plots[0].graph.getSelection()")
    assert moved > row, f"keys on the map left the plots at row {row}, {moved}"
    time_axis = browser.run("return joulepath.plots[0].graph.xAxisRange()")
    browser.run("document.querySelector('[data-by=distance]').click()")
    distance_axis = browser.run("return joulepath.plots[0].graph.xAxisRange()")
    assert time_axis != distance_axis, "the switch to distance changed nothing"
    browser.run("joulepath.plots[0].graph.updateOptions({dateWindow: [0, 1]})")
    browser.press("#cursor", "0")
    assert browser.run("return joulepath.plots[0].graph.xAxisRange()") == distance_axis, "the key 0 did not show all"
    browser.run("document.querySelector('#theme').click()")
    assert browser.run("return joulepath.is_dark()"), "the theme button changed nothing"
    assert browser.console() == [], "messages while using the report"


def main():
    if not chromium() or not shutil.which("chromedriver"):
        if os.environ.get("JOULEPATH_BROWSER") == "required":
            print("Chromium or chromedriver is not installed, and JOULEPATH_BROWSER=required")
            return 1
        print("skipped: Chromium or chromedriver is not installed (Debian: chromium chromium-driver)")
        return SKIPPED
    with tempfile.TemporaryDirectory() as folder:
        subprocess.run([sys.argv[1], folder], check=True)
        browser = Browser(folder)
        try:
            check_plan(browser, f"{folder}/plan.html")
            for kind, plots in (("plan", 5), ("infeasible", 0), ("diagnosis", 2), ("compare", 3), ("front", 5), ("batch", 0)):
                for theme in ("dark", "light"):
                    check_page(browser, f"{folder}/{kind}.html", theme, plots)
                    print(f"ok: {kind}, {theme}")
                if kind in ("diagnosis", "compare", "front"):
                    check_cursor(browser)
            for report in sys.argv[2:]:
                if os.path.exists(report):
                    check_plan(browser, report)
                    print(f"ok: {report}")
        finally:
            browser.close()
    return 0


if __name__ == "__main__":
    sys.exit(main())

#!/usr/bin/env python3
"""Opens reports from file:// in headless Chromium and uses them as a reader does.

usage: browser_test.py REPORT_SAMPLES_PROGRAM [REPORT.html ...]

JOULEPATH_AXE names axe.min.js (`./dev axe` installs it): every page is then searched for barriers, too.

Speaks W3C WebDriver to chromedriver with the standard library alone. Exit code 77 (skipped in CTest)
where Chromium or chromedriver is absent, unless JOULEPATH_BROWSER=required.
"""
import json
import os
import pathlib
import re
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

    def width(self, pixels, height=1000):
        self.call("POST", "/goog/cdp/execute", {"cmd": "Emulation.setDeviceMetricsOverride",
                                                "params": {"width": pixels, "height": height, "deviceScaleFactor": 1, "mobile": False}})

    def barriers(self):
        """Serious and critical findings of axe-core in the page as it is now; None without axe-core."""
        if not os.environ.get("JOULEPATH_AXE"):
            return None
        if not self.run("return !!window.axe"):
            self.run(pathlib.Path(os.environ["JOULEPATH_AXE"]).read_text())
        self.call("POST", "/timeouts", {"script": 60_000})
        return self.call("POST", "/execute/async", {"script": AXE, "args": []})

    def check_barriers(self, where):
        found = self.barriers()
        assert not found, f"axe-core, {where}: {found}"

    def drag(self, selector, begin, end):
        """Drags the mouse between two places of an element, in fractions of its box."""
        element = self.call("POST", "/element", {"using": "css selector", "value": selector})
        self.run("arguments[0].scrollIntoView({block: 'center'})", element)
        width, height = self.run("const b = arguments[0].getBoundingClientRect(); return [b.width, b.height]", element)
        move = lambda at: {"type": "pointerMove", "duration": 20, "origin": element, "x": round((at[0] - 0.5) * width), "y": round((at[1] - 0.5) * height)}
        self.call("POST", "/actions", {"actions": [{"type": "pointer", "id": "mouse", "actions": [
            move(begin), {"type": "pointerDown", "button": 0}, move(end), {"type": "pointerUp", "button": 0}]}]})

    def keys(self, *texts):
        """Keys to whatever has the focus."""
        actions = [{"type": kind, "value": key} for text in texts for key in text for kind in ("keyDown", "keyUp")]
        self.call("POST", "/actions", {"actions": [{"type": "key", "id": "keys", "actions": actions}]})

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


# Transitions are over after two frames; a finding is "rule: element | element".
AXE = """const done = arguments[0];
requestAnimationFrame(() => requestAnimationFrame(() => axe.run(document, {resultTypes: ['violations']}).then((result) => done(result.violations
  .filter((one) => ['serious', 'critical'].includes(one.impact))
  .map((one) => one.id + ': ' + one.nodes.map((node) => node.html.slice(0, 120)).join(' | '))), (error) => done([String(error)]))));"""

# Pixels of a canvas that differ from its first one: 0 for a canvas that nothing was drawn on.
DRAWN = """return [...document.querySelectorAll('.plot canvas, .floor-box canvas')].map((canvas) => {
  const p = canvas.getContext('2d').getImageData(0, 0, canvas.width, canvas.height).data;
  let n = 0;
  for (let k = 4; k < p.length; k += 4) n += p[k] !== p[0] || p[k + 1] !== p[1] || p[k + 3] !== p[3];
  return [canvas.parentElement.closest('.floor-box') ? 'map' : 'plot', n];
});"""


def check_page(browser, file, theme, plots):
    browser.open(file, theme)
    messages = browser.console() + browser.run("return joulepath.errors")
    assert not messages, f"console: {messages}"
    count = browser.run("return document.querySelectorAll('.plot').length")
    assert count >= plots, f"{count} plots, expected at least {plots}"
    drawn = browser.run(DRAWN)
    with_ink = sum(n > 50 for _, n in drawn)
    assert with_ink >= count, f"canvases with ink: {drawn}"
    wide = browser.run("return document.documentElement.scrollWidth - document.documentElement.clientWidth")
    assert wide <= 0, f"the page is {wide} px wider than the window"
    unnamed = browser.run("return [...document.querySelectorAll('button, select, input, canvas[role], [role=img]')]"
                          ".filter((e) => e.offsetParent && !(e.textContent.trim() || e.ariaLabel || e.getAttribute('aria-label'))).map((e) => e.outerHTML.slice(0, 120))")
    assert not unnamed, f"controls or figures without a name: {unnamed}"
    sentences = browser.run("return [...document.querySelectorAll('.sentence')].map((e) => e.textContent)")
    assert len(sentences) == 1 and sentences[0].endswith("."), f"no sentence that says the result: {sentences}"
    title = browser.run("return document.title")
    assert re.fullmatch(r"[A-Z][a-z]+( .*)? · (made-up data · )?\d{4}-\d\d-\d\d · joulepath \d\S*", title), f"the title {title!r} lacks kind, day or version"
    requests = browser.run("return performance.getEntriesByType('resource').map((r) => r.name).filter((n) => !/^(data|blob):/.test(n))")
    assert not requests, f"the page fetched {requests}"
    ground = browser.run("return getComputedStyle(document.body).backgroundColor")
    light = sum(int(part) for part in ground[4:-1].split(",")) > 380
    assert light == (theme == "light"), f"background {ground} in the {theme} theme"
    browser.check_barriers(f"{file}, {theme}")


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
    ink = "const c = document.querySelector('.floor-box canvas'); return c.toDataURL().length + c.toDataURL().slice(-4000)"
    before = browser.run(ink)
    browser.hover(".plot", 0.6, 0.5)
    assert browser.run(ink) != before, "the cursor did not move on the map"
    browser.run("document.querySelector('.floor-box canvas').scrollIntoView()")
    row = browser.run("return Number(document.querySelector('#cursor').value)")
    browser.press(".floor-box canvas", "\ue014")  # right arrow
    moved = browser.run("return Number(document.querySelector('#cursor').value)")
    assert moved > row, f"keys on the map left the plots at row {row}, {moved}"
    span = "return joulepath.plots.map((one) => one.span())"
    time_axis = browser.run(span)
    browser.run("document.querySelector('[data-by=distance]').click()")
    distance_axis = browser.run(span)
    assert time_axis != distance_axis, "the switch to distance changed nothing"
    browser.drag(".plot", (0.4, 0.5), (0.7, 0.5))
    zoomed = browser.run(span)
    assert all(z[1] - z[0] < 0.5 * (d[1] - d[0]) for z, d in zip(zoomed, distance_axis)), f"dragging zoomed to {zoomed}"
    browser.press("#cursor", "0")
    assert browser.run(span) == distance_axis, "the key 0 did not show all"
    browser.run("document.querySelector('#theme').click()")
    assert browser.run("return document.documentElement.dataset.theme") == "dark", "the theme button changed nothing"
    assert browser.console() == [], "messages while using the report"


def check_layout(browser, file):
    """The map comes first and is large; nothing is wider than the window, no label is cut off."""
    for pixels, least in ((400, 360), (1280, 1100), (1920, 1000), (2560, 1300)):
        browser.width(pixels)
        browser.open(file, "light")
        wide = browser.run("return document.documentElement.scrollWidth - document.documentElement.clientWidth")
        assert wide <= 0, f"at {pixels} px the page is {wide} px wider than the window"
        map_width = browser.run("return document.querySelector('.floor-box').clientWidth")
        assert map_width >= least, f"the map has {map_width} of {pixels} px"
        first = browser.run("return [...document.querySelectorAll('.tiles, .floor-box, .plot, table')].map((e) => e.className || e.tagName).slice(0, 2)")
        assert first == ["tiles", "floor-box"], f"the page begins with {first}"
        cut = browser.run("return [...document.querySelectorAll('.stack span, .tile *, .rows > span, .plot-head *, .key')].filter((e) => e.offsetParent && e.scrollWidth > e.clientWidth + 1 && e.clientWidth > 0 && getComputedStyle(e).display !== 'inline').map((e) => e.outerHTML.slice(0, 100))")
        assert not cut, f"at {pixels} px cut off: {cut}"
        browser.check_barriers(f"{file}, {pixels} px")
    assert "dwell" in browser.run("return document.querySelector('.tiles').textContent"), "the duration does not say how much of it is dwell"
    browser.width(1280)


def check_signals(browser, file):
    """Every measured signal of the chosen run has a plot; another run and the differences change them."""
    browser.open(file, "light")
    ink = "return [...document.querySelectorAll('.run-signals canvas')].map((c) => c.toDataURL().slice(-3000))"
    titles = "return [...document.querySelectorAll('.run-signals h3')].map((e) => e.textContent)"
    before = browser.run(ink)
    measured = browser.run("return Object.keys(joulepath.data.runs[0].columns).filter((name) => name.startsWith('measured_')).length")
    assert measured >= 2 and len(browser.run(titles)) == measured, f"{browser.run(titles)} for {measured} signals"
    browser.run("const s = document.querySelector('.run-signals select'); s.value = '1'; s.dispatchEvent(new Event('change'))")
    assert browser.run(ink) != before, "another run has the same plots"
    browser.run("document.querySelector('[data-difference=true]').click()")
    assert all("model less measured" in title for title in browser.run(titles)), browser.run(titles)


def check_keyboard(browser, file):
    """Tab alone reaches every control, table that scrolls and map, in the order of the page, and shows where it is."""
    browser.width(1280)
    browser.open(file, "light")
    wanted = browser.run("window.wanted = [...document.querySelectorAll('a[href], button, select, input, summary, [tabindex=\"0\"]')].filter((e) => e.checkVisibility()); return wanted.length")
    visited = []
    for _ in range(wanted):
        browser.keys("\ue004")
        at, seen = browser.run("const e = document.activeElement, look = getComputedStyle(e); return [wanted.indexOf(e), look.outlineStyle !== 'none' || e.type === 'range' && look.outlineWidth !== '0px']")
        assert seen, f"{file}: the focus is invisible on {browser.run('return document.activeElement.outerHTML.slice(0, 120)')}"
        visited.append(at)
    assert visited == list(range(wanted)), f"{file}: Tab went through {visited} of {wanted} controls"


def check_bands(browser, folder):
    """The 95 % interval is drawn under what is uncertain, and named; a page without an uncertainty has none."""
    for name, expected in (("plan", ["Energy", "Power", "State of charge"]), ("exact", [])):
        browser.open(f"{folder}/{name}.html", "light")
        banded = browser.run("return [...document.querySelectorAll('.plot-block')].filter((e) => e.textContent.includes('95 % interval')).map((e) => e.querySelector('h3').textContent)")
        assert sorted(banded) == expected, f"{name}: bands on {banded}"
    # Beside the line there is ink of the band that the same plot without it lacks.
    ink = """const c = [...document.querySelectorAll('.plot-block')].find((e) => e.querySelector('h3').textContent === 'Energy').querySelector('canvas');
      const p = c.getContext('2d').getImageData(0, 0, c.width, c.height).data; let n = 0;
      for (let k = 0; k < p.length; k += 4) n += p[k + 3] > 30 && p[k + 3] < 80; return n"""
    counts = []
    for name in ("plan", "exact"):
        browser.open(f"{folder}/{name}.html", "light")
        counts.append(browser.run(ink))
    assert counts[0] > counts[1] + 500, f"pixels of the band: {counts}"


def check_texts(browser, folder):
    """Legs are counted from 1 with their goal; percentages are of the profile's energy; a front is a curve."""
    browser.open(f"{folder}/plan.html", "light")
    text = browser.run("return document.body.innerText")
    for words in ("1 to shelf <3> & co", "2 to dock", "Energy of a year", "Of the least energy: speed profile within 0.020"):
        assert words in text, f"{words!r} is not on the page"
    assert "0 to shelf" not in text and "(0.25\u202f% less)" in browser.run("return document.querySelector('.sentence').textContent")
    far = re.findall(r"Other paths of leg (\d) .* may save up to", text)
    assert far == ["1"], f"legs far above their bound: {far}"
    browser.open(f"{folder}/infeasible.html", "light")
    said = browser.run("return document.body.innerText")
    assert "on leg 2 to dock, missed by 2.3" in said.replace("2.300", "2.3") and said.count("missed by") == 1, said
    browser.open(f"{folder}/loss.html", "light")
    said = browser.run("return document.querySelector('.sentence').textContent").replace("\u202f", " ")
    assert said == "These settings: 26.00 s, 525.00 J. Same path and time, optimal: 420.00 J (20 % less). The plan: 22.00 s, 402.00 J.", said
    browser.open(f"{folder}/front.html", "light")
    # In the middle between two points the curve lies below their chord by what the slopes at its ends say.
    worst = browser.run("""const {points} = joulepath.data.front, [a, b] = points, shown = joulepath.curve_of(points.map((p) => ({x: p.duration_s, y: p.energy_J, price: p.price_of_time_W})), (p) => -p.price);
      return points.slice(1).reduce((most, p, k) => { const q = points[k], t = 0.5 * (p.duration_s + q.duration_s), y = 90 + 9000 / (t * t) + 10 * t;
        return Math.max(most, Math.abs(shown.ys[shown.xs.findIndex((x) => Math.abs(x - t) < 1e-9)] - y) / y); }, 0)""")
    assert worst < 5e-4, f"the curve is {worst} beside the law of its points"
    # Classic profiles are few points: marks that the readout names, without a line through them.
    browser.press("#cursor", "\ue010")  # end
    said = browser.run("return document.querySelector('.readout').textContent")
    assert " · optimal " in said and " · trapezoid best tuned " in said, said
    marks = browser.run("return [...document.querySelectorAll('.key')].filter((e) => e.querySelector('svg')).map((e) => e.textContent)")
    assert marks == ["trapezoid best tuned"] * 2, f"marks of the legends: {marks}"


def check_map(browser, folder):
    """The first view has the whole map and all marks, with little around them; without a plan the stations, too."""
    outside = """const [map] = joulepath.maps, grid = joulepath.data.map, [x, y] = grid.origin, wide = grid.width * grid.resolution_m, tall = grid.height * grid.resolution_m;
      const places = [[x, y], [x + wide, y], [x + wide, y + tall], [x, y + tall], ...map.marks.map((one) => [one.x, one.y])].map(([at_x, at_y]) => map.view.at(at_x, at_y));
      return places.filter(([px, py]) => px < 0 || py < 0 || px > map.view.width || py > map.view.height).length"""
    filled = """const [map] = joulepath.maps, grid = joulepath.data.map, across = [grid.width * grid.resolution_m * map.view.scale / map.view.width, grid.height * grid.resolution_m * map.view.scale / map.view.height];
      return Math.max(...across)"""
    for pixels in (400, 1280, 1920):
        browser.width(pixels)
        for name in ("plan", "compare", "infeasible"):
            browser.open(f"{folder}/{name}.html", "light")
            assert browser.run(outside) == 0, f"{name}, {pixels} px: corners of the map or marks outside of the view"
        browser.open(f"{folder}/plan.html", "light")
        assert browser.run(filled) > 0.8, f"{pixels} px: the map fills {browser.run(filled)} of its box"
        alone = browser.run("const tiles = [...document.querySelectorAll('.tile')], right = Math.max(...tiles.map((e) => e.getBoundingClientRect().right)); return right - tiles.at(-1).getBoundingClientRect().right")
        assert alone < 1, f"{pixels} px: the last row of tiles ends {alone} px early"
    browser.open(f"{folder}/infeasible.html", "light")
    said = browser.run("return joulepath.maps[0].marks.map((one) => `${one.kind} ${one.text}`)")
    assert said == ["station start", "station shelf <3> & co", "station off the map", "problem dock"], said
    browser.width(1280)


def check_bars(browser, folder):
    """Bars of energies show the energies of the table under them, also of a profile that is later than the plan."""
    for name, section in (("plan", "Against classic profiles"), ("compare", "Energy")):
        browser.open(f"{folder}/{name}.html", "light")
        texts = "return [...document.querySelectorAll(`section[aria-label='%s'] %s`)].map((e) => e.textContent)"
        bars, cells = (browser.run(texts % (section, what)) for what in (".rows .n", "td"))
        strangers = [text for text in bars if text.split("\u202f")[0] not in cells]
        assert len(bars) >= 2 and not strangers, f"{name}: the bars {strangers} are not in the table {cells}"


def check_without_scripts(browser, file, said):
    """With scripts off the numbers stand in tables."""
    browser.call("POST", "/goog/cdp/execute", {"cmd": "Emulation.setScriptExecutionDisabled", "params": {"value": True}})
    browser.call("POST", "/url", {"url": pathlib.Path(file).resolve().as_uri()})
    browser.call("POST", "/goog/cdp/execute", {"cmd": "Emulation.setScriptExecutionDisabled", "params": {"value": False}})
    text = browser.run("return document.querySelector('noscript').innerText || document.querySelector('noscript').textContent")
    missing = [word for word in said if word not in text]
    assert not missing, f"{missing} not in {text[:300]}"


def check_diagnosis(browser, file):
    """The first screen answers: causes, what next; long tables are folded, and everything fits a phone, unfolded, too."""
    for pixels in (400, 1280, 1920):
        browser.width(pixels)
        browser.open(file, "light")
        sections = browser.run("return [...document.querySelectorAll('main section')].map((e) => e.ariaLabel)")
        order = ["What next", "Measured against predicted", "What is left depends on", "How much", "Which effect", "Where", "What these runs can show", "Notes"]
        assert [next(one for one in order if name.startswith(one)) for name in sections] == order, sections
        said = browser.run("return document.querySelector('section[aria-label^=\"What next\"]').innerText.includes(JSON.parse(document.getElementById('data').text).diagnosis.next_step)")
        assert said, "the page does not show the next step of diagnosis.json"
        assert browser.run("return [...document.querySelectorAll('main details')].every((e) => !e.open || !e.querySelector('table, .rows'))"), "a table is not folded"
        browser.run("document.querySelectorAll('main details').forEach((e) => { e.open = true; })")
        wide = browser.run("return document.documentElement.scrollWidth - document.documentElement.clientWidth")
        assert wide <= 0, f"at {pixels} px the unfolded page is {wide} px wider than the window"
        matrix = browser.run("const box = document.querySelector('.matrix').parentElement; return [box.scrollWidth, box.clientWidth, document.querySelectorAll('.matrix tbody tr').length]")
        assert matrix[0] <= matrix[1] and matrix[2] == 2, f"at {pixels} px the matrix (content, box, rows): {matrix}"
        browser.check_barriers(f"{file}, {pixels} px")
    browser.width(1280)


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
            check_layout(browser, f"{folder}/plan.html")
            check_signals(browser, f"{folder}/diagnosis.html")
            check_without_scripts(browser, f"{folder}/plan.html", ("energy J", "duration s"))
            check_without_scripts(browser, f"{folder}/diagnosis.html", ("rolling_resistance", "interval 95", "probability told apart"))
            check_diagnosis(browser, f"{folder}/diagnosis.html")
            check_bands(browser, folder)
            check_texts(browser, folder)
            check_bars(browser, folder)
            check_map(browser, folder)
            for kind, plots in (("plan", 5), ("infeasible", 0), ("diagnosis", 4), ("compare", 3), ("loss", 3), ("front", 2), ("batch", 0)):
                check_keyboard(browser, f"{folder}/{kind}.html")
                for theme in ("dark", "light"):
                    check_page(browser, f"{folder}/{kind}.html", theme, plots)
                    print(f"ok: {kind}, {theme}")
                if kind in ("diagnosis", "compare", "loss", "front"):
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

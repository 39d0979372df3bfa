#!/usr/bin/env python3
"""Uses the studio's page as people do: drags, sliders, keys, saving, sharing; with and without the program.

usage: browser_test.py JOULEPATH

Exit code 77 (skipped in CTest) where Chromium or chromedriver is absent, unless JOULEPATH_BROWSER=required. axe-core is
used where JOULEPATH_AXE names axe.min.js (`./dev axe` installs it).
"""
import json
import random
import subprocess
import sys
import tempfile
import urllib.error
import urllib.request

from studio_page import MISSION, Served, run_in_browser, write_mission

DRAGS = 6
WIDTHS = (400, 768, 1280, 1920, 2560)


def energy_J(page):
    return page.run("return studio.store.answer.plan.energy_J")


def check_drags(page):
    random_numbers = random.Random(7)
    for _ in range(DRAGS):
        before = page.run("return studio.store.edits")
        name = page.random_drag(random_numbers)
        page.settle()
        assert page.run("return studio.store.edits") > before, f"dragging {name} changed nothing"
        assert not page.messages(), f"after dragging {name}: {page.messages()}"


def check_undo(page):
    """Each drag is one step back, and all steps lead back to the file."""
    for _ in range(3 * DRAGS):
        if page.run("return document.getElementById('undo').disabled"):
            break
        page.run("document.getElementById('undo').click()")
    page.settle()
    assert page.run("return JSON.stringify(studio.store.mission) === JSON.stringify(studio.store.files.mission)"), "undo did not lead back to the file"
    page.run("document.getElementById('redo').click()")
    page.settle()


def check_saved(page, program, mission):
    """What is saved is what is on the screen: the command plans the same joules; comments stay."""
    page.run("document.getElementById('save').click()")
    page.until("return document.getElementById('save').disabled", 10)
    text = mission.read_text()
    for comment in ("# A round in three drawn paths.", "# out", "  # across: two curves, drawn in the map", "# spraying"):
        assert comment in text, f"saving lost the comment {comment}"
    with tempfile.TemporaryDirectory() as out:
        run = subprocess.run([program, "plan", mission, "--solver", "fast", "--without", "baselines", "--out", out, "--force", "--json"], capture_output=True, text=True)
    planned = json.loads(run.stdout)["energy_J"]
    assert abs(planned - energy_J(page)) <= 1e-6 * planned, f"page {energy_J(page)} J, command {planned} J"


def check_conflict(page, mission):
    """A file that another program changed is not overwritten."""
    mission.write_text(mission.read_text() + "# by hand\n")
    page.press("#floor", "n")
    page.press("#floor", "\ue014")
    page.settle()
    page.run("document.getElementById('save').click()")
    page.until("return document.querySelector('.told').textContent.includes('changed by another program')", 10)
    assert mission.read_text().endswith("# by hand\n"), "the other program's change is gone"
    page.run("document.getElementById('reload').click()")
    page.until("return document.getElementById('save').disabled", 10)
    page.settle()


def check_keyboard(page):
    """From the page's beginning by Tab alone to the map, a handle, a slider; each changes the plan."""
    page.run("document.activeElement.blur(); window.getSelection().removeAllRanges()")
    for _ in range(150):
        page.keys("\ue004")
        if page.run("return document.activeElement.id") == "floor":
            break
    else:
        raise AssertionError("Tab does not reach the map")
    before = energy_J(page)
    for _ in range(30):
        page.keys("n")
        if page.run("return studio.store.selection.kind === 'handle' && studio.store.selection.point < 3"):
            break
    page.keys("\ue014\ue013\ue014\ue013")
    page.settle()
    assert energy_J(page) != before, "arrow keys on the map changed nothing"
    for _ in range(150):
        page.keys("\ue004")
        if page.run("return (document.activeElement.getAttribute('aria-label') || '').startsWith('speed in m/s')"):
            break
    else:
        raise AssertionError("Tab does not reach the speed limit")
    before = energy_J(page)
    page.keys("\ue012" * 20)
    page.settle()
    assert energy_J(page) != before, "arrow keys on the slider changed nothing"
    assert page.run("return studio.store.robot.limits.speed_m_s") < 1.0
    assert not page.messages(), page.messages()


def check_widths(page):
    title = page.run("return document.title")
    assert title.startswith("mission · nomad_super_scout · joulepath studio"), title
    for pixels in WIDTHS:
        page.width(pixels)
        page.until("return true")
        wide = page.run("return document.documentElement.scrollWidth - document.documentElement.clientWidth")
        assert wide <= 0, f"at {pixels} px the page is {wide} px wider than the window"
        bars = page.run("return [...document.querySelectorAll('main, main > *, aside *')].filter((e) => e.scrollHeight > e.clientHeight + 1 && ['auto', 'scroll'].includes(getComputedStyle(e).overflowY)).map((e) => e.className)")
        assert not bars, f"at {pixels} px there are scroll bars beside the page's: {bars}"
        narrow = page.run("return [...document.querySelectorAll('.field input[type=range]')].filter((e) => e.offsetParent).map((e) => e.clientWidth).filter((width) => width < 160)")
        assert not narrow, f"at {pixels} px sliders of {narrow} px"
    page.width(1280)


def check_accessible(page):
    unnamed = page.run("return [...document.querySelectorAll('button, select, input, canvas')].filter((e) => e.offsetParent && !(e.textContent.trim() || e.ariaLabel"
                       " || e.getAttribute('aria-label') || (e.labels && e.labels.length))).map((e) => e.outerHTML.slice(0, 120))")
    assert not unnamed, f"controls without a name: {unnamed}"
    if page.barriers() is None:
        return "without axe-core"
    for pixels in WIDTHS:
        page.width(pixels)
        for theme in ("light", "dark"):
            page.run(f"document.documentElement.dataset.theme = '{theme}'")
            page.check_barriers(f"{pixels} px, {theme}")
    page.width(1280)
    return "with axe-core"


def refused(served, code, make):
    try:
        make()
    except urllib.error.HTTPError as error:
        assert error.code == code, f"{error.code} instead of {code}"
        return
    raise AssertionError(f"not refused with {code}")


def check_server(served):
    """Another site, another name of the address, a wrong token and a body without end are refused."""
    refused(served, 403, lambda: served.post("answer", {}, Origin="http://evil.example"))
    refused(served, 403, lambda: served.post("answer", {}, Host="evil.example"))
    refused(served, 403, lambda: served.post("save", {}, Origin=""))
    refused(served, 404, lambda: urllib.request.urlopen(served.address[: served.address.rindex("/", 0, -1)] + "/0000/", timeout=10))
    refused(served, 404, lambda: urllib.request.urlopen(served.address + "../../../../etc/passwd", timeout=10))
    refused(served, 413, lambda: served.post("answer", b"{" + b" " * (17 << 20) + b"}"))
    refused(served, 400, lambda: served.post("answer", b"no JSON"))
    refused(served, 400, lambda: served.post("answer", {"mission": {"robot": "x", "order": "/etc/passwd"}, "robot": {}}))
    error = served.post("answer", {"mode": "plan", "mission": {"robot": "x", "legs": []}, "robot": {}})["error"]
    assert error["message"], error


def check_alone(page, program, mission, folder):
    """The page as one file: no request leaves it; with WebAssembly it plans by itself, as the command does."""
    file = folder / "studio.html"
    subprocess.run([program, "studio", mission, "--out", file, "--force"], check=True, capture_output=True)
    assert file.stat().st_size <= 1.5e6, f"{file.stat().st_size} bytes"
    page.show(file.as_uri())
    assert not page.messages(), page.messages()
    fetched = page.run("return performance.getEntriesByType('resource').map((r) => r.name).filter((n) => !/^(data|blob):/.test(n))")
    assert not fetched, f"the page fetched {fetched}"
    if not page.run("return studio.answers.has_core()"):
        return "no WebAssembly in this build"
    page.random_drag(random.Random(3))
    page.settle()
    assert not page.messages(), page.messages()
    changed = page.run("return JSON.stringify(studio.store.mission)")
    (folder / "changed.json").write_text(changed)
    planned = json.loads(subprocess.run([program, "plan", folder / "changed.json", "--solver", "fast", "--without", "baselines", "--out", folder / "out", "--force", "--json"], capture_output=True, text=True).stdout)["energy_J"]
    assert abs(planned - energy_J(page)) <= 1e-6 * planned, f"page alone {energy_J(page)} J, command {planned} J"
    before = energy_J(page)
    page.run("document.getElementById('keep').click()")
    file.write_text(page.run("return studio.page_text()"))  # a page that was changed, shared again
    page.show(file.as_uri())
    assert not page.messages(), page.messages()
    assert "B − A" in page.run("return document.getElementById('ab').textContent"), "the shared page has no plan A"
    assert energy_J(page) == before and page.run("return JSON.stringify(studio.store.mission)") == changed, "the shared page shows something else"
    return "planned without the program"


def check_all(program, folder, page):
    mission = write_mission(folder)
    with Served(program, mission) as served:
        check_server(served)
        page.show(served.address)
        assert not page.messages(), page.messages()
        check_drags(page)
        check_undo(page)
        check_saved(page, program, mission)
        check_conflict(page, mission)
        check_keyboard(page)
        check_widths(page)
        print("ok: served,", check_accessible(page))
    mission.write_text(MISSION)
    print("ok: alone,", check_alone(page, program, mission, folder))


if __name__ == "__main__":
    sys.exit(run_in_browser(check_all))

#!/usr/bin/env python3
"""The site's pages in headless Chromium: no barrier that axe-core calls serious, no page wider than its window, no message on the console;
Tab reaches every link and field of a document and shows where it is.

usage: check_pages.py SITE      needs chromedriver, and axe-core in the file JOULEPATH_AXE
"""
import contextlib
import functools
import http.server
import itertools
import pathlib
import sys
import tempfile
import threading

ROOT = pathlib.Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT / "tests/app/report"))
from browser_test import Browser  # noqa: E402

STILL = "document.head.append(Object.assign(document.createElement('style'), {textContent: '* { scroll-behavior: auto !important; transition: none !important; }'}));"
LOOKS = list(itertools.product((1280, 400), ("light", "dark")))
WALKED = "docs/quick_start.html"  #: by the keyboard, and in every look; the other pages have one look each
IN_VIEW = """const at = document.activeElement, box = at.getBoundingClientRect(), look = getComputedStyle(at);
return {what: at.outerHTML.slice(0, 120), seen: (look.outlineStyle !== 'none' || look.boxShadow !== 'none') && box.width * box.height > 0
  && box.right > 0 && box.left < innerWidth && box.bottom > 0 && box.top < innerHeight};"""
CONTROLS = """return [...document.querySelectorAll('a[href], button, input, select, textarea, [tabindex]')]
  .filter((one) => one.tabIndex >= 0 && one.checkVisibility({visibilityProperty: true})).length;"""


class Quiet(http.server.SimpleHTTPRequestHandler):
    def log_message(self, *_):
        pass


@contextlib.contextmanager
def served(folder):
    """The address of a folder on this machine."""
    server = http.server.ThreadingHTTPServer(("127.0.0.1", 0), functools.partial(Quiet, directory=folder))
    threading.Thread(target=server.serve_forever, daemon=True).start()
    try:
        yield f"http://127.0.0.1:{server.server_port}"
    finally:
        server.shutdown()


def open_page(browser, page, look):
    width, theme = look
    browser.width(width)
    browser.call("POST", "/url", {"url": page})
    browser.run(STILL)
    browser.run("try { localStorage.setItem('theme', arguments[0]); } catch { } document.body.dataset.theme = arguments[0];", theme)


def faults_of(browser, page, look):
    open_page(browser, page, look)
    faults = [f"console: {message}" for message in browser.console() if "/favicon.ico" not in message]
    beyond = browser.run("return document.documentElement.scrollWidth - document.documentElement.clientWidth")
    if beyond > 0:
        faults.append(f"wider than its window by {beyond} pixels")
    faults += [f"axe-core: {one}" for one in browser.barriers()]
    browser.console()  # axe-core loads styles again, as if they stood beside the page
    return faults


def faults_of_walk(browser, page, look):
    """Tab from the page's top: the link past the navigation first, then every control once."""
    open_page(browser, page, look)
    faults, stops = [], 0
    controls = browser.run(CONTROLS)
    while stops < 2 * controls:
        browser.keys("\ue004")
        if browser.run("return document.activeElement === document.body || arguments[0] > 0 && document.activeElement.className === 'skip'", stops):
            break
        at = browser.run(IN_VIEW)
        if not at["seen"]:
            faults.append(f"the focus is invisible on {at['what']}")
        stops += 1
    if stops < controls:
        faults.append(f"Tab reached {stops} of {controls} controls")
    return faults


def main(site):
    documents = sorted(site.glob("docs/*.html"))
    longest = sorted(site.glob("cpp/classjoulepath*.html"), key=lambda page: -page.stat().st_size)[:1]
    pages = [site / "index.html", site / "search.html", *documents, *sorted(site.glob("docs/notebooks/*.html"))[:1], site / "cpp/index.html", *longest]
    faults = []
    with tempfile.TemporaryDirectory() as folder, served(site) as base:
        browser = Browser(folder)
        try:
            for k, page in enumerate(pages):
                for look in LOOKS if page == site / WALKED else [LOOKS[k % len(LOOKS)]]:
                    faults += [f"{page.relative_to(site)} at {look[0]} pixels, {look[1]}: {fault}" for fault in faults_of(browser, f"{base}/{page.relative_to(site)}", look)]
            for look in (LOOKS[0], LOOKS[2]):
                faults += [f"{WALKED} at {look[0]} pixels: {fault}" for fault in faults_of_walk(browser, f"{base}/{WALKED}", look)]
        finally:
            browser.close()
    print(f"{len(pages)} pages in Chromium, {len(faults)} faults")
    if faults:
        raise SystemExit("\n".join(faults))


if __name__ == "__main__":
    main(pathlib.Path(sys.argv[1]).resolve())

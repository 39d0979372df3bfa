#!/usr/bin/env python3
"""The page of a sweep in headless Chromium: the sentence, units, dots that keys and pointer name and a chosen parameter colors, barriers.

usage: page_test.py JOULEPATH

Exit code 77 (skipped in CTest) where Chromium or chromedriver is absent, unless JOULEPATH_BROWSER=required.
"""
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile

SOURCE = pathlib.Path(__file__).resolve().parents[3]
sys.path.insert(0, str(SOURCE / "tests/app/report"))
from browser_test import SKIPPED, Browser, check_keyboard, check_page, chromium  # noqa: E402

STUDY = """\
schema: joulepath/study/1
name: gears
missions: mission.yaml
parameters:
  gear_ratio: {key: robot.motor.gear_ratio, values: [12, 24]}
  top_speed_m_s: {key: robot.limits.speed_m_s, values: [0.6, 1.0]}
hold_friction: wheel
"""
MISSION = "schema: joulepath/mission/1\nrobot: robot.yaml\nlegs:\n  - {path: {bezier_m: [[[0, 0], [1, 0], [2, 0], [3, 0]]]}}\n"
FILLS = "return [...document.querySelectorAll('circle')].filter((dot) => dot.querySelector('title')).map((dot) => [dot.getAttribute('fill'), dot.textContent])"


def main():
    if not chromium() or not shutil.which("chromedriver"):
        return 1 if os.environ.get("JOULEPATH_BROWSER") == "required" else SKIPPED
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        shutil.copy(SOURCE / "tests/data/broken/good/robot.yaml", folder / "robot.yaml")
        (folder / "study.yaml").write_text(STUDY)
        (folder / "mission.yaml").write_text(MISSION)
        subprocess.run([sys.argv[1], "sweep", folder / "study.yaml", "--out", folder / "out", "--nodes", "20", "--no-cache", "-q"], check=True)
        page = folder / "out/report.html"
        browser = Browser(name)
        try:
            for theme in ("dark", "light"):
                check_page(browser, page, theme, 0)
            said = browser.run("return document.querySelector('.sentence').textContent").replace("\u202f", " ")
            assert said.startswith("The best of 4 designs, gear ratio ") and "top speed " in said and " m/s: " in said, said
            tiles = browser.run("return [...document.querySelectorAll('.tile')].map((e) => e.innerText)")
            assert any("top speed" in tile and "m/s" in tile for tile in tiles), tiles
            by_gear = browser.run(FILLS)
            browser.run("const list = document.getElementById('color-by'); list.value = '1'; list.dispatchEvent(new Event('change'))")
            by_speed = browser.run(FILLS)
            gear = {text.split(",")[0]: fill for fill, text in by_gear}
            speed = {text.split(", ")[1].split(":")[0]: fill for fill, text in by_speed}
            assert len(by_gear) == 4 and len(set(gear.values())) == 2 and sorted(gear) == ["gear ratio 12", "gear ratio 24"], by_gear
            assert all(fill == gear[text.split(",")[0]] for fill, text in by_gear), by_gear
            assert all(fill == speed[text.split(", ")[1].split(":")[0]] for fill, text in by_speed) and len(set(speed.values())) == 2, by_speed
            read = "return document.querySelector('.readout').textContent"
            texts = [text for _, text in by_speed]
            assert browser.run(read) not in texts
            browser.press("#cursor", "\ue014")  # right arrow
            by_keys = browser.run(read)
            browser.run("const dots = [...document.querySelectorAll('circle')].filter((dot) => dot.querySelector('title')), box = dots.at(-1).getBoundingClientRect();"
                        "dots[0].closest('svg').dispatchEvent(new PointerEvent('pointermove', {clientX: box.x + box.width / 2 + 8, clientY: box.y + box.height / 2}))")
            by_pointer = browser.run(read)
            assert by_keys in texts and by_pointer == texts[-1] != by_keys, f"the slider names {by_keys!r}, the pointer near the last dot {by_pointer!r} of {texts}"
            assert browser.run("return document.querySelector('circle.named').getAttribute('visibility')") == "visible", "no ring around the named dot"
            check_keyboard(browser, page)
            print("ok: sweep")
        finally:
            browser.close()
    return 0


if __name__ == "__main__":
    sys.exit(main())

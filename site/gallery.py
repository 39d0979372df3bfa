#!/usr/bin/env python3
"""Runs the commands of site/gallery/entries.toml, takes a picture of the page that each one wrote, and writes the
gallery's page.

usage: gallery.py PROGRAM SOURCE_DIR STAGE_DIR    writes STAGE_DIR/docs/gallery.md and STAGE_DIR/extra/gallery/
Design: docs/decisions/0702-studio-and-reports.md
"""
import concurrent.futures
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import tomllib

WIDTH, HEIGHT, THREADS = 1280, 860, 2
HEAD = """# Gallery

For those who wonder what joulepath can show them: ten pages, each with the one command that made it. The commands
run in a folder that holds `scenarios/`, the folder `gallery/` of the source (`site/gallery`) and the starter of
`joulepath init robot`. A picture opens its page.
"""


def run(command, folder, environment=None):
    done = subprocess.run(command, cwd=folder, env=environment, capture_output=True, text=True)
    if done.returncode != 0:
        raise SystemExit(f"gallery: {' '.join(map(str, command))} ends with {done.returncode}: {done.stderr}")


def picture(page, png):
    with tempfile.TemporaryDirectory() as profile:
        run(["chromium", "--headless=new", "--no-sandbox", "--disable-gpu", "--hide-scrollbars", "--virtual-time-budget=4000",
             f"--user-data-dir={profile}", f"--window-size={WIDTH},{HEIGHT}", f"--screenshot={png}", f"file://{page}#light"], page.parent)
    if not png.is_file() or png.stat().st_size < 10_000:
        raise SystemExit(f"gallery: no picture of {page}")


def make(entry, work, stage, environment):
    """The page of an entry and its picture."""
    (work / entry["name"]).mkdir()
    run(entry["command"].split(), work, environment)
    shown = stage / "extra/gallery" / entry["name"]
    shown.mkdir(parents=True)
    shutil.copy(work / entry["name"] / "report.html", shown)
    picture(work / entry["name"] / "report.html", stage / f"extra/gallery/{entry['name']}.png")


def part(entry):
    """An entry of the gallery's page."""
    name, title = entry["name"], entry["title"]
    return (f"\n## {title}\n\n{entry['words']}\n\n```sh\n{entry['command']}\n```\n\n"
            f'<a href="../gallery/{name}/report.html"><img src="../gallery/{name}.png" alt="{title}" '
            f'width="{WIDTH}" height="{HEIGHT}" loading="lazy"></a>\n')


def main():
    program, source, stage = (pathlib.Path(argument).resolve() for argument in sys.argv[1:4])
    entries = tomllib.loads((source / "site/gallery/entries.toml").read_text())["entry"]
    environment = {**os.environ, "PATH": f"{program.parent}:{os.environ['PATH']}"}
    with tempfile.TemporaryDirectory() as scratch:
        work = pathlib.Path(scratch)
        (work / "scenarios").symlink_to(source / "scenarios")
        (work / "gallery").symlink_to(source / "site/gallery")
        run(["joulepath", "init", "robot", "--quiet"], work, environment)
        with concurrent.futures.ThreadPoolExecutor(THREADS) as pool:
            list(pool.map(lambda entry: make(entry, work, stage, environment), entries))
    (stage / "docs/gallery.md").write_text(HEAD + "".join(map(part, entries)))
    print(f"gallery: {len(entries)} entries")


if __name__ == "__main__":
    main()

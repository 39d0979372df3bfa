#!/usr/bin/env python3
"""Runs the commands of a document: every fenced block that begins with ```sh runnable, in order, in one shell.

usage: run_document.py DOCUMENT.md SOURCE_DIR FOLDER_OF_THE_PROGRAM

The shell starts in a scratch folder that holds a copy of scenarios/, with the program on its PATH, and stops
at the first command that fails. A line that ends in "# exit 1" must fail with that code.
"""
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

BLOCK = re.compile(r"^```sh runnable\n(.*?)^```", re.MULTILINE | re.DOTALL)
FAILS = re.compile(r"^(.*?)\s*# exit (\d+)$")


def script_of(document):
    lines = []
    for block in BLOCK.findall(document):
        for line in block.splitlines():
            fails = FAILS.match(line)
            lines.append(f"code=0; {fails[1]} || code=$?; [ $code -eq {fails[2]} ]" if fails else line)
    return "\n".join(lines)


def main():
    document, source, programs = (pathlib.Path(argument).resolve() for argument in sys.argv[1:4])
    script = script_of(document.read_text())
    if not script:
        print(f"{document.name} has no runnable block")
        return 1
    if re.search(r"\bjq\b", script) and not shutil.which("jq"):
        print("skipped: jq is not installed")
        return 77
    with tempfile.TemporaryDirectory() as scratch:
        shutil.copytree(source / "scenarios", f"{scratch}/scenarios", ignore=shutil.ignore_patterns("*.cpp", "*.hpp"))
        environment = {**os.environ, "PATH": f"{programs}:{os.environ['PATH']}"}
        return subprocess.run(["bash", "-xeuo", "pipefail", "-c", script], cwd=scratch, env=environment).returncode


if __name__ == "__main__":
    sys.exit(main())

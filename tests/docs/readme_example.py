#!/usr/bin/env python3
"""The README's mission gives the answer that the README prints: the same words, each number within 1 %.

usage: readme_example.py SOURCE_DIR PROGRAM
"""
import pathlib
import re
import subprocess
import sys
import tempfile

NUMBER = re.compile(r"-?\d+(?:\.\d+)?")
TOLERANCE = 0.01  # paths, and with them the numbers, may move a little from version to version
LINES_OF_MISSION, LINES_OF_ANSWER = 12, 4


def block(text, language):
    return re.search(rf"```{language}\n(.*?)```", text, re.DOTALL)[1]


def shape(line):
    return " ".join(NUMBER.sub("#", line).split())


def agrees(line, printed):
    if shape(line) != shape(printed):
        return False
    pairs = zip(map(float, NUMBER.findall(line)), map(float, NUMBER.findall(printed)))
    return all(abs(said - found) <= max(TOLERANCE * abs(said), 0.5 if abs(said) < 20 else 0) for said, found in pairs)


def answer(source, program, readme):
    command = re.search(r"`joulepath (plan mission\.yaml [^`]*)`", readme)[1].split()
    with tempfile.TemporaryDirectory() as scratch:
        pathlib.Path(scratch, "scenarios").symlink_to(source / "scenarios")
        pathlib.Path(scratch, "mission.yaml").write_text(block(readme, "yaml"))
        run = subprocess.run([program, *command], cwd=scratch, capture_output=True, text=True)
    if run.returncode != 0:
        sys.exit(f"README.md: its command ends with {run.returncode}: {run.stderr}")
    return run.stdout.splitlines()


def main():
    source = pathlib.Path(sys.argv[1]).resolve()
    readme = (source / "README.md").read_text()
    mission, expected = block(readme, "yaml").splitlines(), block(readme, "text").splitlines()
    printed = answer(source, sys.argv[2], readme)
    problems = [f"README.md: not in the answer: {line}" for line in expected if not any(agrees(line, found) for found in printed)]
    if (len(mission), len(expected)) != (LINES_OF_MISSION, LINES_OF_ANSWER):
        problems.append(f"README.md: {len(mission)} lines of mission, {len(expected)} of answer")
    print("\n".join([*problems, *(printed if problems else ["README.md: the mission gives the printed answer"])]))
    return 1 if problems else 0


if __name__ == "__main__":
    sys.exit(main())

#!/usr/bin/env python3
"""Each word of each extension, asked of a program that was built without it: one error that names the extension, exit
code 2, and for an input its file, line and key.

usage: absent.py PROGRAM SOURCE_DIR
"""
import json
import pathlib
import re
import subprocess
import sys
import tempfile

ROBOT = "scenarios/robots/nomad_super_scout.yaml"
CASES = {}


def case(part):
    return lambda function: CASES.setdefault(part, function)


@case("command")
def _(name, folder, source):
    yield [name, "--help"], ""


@case("option")
def _(name, folder, source):
    command, option = name.split()
    yield [command, source / "scenarios/missions/warehouse_pick.yaml", option, "1"], option


@case("export")
def _(name, folder, source):
    yield ["export", source / "scenarios/missions/warehouse_pick.yaml", "--to", name, "--out", folder / "out"], name


@case("key")
def _(name, folder, source):
    file = folder / "mission.yaml"
    file.write_text(f"schema: joulepath/mission/1\nrobot: {source / ROBOT}\n{name}: 1\n")
    for command in (["plan", file, "--out", folder / "out"], ["check", file]):
        yield command, f"{file}:3:"


@case("kind")
def _(name, folder, source):
    file = folder / "file.yaml"
    file.write_text(f"# a comment\nschema: joulepath/{name}/1\n")
    yield ["check", "--kind", name, file], "kind"
    yield ["check", file], f"{file}:2:"


def named_by_dataset(log, folder, source):
    dataset = folder / "dataset.yaml"
    dataset.write_text(f"robot: {source / ROBOT}\nruns:\n  - file: {log.name}\n")
    for command in ("check", "diagnose"):
        yield [command, dataset, *(["--out", folder / "out"] if command == "diagnose" else [])], f"{dataset}:3:"
    yield ["check", log], str(log)
    yield ["diagnose", log, "--robot", source / ROBOT, "--out", folder / "out"], str(log)


@case("file")
def _(name, folder, source):
    log = folder / ("run" + name)
    log.write_bytes(b"\x89MCAP0\r\n")
    yield from named_by_dataset(log, folder, source)


@case("folder")
def _(name, folder, source):
    log = folder / "bag"
    log.mkdir()
    (log / name).write_text("a: 1\n")
    yield from named_by_dataset(log, folder, source)


@case("lines")
def _(name, folder, source):
    log = folder / "run.jsonl"
    log.write_text(json.dumps({key: 1 for key in name.split()}) + "\n")
    yield from named_by_dataset(log, folder, source)


@case("document")
def _(name, folder, source):
    file = folder / "file.json"
    file.write_text(json.dumps({key: [] for key in name.split()}))
    yield ["check", file], str(file)
    yield ["plan", file, "--robot", source / ROBOT, "--out", folder / "out"], str(file)


def words(source):
    for adds in sorted((source / "extensions").glob("*/adds")):
        for line in adds.read_text().splitlines():
            if re.match("[a-z]", line):
                yield adds.parent.name, *line.split(" ", 1)


def main():
    program, source = sys.argv[1], pathlib.Path(sys.argv[2]).resolve()
    faults, asked = [], 0
    for extension, part, *name in words(source):
        if part == "messages":  # of another extension, which this program does not have
            continue
        with tempfile.TemporaryDirectory() as scratch:
            folder = pathlib.Path(scratch)
            for arguments, place in CASES[part](name[0], folder, source):
                before = sorted(folder.rglob("*"))
                done = subprocess.run([program, *map(str, arguments)], capture_output=True, text=True, cwd=folder)
                asked += 1
                told = all(words in done.stderr for words in (f"a program with the extension {extension}", "./dev build", place))
                if done.returncode != 2 or not told or sorted(folder.rglob("*")) != before:
                    faults.append(f"{extension}: {part} {name}: {' '.join(map(str, arguments))}\n  exit {done.returncode}: {done.stderr}")
    print("\n".join(faults) or f"{asked} questions: each error names the extension and the place")
    return 1 if faults or asked < 50 else 0


if __name__ == "__main__":
    sys.exit(main())

#!/usr/bin/env python3
"""Names in anonymous namespaces are unique within a folder: ./dev compiles a folder as one unit (decision 0800).

A check by text: constants, types and functions with the same parameters at the beginning of a line. Two equal
aliases (`using Json = ...`) are allowed.
"""
import collections
import pathlib
import re
import sys

HOUSE = ["model", "planner", "diagnosis", "scenarios", "app", "extensions", "tests"]


def names(text):
    """(name, line) of each definition in an anonymous namespace."""
    inside = False
    for number, line in enumerate(text.splitlines(), 1):
        if line.startswith("namespace {"):
            inside = True
        elif line == "}  // namespace":
            inside = False
        elif inside and re.match(r"[A-Za-z\[]", line):
            found = (re.match(r"(?:struct|class|enum class) (\w+)(?! *;)", line) or
                     re.match(r"(?:inline )?(?:constexpr|const) .*?\b(k[A-Z]\w*)", line) or
                     re.match(r"using (\w+ = .*);", line))
            function = re.match(r"(?:\[\[\w+\]\] )?(?:\w[\w:<>,&* ]*?)[ &*](\w+\([^()]*\)) (?:const )?\{", line)
            if found or function:
                yield (found or function)[1], number


def main(root):
    complaints = []
    for top in HOUSE:
        for folder in sorted({file.parent for file in (root / top).rglob("*.cpp")}):
            places = collections.defaultdict(list)
            for file in sorted(folder.glob("*.cpp")):
                for name, number in names(file.read_text()):
                    places[name].append(f"{file.relative_to(root).as_posix()}:{number}")
            aliases = collections.defaultdict(set)
            for name in list(places):
                if " = " in name:
                    aliases[name.split(" = ")[0]].add(name)
                    del places[name]
            complaints += [f"{where[1]}: {name} has the name of {where[0]}" for name, where in places.items() if len(where) > 1]
            complaints += [f"{folder}: two meanings of {alias}" for alias, both in aliases.items() if len(both) > 1]
    print("\n".join(complaints) or "names: unique in every folder")
    return 1 if complaints else 0


if __name__ == "__main__":
    sys.exit(main(pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else ".")))

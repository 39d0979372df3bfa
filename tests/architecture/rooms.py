#!/usr/bin/env python3
"""Rooms stand in the order of docs/architecture.md: no include runs upward. The core includes no extension, and an
extension includes no other one. Heavy libraries stay in their place. No two headers define a type of one name."""
import pathlib
import re
import sys

# From the ground up; a room may include itself and the rooms before it. The longest prefix decides.
PLANNER = """model planner/cache planner/path/geometry planner/path/floor planner/path/shape planner/path/search planner/values
planner/motion planner/nlp/interval planner/nlp/terms planner/nlp/transcription planner/nlp/fast planner/nlp/ipopt
planner/joint planner/profile planner/baselines planner/legs planner/ways planner/accounts planner/bound planner/confidence planner/mission
planner/controller""".split()
DIAGNOSIS = """model diagnosis/thresholds.hpp diagnosis/values diagnosis/numerics diagnosis/signals diagnosis/prediction diagnosis/simulator diagnosis/checks
diagnosis/evidence diagnosis/where diagnosis/verdict diagnosis/correction diagnosis/next_run diagnosis/energies_only
diagnosis""".split()
SCENARIOS = """scenarios/text scenarios/registry.hpp scenarios/document_kind.hpp scenarios/robot_files scenarios/mission_files scenarios/log_files scenarios/result_files
scenarios/export scenarios""".split()
TOPS = ["model", "planner", "diagnosis", "scenarios", "app/report", "app", "extensions", "python"]  # planner and diagnosis do not know each other
# Headers that take long to compile or that a replacement of the library must find in one place.
# Design: docs/decisions/0800-build.md
CONFINED = {"CLI/": "app/command_line.cpp", "yaml-cpp/": "scenarios/text/yaml_text.cpp", "png.h": "scenarios/text/image.cpp",
            "Ip": "planner/nlp/ipopt/", "ompl/": "planner/path/search/", "boost/asio/": "extensions/studio/server/http.cpp", "boost/beast/": "extensions/studio/server/http.cpp"}


# The studio's page is compiled from these by emscripten, whose standard library has no algorithms on ranges.
# Design: docs/decisions/0702-studio-and-reports.md
PAGE, PROGRAM_ALONE = re.compile("model/|planner/|extensions/studio/answer/"), re.compile("model/(simulation|estimate)|planner/controller|ipopt_solver|search/search.cpp|ompl_space")


def room(path, rooms):
    inside = [name for name in rooms if path == name or path.startswith(name + "/")]
    return max(inside, key=len, default=None)


def upward(root, path, included):
    for rooms in (PLANNER, DIAGNOSIS, SCENARIOS, TOPS):
        here, there = room(path, rooms), room(included, rooms)
        if here and there and rooms.index(there) > rooms.index(here):
            return True
    tops = {path.split("/")[0], included.split("/")[0]}
    return tops == {"planner", "diagnosis"} or is_other_extension(path, included)


def is_other_extension(path, included):
    """What one extension needs of another goes through the registries: scenarios/registry.hpp, app/program_parts.hpp."""
    (here, mine), (there, other) = (name.split("/")[:2] for name in (path, included))
    return here == there == "extensions" and mine != other


def misplaced(path, header):
    return any(header.startswith(start) and not path.startswith(home) for start, home in CONFINED.items())


def types_of_one_name(root):
    """The linker keeps one of two types of one name in a namespace, whichever it meets first."""
    homes = {}
    for top in TOPS:
        for file in sorted((root / top).rglob("*.hpp")):
            space = ""
            for line in file.read_text().splitlines():
                if match := re.match(r"namespace ([\w:]+) \{", line):
                    space = match[1]
                elif match := re.match(r"(?:struct|class|enum(?: class)?) (\w+)(?: final)?(?: :[^:].*)? \{", line):
                    homes.setdefault(space + "::" + match[1], set()).add(file.relative_to(root).as_posix())
    return [f"{name} has two definitions: {', '.join(sorted(files))}" for name, files in homes.items() if len(files) > 1]


def main(root):
    complaints = types_of_one_name(root)
    for top in TOPS:
        for file in sorted((root / top).rglob("*.[ch]pp")):
            path = file.relative_to(root).as_posix()
            for number, line in enumerate(file.read_text().splitlines(), 1):
                match = re.match(r'#include "(\w+/[^"]+)"', line)
                if match and upward(root, path, match[1]):
                    complaints.append(f"{path}:{number}: includes {match[1]}, which stands above it, or is another extension")
                if "std::ranges::" in line and PAGE.match(path) and not PROGRAM_ALONE.search(path):
                    complaints.append(f"{path}:{number}: std::ranges, which the page's compiler does not have")
                match = re.match(r"#include <([^>]+)>", line)
                if match and misplaced(path, match[1]):
                    complaints.append(f"{path}:{number}: includes {match[1]}, which has another place")
    print("\n".join(complaints) or "rooms: no include runs upward, no two types have one name")
    return 1 if complaints else 0


if __name__ == "__main__":
    sys.exit(main(pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else ".")))

"""The sites that a mutant changes, their draw by a committed seed, and the source text with all mutants in it.

Design: docs/decisions/0800-build.md
"""
import hashlib
import os
import re
import subprocess

ROOT = os.path.abspath(os.path.join(os.path.dirname(__file__), "../.."))
SEED, PER_AREA = 20261122, 75
AREAS = {  # folders and the test programs that judge their mutants
    "model": (["model/"], ["test_model", "test_energy", "test_estimation", "test_calibration", "test_diagnosis"]),
    "nlp": (["planner/nlp/"], ["test_nlp", "test_energy", "test_mission"]),
    "profile": (["planner/accounts/", "planner/profile/", "extensions/nav2/graph_costs", "extensions/nav2/corner_table"], ["test_nlp", "test_energy", "test_mission", "test_nav2"]),
    "diagnosis": (["diagnosis/", "extensions/onboard/monitor/", "extensions/onboard/drift"], ["test_estimation", "test_calibration", "test_diagnosis", "test_onboard"]),
}
LEAST_CONSTANT = 1e-5  # smaller ones guard against rounding: no promise depends on a factor of two
LEFT, RIGHT = r"(?<=[\w)\]]) ", r" (?=[\w({\"-])"
# (kind, pattern, new text, code with the mutant); group 1 is what is replaced, {id} is the mutant's number.
OPERATORS = [
    ("sign of a term", LEFT + r"(\+)" + RIGHT, "-", "+ ::mutant::Binary<{id}, '-'>{{}} +"),
    ("sign of a term", LEFT + r"(-)" + RIGHT, "+", "- ::mutant::Binary<{id}, '+'>{{}} -"),
    ("product", LEFT + r"(\*)" + RIGHT, "/", "* ::mutant::Binary<{id}, '/'>{{}} *"),
    ("quotient", LEFT + r"(/)" + RIGHT, "*", "/ ::mutant::Binary<{id}, '*'>{{}} /"),
    ("comparison", LEFT + r"(<)" + RIGHT, ">=", "< ::mutant::Binary<{id}, 'g'>{{}} <"),
    ("comparison", LEFT + r"(>)" + RIGHT, "<=", "> ::mutant::Binary<{id}, 'l'>{{}} >"),
    ("comparison", LEFT + r"(<=)" + RIGHT, ">", "<= ::mutant::Binary<{id}, '>'>{{}} <="),
    ("comparison", LEFT + r"(>=)" + RIGHT, "<", ">= ::mutant::Binary<{id}, '<'>{{}} >="),
    ("sum", r" (\+=) ", "-=", "+= ::mutant::Opposite<{id}>{{}} +="),
    ("sum", r" (-=) ", "+=", "-= ::mutant::Opposite<{id}>{{}} +="),
    ("dropped terms", r" (\+=) ", "=", "+= ::mutant::Dropped<{id}>{{}} +="),
    ("extremum", r"(std::max)\(", "std::min", "::mutant::max<{id}>"),
    ("extremum", r"(std::min)\(", "std::max", "::mutant::min<{id}>"),
    ("absolute value", r"(std::abs)\(", "", "::mutant::abs<{id}>"),
    ("negation", r"(?:(?<=[=,?:] )|(?<=[({])|(?<=return ))(-)(?=[A-Za-z(])", "", "::mutant::Negative<{id}>{{}} *"),
    ("constant", r"(?<![\w.])(\d+\.\d+(?:e-?\d+)?|\d+e-?\d+)(?![\w.])", None, "::mutant::{live}constant<{id}>({old}, {new})"),
]


def code_lines(text):
    """(number, line) of the lines of code, with strings blanked and comments cut off."""
    for number, line in enumerate(text.split("\n"), 1):
        bare = re.sub(r'"(?:[^"\\]|\\.)*"', lambda m: '"' + "_" * (len(m.group()) - 2) + '"', line).split("//")[0]
        if bare.strip() and not bare.lstrip().startswith(("#", "*", "template", "static_assert")):
            yield number, bare


def in_constant(text, line, column):
    """Whether the statement that goes on at this place began with constexpr."""
    begun = "".join(text.splitlines(keepends=True)[:line - 1]) + text.splitlines()[line - 1][:column]
    return "constexpr" in re.split(r"[;{}][ ]*(?://.*)?\n", begun)[-1]


def sites_of(file):
    with open(os.path.join(ROOT, file)) as stream:
        text = stream.read()
    for number, line in code_lines(text):
        for kind, pattern, new, code in OPERATORS:
            for found in re.finditer(pattern, line):
                old = found.group(1)
                if kind == "constant" and 0 < float(old) < LEAST_CONSTANT:
                    continue
                other = new if new is not None else repr(float(old) * 2) if float(old) != 0 else "1.0"
                yield {"file": file, "line": number, "column": found.start(1), "kind": kind, "source": text.split("\n")[number - 1].strip(),
                       "in_constant": in_constant(text, number, found.start(1)),
                       "old": old, "new": other, "code": code}


def lot(site):
    """Decides the order of the draw. Lines elsewhere do not change it."""
    text = "%d %s %d %s %s %s" % (SEED, site["file"], site["column"], site["source"], site["old"], site["new"])
    return hashlib.sha256(text.encode()).hexdigest()


def key(site):
    return "%s:%d:%d %s -> %s" % (site["file"], site["line"], site["column"] + 1, site["old"], site["new"] or "nothing")


def identity(site):
    """What stays when lines move: verdicts are kept by it."""
    return "%s | %s | %d | %s | %s" % (site["file"], site["source"], site["column"], site["old"], site["new"])


def drawn(area):
    """The sites of an area in the order of the draw, at most one of each place; every prefix is a fair sample."""
    files = subprocess.run(["git", "-C", ROOT, "ls-files", *AREAS[area][0]], capture_output=True, text=True, check=True).stdout.split()
    places, chosen = set(), []
    for site in sorted((site for file in files if file.endswith((".cpp", ".hpp")) for site in sites_of(file)), key=lot):
        place = site["file"], site["line"], site["column"]
        if place not in places:
            places.add(place)
            chosen.append({**site, "area": area})
    return chosen


def with_mutants(text, sites):
    """The text of a file with all of `sites`, which have an "id", in it."""
    lines = text.split("\n")
    for site in sorted(sites, key=lambda site: -site["column"]):  # from the right: columns stay
        line, at = lines[site["line"] - 1], site["column"]
        assert line[at:at + len(site["old"])] == site["old"], key(site)
        live = "live_" if site["live"] else ""
        code = site["code"].format(id=site["id"], old=site["old"], new=site["new"], live=live)
        line = line[:at] + code + line[at + len(site["old"]):]
        if live and re.match(r"\s*((inline|static) )*constexpr (double|std::\w+) \w+ *[={]", line):
            line = line.replace("constexpr", "const", 1)
        lines[site["line"] - 1] = line
    header = os.path.join(os.path.dirname(__file__), "mutation.hpp")
    return '#include "%s"\n#line 1\n' % header + "\n".join(lines)


def mutated(text, site):
    """The text with one mutant instead of its original."""
    lines = text.split("\n")
    line, at = lines[site["line"] - 1], site["column"]
    lines[site["line"] - 1] = line[:at] + site["new"] + line[at + len(site["old"]):]
    return "\n".join(lines)

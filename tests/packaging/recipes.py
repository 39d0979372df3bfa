#!/usr/bin/env python3
"""Recipes say what the build says: name, version, license, and every library that CMake looks for, none besides.

usage: recipes.py SOURCE_DIR VERSION. Exit code 77: no Python here has a reader of YAML.
"""
import json
import os
import pathlib
import re
import sys
import tomllib
import xml.etree.ElementTree as xml

DISTRIBUTION = "/usr/bin/python3"  # the one that Debian's python3-yaml serves
try:
    import yaml
except ImportError:
    if sys.executable != DISTRIBUTION and os.path.exists(DISTRIBUTION):
        os.execv(DISTRIBUTION, [DISTRIBUTION, "-B", *sys.argv])
    print("PyYAML is missing (./dev setup python3-yaml): the recipes are not checked")
    sys.exit(77)

LICENSE = "BSD-3-Clause"

# A library by the name that CMake looks for, and its names in Debian, conda-forge, vcpkg, Homebrew and rosdep.
LIBRARIES = """
Eigen3         libeigen3-dev        eigen           eigen3         eigen          eigen
yaml-cpp       libyaml-cpp-dev      yaml-cpp        yaml-cpp       yaml-cpp       yaml-cpp
nlohmann_json  nlohmann-json3-dev   nlohmann_json   nlohmann-json  nlohmann-json  nlohmann-json-dev
NLopt          libnlopt-dev         nlopt           nlopt          nlopt          libnlopt-dev
PNG            libpng-dev           libpng          libpng         libpng         libpng-dev
Boost          libboost-dev         libboost-devel  boost-*        boost          boost
ipopt          coinor-libipopt-dev  ipopt           coin-or-ipopt  ipopt          coinor-libipopt-dev
CLI11          libcli11-dev         cli11           cli11          cli11          cli11
OMPL           libompl-dev          ompl            ompl           ompl           ompl
ZLIB           zlib1g-dev           zlib            zlib           zlib           zlib
liblz4         liblz4-dev           lz4-c           lz4            lz4            liblz4-dev
libzstd        libzstd-dev          zstd            zstd           zstd           libzstd-dev
SQLite3        libsqlite3-dev       sqlite          sqlite3        sqlite         libsqlite3-dev
tinyxml2       libtinyxml2-dev      tinyxml2        tinyxml2       tinyxml2       tinyxml2
"""
COLLECTIONS = ("debian", "conda-forge", "vcpkg", "homebrew", "rosdep")
# What a collection needs beside the libraries: compilers, tools, parts that Debian splits off.
BESIDE = {
    "debian": "g++ cmake ninja-build ccache pkg-config liblapack-dev libblas-dev libnlopt-cxx-dev libboost-serialization-dev "
              "libboost-filesystem-dev libgtest-dev python3",
    "conda-forge": "",
    "vcpkg": "vcpkg-cmake vcpkg-cmake-config",
    "homebrew": "cmake ninja pkgconf",
    "rosdep": "cmake pkg-config libblas-dev liblapack-dev libgtest-dev",
}


def looked_for(source):
    """Names of the libraries that the product's CMake files look for."""
    names = set()
    for file in [source / "cmake/joulepath_dependencies.cmake", *source.glob("extensions/*/dependencies.cmake")]:
        text = re.sub(r"#.*", "", file.read_text())
        names |= set(re.findall(r"find_package\(([\w-]+)", text)) - {"PkgConfig", "Threads"}
        names |= set(re.findall(r"pkg_check_modules\(\w+ REQUIRED IMPORTED_TARGET ([\w-]+)", text))
        names |= {name.upper() for name in re.findall(r"find_library\((\w+)_LIBRARY", text)}
    return names


def table():
    rows = [line.split() for line in LIBRARIES.strip().splitlines()]
    return {row[0]: dict(zip(COLLECTIONS, row[1:])) for row in rows}


def stated_in_conda(text):
    recipe = yaml.safe_load(text)
    fields = {**recipe["package"], "license": recipe["about"]["license"]}
    return fields, [entry.split()[0] for entry in recipe["requirements"]["host"]]


def stated_in_vcpkg(text):
    port = json.loads(text)
    return port, [entry if isinstance(entry, str) else entry["name"] for entry in port["dependencies"]]


def stated_in_homebrew(text):
    fields = {"name": re.search(r"^class (\w+) < Formula", text, re.M)[1].lower(), "version": re.search(r'^  version "(.*)"', text, re.M)[1],
              "license": re.search(r'^  license "(.*)"', text, re.M)[1]}
    return fields, re.findall(r'depends_on "([^"]+)"', text)


def stated_in_ros(text):
    package = xml.fromstring(text)
    fields = {key: package.findtext(key) for key in ("name", "version", "license")}
    return fields, [entry.text for entry in package if entry.tag.endswith("depend")]


def stated_in_dev(text):
    lists = re.findall(r"^(?:extension_)?packages=\((.*?)\)", text, re.M | re.S)
    return None, " ".join(lists).split()


RECIPES = {
    "packaging/conda-forge/recipe/meta.yaml": ("conda-forge", stated_in_conda),
    "packaging/vcpkg/joulepath/vcpkg.json": ("vcpkg", stated_in_vcpkg),
    "packaging/homebrew/joulepath.rb": ("homebrew", stated_in_homebrew),
    "package.xml": ("rosdep", stated_in_ros),
    "dev": ("debian", stated_in_dev),
}


def wrong_fields(path, fields, version):
    for key, expected in {"name": "joulepath", "version": version, "license": LICENSE}.items():
        if fields is not None and fields[key] != expected:
            yield f"{path}: {key} is {fields[key]}, not {expected}"


def wrong_dependencies(path, collection, stated, needed):
    names = {library: row[collection] for library, row in table().items()}
    beside = set(BESIDE[collection].split())
    if len(set(stated)) < len(stated):
        yield f"{path}: a dependency stands twice"
    for library in sorted(needed):
        if not any(re.fullmatch(names[library].replace("*", r"\w+"), name) for name in stated):
            yield f"{path}: lacks {names[library]} (CMake looks for {library})"
    for name in stated:
        if name not in beside and not any(re.fullmatch(names[library].replace("*", r"\w+"), name) for library in needed):
            yield f"{path}: CMake does not look for {name}"
    yield from (f"{path}: lacks {name}" for name in sorted(beside - set(stated)))


def recipes(source, version, needed):
    for path, (collection, read) in RECIPES.items():
        fields, stated = read((source / path).read_text())
        yield from wrong_fields(path, fields, version)
        yield from wrong_dependencies(path, collection, stated, needed)


def texts(source, version):
    """Version and license where they stand in plain text."""
    python = tomllib.loads((source / "python/pyproject.toml").read_text())["project"]
    yield from wrong_fields("python/pyproject.toml", python, version)
    citation = yaml.safe_load((source / "CITATION.cff").read_text())
    yield from wrong_fields("CITATION.cff", {**citation, "name": citation["title"].split(":")[0]}, version)
    yield from (f"CITATION.cff: lacks {key}" for key in ("cff-version", "message", "authors") if key not in citation)
    docker = (source / "packaging/docker/Dockerfile").read_text()
    found = set(re.findall(r"\b\d+\.\d+\.\d+\b", docker))
    if found != {version}:
        yield f"packaging/docker/Dockerfile: versions {sorted(found)}, not {version}"
    if f'licenses="{LICENSE}"' not in docker:
        yield f"packaging/docker/Dockerfile: its license is not {LICENSE}"


def forms(source):
    """Each form has a name, a description, and elements with a label and an id of their own."""
    for file in sorted(source.glob(".github/ISSUE_TEMPLATE/[0-9]_*.yml")):
        form = yaml.safe_load(file.read_text())
        ids = {element["id"] for element in form["body"] if element["attributes"]["label"] and element["type"] in ("input", "textarea")}
        if not (form["name"] and form["description"] and ids and len(ids) == len(form["body"])):
            yield f"{file.relative_to(source)}: an element without a label or without an id of its own"


def main():
    source, version = pathlib.Path(sys.argv[1]).resolve(), sys.argv[2]
    needed = looked_for(source)
    unknown = [f"tests/packaging/recipes.py: has no names of {name}" for name in sorted(needed - set(table()))]
    unneeded = [f"tests/packaging/recipes.py: CMake does not look for {name}" for name in sorted(set(table()) - needed)]
    problems = [*unknown, *unneeded, *recipes(source, version, needed & set(table())), *texts(source, version), *forms(source)]
    print("\n".join(problems) or "recipes: names, versions, licenses and dependencies are those of the build")
    return 1 if problems else 0


if __name__ == "__main__":
    sys.exit(main())

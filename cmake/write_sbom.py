#!/usr/bin/env python3
# Design: docs/decisions/0800-build.md
"""CycloneDX 1.5 list of what a Debian package of joulepath contains and needs.

usage: write_sbom.py PACKAGE.deb OUTPUT.json
Components: the program, the libraries that are compiled in (headers), the packages that it depends on, and those of
every other shared library that `ldd` finds for the program, each with the version of the distribution's package.
Without times, so that it repeats: docs/decisions/0800-build.md.
"""
import hashlib
import json
import pathlib
import re
import subprocess
import sys
import tempfile

COMPILED_IN = {"libeigen3-dev": "MPL-2.0", "libboost-dev": "BSL-1.0", "nlohmann-json3-dev": "MIT", "libcli11-dev": "BSD-3-Clause"}


def output(*command):
    return subprocess.run(command, capture_output=True, text=True, check=True).stdout.strip()


def package_of(library):
    """The package that owns a shared library; some have their file in /lib, which is a link to /usr/lib."""
    real = str(pathlib.Path(library).resolve())
    for path in (library, real, real.removeprefix("/usr"), "/usr" + library):
        found = subprocess.run(["dpkg-query", "-S", path], capture_output=True, text=True)
        if found.returncode == 0:
            return found.stdout.split(":")[0]
    sys.exit("no package owns %s" % library)


def loaded_packages(program):
    """The packages of all shared libraries that the program loads, those of its libraries included."""
    listed = output("ldd", str(program))
    if "not found" in listed:
        sys.exit("a shared library is not installed here:\n%s" % listed)
    return {package_of(path) for path in re.findall(r"(/\S+) \(0x", listed)}


def component(package, scope, license_id=None):
    version = output("dpkg-query", "-W", "-f=${Version}", package)
    made = {"type": "library", "bom-ref": "%s-%s" % (package, scope), "name": package, "version": version, "scope": "required",
            "purl": "pkg:deb/debian/%s@%s" % (package.split(":")[0], version.replace("+", "%2B")),
            "properties": [{"name": "joulepath:use", "value": scope}]}
    if license_id:
        made["licenses"] = [{"license": {"id": license_id}}]
    return made


def main():
    package, target = sys.argv[1:3]
    name, version = (output("dpkg-deb", "-f", package, field) for field in ("Package", "Version"))
    needed = sorted({re.split(r"[ (|]", entry.strip())[0] for entry in output("dpkg-deb", "-f", package, "Depends").split(",")})
    with open(package, "rb") as file:
        digest = hashlib.sha256(file.read()).hexdigest()
    parts = [component(part, "compiled in", license_id) for part, license_id in COMPILED_IN.items()]
    parts += [component(part, "shared library") for part in needed]
    with tempfile.TemporaryDirectory() as folder:
        output("dpkg-deb", "-x", package, folder)
        loaded = loaded_packages(pathlib.Path(folder) / "usr/bin/joulepath")
    parts += [component(part, "shared library of a shared library") for part in sorted(loaded.difference(needed))]
    bom = {"bomFormat": "CycloneDX", "specVersion": "1.5", "version": 1,
           "metadata": {"component": {"type": "application", "bom-ref": name, "name": name, "version": version,
                                      "licenses": [{"license": {"id": "BSD-3-Clause"}}],
                                      "hashes": [{"alg": "SHA-256", "content": digest}]}},
           "components": parts, "dependencies": [{"ref": name, "dependsOn": [part["bom-ref"] for part in parts]}]}
    with open(target, "w") as file:
        json.dump(bom, file, indent=2)
        file.write("\n")


if __name__ == "__main__":
    main()

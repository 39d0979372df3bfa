#!/usr/bin/env python3
# Design: docs/decisions/0800-build.md
"""CycloneDX 1.5 list of what a Debian package of joulepath contains and needs.

usage: write_sbom.py PACKAGE.deb OUTPUT.json
Components: the program, the libraries that are compiled in (headers), and the shared libraries that the
package depends on, each with the version of the distribution's package. Without times, so that it repeats: docs/decisions/0800-build.md.
"""
import hashlib
import json
import re
import subprocess
import sys

COMPILED_IN = {"libeigen3-dev": "MPL-2.0", "libboost-dev": "BSL-1.0", "nlohmann-json3-dev": "MIT", "libcli11-dev": "BSD-3-Clause"}


def output(*command):
    return subprocess.run(command, capture_output=True, text=True, check=True).stdout.strip()


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

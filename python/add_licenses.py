#!/usr/bin/env python3
"""Adds to a repaired wheel the license of every shared library in it: the copyright file of its Debian package.

The wheel fails without a license for each of them.
"""
import pathlib
import re
import subprocess
import sys
import tempfile

COMMON = pathlib.Path("/usr/share/common-licenses")


def libraries_here():
    """The shared libraries of this machine by the names of their files, links resolved."""
    listed = subprocess.run(["/sbin/ldconfig", "-p"], capture_output=True, text=True, check=True).stdout
    files = [pathlib.Path(line.split(" => ")[1]).resolve() for line in listed.splitlines() if " => " in line]
    return {file.name: file for file in files}


def origin(library, known):
    """The file that auditwheel copied: libfoo-0123abcd.so.1.2 came from libfoo.so.1.2."""
    name = re.sub(r"-[0-9a-f]{8}(?=\.)", "", library.name)
    if name not in known:
        raise SystemExit(f"no library on this machine is called {name}")
    return known[name]


def package_of(file):
    """The Debian package that owns a library; some packages have their file in /lib, which is a link to /usr/lib."""
    for path in (file, pathlib.Path(str(file).removeprefix("/usr"))):
        found = subprocess.run(["dpkg", "-S", str(path)], capture_output=True, text=True)
        if found.returncode == 0:
            return found.stdout.split(":")[0]
    raise SystemExit(f"no package owns {file}")


def add_licenses(folder, libraries):
    """Writes the copyright file of each library's package into the folder: {name as bundled: file on this machine}."""
    folder.mkdir(parents=True)
    table = []
    for name, file in sorted(libraries.items()):
        package = package_of(file)
        text = pathlib.Path(f"/usr/share/doc/{package}/copyright").read_text()
        (folder / f"{package}.txt").write_text(text)
        for common in sorted(set(re.findall(r"/usr/share/common-licenses/([\w.+-]*\w)", text))):
            if (COMMON / common).is_file():
                (folder / f"{common}.txt").write_text((COMMON / common).read_text())
        table.append(f"{name}\t{package}.txt\n")
    (folder / "LIBRARIES.tsv").write_text("".join(table))
    return len(table)


def main():
    for wheel in map(pathlib.Path, sys.argv[1:]):
        with tempfile.TemporaryDirectory() as scratch:
            run = [sys.executable, "-m", "wheel"]
            subprocess.run([*run, "unpack", "-d", scratch, wheel], check=True, stdout=subprocess.DEVNULL)
            tree, known = next(pathlib.Path(scratch).iterdir()), libraries_here()
            bundled = {library.name: origin(library, known) for library in tree.glob("*.libs/*.so*")}
            folder = next(tree.glob("*.dist-info")) / "licenses/bundled"
            print(f"{wheel.name}: {add_licenses(folder, bundled)} bundled libraries, each with its license")
            subprocess.run([*run, "pack", "-d", wheel.parent, tree], check=True, stdout=subprocess.DEVNULL)


if __name__ == "__main__":
    main()

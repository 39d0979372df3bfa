#!/usr/bin/env python3
"""A tarball of the program that runs without root: what a Debian package holds, less headers and static libraries, with
every shared library but the C library's beside it.

usage: make_tarball.py PACKAGE.deb OUT.tar.gz      SOURCE_DATE_EPOCH is the time of its files
Design: docs/decisions/0800-build.md
"""
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "python"))
from add_licenses import add_licenses, package_of  # noqa: E402

OLDEST_GLIBC = (2, 36)
FROM_THE_SYSTEM = {"libc6"}  # its loader, libc, libm and libpthread belong together
SHARES = ("joulepath", "man", "bash-completion", "doc")


def output(*command):
    return subprocess.run(command, capture_output=True, text=True, check=True).stdout


def libraries(program):
    """{name that the loader asks for: file} of what is bundled."""
    listed = output("ldd", program)
    if "not found" in listed:
        sys.exit(f"a shared library is not installed here:\n{listed}")
    found = {pathlib.Path(path).name: pathlib.Path(path).resolve() for path in re.findall(r"(/\S+) \(0x", listed)}
    return {name: file for name, file in sorted(found.items()) if package_of(file) not in FROM_THE_SYSTEM}


def newest_glibc(files):
    """The newest version of the C library that a symbol of the files asks for."""
    asked = {tuple(map(int, version.split("."))) for file in files for version in re.findall(r"GLIBC_([\d.]+)", output("objdump", "-T", file))}
    return max(asked)


def build(package, tree):
    with tempfile.TemporaryDirectory() as unpacked:
        output("dpkg-deb", "-x", package, unpacked)
        usr = pathlib.Path(unpacked) / "usr"
        (tree / "bin").mkdir(parents=True)
        (tree / "lib").mkdir()
        program = tree / "bin/joulepath"
        shutil.copy(usr / "bin/joulepath", program)
        for share in SHARES:
            shutil.copytree(usr / "share" / share, tree / "share" / share)
    bundled = libraries(program)
    for name, file in bundled.items():
        shutil.copy(file, tree / "lib" / name)
        output("patchelf", "--force-rpath", "--set-rpath", "$ORIGIN", str(tree / "lib" / name))
    output("patchelf", "--force-rpath", "--set-rpath", "$ORIGIN/../lib", str(program))
    add_licenses(tree / "share/doc/joulepath/bundled", bundled)
    (tree / "scenarios").symlink_to("share/joulepath/scenarios")
    (tree / "LICENSE").write_text((tree / "share/doc/joulepath/LICENSE").read_text())
    newest = newest_glibc([program, *(tree / "lib").iterdir()])
    if newest > OLDEST_GLIBC:
        sys.exit(f"the program asks for glibc {newest}, newer than {OLDEST_GLIBC}")
    return len(bundled)


def modes(tree):
    """The same modes whatever the umask was: programs and folders 755, other files 644."""
    for path in [tree, *tree.rglob("*")]:
        if not path.is_symlink():
            path.chmod(0o755 if path.is_dir() or path.parent.name == "bin" else 0o644)


def main():
    package, out = pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2]).resolve()
    with tempfile.TemporaryDirectory() as scratch:
        tree = pathlib.Path(scratch) / out.name.removesuffix(".tar.gz")
        count = build(package, tree)
        modes(tree)
        tar = ["tar", "--sort=name", f"--mtime=@{os.environ['SOURCE_DATE_EPOCH']}", "--owner=0", "--group=0", "--numeric-owner", "--format=gnu",
               "-C", scratch, "-cf", "-", tree.name]
        with subprocess.Popen(tar, stdout=subprocess.PIPE) as packed, out.open("wb") as file:
            subprocess.run(["gzip", "-9", "-n"], stdin=packed.stdout, stdout=file, check=True)
        if packed.returncode != 0:
            sys.exit("tar failed")
    print(f"{out.name}: {count} bundled libraries, {out.stat().st_size / 2**20:.1f} MiB")


if __name__ == "__main__":
    main()

"""What the installed wheel has in it. Skipped for a package that is not installed from a repaired wheel."""
import importlib.metadata
import pathlib

import pytest


def test_every_bundled_library_has_a_license():
    distribution = importlib.metadata.distribution("joulepath")
    files = [pathlib.Path(distribution.locate_file(f)) for f in distribution.files or []]
    libraries = {f.name for f in files if f.parent.name == "joulepath.libs"}
    if not libraries:
        pytest.skip("no bundled libraries: not a repaired wheel")
    table = next(f for f in files if f.name == "LIBRARIES.tsv")
    licensed = dict(line.split("\t") for line in table.read_text().splitlines())
    assert set(licensed) == libraries
    for name in set(licensed.values()):
        assert (table.parent / name).stat().st_size > 100
    assert any(f.name == "LICENSE" for f in files) and any(f.name == "THIRD_PARTY_NOTICES.md" for f in files)


def test_numpy_is_the_only_hard_dependency():
    required = [r for r in importlib.metadata.requires("joulepath") or [] if "extra ==" not in r]
    assert [r.split(">")[0] for r in required] == ["numpy"]

"""numpy, for the tests of the problem set: of this Python, or of the environment that the peers' benchmark makes."""
import os
import pathlib
import sys

PEERS = pathlib.Path(__file__).resolve().parents[2] / "build/peers/venv/bin/python"

try:
    import numpy as np  # noqa: F401
except ImportError:
    if PEERS.exists() and pathlib.Path(sys.prefix) != PEERS.parents[1]:
        os.execv(PEERS, [str(PEERS), "-B", *sys.argv])
    print("numpy is missing (./dev setup python3-numpy): the problem set is not checked")
    sys.exit(77)  # CTest's code for a skipped test

"""The program: ``python -m joulepath plan mission.yaml``, or ``joulepath plan mission.yaml``."""

import sys

from . import _core


def main() -> int:
    """Runs the command line of this process."""
    if sys.argv[1:2] == ["fleet"]:  # its planner is Python
        from .fleet._program import main as fleet_main

        return fleet_main(sys.argv[2:])
    return _core.program_main(["joulepath", *sys.argv[1:]])


if __name__ == "__main__":
    sys.exit(main())

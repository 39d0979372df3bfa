#!/usr/bin/env python3
"""Takes the picture of the studio with the demo mission.

usage: picture.py JOULEPATH OUT.png [WIDTH]
"""
import base64
import pathlib
import sys
import tempfile

from studio_page import SOURCE, Served, StudioPage

FRONT = "document.querySelector('#front button').click()"


def main():
    program, out, width = sys.argv[1], pathlib.Path(sys.argv[2]), int(sys.argv[3]) if len(sys.argv) > 3 else 1440
    served = Served(program, SOURCE / "scenarios/missions/warehouse_pick.yaml")
    with tempfile.TemporaryDirectory() as folder:
        page = StudioPage(folder)
        try:
            page.width(width, 1000)
            page.show(served.address + "#light", 600)
            page.settle()
            page.run(FRONT)
            page.until("return studio.store.front !== null", 300)
            page.run("document.getElementById('clock').value = 300; document.getElementById('clock').dispatchEvent(new Event('input')); document.activeElement.blur()")
            page.until("return true")
            out.write_bytes(base64.b64decode(page.call("GET", "/screenshot")))
        finally:
            page.close()
            served.close()


if __name__ == "__main__":
    main()

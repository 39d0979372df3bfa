#!/usr/bin/env python3
"""Takes the picture of the studio with the demo mission, or a short animation of a drag.

usage: picture.py JOULEPATH OUT.png [WIDTH]
       picture.py JOULEPATH OUT.png --drag     frames of a stop that is dragged, as one animated PNG
"""
import base64
import pathlib
import struct
import sys
import tempfile
import zlib

from studio_page import SOURCE, Served, StudioPage

FRONT = "document.querySelector('#front button').click()"
FRAMES, STEP_M, PAUSE_MS = 8, -0.35, 260
SIGNATURE = b"\x89PNG\r\n\x1a\n"
# A stop moved on by a step, without letting go; done once the draft of it is on the screen.
MOVE = """
const [name, step, done] = arguments, handle = studio.handles().find((one) => one.name === name), drafted = studio.next_draft();
handle.drag(handle.x + step, handle.y + 0.4 * step, {of: 'picture', release: false});
drafted.then(() => requestAnimationFrame(() => requestAnimationFrame(() => done())));
"""


def picture(page):
    return base64.b64decode(page.call("GET", "/screenshot"))


def chunks(png):
    at = len(SIGNATURE)
    while at < len(png):
        (size,) = struct.unpack(">I", png[at:at + 4])
        yield png[at + 4:at + 8], png[at + 8:at + 8 + size]
        at += 12 + size


def chunk(kind, data):
    return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))


def animated(frames):
    """One animated PNG (https://wiki.mozilla.org/APNG_Specification) of [(PNG, milliseconds)] of the same size."""
    (header,) = [data for kind, data in chunks(frames[0][0]) if kind == b"IHDR"]
    width, height = struct.unpack(">II", header[:8])
    out, number = SIGNATURE + chunk(b"IHDR", header) + chunk(b"acTL", struct.pack(">II", len(frames), 0)), 0
    for k, (png, milliseconds) in enumerate(frames):
        out += chunk(b"fcTL", struct.pack(">IIIIIHHBB", number, width, height, 0, 0, milliseconds, 1000, 0, 0))
        number += 1
        pixels = zlib.compress(zlib.decompress(b"".join(data for kind, data in chunks(png) if kind == b"IDAT")), 9)
        out += chunk(b"IDAT", pixels) if k == 0 else chunk(b"fdAT", struct.pack(">I", number) + pixels)
        number += k > 0
    return out + chunk(b"IEND", b"")


def drag(page):
    """The last stop but one is dragged away and planned anew."""
    name = page.run("const leg = studio.store.mission.legs.filter((one) => one.to).at(-2); return 'stop ' + leg.to")
    page.call("POST", "/timeouts", {"script": 300_000})
    frames = [(picture(page), 900)]
    for _ in range(FRAMES):
        page.call("POST", "/execute/async", {"script": MOVE, "args": [name, STEP_M]})
        frames.append((picture(page), PAUSE_MS))
    page.run("const h = studio.handles().find((one) => one.name === arguments[0]); h.drag(h.x, h.y, {of: 'picture', release: true})", name)
    page.settle()
    page.until("return true")
    return animated([*frames, (picture(page), 1800)])


def still(page):
    page.run(FRONT)
    page.until("return studio.store.front !== null", 300)
    page.run("document.getElementById('clock').value = 300; document.getElementById('clock').dispatchEvent(new Event('input')); document.activeElement.blur()")
    page.until("return true")
    return picture(page)


def main():
    program, out, option = sys.argv[1], pathlib.Path(sys.argv[2]), sys.argv[3] if len(sys.argv) > 3 else "1440"
    served = Served(program, SOURCE / "scenarios/missions/warehouse_pick.yaml")
    with tempfile.TemporaryDirectory() as folder:
        page = StudioPage(folder)
        try:
            page.width(*((1000, 640) if option == "--drag" else (int(option), 1000)))
            page.show(served.address + "#light", 600)
            page.settle()
            out.write_bytes(drag(page) if option == "--drag" else still(page))
        finally:
            page.close()
            served.close()


if __name__ == "__main__":
    main()

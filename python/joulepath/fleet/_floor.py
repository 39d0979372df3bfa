"""The map of a fleet's report: cells of the floor, driven paths, and where each robot is at each time."""

from __future__ import annotations

import base64
import html
import math
import struct
import zlib
from typing import Any

COLORS = ("plan", "second", "third", "fourth", "fifth", "sixth")  #: of the page's style
PALETTE = ((0, 0, 0, 0), (128, 128, 128, 60), (110, 120, 132, 255), (200, 90, 40, 80))  #: free, unknown, occupied, keep-out


class Floor:
    """Places of the world as percentages of the map's picture."""

    def __init__(self, picture: Any) -> None:
        self.width, self.height, cell_m, (self.x_m, self.y_m, heading_rad), self.runs = picture
        self.across_m, self.up_m = self.width * cell_m, self.height * cell_m
        self.cos, self.sin = math.cos(heading_rad), math.sin(heading_rad)

    def at(self, x_m: float, y_m: float) -> tuple[float, float]:
        """From the left and from the top."""
        dx, dy = x_m - self.x_m, y_m - self.y_m
        right, up = self.cos * dx + self.sin * dy, self.cos * dy - self.sin * dx
        return round(100 * right / self.across_m, 3), round(100 * (1 - up / self.up_m), 3)

    def png(self) -> str:
        """The cells as a data URI."""
        cells = b"".join(bytes([kind]) * count for kind, count in self.runs)
        rows = b"".join(b"\0" + cells[k * self.width:(k + 1) * self.width] for k in reversed(range(self.height)))
        parts = [_chunk(b"IHDR", struct.pack(">IIBBBBB", self.width, self.height, 8, 3, 0, 0, 0)),
                 _chunk(b"PLTE", b"".join(bytes(color[:3]) for color in PALETTE)), _chunk(b"tRNS", bytes(color[3] for color in PALETTE)),
                 _chunk(b"IDAT", zlib.compress(rows, 9)), _chunk(b"IEND", b"")]
        return "data:image/png;base64," + base64.b64encode(b"\x89PNG\r\n\x1a\n" + b"".join(parts)).decode()


def _chunk(name: bytes, data: bytes) -> bytes:
    return struct.pack(">I", len(data)) + name + data + struct.pack(">I", zlib.crc32(name + data))


class _Tracks:
    """The paths of legs, each once."""

    def __init__(self, source: Any) -> None:
        self.source, self.floor = source, Floor(source.map_picture)
        self.numbers: dict[Any, int] = {}
        self.tracks: list[list[tuple[float, float, float]]] = []

    def number(self, leg: Any) -> int:
        if leg not in self.numbers:
            rows = self.source.track(leg)
            end_s = max(rows[-1][0], 1e-9)
            self.numbers[leg] = len(self.tracks)
            self.tracks.append([(round(t / end_s, 3), *self.floor.at(x, y)) for t, x, y in rows])
        return self.numbers[leg]


def moves_of(source: Any, content: dict[str, Any]) -> dict[str, Any]:
    """``tracks``: rows (share of the leg's time, left %, top %); ``robots``: name, start, moves (from s, to s, track)."""
    tracks, robots = _Tracks(source), []
    for robot, known in zip(content["robots"], source.problem.robots):
        moves = [move for item in robot["timeline"] for move in _moves(source, tracks, known.type, item)]
        place = source.content["floor"]["stations"][known.start]
        robots.append({"name": robot["name"], "start": tracks.floor.at(place["x_m"], place["y_m"]), "moves": moves})
    return {"tracks": tracks.tracks, "robots": robots}


def _moves(source: Any, tracks: _Tracks, t: int, item: dict[str, Any]) -> list[tuple[float, float, int]]:
    if item["does"] == "drive":
        return [(item["from_s"], item["to_s"], tracks.number((t, item["from"], item["to"], 0.0)))]
    if item["does"] != "mission":
        return []
    mission = next(m for m in source.content["missions"] if m["name"] == item["mission"])
    clock, moves = item["from_s"] + mission["stops"][0]["dwell_s"], []
    for leg, stop in zip(source.mission_legs(mission, t), mission["stops"][1:]):
        points = source.table[leg]
        end_s = min(item["to_s"], clock + points[min(item["point"], len(points) - 1)][0])
        if leg[1] != leg[2]:
            moves.append((round(clock, 2), round(end_s, 2), tracks.number(leg)))
        clock = end_s + stop["dwell_s"]
    return moves


def _side(left: float) -> str:
    """Names of places near the right edge stand on their left."""
    return " left" if left > 75 else ""


def floor_html(source: Any, content: dict[str, Any], moves: dict[str, Any]) -> str:
    """The picture with its marks; the page's script moves the robots."""
    floor = Floor(source.map_picture)
    chargers = {c["station"] for c in content["chargers"]}
    lines, dots = [], []
    for n, robot in enumerate(moves["robots"]):
        color = COLORS[n % len(COLORS)]
        for k in sorted({track for _, _, track in robot["moves"]}):
            points = " ".join(f"{x},{y}" for _, x, y in moves["tracks"][k])
            lines.append(f'<polyline points="{points}" style="stroke:var(--{color})"/>')
        x, y = robot["start"]
        dots.append(f'<b class="robot{_side(x)}" style="left:{x}%;top:{y}%;background:var(--{color})"><span>{html.escape(robot["name"])}</span></b>')
    marks = []
    for name, place in source.content["floor"]["stations"].items():
        x, y = floor.at(place["x_m"], place["y_m"])
        marks.append(f'<i class="place{" dock" if name in chargers else ""}{_side(x)}" style="left:{x}%;top:{y}%"><span>{html.escape(name)}</span></i>')
    return (f'<div class="plan" style="--ratio:{floor.across_m / floor.up_m:.4f}"><img alt="Map" src="{floor.png()}">'
            f'<svg viewBox="0 0 100 100" preserveAspectRatio="none" aria-hidden="true">{"".join(lines)}</svg>{"".join(marks)}{"".join(dots)}</div>')

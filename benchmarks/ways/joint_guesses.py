"""First drives for the nonlinear program of joint_program.py: words of arcs and lines, and cubic curves.

Each begins in another basin: the turns at both ends and their radii differ, and so do length and whole turns.
"""

import math

import numpy as np

from joint_program import Drive

RADII_M = (0.15, 0.5)
SHARE_OF_DISTANCE = 0.22  # no greater radius: the arcs of near poses would overlap
TANGENTS = (0.5, 1.5)  # of cubic curves, over the distance
EASE = 0.5  # of the limits that the first speeds keep


def word(start, goal, radius_m, first, last):
    """Arc, line, arc [Dubins1957] with senses `first`, `last` (1: left): lengths, curvatures, or None."""
    centre = lambda pose, sense: np.array(
        [pose[0] - sense * radius_m * math.sin(pose[2]), pose[1] + sense * radius_m * math.cos(pose[2])]
    )
    way = centre(goal, last) - centre(start, first)
    apart, bearing = math.hypot(*way), math.atan2(way[1], way[0])
    if first != last:
        if apart < 2 * radius_m:
            return None
        bearing += first * math.asin(2 * radius_m / apart)
        apart = math.sqrt(apart**2 - 4 * radius_m**2)
    turns = (first * (bearing - start[2])) % (2 * math.pi), (last * (goal[2] - bearing)) % (2 * math.pi)
    pieces = [(turns[0] * radius_m, first / radius_m), (apart, 0.0), (turns[1] * radius_m, last / radius_m)]
    return [piece for piece in pieces if piece[0] > 1e-6]


def triple(start, goal, radius_m, first):
    """Arc, opposite arc, arc of one radius [Dubins1957], or None where the circles are too far apart."""
    centre = lambda pose: np.array(
        [pose[0] - first * radius_m * math.sin(pose[2]), pose[1] + first * radius_m * math.cos(pose[2])]
    )
    a, b = centre(start), centre(goal)
    apart = math.hypot(*(b - a))
    if not 1e-6 < apart < 4 * radius_m:
        return None
    bearing, lift = math.atan2(*(b - a)[::-1]), math.acos(apart / (4 * radius_m))
    out = bearing + first * lift  # from the first circle's centre to the middle one's
    back = bearing + math.pi - first * lift  # from the last circle's centre to the middle one's
    outward = lambda heading: heading - first * math.pi / 2
    turns = [
        (first * (out - outward(start[2]))) % (2 * math.pi),
        (-first * (back - out)) % (2 * math.pi),
        (first * (outward(goal[2]) - back)) % (2 * math.pi),
    ]
    bends = (first, -first, first)
    return [(turn * radius_m, bend / radius_m) for turn, bend in zip(turns, bends) if turn > 1e-6]


def along_pieces(start, pieces):
    """Dense s, x, y, heading, curvature of arcs and lines."""
    length = sum(piece[0] for piece in pieces)
    ends = np.cumsum([piece[0] for piece in pieces])
    s = np.linspace(0, length, 1001)
    bend = np.array(pieces)[np.minimum(np.searchsorted(ends, (s[1:] + s[:-1]) / 2), len(pieces) - 1), 1]
    heading = start[2] + np.concatenate([[0], np.cumsum(bend * np.diff(s))])
    return s, heading, np.concatenate([[bend[0]], (bend[1:] + bend[:-1]) / 2, [bend[-1]]])


def along_cubic(start, goal, tangent):
    """Dense s, heading, curvature of Hermite's cubic with tangents of `tangent` distances."""
    size = tangent * max(math.dist(start[:2], goal[:2]), 0.2)
    t = np.linspace(0, 1, 1001)
    ends = [np.array([pose[0], pose[1]]) for pose in (start, goal)]
    ways = [size * np.array([math.cos(pose[2]), math.sin(pose[2])]) for pose in (start, goal)]
    shape = (2 * t**3 - 3 * t**2 + 1, 3 * t**2 - 2 * t**3), (t**3 - 2 * t**2 + t, t**3 - t**2)
    x, y = (
        sum(f * e[i] for f, e in zip(shape[0], ends)) + sum(f * w[i] for f, w in zip(shape[1], ways))
        for i in (0, 1)
    )
    s = np.concatenate([[0], np.cumsum(np.hypot(np.diff(x), np.diff(y)))])
    heading = np.unwrap(np.arctan2(np.gradient(y, t), np.gradient(x, t)))
    heading += start[2] - heading[0]
    return s, heading, np.clip(np.gradient(heading, s), -20, 20)


def first_speeds(robot, s, bend):
    """Squares of speeds (m^2/s^2) that keep half of the limits: a pass forward and one backward."""
    at = lambda key, other: robot.limits.get(key, other)
    sharp = np.maximum(np.abs(bend), 1e-6)
    cap = np.minimum(at("speed_m_s", 1.5), EASE * at("yaw_rate_rad_s", 2.0) / sharp) ** 2
    cap = EASE * np.minimum(cap, at("lateral_acceleration_m_s2", 1.0) / sharp)
    rise = np.minimum(at("acceleration_m_s2", 1.0), at("yaw_acceleration_rad_s2", 4.0) / sharp)
    b = np.minimum(cap, np.minimum(s, s[-1] - s) * 2)
    b[0] = b[-1] = 0
    for order in (range(1, len(s)), range(len(s) - 2, -1, -1)):
        for k in order:
            before = k - 1 if order.step > 0 else k + 1
            b[k] = min(b[k], b[before] + EASE * 2 * rise[k] * abs(s[k] - s[before]))
    return np.maximum(b, 1e-6)


def guess_of(robot, start, s, heading, bend):
    """A dense drive along a curve."""
    middle = (heading[1:] + heading[:-1]) / 2
    x = start[0] + np.concatenate([[0], np.cumsum(np.cos(middle) * np.diff(s))])
    y = start[1] + np.concatenate([[0], np.cumsum(np.sin(middle) * np.diff(s))])
    return Drive(s, x, y, heading, bend * robot.half_track_m, first_speeds(robot, s, bend))


def guesses(robot, start, goal):
    """Names and dense drives from start to goal, (x in m, y in m, heading in rad) each."""
    limit_m = SHARE_OF_DISTANCE * math.dist(start[:2], goal[:2])
    curves = {}
    for radius_m in dict.fromkeys(min(radius_m, limit_m) for radius_m in RADII_M):
        for first in (1, -1):
            for last in (1, -1):
                curves[f"{'LR'[first < 0]}S{'LR'[last < 0]} {radius_m:.2f}"] = word(
                    start, goal, radius_m, first, last
                )
    wide_m = max(RADII_M[1], 0.3 * math.dist(start[:2], goal[:2]))
    for first in (1, -1):
        curves[f"{'LR'[first < 0]}{'RL'[first < 0]}{'LR'[first < 0]}"] = triple(start, goal, wide_m, first)
    found = {name: along_pieces(start, pieces) for name, pieces in curves.items() if pieces}
    found.update({f"cubic {tangent}": along_cubic(start, goal, tangent) for tangent in TANGENTS})
    return {name: guess_of(robot, start, *curve) for name, curve in found.items()}

"""Test days as users drive them: commanded speeds of each run, its start pose, payload and time of day.

A run is two arrays, speed in m/s and yaw rate in rad/s, one value per TICK_s. A day is a list of runs.
"""
import math

import numpy as np

TICK_s = 0.004
KINDS = ("testday", "missions", "out_and_back", "shuttle", "eights", "joystick", "scurve")


def ticks(seconds):
    return max(1, round(seconds / TICK_s))


def pulse(distance, peak, rise):
    """Trapezoid of a speed over time: `distance` to go, `peak` speed, `rise` per second; any unit, signed distance."""
    length = abs(distance)
    peak = min(peak, math.sqrt(length * rise))
    ramp, hold = ticks(peak / rise), ticks(max(0.0, length / peak - peak / rise))
    up = np.arange(ramp) / ramp * peak
    shape = np.concatenate([up, np.full(hold, peak), up[::-1], [0.0]])
    return shape * distance / (shape.sum() * TICK_s)


def eased(shape, seconds):
    """The same distance with a bounded jerk: the mean over a window of that many seconds."""
    width = ticks(seconds)
    return np.convolve(shape, np.full(width, 1.0 / width))


def straight(distance, speed, rise, ease=0.0):
    """(speed, yaw rate) along a line; m, m/s, m/s2, s."""
    shape = pulse(distance, speed, rise)
    shape = eased(shape, ease) if ease else shape
    return shape, np.zeros_like(shape)


def spin(angle, rate, rise):
    """(speed, yaw rate) of a turn on the spot; rad, rad/s, rad/s2."""
    shape = pulse(angle, rate, rise)
    return np.zeros_like(shape), shape


def arc(angle, radius, speed, rise, ease=0.0):
    """(speed, yaw rate) along an arc from rest to rest; signed angle in rad, radius in m."""
    shape, _ = straight(abs(angle) * radius, speed, rise, ease)
    return shape, shape * math.copysign(1 / radius, angle)


def stand(seconds):
    return np.zeros(ticks(seconds)), np.zeros(ticks(seconds))


def joined(*legs):
    """Legs one after the other, with half a second of standstill around each."""
    pause = stand(0.5)
    parts = [pause] + [part for leg in legs for part in (leg, pause)]
    return np.concatenate([p[0] for p in parts]), np.concatenate([p[1] for p in parts])


def bent(pieces, speed, rise, ease):
    """One drive from rest to rest along lines and arcs: pieces are (length in m, curvature in 1/m)."""
    v, _ = straight(sum(length for length, _ in pieces), speed, rise, ease)
    way = np.cumsum(v) * TICK_s
    curvature = np.zeros_like(v)
    start = 0.0
    for length, value in pieces:
        curvature[(way >= start) & (way < start + length)] = value
        start += length
    return v, v * eased(curvature, 0.8)[: len(v)]


def joystick(rng, robot, seconds):
    """A hand on a stick: a new target every one to four seconds, followed with a bounded rate."""
    count = ticks(seconds)
    v, w = np.zeros(count), np.zeros(count)
    k = ticks(0.6)
    while k < count - ticks(3.0):
        end = min(k + ticks(rng.uniform(1, 4)), count - ticks(3.0))
        v[k:end] = robot["v"] * rng.choice([0.0, 0.4, 0.7, 1.0, 1.0, -0.5]) * rng.uniform(0.8, 1)
        w[k:end] = robot["w"] * rng.choice([0.0, 0.0, 0.4, -0.4, 0.8, -0.8]) * rng.uniform(0.7, 1)
        k = end
    return eased(v, robot["v"] / robot["a"])[:count], eased(w, 0.8)[:count]


def factor(rng, spread=0.1):
    return rng.uniform(1 - spread, 1 + spread)


def testday_run(rng, m, kind):
    """One manoeuvre of a test day, by its number."""
    v, a, w = m["v"] * factor(rng), m["a"] * factor(rng), m["w"] * factor(rng)
    side = rng.choice([-1, 1])
    length = 6 * m["v"] * factor(rng)
    choices = (
        lambda: [straight(length, 0.9 * v, a)],
        lambda: [straight(0.5 * length, 0.3 * v, 0.6 * a)],
        lambda: [spin(side * 9.0, w, 1.5 * w), stand(1), spin(-side * 9.0, 0.5 * w, w)],
        lambda: [arc(side * 5.0, 1.2 * m["v"], 0.7 * v, a), stand(1)],
        lambda: [straight(0.5 * length, 0.8 * v, a), straight(-0.5 * length, 0.6 * v, a)],
        lambda: [arc(-side * 5.0, 1.6 * m["v"], 0.8 * v, 0.8 * a)],
        lambda: [straight(0.2 * length, 0.8 * v, 1.3 * a) for _ in range(4)],
        lambda: [stand(3), straight(0.12 * length, 0.1 * v, a), straight(0.5 * length, 0.6 * v, 1.3 * a)],
    )
    return joined(*choices[kind % len(choices)]())


def testday(rng, m, count):
    """Every manoeuvre in turn, payloads mixed; each run begins at the start mark."""
    order = [k % 8 for k in range(count)]
    rng.shuffle(order)
    loads = [0.0, 0.5 * m["load"], 0.9 * m["load"]]
    return [dict(command=testday_run(rng, m, kind), load=rng.choice(loads), pose=(0, 0, rng.choice([0, math.pi / 2]))) for kind in order]


def missions(rng, m, count):
    """The same way between two stations: loaded there, empty back. The localizer keeps the robot on its way."""
    legs = [m["v"] * rng.uniform(3, 6), m["v"] * rng.uniform(3, 5)]
    bend, load = 0.9 * m["v"], m["load"] * rng.uniform(0.4, 1)
    turn, speed = rng.choice([-1, 1]), m["v"] * rng.uniform(0.75, 1)
    half = math.pi / 2 * bend
    there = [(legs[0], 0), (half, turn / bend), (legs[1], 0)]
    back = [(legs[1], 0), (half, -turn / bend), (legs[0], 0)]
    runs, pose = [], (0.0, 0.0, 0.0)
    for k in range(count):
        ease = 0.5 if k % 2 else 0.3
        command = joined(bent(back if k % 2 else there, speed, m["a"], ease), stand(2), spin(math.pi, 0.8 * m["w"], m["w"]))
        runs.append(dict(command=command, load=0.0 if k % 2 else load, pose=pose, tracked=True))
        pose = end_pose(command, pose)
    return runs


def out_and_back(rng, m, count):
    """A line out, a turn, the line back, a turn; speeds and payloads vary from run to run."""
    runs = []
    for k in range(count):
        speed, length = m["v"] * rng.choice([0.4, 0.7, 1.0]), 3.5 * m["v"] * factor(rng)
        turn = spin(rng.choice([-1, 1]) * math.pi, 0.8 * m["w"], 1.2 * m["w"])
        line = straight(length, speed, m["a"] * factor(rng))
        runs.append(dict(command=joined(line, turn, line, turn), load=rng.choice([0, 0.5, 1]) * m["load"], pose=(0, 0, 0), tracked=True))
    return runs


def shuttle(rng, m, count):
    """Straight lines alone, forward out and backward home."""
    runs = []
    for k in range(count):
        speed, length = m["v"] * rng.choice([0.3, 0.6, 1.0]), 4 * m["v"] * factor(rng)
        home = straight(-length, 0.7 * speed, m["a"])
        runs.append(dict(command=joined(straight(length, speed, m["a"] * factor(rng), 0.3), stand(1), home),
                         load=rng.choice([0, 0.6, 1]) * m["load"], pose=(0, 0, 0), tracked=True))
    return runs


def eights(rng, m, count):
    """Figures of eight at several speeds, radii and payloads."""
    runs = []
    for k in range(count):
        radius, speed = m["v"] * rng.choice([0.7, 1.0]), m["v"] * rng.choice([0.4, 0.6, 0.8])
        circle, side = 2 * math.pi * radius, rng.choice([-1, 1])
        figure = bent([(circle, side / radius), (circle, -side / radius)], speed, m["a"], 0.3)
        runs.append(dict(command=joined(figure), load=rng.choice([0, 0.5, 1]) * m["load"], pose=(0, 0, 0), tracked=True))
    return runs


def joysticks(rng, m, count):
    """Driven by hand, two payloads."""
    return [dict(command=joystick(rng, m, rng.uniform(18, 30)), load=rng.choice([0, 0.8]) * m["load"], pose=(0, 0, rng.uniform(-3, 3)))
            for _ in range(count)]


def scurve(rng, m, count):
    """Lines and bends with a bounded jerk at three speeds, as a drive's own profile generator makes them."""
    runs = []
    for k in range(count):
        speed, side = m["v"] * (0.35, 0.65, 1.0)[k % 3], rng.choice([-1, 1])
        line = straight(4 * m["v"] * factor(rng), speed, m["a"], 0.6)
        curve = arc(side * 2.5, 1.3 * m["v"], 0.7 * speed + 0.1 * m["v"], m["a"], 0.6)
        turn = spin(-side * 2.0, 0.6 * m["w"], m["w"])
        runs.append(dict(command=joined(line, (curve, turn)[k % 2]), load=rng.choice([0, 0.5, 1]) * m["load"], pose=(0, 0, side)))
    return runs


def end_pose(command, pose):
    """Where a command ends that is followed exactly: x and y in m, heading in rad."""
    x, y, heading = path_of(command, pose)
    return x[-1], y[-1], heading[-1]


def path_of(command, pose):
    """(x, y, heading) at each tick of a command that is followed exactly."""
    v, w = command
    heading = pose[2] + np.concatenate([[0.0], np.cumsum(w[:-1]) * TICK_s])
    middle = heading + 0.5 * TICK_s * w
    x = pose[0] + np.cumsum(v * np.cos(middle)) * TICK_s
    y = pose[1] + np.cumsum(v * np.sin(middle)) * TICK_s
    return x, y, heading


MAKERS = {"testday": testday, "missions": missions, "out_and_back": out_and_back, "shuttle": shuttle, "eights": eights,
          "joystick": joysticks, "scurve": scurve}


def parsed(protocol):
    """(kind, runs) of `missions:16`, of a kind alone (18 runs), or of a number alone (a test day)."""
    kind, _, count = protocol.partition(":")
    if kind.isdigit():
        return "testday", int(kind)
    if kind not in KINDS:
        raise SystemExit(f"blind_field: no day {kind}; there are {', '.join(KINDS)}")
    return kind, int(count or 18)


def day(protocol, m, rng):
    """The runs of a day; start times in s of the day, with a pause between the runs."""
    kind, count = parsed(protocol)
    runs = MAKERS[kind](rng, m, count)
    stated(runs, m, rng)
    return runs


def stated(runs, m, rng):
    """Times of day, and payloads as a scale shows them (kg, one decimal)."""
    clock = 0.0
    for run in runs:
        run["load"], run["start_s"] = round(float(run["load"]), 1), round(clock)
        clock += len(run["command"][0]) * TICK_s + rng.uniform(5, 40)


def asked_leg(leg, m):
    """(speed, yaw rate) of one leg of a proposed run; keys as in a mission's `motion:`."""
    number = lambda key, default: float(leg.get(key, default))
    speed, rise = number("speed_m_s", 0.6 * m["v"]), number("acceleration_m_s2", m["a"])
    rate, sign = number("yaw_rate_rad_s", 0.6 * m["w"]), -1 if leg.get("direction") == "reverse" else 1
    profile = leg.get("profile")
    if profile == "stand":
        return stand(number("duration_s", 5))
    if profile == "spin":
        return spin(number("angle_rad", math.pi), rate, number("yaw_acceleration_rad_s2", m["w"]))
    if profile == "arc":
        return arc(number("angle_rad", 3.0), abs(number("radius_m", 1.0)), speed, rise)
    if profile == "constant_ramp":
        speed = rise * number("ramp_s", speed / rise)
    return straight(sign * number("distance_m", 3), speed, rise)


def asked(text, m):
    """More runs: legs `key:value,...` joined by `+`, runs by `;`."""
    runs = []
    for description in text.split(";"):
        legs = [dict(part.split(":", 1) for part in leg.split(",")) for leg in description.split("+")]
        moves = [asked_leg(leg, m) for leg in legs for _ in range(int(float(leg.get("repeat", 1))))]
        runs.append(dict(command=joined(*moves), load=float(legs[0].get("payload_kg", 0)), pose=(0, 0, 0)))
    return runs

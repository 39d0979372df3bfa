"""The Husky A200 of `husky_borealtc`: a skid steer on five terrains. Its turns are scrub; it is calibrated on straight
driving alone, so that what a terrain takes in turns shows as an effect."""
import recordings
from recordings import SIDES, mean

FOLDER = "husky_borealtc"
PERIOD_s = 0.1538
STRETCH_s, LEAST_s = 10, 4
RADIUS_m = 0.13
REST_A = 0.59              # reading at rest
TORQUE_PER_AMPERE = 78.71 * 0.044
CLEAR_TURN_rad_s = 1.0
STRAIGHT_m_s = 0.005
MOST_RUNS = 24  # of a kind
TERRAINS = {"ASPHALT": "hard, outdoors", "FLOORING": "hard, indoors, with spins", "ICE": "slippery: little scrub",
            "SANDY_LOAM": "soft: more rolling, scrub", "SNOW": "deep: most rolling"}

COLUMNS = """
  time_s: {from: time}
  wheel_speed_left_rad_s: {from: velL, scale: 7.692307692}
  wheel_speed_right_rad_s: {from: velR, scale: 7.692307692}
  motor_current_left_A: {from: curL, offset: -0.59, unsigned: true}
  motor_current_right_A: {from: curR, offset: -0.59, unsigned: true}"""


def kind_of(row):
    """rest, straight, spin, or arc. In an arc the inner side may brake, which a current without sign cannot show."""
    left, right = float(row["velL"]), float(row["velR"])
    if abs(left) < 0.05 and abs(right) < 0.05:
        return "rest"
    if abs(left - right) < 0.08:
        return "straight"
    return "spin" if left * right < 0 and abs(left + right) < 0.5 * abs(left - right) else "arc"


def pieces(rows, kind):
    """Stretches of one kind of motion, LEAST_s to STRETCH_s long."""
    out, current = [], []
    for row in rows + [None]:
        if row is not None and kind_of(row) == kind and len(current) * PERIOD_s < STRETCH_s:
            current.append(row)
            continue
        if len(current) * PERIOD_s >= LEAST_s:
            out.append(current)
        current = [row] if row is not None and kind_of(row) == kind else []
    return out


def is_straight(piece):
    """Forward, and straight on the whole: a skid steer that drifts by a hundredth of a radian per second scrubs in full."""
    left, right = (mean([float(row[key]) for row in piece]) for key in ("velL", "velR"))
    return left > 0.1 and abs(left - right) < STRAIGHT_m_s


def load(data, terrain):
    """{kind: stretches}, at most MOST_RUNS of each kind, spread over all recordings; and how many recordings there are."""
    logs = [recordings.rows_of(path) for path in sorted((data / FOLDER / terrain).glob("pro_*.csv"))]
    found = {kind: [piece for log in logs for piece in pieces(log, kind)] for kind in ("straight", "spin")}
    found["straight"] = [piece for piece in found["straight"] if is_straight(piece)]
    return {kind: every[::-(-len(every) // MOST_RUNS) or 1] for kind, every in found.items()}, len(logs)


def windows(rows, size=6):
    """{side: [Window]} of about a second each, of a stretch of one kind."""
    out = {side: [] for side in SIDES}
    for k in range(0, len(rows) - size, size // 2):
        part = rows[k:k + size]
        speed = [[float(r["velL"]) / RADIUS_m for r in part], [float(r["velR"]) / RADIUS_m for r in part]]
        if any(min(s) * max(s) <= 0 or abs(mean(s)) < 0.5 for s in speed):
            continue
        current = [mean([max(0.0, float(r[key]) - REST_A) for r in part]) for key in ("curL", "curR")]
        slope = [(mean(s[size // 2:]) - mean(s[:size // 2])) / (size // 2 * PERIOD_s) for s in speed]
        pair = recordings.pair_of_windows([mean(s) for s in speed], slope, CLEAR_TURN_rad_s, current)
        for side in SIDES:
            out[side].append(pair[side])
    return out

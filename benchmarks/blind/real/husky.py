"""The Husky A200 of `husky_borealtc`: a skid steer on five terrains. Its turns are scrub; it is calibrated on straight
driving alone, so that what a terrain takes in turns shows as an effect."""
import answers
import calibration
import recordings
import workspace
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
MASS_kg, GRAVITY_m_s2, HALF_TRACK_m = 70.0, 9.81, 0.55
NORMAL = "FLOORING"        # indoors and flat; asphalt is outdoors, on slopes that nobody measured
TERRAINS = {"FLOORING": "scrub in spins, nothing else", "ASPHALT": "hard: scrub in spins, nothing else", "ICE": "slippery: little scrub",
            "SANDY_LOAM": "soft: scrub and some rolling", "SNOW": "deep: most rolling, little scrub"}
# Relative deviations of what the calibration cannot see.
UNSEEN = {"viscous_friction_Nm_s_rad": 0.3, "chassis_mass_kg": 0.1, "chassis_yaw_inertia_kg_m2": 0.5, "wheel_axle_inertia_kg_m2": 0.5,
          "wheel_radius_m": 0.01, "half_track_m": 0.1, "torque_constant_Nm_A": 0.03}

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


def without_repeats(stretches):
    """Two recordings of SNOW hold the same samples in part: a stretch counts once."""
    readings = lambda piece: tuple(tuple(row[key] for key in ("velL", "velR", "curL", "curR")) for row in piece)
    return list({readings(piece): piece for piece in stretches}.values())


def load(data, terrain):
    """{kind: stretches}, at most MOST_RUNS of each kind, spread over all recordings; and how many recordings there are."""
    logs = [recordings.rows_of(path) for path in sorted((data / FOLDER / terrain).glob("pro_*.csv"))]
    found = {kind: [piece for log in logs for piece in pieces(log, kind)] for kind in ("straight", "spin")}
    found["straight"] = [piece for piece in found["straight"] if is_straight(piece)]
    found = {kind: without_repeats(every) for kind, every in found.items()}
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


def mean_torque(pieces):
    """Mean torque of both sides together, N m, over all windows; None where there are none."""
    found = [TORQUE_PER_AMPERE * w.current for piece in pieces for side in SIDES for w in windows(piece)[side]]
    return 2 * mean(found) if found else None


def measured(pieces, normal_Nm):
    """(rolling coefficient beyond the normal floor's, yaw moment of a spin beyond straight driving) from mean currents."""
    straight, spin = mean_torque(pieces["straight"]), mean_torque(pieces["spin"])
    rolling = (straight - normal_Nm) / (MASS_kg * GRAVITY_m_s2 * RADIUS_m)
    return rolling, (spin - straight) * HALF_TRACK_m / RADIUS_m


def said(answer):
    """(rolling coefficient, scrub moment) that the diagnosis names; a Coulomb torque counts as the rolling that looks the same."""
    rolling = answers.value_of(answer, "rolling_resistance", "coefficient")
    torque = answers.value_of(answer, "coulomb_friction", "torque_Nm")
    if rolling is None and torque is not None:
        rolling = 2 * torque / (MASS_kg * GRAVITY_m_s2 * RADIUS_m)
    return rolling, answers.value_of(answer, "turning_scrub", "moment_Nm")


def section(data, scratch):
    """Lines of the report."""
    normal, logs = load(data, NORMAL)
    drive = calibration.calibrate([windows(piece) for piece in normal["straight"][::2]], TORQUE_PER_AMPERE, ("left", "right", "straight"))
    drive.scatter /= logs**0.5  # of the mean over recordings
    robot = scratch / "husky.yaml"
    robot.write_text(calibration.robot_text(workspace.ROOT / "scenarios" / "robots" / "husky_a200.yaml", drive, UNSEEN))
    lines = [f"Data checksum {recordings.checksum(data / FOLDER)}. Runs are stretches of {LEAST_s} to {STRETCH_s} s of straight driving or of spins. Calibrated on straight driving on "
             f"every other stretch of {NORMAL}: friction {drive.friction[0]:.2f}, {drive.friction[1]:.2f} N m, {100 * drive.scatter:.0f} % uncertain. No voltage, no pose, no sign of the "
             "current, 6.5 Hz: energies are what the currents take by the robot file's winding.", "", answers.TITLE]
    compared = ["| terrain | rolling coefficient beyond normal: mean current | diagnosis | scrub moment of a spin, N m: mean current | diagnosis |", "|---|---|---|---|---|"]
    normal_Nm = mean_torque(normal["straight"][::2])
    number = lambda value, digits: "–" if value is None else f"{value:.{digits}f}"
    for terrain, cause in TERRAINS.items():
        pieces = load(data, terrain)[0] if terrain != NORMAL else {kind: every[1::2] for kind, every in normal.items()}
        runs = pieces["straight"] + pieces["spin"]
        place = scratch / f"husky_{terrain}"
        answer = answers.diagnose(recordings.write_set(place, robot, COLUMNS, runs), place / "out")
        name = terrain + (", the other half" if terrain == NORMAL else "")
        lines.append(answers.row(f"{name} ({len(pieces['straight'])} straight, {len(pieces['spin'])} spins)", cause, answer))
        (rolling, moment), (rolling_said, moment_said) = measured(pieces, normal_Nm), said(answer)
        compared.append(f"| {name} | {rolling:.3f} | {number(rolling_said, 3)} | {moment:.0f} | {number(moment_said, 0)} |")
    return lines + ["", "Against plain means of the currents (spins less straight driving; a moment of zero and below: the floor gives way):", ""] + compared

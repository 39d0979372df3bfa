"""A robot's constants from its normal condition, with deviations that cover the scatter between stretches.

Each wheel: Kt n i = T_m + nu |q'| + J q'' (signs of the motion), and where the voltage is known
V = V_d + Kv n q' + R i. Kt = Kv in SI units."""
import re

from recordings import SIDES, mean

LEAST_WINDOWS = 5  # of a stretch and side that shall say something about the scatter


def least_squares(rows, values):
    """Coefficients c of rows c = values by normal equations."""
    n = len(rows[0])
    system = [[sum(r[a] * r[b] for r in rows) for b in range(n)] + [sum(r[a] * v for r, v in zip(rows, values))] for a in range(n)]
    for p in range(n):
        pivot = max(range(p, n), key=lambda k: abs(system[k][p]))
        system[p], system[pivot] = system[pivot], system[p]
        for k in range(n):
            if k != p:
                factor = system[k][p] / system[p][p]
                system[k] = [u - factor * w for u, w in zip(system[k], system[p])]
    return [system[k][n] / system[k][k] for k in range(n)]


def deviation(values):
    center = mean(values)
    return (sum((v - center) ** 2 for v in values) / max(1, len(values) - 1)) ** 0.5


class Drive:
    """The fitted constants. `torque_rms` and `voltage_rms` are what is left over; `scatter` is the deviation of a
    stretch's friction, `spread` that of constants, relative; `scrub` is the torque on a wheel while the robot turns."""

    def __init__(self):
        self.friction, self.viscous, self.scrub = [0.0, 0.0], 0.0, 0.0
        self.straight_inertia = self.turning_inertia = 0.0
        self.torque_rms, self.voltage_rms, self.scatter, self.spread = 0.0, 1.0, 0.0, {}
        self.torque_per_ampere, self.ohm, self.drop_V = None, None, None


def fit_winding(drive, runs):
    """Kv n, R, V_d over all windows; deviations of the first two by leaving out a fifth of the stretches."""
    def fit(chosen):
        windows = [w for run in chosen for side in SIDES for w in run[side]]
        return least_squares([(w.speed, w.current * w.sign, w.sign) for w in windows], [w.voltage for w in windows])
    drive.torque_per_ampere, drive.ohm, drive.drop_V = whole = fit(runs)
    left = [w.voltage - drive.torque_per_ampere * w.speed - (drive.ohm * w.current + drive.drop_V) * w.sign
            for run in runs for side in SIDES for w in run[side]]
    drive.voltage_rms = mean([e * e for e in left]) ** 0.5
    parts = [fit([run for k, run in enumerate(runs) if k % 5 != fold]) for fold in range(5)]
    for c, key in enumerate(("torque_constant_Nm_A", "resistance_ohm")):
        drive.spread[key] = 2 * deviation([part[c] for part in parts]) / abs(whole[c])


TORQUES = {"left": lambda w, side: float(side == "left"), "right": lambda w, side: float(side == "right"),
           "viscous": lambda w, side: abs(w.speed), "straight": lambda w, side: w.straight_acceleration * w.sign,
           "turning": lambda w, side: w.turning_acceleration * w.sign, "scrub": lambda w, side: w.turn * w.sign}


def fit_friction(drive, runs, terms):
    """T_m of both sides and the other `terms` (keys of TORQUES) from the currents; the scatter of T_m between stretches."""
    entries = [(k, side, w) for k, run in enumerate(runs) for side in SIDES for w in run[side]]
    rows = [[TORQUES[term](w, side) for term in terms] for _, side, w in entries]
    torques = [drive.torque_per_ampere * w.current for _, _, w in entries]
    solved = dict(zip(terms, least_squares(rows, torques)))
    if solved.get("viscous", 0.0) < 0:
        return fit_friction(drive, runs, [term for term in terms if term != "viscous"])
    drive.friction = [solved["left"], solved["right"]]
    drive.viscous, drive.scrub = solved.get("viscous", 0.0), solved.get("scrub", 0.0)
    drive.straight_inertia, drive.turning_inertia = solved["straight"], solved.get("turning", 0.0)
    left = {}
    for (k, side, _), row, torque in zip(entries, rows, torques):
        left.setdefault((k, side), []).append(torque - sum(solved[term] * x for term, x in zip(terms, row)))
    drive.torque_rms = mean([e * e for errors in left.values() for e in errors]) ** 0.5
    drive.scatter = deviation([mean(errors) / drive.friction[SIDES.index(side)]
                               for (_, side), errors in left.items() if len(errors) >= LEAST_WINDOWS])


def calibrate(runs, torque_per_ampere=None, terms=tuple(TORQUES)):
    """`runs` is a list of {side: [Window]}, one per stretch; without `torque_per_ampere` it is taken from the voltages."""
    drive = Drive()
    if torque_per_ampere is None:
        fit_winding(drive, runs)
    else:
        drive.torque_per_ampere = torque_per_ampere
    fit_friction(drive, runs, list(terms))
    return drive


def number_at(text, key):
    return float(re.search(rf"\b{key}: ([0-9.e+-]+)", text)[1])


def replaced(text, values):
    for key, value in values.items():
        text = re.sub(rf"\b{key}: (\{{[^}}]*\}}|[0-9.e+-]+)", f"{key}: {value}", text, count=1)
    return text


def inertias(text, drive):
    """Masses that stand for the inertias seen at the wheels: J = m r^2/2 + I_w, D = I r^2/(2 l^2) + I_w."""
    radius, half_track = number_at(text, "wheel_radius_m"), number_at(text, "half_track_m")
    wheel = min(number_at(text, "wheel_axle_inertia_kg_m2"), 0.1 * drive.straight_inertia)
    wheels_kg = 2 * number_at(text, "wheel_mass_kg")
    mass = 2 * (drive.straight_inertia - wheel) / radius**2 - wheels_kg
    yaw = 2 * (drive.turning_inertia - wheel) * (half_track / radius)**2 - wheels_kg * half_track**2
    return {"wheel_axle_inertia_kg_m2": f"{wheel:.4g}", "chassis_mass_kg": f"{max(mass, 0.1):.4g}",
            "chassis_yaw_inertia_kg_m2": f"{max(yaw, 1e-3):.4g}"}


def robot_text(template, drive, others):
    """The robot file with the drive's constants, its scrub and drop as effects, and `uncertainty:` (of what was fitted
    the deviations found, of the rest what `others` says)."""
    text = template.read_text()
    text = replaced(text, {"friction_torque_Nm": f"{{left: {drive.friction[0]:.5g}, right: {drive.friction[1]:.5g}}}",
                           "viscous_friction_Nm_s_rad": f"{max(drive.viscous, 1e-6):.4g}"})
    effects = []
    if drive.ohm is not None:
        constant = f"{drive.torque_per_ampere / number_at(text, 'gear_ratio'):.5g}"
        text = replaced(text, {"torque_constant_Nm_A": constant, "voltage_constant_V_s_rad": constant,
                               "resistance_ohm": f"{drive.ohm:.4g}", **inertias(text, drive)})
        effects.append(f"  - driver_voltage_drop: {{voltage_V: {max(drive.drop_V, 1e-3):.4g}}}")
    if drive.scrub > 0:
        moment = drive.scrub * 2 * number_at(text, "half_track_m") / number_at(text, "wheel_radius_m")
        effects.append(f"  - turning_scrub: {{moment_Nm: {moment:.4g}}}")
    uncertainty = {**others, **drive.spread, "friction_torque_Nm": drive.scatter}
    return (text + ("effects:\n" + "\n".join(effects) + "\n" if effects else "")
            + "uncertainty: {" + ", ".join(f"{key}: {value:.3g}" for key, value in uncertainty.items()) + "}\n")

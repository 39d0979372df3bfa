"""The Kobuki of `kobuki_wheelslip`: what its columns mean, and its sets.

Its current sensors sit on the supply's side of the driver: motor current = reading / duty. Taken so, the winding's
equation V = V_d + Kv n q' + R i holds with the same Kv n in all five recordings, with duty times battery as V."""
import itertools
import math

import answers
import calibration
import recordings
import workspace
from recordings import SIDES, Window, mean

FOLDER = "kobuki_wheelslip"
PERIOD_s = 0.02
TICK_RAD = 0.0024369169
STRETCH_s = 4
CLEAR_TURN_rad_s = 1.0  # difference of the wheels' speeds from which scrub has its full size
LEAST_DUTY = 0.05    # below it the reading is divided by next to nothing
CURRENT = {"left": "field.current0", "right": "field.current1"}

COLUMNS = """
  time_s: {from: field.time_stamp, scale: 0.001, wraps_at: 65536}
  wheel_speed_left_rad_s: {from: field.left_encoder, scale: 0.0024369169, wraps_at: 65536, derivative: true}
  wheel_speed_right_rad_s: {from: field.right_encoder, scale: 0.0024369169, wraps_at: 65536, derivative: true}
  motor_current_left_A: {from: motor_current_left, unsigned: true, delay_s: DELAY}
  motor_current_right_A: {from: motor_current_right, unsigned: true, delay_s: DELAY}
  motor_voltage_left_V: {from: motor_voltage_left, delay_s: DELAY}
  motor_voltage_right_V: {from: motor_voltage_right, delay_s: DELAY}"""

# Relative deviations of what the calibration cannot see.
UNSEEN = {"viscous_friction_Nm_s_rad": 0.3, "chassis_mass_kg": 0.1, "chassis_yaw_inertia_kg_m2": 0.3,
          "wheel_axle_inertia_kg_m2": 0.5, "wheel_radius_m": 0.01, "half_track_m": 0.02}
SETS = [("left_faulty", "fault of the left wheel (slip)"), ("right_faulty", "fault of the right wheel (slip)"),
        ("both_faulty", "fault of both wheels (slip)"), ("faulty", "unnamed; the right current is ten times normal")]


def with_motor_side(rows, late=0):
    """The rows with what each motor sees: voltage = duty times battery, |current| = reading of `late` rows later / |duty|."""
    for k, row in enumerate(rows):
        battery_V = int(row["field.battery"]) * 0.1
        for side in SIDES:
            percent = int(row[f"field.{side}_pwm"])
            duty = (percent - 256 if percent > 127 else percent) / 100
            reading_A = int(rows[min(k + late, len(rows) - 1)][CURRENT[side]]) * 0.01
            row[f"motor_voltage_{side}"] = f"{duty * battery_V:.4f}"
            row[f"motor_current_{side}"] = f"{reading_A / abs(duty) if abs(duty) >= LEAST_DUTY else 0.0:.5f}"
    return rows


def load(data, name, late):
    rows = with_motor_side(recordings.rows_of(data / FOLDER / name / "mobile_base_sensors_core.csv"), late)
    moves = lambda piece: any(float(r["motor_current_left"]) + float(r["motor_current_right"]) > 0 for r in piece[10:])
    return recordings.stretches(rows, STRETCH_s, PERIOD_s, moves)


def windows(rows, delay=0, size=16):
    """{side: [Window]} of a third of a second each, each wheel turning one way; electrical readings `delay` rows later."""
    out, half = {side: [] for side in SIDES}, size // 2
    between = lambda key, a, b: ((int(rows[b][key]) - int(rows[a][key]) + 32768) % 65536) - 32768
    for k in range(max(0, -delay), len(rows) - size - max(0, delay), half):
        clock_s = between("field.time_stamp", k, k + size) / 1000
        if abs(clock_s - size * PERIOD_s) > 0.1:
            continue
        halves = [[between(f"field.{side}_encoder", a, a + half) * TICK_RAD / (clock_s / 2) for a in (k, k + half)] for side in SIDES]
        electrical = rows[k + delay:k + delay + size]
        voltages = [[float(r[f"motor_voltage_{side}"]) for r in electrical] for side in SIDES]
        currents = [mean([float(r[f"motor_current_{side}"]) for r in electrical]) for side in SIDES]
        pair = recordings.pair_of_windows([mean(h) for h in halves], [(h[1] - h[0]) / (clock_s / 2) for h in halves],
                                          CLEAR_TURN_rad_s, currents, [mean(v) for v in voltages])
        for side, volts in zip(SIDES, voltages):
            if abs(pair[side].speed) > 0.7 and min(volts) * max(volts) > 0 and min(map(abs, volts)) > 0.9:
                out[side].append(pair[side])
    return out


def calibrate(data):
    """The normal recording: (drive, its stretches, rows that the reading is late, rows that the electrical channels are early).

    Both shifts are those that leave the least of voltages and torques on every other stretch."""
    def fit(late, early):
        stretches = load(data, "nonfaulty", late)
        drive = calibration.calibrate([windows(piece, -early) for piece in stretches[::2]])
        return math.log(drive.voltage_rms * drive.torque_rms), late, early, drive, stretches
    _, late, early, drive, stretches = min((fit(*shifts) for shifts in itertools.product(range(3), range(-2, 7))), key=lambda f: f[0])
    return drive, stretches, late, early


def extra_torques(pieces, early, normal):
    """Friction beyond the normal one by side, N m, from a regression of the currents; what the diagnosis is compared with."""
    drive = calibration.calibrate([windows(piece, -early) for piece in pieces])
    return [found - usual for found, usual in zip(drive.friction, normal.friction)]


def section(data, scratch):
    """Lines of the report."""
    drive, normal, late, early = calibrate(data)
    robot = scratch / "kobuki.yaml"
    robot.write_text(calibration.robot_text(workspace.ROOT / "scenarios" / "robots" / "kobuki.yaml", drive, UNSEEN))
    columns = COLUMNS.replace("DELAY", f"{-early * PERIOD_s:.2f}")
    sets = [("nonfaulty, the other half", "none", normal[1::2])]
    sets += [(name, cause, load(data, name, late)) for name, cause in SETS]
    lines = [f"Data checksum {recordings.checksum(data / FOLDER)}. Runs are stretches of {STRETCH_s} s. Calibrated on every other stretch of `nonfaulty`: "
             f"friction {drive.friction[0]:.4f}, {drive.friction[1]:.4f} N m (scatter between stretches {100 * drive.scatter:.0f} %), viscous {drive.viscous:.4f} N m s/rad, "
             f"scrub {drive.scrub:.4f} N m per wheel in turns, Kv n {drive.torque_per_ampere:.3f} V s/rad, R {drive.ohm:.1f} ohm, driver's drop {drive.drop_V:.2f} V; "
             f"the current's reading is {1000 * late * PERIOD_s:.0f} ms late on the duty, both are {1000 * early * PERIOD_s:.0f} ms ahead of the encoders.", "",
             answers.TITLE]
    beyond = ["| set | friction beyond normal, left, N m | right, N m |", "|---|---|---|"]
    for name, cause, pieces in sets:
        place = scratch / ("kobuki_" + name.split(",")[0])
        answer = answers.diagnose(recordings.write_set(place, robot, columns, pieces), place / "out")
        lines.append(answers.row(f"{name} ({len(pieces)} runs)", cause, answer))
        left, right = extra_torques(pieces, early, drive)
        beyond.append(f"| {name} | {left:+.4f} | {right:+.4f} |")
    return lines + ["", "The same by a regression of the motor currents on friction, speed, accelerations and turning, set by set:", ""] + beyond

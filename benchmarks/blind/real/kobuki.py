"""The Kobuki of `kobuki_wheelslip`: what its columns mean, and its sets.

Its current sensors sit on the supply's side of the driver: motor current = reading / duty. Taken so, the winding's
equation V = V_d + Kv n q' + R i holds with the same Kv n in all five recordings, with duty times battery as V."""
import recordings
from recordings import SIDES, Window, mean

FOLDER = "kobuki_wheelslip"
PERIOD_s = 0.02
TICK_RAD = 0.0024369169
STRETCH_s = 6
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

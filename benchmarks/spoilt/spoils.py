"""The usual ways to spoil a channel of a log, and the names by which a data check is right about each."""
import csv
import math
import random

SIDES = ("left", "right")
SPEED, VOLTAGE, CURRENT = ([f"{name}_{side}_{unit}" for side in SIDES]
                           for name, unit in (("wheel_speed", "rad_s"), ("motor_voltage", "V"), ("motor_current", "A")))


def scaled(columns, factor):
    def spoil(rows):
        for row in rows:
            for column in columns:
                row[column] *= factor
    return spoil


def swapped(*pairs):
    def spoil(rows):
        for row in rows:
            for left, right in pairs:
                row[left], row[right] = row[right], row[left]
    return spoil


def dead(column, value=0.0, noise=0.0):
    def spoil(rows):
        draw = random.Random(1)
        for row in rows:
            row[column] = value + draw.gauss(0, noise) if noise else value
    return spoil


def degrees(column):
    def spoil(rows):
        for row in rows:
            row[column] *= 180 / math.pi
    return spoil


def spoils():
    """name -> (kinds that are right, columns of which the check must hold one, what it does to the rows)."""
    ways = {}
    for side in (0, 1):
        ways[f"current {SIDES[side]} inverted"] = (("inverted",), [CURRENT[side]], scaled([CURRENT[side]], -1))
        ways[f"voltage {SIDES[side]} inverted"] = (("inverted",), [VOLTAGE[side]], scaled([VOLTAGE[side]], -1))
        ways[f"wheel speed {SIDES[side]} inverted"] = (("inverted",), [SPEED[side]], scaled([SPEED[side]], -1))
        ways[f"current {SIDES[side]} in mA"] = (("unit",), [CURRENT[side]], scaled([CURRENT[side]], 1e3))
    ways["currents inverted"] = (("inverted",), CURRENT, scaled(CURRENT, -1))
    ways["gyro inverted"] = (("inverted",), ["gyro_yaw_rate_rad_s"], scaled(["gyro_yaw_rate_rad_s"], -1))
    ways["heading inverted"] = (("inverted",), ["heading_rad"], scaled(["heading_rad"], -1))
    ways["battery current inverted"] = (("inverted",), ["battery_current_A"], scaled(["battery_current_A"], -1))
    ways["currents swapped"] = (("swapped",), CURRENT, swapped(CURRENT))
    ways["voltages swapped"] = (("swapped",), VOLTAGE, swapped(VOLTAGE))
    ways["wheel speeds swapped"] = (("swapped",), SPEED, swapped(SPEED))
    ways["sides swapped"] = (("swapped",), SPEED, swapped(SPEED, VOLTAGE, CURRENT))
    ways["current dead"] = (("dead",), [CURRENT[1]], dead(CURRENT[1]))
    ways["current dead but for noise"] = (("dead",), [CURRENT[0]], dead(CURRENT[0], 0.0, 0.01))
    ways["current stuck"] = (("dead",), [CURRENT[0]], dead(CURRENT[0], 0.7))
    ways["voltage dead"] = (("dead",), [VOLTAGE[0]], dead(VOLTAGE[0]))
    ways["wheel speed dead"] = (("dead",), [SPEED[0]], dead(SPEED[0]))
    ways["gyro dead"] = (("dead",), ["gyro_yaw_rate_rad_s"], dead("gyro_yaw_rate_rad_s"))
    ways["battery current dead"] = (("dead",), ["battery_current_A"], dead("battery_current_A"))
    ways["wheel speeds in rpm"] = (("unit", "scaled"), SPEED, scaled(SPEED, 30 / math.pi))
    ways["wheel speeds in deg/s"] = (("unit", "scaled"), SPEED, scaled(SPEED, 180 / math.pi))
    ways["currents in mA"] = (("unit",), CURRENT, scaled(CURRENT, 1e3))
    ways["voltages in mV"] = (("unit",), VOLTAGE, scaled(VOLTAGE, 1e3))
    ways["gyro in deg/s"] = (("unit", "scaled"), ["gyro_yaw_rate_rad_s"], degrees("gyro_yaw_rate_rad_s"))
    ways["heading in degrees"] = (("unit", "scaled"), ["heading_rad"], degrees("heading_rad"))
    ways["position in mm"] = (("unit",), ["position_x_m"], scaled(["position_x_m", "position_y_m"], 1e3))
    ways["clock in ms"] = (("clock", "unit"), ["time_s"], scaled(["time_s"], 1e3))
    ways["currents times 3"] = (("scaled",), CURRENT, scaled(CURRENT, 3))
    ways["current right times 0.3"] = (("scaled",), [CURRENT[1]], scaled([CURRENT[1]], 0.3))
    ways["gyro times 0.3"] = (("scaled",), ["gyro_yaw_rate_rad_s"], scaled(["gyro_yaw_rate_rad_s"], 0.3))
    return ways


LEAST_TURN_rad_s = 0.3  # rms difference of the wheels' speeds in a run that turns
SHOWN_BY_TURNS = ("gyro inverted", "gyro times 0.3", "heading inverted", "sides swapped", "wheel speeds swapped", "voltages swapped",
                  "currents swapped")


def shows(way, rows):
    """Whether a run can show the way: without turns a gyro and a heading read noise, and both sides are equal."""
    turned = math.sqrt(sum((row[SPEED[1]] - row[SPEED[0]]) ** 2 for row in rows) / len(rows))
    return way not in SHOWN_BY_TURNS or turned >= LEAST_TURN_rad_s


def read_rows(path):
    with open(path, newline="") as file:
        return [{key: float(value) for key, value in row.items()} for row in csv.DictReader(file)]


def write_rows(path, rows):
    with open(path, "w", newline="") as file:
        writer = csv.DictWriter(file, rows[0].keys())
        writer.writeheader()
        writer.writerows({key: repr(value) for key, value in row.items()} for row in rows)

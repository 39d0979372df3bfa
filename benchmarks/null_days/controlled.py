"""Days of a robot under a motor controller, logged by the instruments that users have.

Shares no code and no numerics with the product: dry friction is an impulse that holds or lets go (Moreau's time stepping),
currents are states with inductance, a sampled PI controller reads an encoder's counts and follows commands that a path
follower corrects, the battery discharges through its internal resistance. A day repeats two missions. The robot differs from
its file by errors of the sizes that the file states. Needs python3 (standard library only).
"""
import math
import random

STEP_S = 0.002
CONTROL, LOG, SLOW = 5, 10, 50  # steps between calls of the controller, usual rows of the drive's log, rows of battery and pose
CALL_S = STEP_S * CONTROL
UNCERTAIN = {"friction_torque_Nm": 0.03, "viscous_friction_Nm_s_rad": 0.1, "resistance_ohm": 0.02, "torque_constant_Nm_A": 0.01,
             "chassis_mass_kg": 0.01, "chassis_yaw_inertia_kg_m2": 0.05, "wheel_radius_m": 0.004, "half_track_m": 0.01, "payload_kg": 0.02}
# ASSUMED, all: a laboratory robot, a warehouse robot and a small one, in the units of a robot file.
ROBOTS = {
    "laboratory": dict(r=0.1, l=0.165, m=21.2, mw=1.39, J=0.5, jp=0.02, Iw=0.0281, Id=0.007, n=24.9, R=2.74, K=0.069, nu=0.0017, T=0.36,
                       U_max=24.0, I_max=8.0, standby=10.0, Wh=240.0, U=25.0, Ri=0.05, L=2.6e-3, load=8.0, v=0.7, w=1.0, scale=1.0),
    "warehouse": dict(r=0.13, l=0.25, m=144.0, mw=3.0, J=12.3, jp=0.03, Iw=0.047, Id=0.013, n=12.0, R=0.3, K=0.1135, nu=0.02, T=2.0,
                      U_max=24.0, I_max=25.0, standby=60.0, Wh=1200.0, U=25.6, Ri=0.03, L=0.5e-3, load=40.0, v=1.0, w=0.8, scale=1.5),
    "small": dict(r=0.036, l=0.115, m=5.2, mw=0.2, J=0.04, jp=0.01, Iw=6e-4, Id=1e-4, n=50.0, R=3.2, K=0.0125, nu=0.0012, T=0.05,
                  U_max=12.0, I_max=3.0, standby=4.0, Wh=40.0, U=12.4, Ri=0.12, L=1e-3, load=1.5, v=0.45, w=1.2, scale=0.7)}
ACCELERATION, YAW_ACCELERATION = 0.4, 1.5
EMPTYING = dict(pause_s=240, charge=0.6, drain=3)  # the battery's state of charge falls by a third
# What differs from a plain day of 12 runs. Each kind is driven by the three robots.
KINDS = {
    "6 runs": dict(runs=6),
    "discharging battery, 20 runs": dict(runs=20, **EMPTYING),
    "60 runs": dict(runs=60, pause_s=60, charge=0.7),
    "wheel speeds behind a filter of 80 ms": dict(filter_s=0.08),
    "coarse encoders behind a filter of 50 ms": dict(ticks=1024, filter_s=0.05),
    **{f"encoders of 512 ticks{behind} at {rate} Hz": dict(ticks=512, log=round(1 / STEP_S / rate), filter_s=filter_s)
       for behind, filter_s in (("", 0.0), (" behind a filter of 60 ms", 0.06)) for rate in (20, 50, 100)},
    "gyro and wheel speeds half a sample apart": dict(gyro_at_end=True),
    "electrical logger 60 ms late": dict(clock_s=0.06),
    "dead band and stiction": dict(dead_band=0.02, stiction=1.5),
    "warm-up within the file's uncertainty": dict(runs=20, warm_up=0.05, pause_s=60),
    "payload not stated": dict(payload_stated=False),
    "one odd run of twenty": dict(runs=20, odd_run=7),
    "battery and odometry": dict(battery_alone=True),
    "most of these together": dict(runs=20, filter_s=0.06, ticks=4000, dead_band=0.01, stiction=1.3, clock_s=0.04, **EMPTYING)}
SHORT = ("discharging battery, 20 runs", "gyro and wheel speeds half a sample apart")
# A late electrical logger is a delay, and a filter makes the wheel speeds late: this name is no false alarm there.
ALLOWED = {kind: {"time_misalignment"} for kind, day in KINDS.items() if day.get("clock_s") or day.get("filter_s")}


def sizes(robot):
    """Effects of the catalog at sizes beyond the calibration errors."""
    b = ROBOTS[robot]
    T, weight_N = b["T"], b["m"] * 9.81
    return {"coulomb_friction": 0.35 * T, "dragging_wheel": 0.5 * T, "viscous_friction": 0.3 * T * b["r"] / b["v"],
            "rolling_resistance": 0.7 * T / (weight_N * b["r"]), "winding_resistance_error": 0.25, "torque_constant_error": -0.08,
            "wheel_radius_error": -0.04, "time_misalignment": 0.09, "standby_power_error": 0.35 * b["standby"], "supply_sag": 6 * b["Ri"],
            "current_sensor_gain": 0.08, "current_sensor_offset": 0.01 * b["I_max"], "driver_voltage_drop": 0.03 * b["U_max"],
            "gear_efficiency": 0.12, "turning_scrub": 0.6 * T * b["l"] / b["r"], "floor_slope": 0.6 * T / (weight_N * b["r"])}


EFFECT_DAYS = (("laboratory", EMPTYING), ("warehouse", dict(filter_s=0.06)), ("small", dict(runs=16)))


def robot_text(b):
    uncertain = ", ".join(f"{key}: {value}" for key, value in UNCERTAIN.items())
    return f"""schema: joulepath/robot/1
name: robot
geometry: {{wheel_radius_m: {b['r']}, half_track_m: {b['l']}, center_of_mass_offset_m: 0.0}}
inertia: {{chassis_mass_kg: {b['m']}, wheel_mass_kg: {b['mw']}, chassis_yaw_inertia_kg_m2: {b['J']}, payload_yaw_inertia_m2: {b['jp']},
          wheel_axle_inertia_kg_m2: {b['Iw']}, wheel_diameter_inertia_kg_m2: {b['Id']}}}
motor: {{gear_ratio: {b['n']}, resistance_ohm: {b['R']}, torque_constant_Nm_A: {b['K']}, voltage_constant_V_s_rad: {b['K']},
        viscous_friction_Nm_s_rad: {b['nu']}, friction_torque_Nm: {b['T']}, max_voltage_V: {b['U_max']}, max_current_A: {b['I_max']}}}
limits: {{speed_m_s: {1.3 * b['v']:.3g}, acceleration_m_s2: 0.6, deceleration_m_s2: 0.6, lateral_acceleration_m_s2: 0.6,
         yaw_rate_rad_s: {1.5 * b['w']:.3g}, yaw_acceleration_rad_s2: 2.5, max_payload_kg: {1.5 * b['load']:.3g}}}
power: {{standby_W: {b['standby']}, regeneration_efficiency: 0.0}}
battery: {{capacity_Wh: {b['Wh']}, open_circuit_voltage_V: {b['U']}, internal_resistance_ohm: {b['Ri']}, reserve_fraction: 0.1}}
footprint: {{radius_m: {1.5 * b['l']:.3g}}}
uncertainty: {{{uncertain}}}
"""


def commands(b, which, rng):
    """Speed and yaw rate for each call of the controller: one of two missions, with the corrections of a path follower."""
    scale, speed, result = b["scale"] * rng.gauss(1, 0.01), b["v"] * rng.gauss(1, 0.015), []

    def ramp(way, most, rate):
        most = min(most, math.sqrt(way * rate))
        total = way / most + most / rate
        return [max(0.0, min(most, rate * min(k * CALL_S, total - k * CALL_S))) for k in range(round(total / CALL_S))]

    def stand(seconds):
        result.extend((0.0, 0.0) for _ in range(round(seconds * rng.uniform(0.8, 1.2) / CALL_S)))

    def spin(angle):
        result.extend((0.0, math.copysign(w, angle)) for w in ramp(abs(angle), b["w"], YAW_ACCELERATION))

    def line(way, share=1.0, angle=0.0):
        at, of_v, of_w, keep = len(result), 0.0, 0.0, math.exp(-CALL_S / 0.4)
        for v in ramp(scale * way, share * speed, ACCELERATION):
            of_v, of_w = (keep * x + math.sqrt(1 - keep * keep) * rng.gauss(0, 1) for x in (of_v, of_w))
            steered = v > 0.3 * b["v"]
            result.append((v + steered * 0.015 * b["v"] * of_v, v * angle / (scale * way) + steered * 0.025 * of_w))
        assert len(result) > at

    if which == 0:
        stand(1.5), line(2.5), spin(math.pi / 2), line(1.5, 0.7), stand(2), line(2, 0.8, -math.pi / 2), stand(1)
    else:
        stand(1), line(2, 0.7, math.pi / 2), stand(1.5), line(2), spin(-math.pi / 2), line(1.5, 0.6), spin(math.pi), stand(1.5)
    return result


def open_circuit_V(b, charge):
    """Of a lithium battery: a flat middle and a fall at the end."""
    return b["U"] * (0.985 + 0.03 * (charge - 0.5) + 0.01 * math.tanh((charge - 0.85) / 0.08) - 0.12 * math.exp(-charge / 0.06))


def machine(b, rng):
    """The robot as it is: constants off by what the file states."""
    off = {key: 1 + sigma * max(-2, min(2, rng.gauss(0, 1))) for key, sigma in UNCERTAIN.items()}
    of = dict(R="resistance_ohm", K="torque_constant_Nm_A", nu="viscous_friction_Nm_s_rad", r="wheel_radius_m", l="half_track_m",
              m="chassis_mass_kg", J="chassis_yaw_inertia_kg_m2", T="friction_torque_Nm", load="payload_kg")
    return {name: value * off[of[name]] if name in of else value for name, value in b.items()}


def drive(b, x, effect, day, load, number, start_s, charge, rng):
    """One run: rows of the drive's log and of the slow one, and the charge left. `b` is the file, `x` the machine."""
    e = lambda name: effect.get(name, 0.0)
    gravity, called = 9.81, commands(b, number % 2, rng)
    R = [x["R"] * (1 + e("winding_resistance_error")) * (1 + rng.gauss(0, 0.006)) for _ in range(2)]
    K = x["K"] * b["n"] * (1 + e("torque_constant_error"))
    nu, l, r = x["nu"] + e("viscous_friction"), x["l"], x["r"] * (1 + e("wheel_radius_error"))
    payload = load * x["load"] / b["load"]
    m = x["m"] + payload + 2 * b["mw"]
    J = x["J"] + b["jp"] * payload + 2 * b["mw"] * l * l + 2 * b["Id"]
    T = x["T"] * rng.gauss(1, 0.015) * (1 + day.get("warm_up", 0) * (math.exp(-start_s / 600) - 0.3))
    T = (T + e("coulomb_friction") + e("rolling_resistance") * m * gravity / 2 * r) * (1.8 if day.get("odd_run") == number else 1)
    T = [T + e("dragging_wheel"), T]
    standby, Ri = b["standby"] + e("standby_power_error"), effect.get("supply_sag", b["Ri"])
    loss, scrub, slope, drop = e("gear_efficiency"), STEP_S * e("turning_scrub"), e("floor_slope"), e("driver_voltage_drop")
    dead, stiction = day.get("dead_band", 0) * b["U_max"], day.get("stiction", 1)
    count, filter_s, log = day.get("ticks", 40000) / (2 * math.pi), day.get("filter_s", 0), day.get("log", LOG)
    quick, slow_by = math.exp(-CALL_S / 0.03), math.exp(-CALL_S / filter_s) if filter_s else 0.0
    # Inverse of the mass matrix of both wheel speeds; a moment of the floor acts with the share `lever`.
    a, c = m * r * r / 4 + J * r * r / (4 * l * l) + b["Iw"] + STEP_S * nu, m * r * r / 4 - J * r * r / (4 * l * l)
    own, other, lever = a / (a * a - c * c), -c / (a * a - c * c), r / (2 * l)
    turned_by = lever * (own - other)
    phase = [rng.uniform(0, 2 * math.pi) for _ in range(2)]
    q, before, angle, i, V, held = [0.0, 0.0], [0.0, 0.0], [0.0, 0.0], [0.0, 0.0], [0.0, 0.0], [0.0, 0.0]
    counted, estimate, integral, filtered, logged = [0, 0], [0.0, 0.0], [0.0, 0.0], [0.0, 0.0], [0, 0]
    held_turn, of_call_A, px, py, heading, bus_V = 0.0, 0.0, 0.0, 0.0, 0.0, open_circuit_V(b, charge)
    sums, fast, slow = [0.0] * 5, [], []
    for step in range(len(called) * CONTROL):
        if step % CONTROL == 0:
            v, w = called[step // CONTROL]
            for k, side in ((0, -1), (1, 1)):
                target, ticks = (v + side * w * b["l"]) / b["r"], math.floor(angle[k] * count)
                raw, counted[k] = (ticks - counted[k]) / count / CALL_S, ticks
                estimate[k] = quick * estimate[k] + (1 - quick) * raw
                filtered[k] = slow_by * filtered[k] + (1 - slow_by) * raw
                error, rests = target - estimate[k], target == 0 and abs(estimate[k]) < 0.02
                integral[k] = 0.999 * integral[k] if rests else integral[k] + 5 * b["K"] * b["n"] * CALL_S * error
                want = b["K"] * b["n"] * (target + 1.2 * error) + integral[k]
                V[k] = 0.0 if abs(want) < dead else round(max(-bus_V, min(bus_V, want)) / b["U_max"] * 1000) / 1000 * b["U_max"]
        for k in range(2):
            i[k] = (i[k] * b["L"] / STEP_S + V[k] - drop * math.tanh(50 * i[k] * 8 / b["I_max"]) - K * (1.5 * q[k] - 0.5 * before[k])) / (R[k] + b["L"] / STEP_S)
        pull = -m * gravity * slope * math.cos(heading) * r / 2
        free = [(a - STEP_S * nu) * q[k] + c * q[1 - k] + STEP_S * (K * i[k] + pull) for k in range(2)]
        free = [own * free[k] + other * free[1 - k] for k in range(2)]
        bound = [STEP_S * (T[k] * (1 + 0.03 * math.sin(angle[k] + phase[k])) + loss * abs(K * i[k])) * (stiction if abs(q[k]) < 1e-3 else 1) for k in range(2)]
        for _ in range(4):  # impulses of friction, each in turn
            for k, side in ((0, -1), (1, 1)):
                speed = free[k] + own * held[k] + other * held[1 - k] + side * turned_by * held_turn
                held[k] = max(-bound[k], min(bound[k], held[k] - speed / own))
            if scrub:
                yaw = lever * (free[1] - free[0]) + turned_by * (held[1] - held[0]) + 2 * lever * turned_by * held_turn
                held_turn = max(-scrub, min(scrub, held_turn - yaw / (2 * lever * turned_by)))
        before, q = q, [free[k] + own * held[k] + other * held[1 - k] + (2 * k - 1) * turned_by * held_turn for k in range(2)]
        angle = [angle[k] + STEP_S * (q[k] + before[k]) / 2 for k in range(2)]
        v, w = r * (q[0] + q[1]) / 2, lever * (q[1] - q[0])
        heading += STEP_S * w
        px, py = px + STEP_S * v * math.cos(heading), py + STEP_S * v * math.sin(heading)
        amperes = (standby + max(0.0, V[0] * i[0]) + max(0.0, V[1] * i[1])) / bus_V
        of_call_A = amperes / CONTROL + (of_call_A if step % CONTROL else 0.0)  # what the monitor reads: not the ripple within a call
        rest_V = open_circuit_V(b, charge)
        bus_V = rest_V - Ri * amperes
        charge -= amperes * rest_V * STEP_S / 3600 / b["Wh"]
        sums = [s + value for s, value in zip(sums, (*V, *i, w))]
        time_s = (step + 1) * STEP_S
        if (step + 1) % log == 0:
            ticks = [math.floor(angle[k] * count) for k in range(2)]
            speeds = filtered if filter_s else [(ticks[k] - logged[k]) / count / (log * STEP_S) for k in range(2)]
            mean, logged = [s / log for s in sums], ticks
            fast.append([time_s, *speeds, *mean[:4], w if day.get("gyro_at_end") or filter_s else mean[4]])
            sums = [0.0] * 5
        if (step + 1) % SLOW == 0:
            slow.append([time_s, bus_V, of_call_A, px, py, heading])
    return fast, slow, charge


def measured(b, effect, fast, slow, rng):
    """Noise and steps of the instruments, in place."""
    ampere, bias = b["I_max"] / 8, rng.gauss(0, 0.001)
    rounded = lambda value, step: round(value / step) * step
    for row in fast:
        for k in (5, 6):
            reading = row[k] * (1 + effect.get("current_sensor_gain", 0)) + (k == 5) * effect.get("current_sensor_offset", 0)
            row[k] = rounded(reading + 0.015 * ampere * rng.gauss(0, 1), 0.01 * ampere)
        row[7] += bias + 0.005 * rng.gauss(0, 1)
    for row in slow:
        row[1] = rounded(row[1] + 0.01 * rng.gauss(0, 1), 0.02)
        row[2] = rounded(row[2] + 0.01 * ampere * rng.gauss(0, 1), 0.02 * ampere)
        row[3:] = [value + 0.005 * rng.gauss(0, 1) for value in row[3:]]


FAST = ["time_s", "wheel_speed_left_rad_s", "wheel_speed_right_rad_s", "motor_voltage_left_V", "motor_voltage_right_V",
        "motor_current_left_A", "motor_current_right_A", "gyro_yaw_rate_rad_s"]
SLOWLY = ["time_s", "battery_voltage_V", "battery_current_A", "position_x_m", "position_y_m", "heading_rad"]


def day_of(robot, effect, day, seed, folder):
    """Files of a day: drive, electrical and slow channels from loggers of their own. Returns the dataset."""
    rng, b = random.Random(seed), ROBOTS[robot]
    folder.mkdir(parents=True)
    (folder / "robot.yaml").write_text(robot_text(b))
    x, charge, start_s, lines = machine(b, rng), day.get("charge", 0.9), 0.0, []
    late_s = day.get("clock_s", 0) + effect.get("time_misalignment", 0)
    for number in range(day.get("runs", 12)):
        load = b["load"] * (number % 2)
        fast, slow, charge = drive(b, x, effect, day, load, number, start_s, charge, rng)
        measured(b, effect, fast, slow, rng)
        files = [("drive", FAST, fast, (0, 1, 2, 7), 0), ("battery", SLOWLY, slow, (0, 1, 2), late_s)]
        if not day.get("battery_alone"):
            files += [("motors", FAST, fast, (0, 3, 4, 5, 6), late_s), ("pose", SLOWLY, slow, (0, 3, 4, 5), 0)]
        for name, header, rows, columns, shift_s in files:
            text = [",".join(header[k] for k in columns)]
            text += [",".join(f"{row[k] + (shift_s if k == 0 else 0):.6g}" for k in columns) for row in rows]
            (folder / f"{name}_{number:02d}.csv").write_text("\n".join(text) + "\n")
        stated = f", payload_kg: {load:g}" if day.get("payload_stated", True) else ""
        lines.append(f"  - {{files: [{', '.join(f'{f[0]}_{number:02d}.csv' for f in files)}], start_time_s: {start_s:.1f}{stated}}}")
        pause_s = day.get("pause_s", 40)
        charge -= b["standby"] * pause_s * day.get("drain", 1) / 3600 / b["Wh"]
        start_s += fast[-1][0] + pause_s
    (folder / "dataset.yaml").write_text("\n".join(["schema: joulepath/dataset/1", "robot: robot.yaml", "runs:", *lines, ""]))
    return folder / "dataset.yaml"

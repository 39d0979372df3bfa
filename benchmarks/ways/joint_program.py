"""The least-energy curve and speed between two poses as a nonlinear program, for CasADi and Ipopt.

Over arc length (Program), states at the nodes are the place (m), the heading (rad), u = half track *
curvature (1) and b = speed squared (m^2/s^2). Curvature and b are linear in arc length on each part: the
acceleration along the path is constant there and the curve is a chain of clothoids. The length (m) is free;
the shares of the parts in it are the mesh. Over time (TimedProgram), speed (m/s) and yaw rate (rad/s) are
linear on parts of equal length, and the duration (s) is free. The power model is that of [P1, Eqs.
(19)-(28)], the square of the speed as a state that of [Verscheure2009], the programs use CasADi
[Andersson2019], the solver is that of [WaechterBiegler2006]. Nothing here is shared with the planner, whose
unknowns are directions of motion.

What is left out: cusps and driving backward (the speed is above 0 between the ends), turns in place (over
time they are a limit), limits of jerk, of motors and of tires, effects, payload. Limits hold at the ends
and the middle of each part.
"""

import dataclasses

import numpy as np
import yaml

GAUSS = {n: np.polynomial.legendre.leggauss(n) for n in (3, 4, 5)}
REST, LEAST_B = 1e-10, 1e-8  # m^2/s^2, at the ends and between: the square root has no derivative at 0
SHARPEST = 1 / 0.12  # half track * curvature, in the program over arc length


@dataclasses.dataclass
class Robot:
    """Constants of a robot file, in its units; motors as (left, right)."""

    name: str
    radius_m: float
    half_track_m: float
    mass_kg: float
    first_moment_kg_m: float
    yaw_inertia_kg_m2: float
    axle_inertia_kg_m2: float
    ohm: tuple
    amperes_per_Nm: tuple
    volts_per_speed_V_s: tuple
    viscous_Nm_s: tuple
    friction_Nm: tuple
    standby_W: float
    recovered: float
    shared_bus: bool
    limits: dict


def sided(value):
    return (value["left"], value["right"]) if isinstance(value, dict) else (value, value)


def read_robot(file):
    """The robot without payload and effects."""
    data = yaml.safe_load(open(file))
    body, inertia, motor = data["geometry"], data["inertia"], data["motor"]
    offset_m, half_m = body.get("center_of_mass_offset_m", 0.0), body["half_track_m"]
    wheel_kg, chassis_kg = inertia["wheel_mass_kg"], inertia["chassis_mass_kg"]
    at = {key: sided(value) for key, value in motor.items() if key != "thermal"}
    limits = dict(data.get("limits", {}))
    for row in limits.pop("by_payload", []):
        if row["payload_kg"] == 0:
            limits.update(row)
    limits.update({key: motor[key] for key in ("max_current_A", "max_voltage_V") if key in motor})
    per = lambda key: tuple(a * n for a, n in zip(at[key], at["gear_ratio"]))
    return Robot(
        name=data["name"],
        radius_m=body["wheel_radius_m"],
        half_track_m=half_m,
        mass_kg=chassis_kg + 2 * wheel_kg,
        first_moment_kg_m=chassis_kg * offset_m,
        yaw_inertia_kg_m2=inertia["chassis_yaw_inertia_kg_m2"]
        + chassis_kg * offset_m**2
        + 2 * wheel_kg * half_m**2
        + 2 * inertia["wheel_diameter_inertia_kg_m2"],
        axle_inertia_kg_m2=inertia["wheel_axle_inertia_kg_m2"],
        ohm=at["resistance_ohm"],
        amperes_per_Nm=tuple(1 / value for value in per("torque_constant_Nm_A")),
        volts_per_speed_V_s=per("voltage_constant_V_s_rad"),
        viscous_Nm_s=at["viscous_friction_Nm_s_rad"],
        friction_Nm=at["friction_torque_Nm"],
        standby_W=data["power"]["standby_W"],
        recovered=data["power"]["regeneration_efficiency"],
        shared_bus=data["power"].get("sharing", "wheel") == "bus",
        limits=limits,
    )


def wheel_powers(robot, speed, acceleration, yaw_rate, yaw_acceleration, sign):
    """Electrical power (W) of the left and the right wheel [P1, Eqs. (19)-(28)].

    Numbers, arrays or symbols; `sign` is the direction of each wheel, -1 to 1.
    """
    r, l = robot.radius_m, robot.half_track_m
    force = robot.mass_kg * acceleration - robot.first_moment_kg_m * yaw_rate * yaw_rate
    moment = robot.yaw_inertia_kg_m2 * yaw_acceleration + robot.first_moment_kg_m * speed * yaw_rate
    powers = []
    for side, out in enumerate((-1, 1)):
        contact = force / 2 + out * moment / (2 * l)
        turning = (speed + out * l * yaw_rate) / r
        torque = (
            r * contact
            + robot.axle_inertia_kg_m2 * (acceleration + out * l * yaw_acceleration) / r
            + robot.viscous_Nm_s[side] * turning
            + robot.friction_Nm[side] * sign[side]
        )
        current = robot.amperes_per_Nm[side] * torque
        voltage = robot.ohm[side] * current + robot.volts_per_speed_V_s[side] * turning
        powers.append(voltage * current)
    return powers


def drive_energy(robot, s, u, b):
    """Energy (J) and time (s) of a drive with u and b linear between places s (m), at many instants."""
    share = (np.arange(48) + 0.5) / 48
    h, v0, v1 = np.diff(s)[:, None], np.sqrt(b[:-1])[:, None], np.sqrt(b[1:])[:, None]
    seconds = 2 * h / (v0 + v1)
    speed = v0 + (v1 - v0) * share
    along = (v0 * share + (v1 - v0) * share**2 / 2) * seconds / h
    bend = (u[:-1, None] + np.diff(u)[:, None] * along) / robot.half_track_m
    slope = np.diff(u)[:, None] / robot.half_track_m / h
    a = (v1 - v0) / seconds
    share_of_wheel = bend * robot.half_track_m
    powers = wheel_powers(
        robot,
        speed,
        a,
        bend * speed,
        bend * a + slope * speed**2,
        (np.sign(1 - share_of_wheel), np.sign(1 + share_of_wheel)),
    )
    return supplied_J(robot, powers, seconds), float(seconds.sum())


def supplied_J(robot, powers, seconds):
    """What the battery supplies over parts of `seconds` (a column) at equally spaced instants (rows)."""
    powers = [powers[0] + powers[1]] if robot.shared_bus else powers
    supplied = sum(np.maximum(power, robot.recovered * power) for power in powers) + robot.standby_W
    return float((supplied * seconds).sum() / supplied.shape[1])


def part_function(ca, robot):
    """(b0, b1, u0, u1, h, width of the sign) -> time, energies per account, turn, limited rows.

    The energies are Gauss-Legendre sums in time, the place's sums are in place_function().
    """
    b0, b1, u0, u1, h, width = (ca.SX.sym(name) for name in ("b0", "b1", "u0", "u1", "h", "width"))
    l = robot.half_track_m
    v0, v1 = ca.sqrt(b0), ca.sqrt(b1)
    dt, a, slope = 2 * h / (v0 + v1), (b1 - b0) / (2 * h), (u1 - u0) / (l * h)
    energy = [0, 0]
    for node, weight in zip(*GAUSS[4]):
        share = (1 + node) / 2
        v = v0 + (v1 - v0) * share
        u = u0 + (u1 - u0) * share * (2 * v0 + (v1 - v0) * share) / (v0 + v1)
        sign = (ca.tanh((1 - u) / width), ca.tanh((1 + u) / width))
        powers = wheel_powers(robot, v, a, u / l * v, u / l * a + slope * v * v, sign)
        energy = [sum_J + dt * weight / 2 * power for sum_J, power in zip(energy, powers)]
    accounts = [energy[0] + energy[1]] if robot.shared_bus else energy
    rows = [a]
    for u, b in ((u0, b0), (u1, b1)):
        rows.append((u * a) / l + slope * b)
    um, bm = (u0 + u1) / 2, (b0 + b1) / 2
    rows += [um * um * bm / l**2, um * bm / l, u1 * u1 * b1 / l**2, u1 * b1 / l]
    return ca.Function(
        "part",
        [b0, b1, u0, u1, h, width],
        [dt, ca.vertcat(*accounts), h * (u0 + u1) / (2 * l), ca.vertcat(*rows)],
    )


def row_bounds(robot):
    """Lower and upper bounds of the rows of part_function()."""
    at = lambda key: robot.limits.get(key, np.inf)
    yaw, side, rate = (
        at("yaw_acceleration_rad_s2"),
        at("lateral_acceleration_m_s2"),
        at("yaw_rate_rad_s") ** 2,
    )
    high = np.array([at("acceleration_m_s2"), yaw, yaw, rate, side, rate, side])
    low = np.array([-at("deceleration_m_s2"), -yaw, -yaw, -np.inf, -side, -np.inf, -side])
    return low, high


def place_function(ca, robot):
    """(heading at the begin, u0, u1, h) -> the way in x and y: Gauss-Legendre sums along the clothoid."""
    heading, u0, u1, h = (ca.SX.sym(name) for name in ("heading", "u0", "u1", "h"))
    x, y = 0, 0
    for node, weight in zip(*GAUSS[5]):
        share = (1 + node) / 2
        at = heading + h / robot.half_track_m * (u0 * share + (u1 - u0) * share**2 / 2)
        x, y = x + weight / 2 * h * ca.cos(at), y + weight / 2 * h * ca.sin(at)
    return ca.Function("place", [heading, u0, u1, h], [ca.vertcat(x, y)])


@dataclasses.dataclass
class Drive:
    """Nodes of a drive: places along the path (m), x, y (m), heading (rad), u, b (m^2/s^2)."""

    s: np.ndarray
    x: np.ndarray
    y: np.ndarray
    heading: np.ndarray
    u: np.ndarray
    b: np.ndarray

    def on(self, s):
        """The same drive with nodes elsewhere; places and headings are only a guess there."""
        return Drive(s, *(np.interp(s, self.s, v) for v in (self.x, self.y, self.heading, self.u, self.b)))

    def times(self):
        """Seconds at the nodes."""
        root = np.sqrt(self.b)
        return np.concatenate([[0], np.cumsum(2 * np.diff(self.s) / np.maximum(root[1:] + root[:-1], 1e-4))])


@dataclasses.dataclass
class TimedDrive:
    """Nodes of a drive: times (s), x, y (m), heading (rad), speed (m/s), yaw rate (rad/s)."""

    t: np.ndarray
    x: np.ndarray
    y: np.ndarray
    heading: np.ndarray
    speed: np.ndarray
    yaw_rate: np.ndarray

    def on(self, parts):
        """The same drive with equally long parts."""
        t = np.linspace(0, self.t[-1], parts + 1)
        rest = (self.x, self.y, self.heading, self.speed, self.yaw_rate)
        return TimedDrive(t, *(np.interp(t, self.t, v) for v in rest))


def timed(drive, half_track_m):
    speed = np.sqrt(drive.b)
    return TimedDrive(drive.times(), drive.x, drive.y, drive.heading, speed, drive.u * speed / half_track_m)


def remeshed(drive, parts, half_track_m, smooth=0.15):
    """The drive on nodes that share way, turn and time equally: sharp bends and slow ends have many."""
    h = np.diff(drive.s)
    seconds = 2 * h / np.maximum(np.sqrt(drive.b[:-1]) + np.sqrt(drive.b[1:]), 1e-3)
    turn = h * np.abs(drive.u[:-1] + drive.u[1:]) / 2 / half_track_m
    change = np.abs(np.diff(np.arctan(drive.u)))
    density = sum(part / max(part.sum(), 1e-9) for part in (h, turn, seconds, change)) + smooth / len(h)
    way = np.concatenate([[0], np.cumsum(density)])
    return drive.on(np.interp(np.linspace(0, way[-1], parts + 1), way, drive.s))


class Chain:
    """The nonlinear program of a chain of legs with `parts` parts each: built once, solved for any poses.

    Between two legs the robot stands, and its heading is the same before and behind the stop.
    """

    def __init__(self, robot, parts, legs=1):
        import casadi as ca

        self.robot, self.parts, self.legs = robot, parts, legs
        self.accounts = 1 if robot.shared_bus else 2
        shares, shape, pose = (
            ca.MX.sym("shares", parts, legs),
            ca.MX.sym("shape", 2),
            ca.MX.sym("pose", 3, legs + 1),
        )
        functions = self.functions(ca)
        unknowns, rows, total, before = [], [], 0, pose[2, 0]
        for leg in range(legs):
            x, g, cost, first, last = self.leg(ca, leg, shares[:, leg], shape, functions)
            unknowns.append(x)
            rows += [g, first[:2] - pose[:2, leg], last[:2] - pose[:2, leg + 1], first[2] - before]
            before, total = last[2], total + cost
        rows.append(before - pose[2, legs])
        nlp = {
            "x": ca.vertcat(*unknowns),
            "f": total,
            "g": ca.vertcat(*rows),
            "p": ca.vertcat(ca.vec(shares), ca.vec(pose), shape),
        }
        self.make = lambda options: ca.nlpsol("joint", "ipopt", nlp, options)
        self.bounds, self.solvers, self.iterations = self.all_bounds(), {}, 0

    def all_bounds(self):
        low, high = self.row_bounds()
        n, ends, x_low, x_high = self.parts, np.zeros(5), *self.unknown_bounds()
        equal, clipped = np.zeros(3 * n), np.zeros(self.accounts * n)
        g_low, g_high = [equal, clipped, np.tile(low, n), ends], [
            equal,
            clipped + np.inf,
            np.tile(high, n),
            ends,
        ]
        again = lambda values: np.tile(np.concatenate(values), self.legs)
        return {
            "lbg": np.append(again(g_low), 0),
            "ubg": np.append(again(g_high), 0),
            "lbx": again(x_low),
            "ubx": again(x_high),
        }

    def solver(self, tolerance, first_barrier):
        key = tolerance, first_barrier
        if key not in self.solvers:
            self.solvers[key] = self.make(
                {
                    "print_time": False,
                    "show_eval_warnings": False,
                    "ipopt.print_level": 0,
                    "ipopt.sb": "yes",
                    "ipopt.tol": tolerance,
                    "ipopt.max_iter": 300,
                    "ipopt.mu_init": first_barrier,
                    "ipopt.acceptable_iter": 5,
                    "ipopt.acceptable_tol": 10 * tolerance,
                    "ipopt.acceptable_obj_change_tol": 1e-6,
                    "error_on_fail": False,
                }
            )
        return self.solvers[key]

    def solve(self, guesses, poses, width=0.1, sharpest=SHARPEST, tolerance=1e-6, first_barrier=0.1):
        """From one drive for each leg: the drives found, the objective (J) and whether Ipopt converged.

        `width`: of the sign of friction, in u or in m/s; `sharpest`: bound of u, of the program over time.
        """
        shares = [self.shares(guess) for guess in guesses]
        first = np.concatenate([part for guess in guesses for part in self.unknowns(guess)])
        solver = self.solver(tolerance, first_barrier)
        found = solver(
            x0=first, p=np.concatenate([*shares, *np.array(poses, float), [width, sharpest]]), **self.bounds
        )
        stats = solver.stats()
        self.iterations = stats["iter_count"]
        values = np.array(found["x"]).ravel().reshape(self.legs, -1)
        return (
            [self.drive(row, share) for row, share in zip(values, shares)],
            float(found["f"]),
            stats["success"],
        )

    def cost(self, ca, energy, lost, dt):
        """Energy (J) of a leg: that of its parts, what braking loses of it, and standby."""
        return (
            ca.sum1(ca.sum2(energy))
            + (1 - self.robot.recovered) * ca.sum1(ca.sum2(lost))
            + self.robot.standby_W * dt
        )


class Program(Chain):
    """Over arc length, on a mesh that the first drive has."""

    def functions(self, ca):
        return part_function(ca, self.robot).map(self.parts), place_function(ca, self.robot).map(self.parts)

    def row_bounds(self):
        return row_bounds(self.robot)

    def leg(self, ca, leg, shares, shape, functions):
        n = self.parts
        state, inner = ca.MX.sym(f"state{leg}", 4, n + 1), ca.MX.sym(f"b{leg}", n - 1)
        lost, length = ca.MX.sym(f"lost{leg}", self.accounts, n), ca.MX.sym(f"length{leg}")
        heading, u, b = state[2, :], state[3, :], ca.horzcat(REST, inner.T, REST)
        h = (shares * length).T
        dt, energy, turn, limited = functions[0](b[:-1], b[1:], u[:-1], u[1:], h, shape[0])
        way = functions[1](heading[:-1], u[:-1], u[1:], h)
        follow = ca.vertcat(state[:2, 1:] - state[:2, :-1] - way, heading[1:] - heading[:-1] - turn)
        g = ca.vertcat(ca.vec(follow), ca.vec(lost + energy), ca.vec(limited))
        unknowns = ca.vertcat(ca.vec(state), inner, ca.vec(lost), length)
        return unknowns, g, self.cost(ca, energy, lost, ca.sum2(dt)), state[:3, 0], state[:3, -1]

    def unknown_bounds(self):
        n, inf, lost = self.parts, np.inf, np.zeros(self.accounts * self.parts)
        fastest = self.robot.limits.get("speed_m_s", 10.0) ** 2
        low = [np.tile([-inf, -inf, -inf, -SHARPEST], n + 1), np.full(n - 1, LEAST_B), lost, [0.01]]
        high = [np.tile([inf, inf, inf, SHARPEST], n + 1), np.full(n - 1, fastest), lost + inf, [200.0]]
        return low, high

    def shares(self, guess):
        return np.diff(guess.s) / guess.s[-1]

    def unknowns(self, guess):
        state = np.array([guess.x, guess.y, guess.heading, np.clip(guess.u, -0.9 * SHARPEST, 0.9 * SHARPEST)])
        return state.ravel(order="F"), guess.b[1:-1], np.full(self.accounts * self.parts, 0.01), [guess.s[-1]]

    def drive(self, values, shares):
        n = self.parts
        state = values[: 4 * (n + 1)].reshape(n + 1, 4).T
        b = np.concatenate([[0], values[4 * (n + 1) : 4 * (n + 1) + n - 1], [0]])
        return Drive(np.concatenate([[0], np.cumsum(shares)]) * values[-1], *state, np.maximum(b, 0))


def timed_function(ca, robot):
    """(heading, speeds and yaw rates at both ends, seconds, [width of the sign in m/s, bound of u]) of a part
    with speed and yaw rate linear in time -> energies per account, way in x and y and turn, limited rows."""
    heading, v0, v1, w0, w1, dt = (ca.SX.sym(name) for name in ("heading", "v0", "v1", "w0", "w1", "dt"))
    shape = ca.SX.sym("shape", 2)
    width, sharpest = shape[0], shape[1]
    l, a, alpha = robot.half_track_m, (v1 - v0) / dt, (w1 - w0) / dt
    energy, x, y = [0, 0], 0, 0
    for node, weight in zip(*GAUSS[4]):
        share = (1 + node) / 2
        v, w = v0 + (v1 - v0) * share, w0 + (w1 - w0) * share
        sign = (ca.tanh((v - l * w) / width), ca.tanh((v + l * w) / width))
        powers = wheel_powers(robot, v, a, w, alpha, sign)
        energy = [sum_J + dt * weight / 2 * power for sum_J, power in zip(energy, powers)]
        at = heading + dt * (w0 * share + (w1 - w0) * share**2 / 2)
        x, y = x + weight / 2 * dt * v * ca.cos(at), y + weight / 2 * dt * v * ca.sin(at)
    accounts = [energy[0] + energy[1]] if robot.shared_bus else energy
    middle = (v0 + v1) * (w0 + w1) / 4
    rows = [a, alpha, middle, v1 * w1, sharpest * v1 - l * w1, sharpest * v1 + l * w1]
    return ca.Function(
        "timed",
        [heading, v0, v1, w0, w1, dt, shape],
        [ca.vertcat(*accounts), ca.vertcat(x, y, dt * (w0 + w1) / 2), ca.vertcat(*rows)],
    )


class TimedProgram(Chain):
    """Over time, in parts of equal length: a second transcription that resolves sharp bends at rest well.

    Curvature is bounded by `sharpest` over half the track, a linear row in speed and yaw rate.
    """

    def functions(self, ca):
        return timed_function(ca, self.robot).map(self.parts)

    def row_bounds(self):
        at = lambda key: self.robot.limits.get(key, np.inf)
        side = at("lateral_acceleration_m_s2")
        high = np.array([at("acceleration_m_s2"), at("yaw_acceleration_rad_s2"), side, side, np.inf, np.inf])
        return np.array([-at("deceleration_m_s2"), *-high[1:4], 0, 0]), high

    def leg(self, ca, leg, shares, shape, part):
        n = self.parts
        state, inner = ca.MX.sym(f"state{leg}", 3, n + 1), ca.MX.sym(f"rates{leg}", 2, n - 1)
        lost, seconds = ca.MX.sym(f"lost{leg}", self.accounts, n), ca.MX.sym(f"seconds{leg}")
        rest = ca.DM.zeros(2, 1)
        rates, dt = ca.horzcat(rest, inner, rest), ca.repmat(seconds / n, 1, n)
        energy, step, limited = part(
            state[2, :-1], rates[0, :-1], rates[0, 1:], rates[1, :-1], rates[1, 1:], dt, shape
        )
        g = ca.vertcat(ca.vec(state[:, 1:] - state[:, :-1] - step), ca.vec(lost + energy), ca.vec(limited))
        unknowns = ca.vertcat(ca.vec(state), ca.vec(inner), ca.vec(lost), seconds)
        return unknowns, g, self.cost(ca, energy, lost, seconds), state[:, 0], state[:, -1]

    def unknown_bounds(self):
        n, inf, lost = self.parts, np.inf, np.zeros(self.accounts * self.parts)
        rate = [self.robot.limits.get(key, inf) for key in ("speed_m_s", "yaw_rate_rad_s")]
        low = [np.full(3 * (n + 1), -inf), np.tile([0, -rate[1]], n - 1), lost, [0.1]]
        high = [np.full(3 * (n + 1), inf), np.tile(rate, n - 1), lost + inf, [600.0]]
        return low, high

    def shares(self, guess):
        return np.zeros(self.parts)

    def unknowns(self, guess):
        state = np.array([guess.x, guess.y, guess.heading])
        rates = np.array([guess.speed, guess.yaw_rate])[:, 1:-1]
        return (
            state.ravel(order="F"),
            rates.ravel(order="F"),
            np.full(self.accounts * self.parts, 0.01),
            [guess.t[-1]],
        )

    def drive(self, values, shares):
        n = self.parts
        state = values[: 3 * (n + 1)].reshape(n + 1, 3).T
        rates = values[3 * (n + 1) : 3 * (n + 1) + 2 * (n - 1)].reshape(n - 1, 2).T
        rest = np.zeros((2, 1))
        return TimedDrive(np.linspace(0, values[-1], n + 1), *state, *np.hstack([rest, rates, rest]))


def timed_energy(robot, drive):
    """Energy (J) of a drive with speed and yaw rate linear between its nodes, summed over many instants."""
    share = (np.arange(48) + 0.5) / 48
    dt, l = np.diff(drive.t)[:, None], robot.half_track_m
    v, w = (values[:-1, None] + np.diff(values)[:, None] * share for values in (drive.speed, drive.yaw_rate))
    a, alpha = np.diff(drive.speed)[:, None] / dt, np.diff(drive.yaw_rate)[:, None] / dt
    powers = wheel_powers(robot, v, a, w, alpha, (np.sign(v - l * w), np.sign(v + l * w)))
    return supplied_J(robot, powers, dt)

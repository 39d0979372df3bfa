"""What cannot be meant is refused with its name; what can be converted is."""
import numpy as np
import pytest

import joulepath as jp

XY = np.array([[0.0, 0.0], [2.0, 0.0], [4.0, 1.0]])


@pytest.mark.parametrize("same", [
    XY.tolist(), XY.astype(np.float32), XY.astype(int), np.asfortranarray(XY), np.repeat(XY, 2, axis=0)[::2],
    XY[::-1][::-1], np.ascontiguousarray(XY.astype(">f8"))], ids=["list", "float32", "int", "fortran", "strided",
                                                                  "reversed", "big-endian"])
def test_other_layouts_and_types_are_converted(robot, same):
    assert jp.Path(same).length_m == jp.Path(XY).length_m


@pytest.mark.parametrize(("wrong", "message"), [
    (XY.T, r"xy: found shape \(2, 3\).*transpose"),
    (XY[0], "axes"),
    (XY[:1], "1 points"),
    (np.zeros((3, 3)), r"shape \(3, 3\)"),
    ([[0, 0], [np.nan, 1]], r"xy\[1\]\[0\]: found nan"),
    ([[0, 0], [np.inf, 1]], r"found inf"),
    ([["a", "b"], ["c", "d"]], "type <U1"),
    ([[0, 0], [1]], "rows of different lengths"),
    (XY + 1j, "complex"),
    (XY > 1, "bool"),
    (np.ma.masked_array(XY, XY > 3), "masked"),
    ([[0, 0], [0, 0]], r"xy\[1\]"),
])
def test_wrong_waypoints_are_refused(robot, wrong, message):
    with pytest.raises(jp.ConfigError, match=message):
        jp.profile(robot, wrong)


@pytest.mark.parametrize(("options", "message"), [
    ({"payload_kg": -1}, "payload_kg: found -1, accepted: a number >= 0"),
    ({"payload_kg": None}, "payload_kg: found None"),
    ({"payload_kg": float("nan")}, "payload_kg: found nan"),
    ({"payload_kg": "5"}, "payload_kg: found '5'"),
    ({"payload_kg": 50}, "^payload_kg: found 50, accepted: at most 12, limits.max_payload_kg of the robot$"),
    ({"time_s": 0}, "time_s: found 0, accepted: a number > 0"),
    ({"solver": "magic"}, "one of: ipopt, fast"),
    ({"nodes": 2.5}, "nodes: found 2.5"),
])
def test_wrong_options_are_refused(robot, options, message):
    with pytest.raises(jp.ConfigError, match=message):
        jp.profile(robot, XY, **options)


def test_wrong_motions_are_refused(robot):
    with pytest.raises(jp.ConfigError, match=r"t\[2\]: found 1 after 1"):
        jp.energy(robot, [0, 1, 1], [0, 1, 0])
    with pytest.raises(jp.ConfigError, match="v: found 2 samples"):
        jp.energy(robot, [0, 1, 2], [0, 1])
    with pytest.raises(jp.ConfigError, match="2 samples or more"):
        jp.energy(robot, [0], 0)


def test_a_file_s_error_names_its_place(tmp_path):
    (tmp_path / "robot.yaml").write_text(jp.Robot.example().text().replace("gear_ratio: 24.9", "gear_ratio: -1"))
    with pytest.raises(jp.ConfigError) as raised:
        jp.Robot.load(tmp_path / "robot.yaml")
    assert raised.value.file.endswith("robot.yaml")
    assert raised.value.line > 0 and raised.value.key == "motor.gear_ratio" and raised.value.found == "-1"


def test_a_dict_s_error_names_its_key_alone(robot):
    with pytest.raises(jp.ConfigError) as raised:
        robot.replace(motor={"gear_ratoi": 3})
    assert raised.value.key.startswith("motor") and raised.value.line is None
    assert "gear_ratio" in str(raised.value)
    with pytest.raises(jp.ConfigError, match="not finite"):
        robot.replace(motor={"gear_ratio": float("inf")})
    with pytest.raises(jp.ConfigError, match="type object"):
        robot.replace(motor={"gear_ratio": object()})


def test_an_infeasible_profile_says_what_where_and_how(robot):
    with pytest.raises(jp.Infeasible) as raised:
        jp.profile(robot, XY, time_s=1.0)
    error = raised.value
    assert error.limit and error.amount > 0 and error.unit
    assert set(error.place) == {"leg", "arc_length_m", "x_m", "y_m"}
    assert error.relaxation and error.plan.status == "infeasible"
    (key, value), = error.relaxation.items()
    assert key == "time_s" and "duration_s" not in str(error)
    assert jp.profile(robot, XY, time_s=value * (1 + 1e-6)).status in ("optimal", "feasible")


def test_unknown_effects_are_refused(curve):
    with pytest.raises(jp.ConfigError, match="rolling_resistance"):
        jp.simulate(curve, effects={"roling_resistance": {"coefficient": 0.01}})


@pytest.mark.parametrize(("effects", "key"), [
    ({"rolling_resistance": {"coefficient": "much"}}, "effects.rolling_resistance.coefficient"),
    ({"rolling_resistance": {"coefficient": -1}}, "effects.rolling_resistance.coefficient"),
    ([{"rolling_resistance": {"coefficient": 0.01}}, {"rolling_resistance": {"coefficient": []}}], "effects[1].rolling_resistance.coefficient"),
    ({"rolling_resistance": {"coefficient": 0.01, "nothing": 1}}, "effects.rolling_resistance")])
def test_wrong_effects_are_named_as_the_caller_wrote_them(curve, effects, key):
    with pytest.raises(jp.ConfigError) as raised:
        jp.simulate(curve, effects=effects)
    assert raised.value.key.startswith(key) and str(raised.value).startswith(key) and raised.value.file is None


def test_wrong_logs_are_refused(robot, curve):
    log = jp.simulate(curve, robot).to_frame()
    with pytest.raises(jp.ConfigError, match="same samples"):
        jp.diagnose(robot, [log, log.copy()])
    with pytest.raises(jp.ConfigError, match="time_s"):
        jp.diagnose(robot, [log.drop(columns="time_s")])
    with pytest.raises(jp.ConfigError, match="only a dataset file names its robot"):
        jp.diagnose(None, [log])

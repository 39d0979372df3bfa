"""Frames for the diagnosis: numbers in every form are read, anything else is refused with its column and row."""
import decimal
import fractions
import re

import numpy as np
import pytest

import joulepath as jp

ACCEPTED = "accepted: a finite number, or NaN where a value is missing"


@pytest.fixture(scope="module")
def log(robot):
    plan = jp.profile(robot, [[0, 0], [2, 0], [4, 1], [6, 1]], payload_kg=5, solver="fast", nodes=60)
    return {name: np.array(column) for name, column in jp.simulate(plan, seed=3).items()}


def changed(log, row, value):
    column = log["motor_current_left_A"].astype(object)
    column[row] = value
    return {**log, "motor_current_left_A": column}


def answer(robot, frame, **options):
    """All of the diagnosis but its notes on the columns."""
    found = jp.diagnose(robot, [frame], **options).json.to_dict()
    found.pop("artifacts")
    return found


def test_a_clock_in_ms_is_asked_for_with_its_repair(robot, log):
    in_ms = {**log, "time_s": 1000 * log["time_s"]}
    d = jp.diagnose(robot, [in_ms])
    assert d.data_checks == d.json.data_checks and "time_s clock" in repr(d)
    assert re.search(r"^suspect: all: time_s clock[.] .*[.] Repair: columns: [{]time_s: [{]scale: 0[.]001[}][}]$", str(d), re.MULTILINE)
    assert not jp.diagnose(robot, [in_ms], columns={"time_s": {"scale": 0.001}}).data_checks
    wheels = {name: column for name, column in in_ms.items() if name.startswith(("time", "wheel"))}
    assert re.search(r"^suspect: .* at most 100 s: is the stamp in ms .*[?] Repair: ", str(jp.diagnose(robot, [wheels])), re.MULTILINE)


@pytest.mark.parametrize(("value", "found"), [
    ("n/a", "'n/a' of type str"), ("1.5", "'1.5' of type str"), (True, "True of type bool"), (np.bool_(False), "of type bool"),
    (1j, "1j of type complex"), ([1.0], r"\[1.0\] of type list"), (np.datetime64("2026-01-01"), "of type datetime64"),
    (float("inf"), "inf"), (-np.inf, "-inf"), (10**400, "of type int"), (decimal.Decimal("sNaN"), "of type Decimal"),
    ("x" * 500, "of type str")], ids=lambda value: repr(value)[:20])
def test_what_is_no_number_is_refused_with_its_column_and_row(robot, log, value, found):
    with pytest.raises(jp.ConfigError, match=found + ", " + ACCEPTED) as raised:
        jp.diagnose(robot, [log, changed(log, 17, value)])
    assert raised.value.key == "logs[1].motor_current_left_A[17]" and len(str(raised.value)) < 250


@pytest.mark.parametrize("column", [
    np.array(["a", "b", "c"]), np.array([True, False, True]), np.array([b"1", b"2", b"3"]), np.array([1j, 2, 3]),
    np.arange(3).astype("datetime64[s]"), np.arange(3).astype("timedelta64[s]"), ["1", "2", "3"], [1.0, "2", 3.0]],
    ids=lambda column: str(getattr(column, "dtype", column)))
def test_columns_of_another_type_are_refused(robot, column):
    frame = {"time_s": [0.0, 1, 2], "linear_speed_m_s": [0.0, 1, 0], "angular_speed_rad_s": column}
    with pytest.raises(jp.ConfigError, match=ACCEPTED) as raised:
        jp.diagnose(robot, [frame])
    assert raised.value.key.startswith("logs[0].angular_speed_rad_s[")


@pytest.mark.parametrize("value", [None, np.nan, decimal.Decimal("NaN")])
def test_a_missing_value_is_that_of_a_file(robot, log, value):
    assert answer(robot, changed(log, 17, value)) == answer(robot, changed(log, 17, np.nan).copy())


@pytest.mark.parametrize("kind", [int, np.int16, np.float32, fractions.Fraction, decimal.Decimal, np.longdouble])
def test_numbers_of_every_kind_are_converted(robot, log, kind):
    column = np.round(log["motor_current_left_A"])
    expected = answer(robot, {**log, "motor_current_left_A": column})
    assert answer(robot, {**log, "motor_current_left_A": [kind(int(x)) for x in column]}) == expected


def test_every_layout_is_converted(robot, log):
    expected = answer(robot, log)
    wide = {name: np.stack([column, column], 1)[:, 0] for name, column in log.items()}
    backward = {name: column[::-1].copy()[::-1] for name, column in log.items()}
    foreign = {name: column.astype(">f8") for name, column in log.items()}
    frozen = {name: column.copy() for name, column in log.items()}
    for column in frozen.values():
        column.flags.writeable = False
    for same in (wide, backward, foreign, frozen, {name: column.tolist() for name, column in log.items()}):
        assert answer(robot, same) == expected


def test_frames_of_pandas(robot, log):
    pandas = pytest.importorskip("pandas")
    frame = pandas.DataFrame(log)
    expected = answer(robot, frame)
    assert answer(robot, log) == expected == answer(robot, frame.convert_dtypes()) == answer(robot, frame.set_index(frame.index + 7))
    assert answer(robot, frame.assign(note="a text beside the numbers", day=pandas.Timestamp(0))) == expected
    missing = frame.convert_dtypes()
    missing.loc[17, "motor_current_left_A"] = pandas.NA
    assert answer(robot, missing) == answer(robot, changed(log, 17, None))
    with pytest.raises(jp.ConfigError, match="time_s.*'a day'"):
        jp.diagnose(robot, [frame.assign(time_s="a day")])
    with pytest.raises(jp.ConfigError, match="time_s.*of type (Timestamp|datetime64)"):
        jp.diagnose(robot, [frame.assign(time_s=pandas.to_datetime(frame.time_s, unit="s"))])
    twice = pandas.concat([frame, frame[["wheel_speed_left_rad_s"]]], axis=1)
    with pytest.raises(jp.ConfigError, match="logs\\[0\\].wheel_speed_left_rad_s: found 2 columns of this name"):
        jp.diagnose(robot, [twice])


@pytest.mark.parametrize(("change", "message"), [
    ({"linear_speed_m_s": [0, 1]}, r"logs\[0\].linear_speed_m_s: found 2 rows, accepted: 3 rows, as time_s has"),
    ({"linear_speed_m_s": [np.nan] * 3}, r"logs\[0\].linear_speed_m_s: found no number in 3 rows"),
    ({"linear_speed_m_s": [None] * 3}, r"logs\[0\].linear_speed_m_s: found no number in 3 rows"),
    ({"linear_speed_m_s": 5.0}, r"found shape \(\)"),
    ({"linear_speed_m_s": np.zeros((3, 2))}, r"found shape \(3, 2\)"),
    ({"linear_speed_m_s": [[1], [1, 2], [3]]}, "rows of different lengths"),
    ({"linear_speed_m_s": np.ma.masked_array([1.0, 2, 3], [0, 1, 0])}, "a masked array"),
    ({"time_s": [], "linear_speed_m_s": [], "angular_speed_rad_s": []}, "0 rows"),
    ({1: [0.0, 1, 2], "1": [0.0, 1, 2]}, "found 2 columns of this name"),
    ({"a\udcff": [0.0, 1, 2]}, "UTF-8"),
])
def test_frames_of_another_shape_are_refused(robot, change, message):
    frame = {"time_s": [0.0, 1, 2], "linear_speed_m_s": [0.0, 1, 0], "angular_speed_rad_s": [0.0, 0, 0], **change}
    with pytest.raises(jp.ConfigError, match=message):
        jp.diagnose(robot, [frame])


def test_what_is_not_read_may_be_anything(robot, log):
    """As in a file: text beside the numbers is no error."""
    beside = {"note": ["text"] * len(log["time_s"]), "picture": np.zeros((2, 2)), "flag": True, "two": [1, 2]}
    assert answer(robot, {**log, **beside}) == answer(robot, log)
    absent = {"battery_voltage_V": {"absent": True}}
    assert answer(robot, {**log, "battery_voltage_V": ["broken"] * len(log["time_s"])}, columns=absent) == answer(
        robot, log, columns=absent)


@pytest.mark.parametrize("source", ["amps", ["none", "amps"]])
def test_mapped_columns_are_checked_by_their_own_names(robot, log, source):
    named = {**log, "amps": log["motor_current_left_A"], "motor_current_left_A": ["not read"] * len(log["time_s"])}
    columns = {"motor_current_left_A": {"from": source}}
    assert answer(robot, named, columns=columns) == answer(robot, log)
    named["amps"] = named["motor_current_left_A"]
    with pytest.raises(jp.ConfigError, match=r"logs\[0\].amps\[0\]: found 'not read'"):
        jp.diagnose(robot, [named], columns=columns)


@pytest.mark.parametrize(("call", "message"), [
    (lambda r, log: jp.diagnose(r, []), "^logs: "),
    (lambda r, log: jp.diagnose(r, [log], columns=["time_s"]), "columns: found a value of type list"),
    (lambda r, log: jp.diagnose(r, [log], columns={"time": {"from": "t"}}), "columns.*time"),
    (lambda r, log: jp.diagnose(r, [log], columns={"time_s": 3}), "columns.time_s"),
    (lambda r, log: jp.diagnose(r, [log], columns={"time_s": {"from": 3}}), r"^logs\[0\]: found no column 3"),
    (lambda r, log: jp.diagnose(r, [{**log, 3: "today"}], columns={"time_s": {"from": 3}}), r"logs\[0\].3: found shape"),
    (lambda r, log: jp.diagnose(r, [log], without=None), "without: found None"),
    (lambda r, log: jp.diagnose(r, [log], without=[3]), "without: found"),
    (lambda r, log: jp.diagnose(r, [jp.Run(log, name=3)]), r"logs\[0\].name: found a value of type int"),
    (lambda r, log: jp.diagnose(r, [jp.Run(log, payload_kg="5 kg")]), r"^logs\[0\].payload_kg: "),
    (lambda r, log: jp.diagnose(r, [jp.Run(log, use="nothing")]), r"^logs\[0\].use: "),
    (lambda r, log: jp.diagnose(r, [jp.Run(log, name="a"), jp.Run(log, name="a")]), r"^logs\[1\]: .*a log that no other run has"),
    (lambda r, log: jp.diagnose(r, [log, "none.mcap"]), r"^logs\[1\]: found none.mcap"),
    (lambda r, log: jp.diagnose(r, [log], columns={"time_s": {"form": "t"}}), "^columns.time_s.form: "),
])
def test_wrong_arguments_are_refused(robot, log, call, message):
    with pytest.raises(jp.ConfigError, match=message):
        call(robot, log)


def without(log, *names):
    return {name: column for name, column in log.items() if name not in names}


@pytest.mark.parametrize("wrong", ["wheel_speed_lft_rad_s", "wheel_speed_left_rpm", "Wheel_speed_left_rad_S"])
def test_a_mistyped_column_is_an_error_and_not_derived(robot, log, wrong):
    frame = {**without(log, "wheel_speed_left_rad_s"), wrong: log["wheel_speed_left_rad_s"]}
    with pytest.raises(jp.ConfigError, match="unknown column.*did you mean wheel_speed_left_rad_s?") as raised:
        jp.diagnose(robot, [jp.Run(log, name="first"), jp.Run(frame, name="second")])
    assert raised.value.key == "logs[1]." + wrong and raised.value.file is None


def test_one_wheel_is_an_error(robot, log):
    with pytest.raises(jp.ConfigError, match=r"^logs\[0\]: found wheel_speed_right_rad_s without wheel_speed_left_rad_s"):
        jp.diagnose(robot, [without(log, "wheel_speed_left_rad_s")])


def test_what_was_derived_is_told(robot, log):
    found = jp.diagnose(robot, [without(log, "wheel_speed_left_rad_s", "wheel_speed_right_rad_s", "linear_speed_m_s", "angular_speed_rad_s")])
    assert "logs[0]: derived in wheel_speed_left_rad_s, wheel_speed_right_rad_s: from linear and angular speed" in found.artifacts
    assert "logs[0]: derived in linear_speed_m_s: from the pose's differences" in found.artifacts
    assert "derived in linear_speed_m_s" in repr(found) and "artifact: logs[0]: derived in linear_speed_m_s" in str(found)
    assert "derived" not in repr(jp.diagnose(robot, [log]))


def test_the_share_of_missing_values_is_told(robot, log):
    found = jp.diagnose(robot, [changed(log, slice(None, None, 4), np.nan)])
    assert "logs[0]: missing_values in motor_current_left_A: 25 % of the rows are empty, filled by interpolation" in found.artifacts


def test_a_diagnosis_tells_what_its_file_tells(robot, log):
    found = jp.diagnose(robot, [without(log, "battery_current_A", "payload_kg")])
    assert found.missing_channels and found.notes
    for name in ("artifacts", "missing_channels", "notes"):
        assert list(getattr(found, name)) == found.json.to_dict()[name], name
    for note in found.notes:
        assert f"note: {note}" in str(found)


def test_runs_of_frames_are_values(log):
    run = jp.Run(log)
    assert run == run and run != jp.Run(log) and len({run, jp.Run(log)}) == 2


def test_one_log_or_many_with_the_robot_in_either_place(robot, log):
    whole = jp.diagnose(robot, [log]).json.to_dict()
    for found in (jp.diagnose(log, robot=robot), jp.diagnose([log], robot=robot), jp.diagnose(robot, jp.Run(log)), jp.diagnose(robot=robot, logs=log)):
        assert found.json.to_dict() == whole
    with pytest.raises(TypeError, match="each once"):
        jp.diagnose(robot, [log], robot=robot)

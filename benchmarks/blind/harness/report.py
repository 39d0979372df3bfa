"""Score a diagnosed campaign once and write the report."""
import pathlib
import platform
import subprocess
import sys
import time

from campaign import done_cases
import plan
import plots
import scorecard
import seal
import workspace
from judge import Answer, detectable, material, truth_of
from statistics_of import calibration

CONTROLS = ("always_friction", "plain_refit", "stlsq", "black_box")


def load(frozen, name):
    labels = seal.open_labels(frozen, name)
    results = done_cases(workspace.sealed_folder(frozen, name) / "diagnosed.jsonl")
    if not results:
        sys.exit("nothing is diagnosed yet")
    usable = {i: label for i, label in labels.items() if "unusable" not in label}
    return usable, {i: result for i, result in results.items() if i in usable}, sorted(set(labels) - set(usable))


def cases_of(labels, results):
    return [(labels[i], Answer(results[i].get("diagnosis"))) for i in sorted(results)]


def card_table(labels, results, last):
    cases = cases_of(labels, results)
    seconds = [r["seconds"] for r in results.values() if "diagnosis" in r]
    rows = scorecard.rates(cases) + scorecard.correction_rates(labels, results) + scorecard.interval_values(cases)
    rows += scorecard.place_rates(cases) + scorecard.next_run_rates(labels, results) + scorecard.again_rates(results)
    rows += scorecard.values(cases, seconds) + scorecard.shrink_values(labels, results)
    lines = ["| measure | value | 95 % interval | cases | aim / fails | | last campaign |", "|---|---|---|---|---|---|---|"]
    return lines + [f"{row.row()} {last.get(row.name, '')} |" for row in rows]


def values_of(lines):
    """{measure: value} of the lines of a scorecard."""
    return {cells[1].strip(): cells[2].strip() for cells in (line.split("|") for line in lines) if len(cells) > 6}


def last_campaign(page):
    """Measure and value of the page that this campaign replaces."""
    return values_of(page.read_text().split("## Controls")[0].splitlines() if page.exists() else [])


def control_table(labels, results):
    columns = {"joulepath": {i: Answer(r.get("diagnosis")) for i, r in results.items()}}
    for control in CONTROLS:
        answers = {i: Answer(r["controls"][control]) for i, r in results.items() if control in (r.get("controls") or {})}
        if answers:
            columns[control] = answers
    measured = {name: scorecard.rates([(labels[i], a) for i, a in answers.items()]) for name, answers in columns.items()}
    extra = {name: scorecard.values([(labels[i], a) for i, a in answers.items()], [])[0] for name, answers in columns.items()}
    lines = ["| measure | " + " | ".join(columns) + " |", "|---" * (len(columns) + 1) + "|"]
    for k, rate in enumerate(measured["joulepath"]):
        cells = [f"{measured[c][k].value:.3f}" if measured[c][k].total else "–" for c in columns]
        lines.append(f"| {rate.name} | " + " | ".join(cells) + " |")
    lines.append(f"| {extra['joulepath'].name} | " + " | ".join(f"{extra[c].value:.3f}" for c in columns) + " |")
    return lines


def power_lines(table):
    lines = ["| effect | parameter | detectable found | smallest size found in 90 % | smallest the oracle detects |", "|---|---|---|---|---|"]
    number = lambda x: "–" if x is None else f"{x:.3g}"
    for name in sorted(table):
        e = table[name]
        lines.append(f"| {name} | {e['parameter']} | {e['found']}/{e['detectable']} | {number(e['smallest_found'])} | {number(e['smallest_detectable'])} |")
    return lines


def confusion_lines(table):
    lines = ["| truth | cases | said first (count) |", "|---|---|---|"]
    for true in sorted(table):
        said = sorted(table[true].items(), key=lambda item: -item[1])
        lines.append(f"| {true} | {sum(table[true].values())} | " + ", ".join(f"{name} {count}" for name, count in said) + " |")
    return lines


def robots_of(cases):
    """The robots of the cases; those of the plant in its order, others by name."""
    known, there = [name for name, _ in plan.ROBOTS], {l["robot"] for l, _ in cases}
    return [name for name in known if name in there] + sorted(there - set(known))


def split_table(cases):
    """The first measures by level, robot and protocol: where it is weak."""
    wanted = {"top-1": "top-1, single detectable effect", "group, material": "inside the named group, detectable and material",
              "wrong name": "wrong name, when a name is given", "false alarm": "false alarm on null sets (a failure counts as one)",
              "pairs: both": "pairs: both", "pairs: both, material": "pairs: both, detectable and material",
              "foreign says none fits": "foreign effect: says none fits (unexplained or partly)"}
    lines = ["| part | " + " | ".join(wanted) + " |", "|---" * (len(wanted) + 1) + "|"]
    parts = [(f"level {v}", lambda l, v=v: l["level"] == v) for v in (0, 1)]
    parts += [(v, lambda l, v=v: l["robot"] == v) for v in robots_of(cases)]
    parts += [(f"{v} runs", lambda l, v=v: l["runs"] == v) for v in sorted({l["runs"] for l, _ in cases}, reverse=True)]
    for name, inside in parts:
        rates = {r.name: r for r in scorecard.rates([(l, a) for l, a in cases if inside(l)])}
        shown = [rates[title] for title in wanted.values()]
        lines.append(f"| {name} | " + " | ".join(f"{r.value:.2f} ({r.hits}/{r.total})" if r.total else "–" for r in shown) + " |")
    return lines


def machine():
    model = "unknown processor"
    info = pathlib.Path("/proc/cpuinfo")
    if info.exists():
        model = next((l.split(":")[1].strip() for l in info.read_text().splitlines() if l.startswith("model name")), model)
    cores = subprocess.run(["nproc"], capture_output=True, text=True).stdout.strip()
    return f"{model}, {cores} cores, {platform.system()} {platform.release()}"


def case_lines(labels, results):
    """Every case, one line: nothing is left out of the count."""
    lines = []
    for i in sorted(results):
        label, answer = labels[i], Answer(results[i].get("diagnosis"))
        true = "+".join(f"{e['effect']}={next(iter(e['parameters'].values())):.4g}" for e in label["effects"]) or "null"
        lines.append(f"{i}\t{label['bin']}\t{label['robot']}\t{label['runs']}\t{label['level']}\t{true}\t"
                     f"{('material' if material(label) else 'detectable') if detectable(label) else '-'}\t{answer.verdict}\t{','.join(answer.names) or '-'}\t"
                     f"{answer.probability:.3f}\t{results[i].get('seconds', 0):.2f}\t{results[i].get('data_sha256', '-')[:16]}")
    return lines


def shrink_curve(cases):
    """(fraction of the held-out gap closed, share of cases that close at least this)."""
    shrinks = sorted(a.energy("shrink_fraction") or 0 for l, a in cases if l["bin"] == "single" and detectable(l)
                     and not a.silent and (a.energy("before_percent") or 0) > 2)
    return [(max(0.0, s), 1 - k / len(shrinks)) for k, s in enumerate(shrinks)]


def figures(cases, power, confusion, reliability):
    """{file name: SVG}; what has no point is left out."""
    line = plots.line_plot
    drawn = {"confusion.svg": plots.confusion_plot(confusion),
             "risk_coverage.svg": line("risk against coverage", "share of all cases answered with a name", "share of wrong names",
                                       {"joulepath": scorecard.risk_coverage(cases)}),
             "reliability.svg": line("reliability of the probabilities", "probability said", "share right",
                                     {"joulepath": [(p, s) for p, s, _ in reliability]}, True)}
    if power:
        drawn["power.svg"] = plots.power_plot(power)
    curve = shrink_curve(cases)
    if curve:
        drawn["shrink.svg"] = line("held-out energy gap closed", "fraction of the gap closed", "share of cases that close at least this",
                                   {"joulepath": curve})
    return drawn


TITLE = "Blind benchmark of the diagnosis"
CAMPAIGNS = {  # options of the command, title, what moves the robot where it is not the plant
    "full": ("", TITLE, ""), "short": (" --short", TITLE, ""),
    "field": (" --name field", "Blind benchmark on days as users drive them",
              "The field generator moves the robots: rotor and rim with backlash between them, tyres with a relaxation length, a current loop, a speed controller on encoder counts, a lidar localizer "
              "(`benchmarks/blind/README.md`). What is detectable, material, and where a gap lies, is its own oracle's word."),
    "mujoco": (" --name mujoco", "Blind benchmark on robots that MuJoCo drives",
               "MuJoCo moves the robots: rigid bodies in space, contacts, joint friction, implicit integration; the forms of the effects stand in `benchmarks/blind/README.md`. "
               "Machines, sizes, protocols and noise are drawn as in the [large campaign](blind.md). What is detectable, material, separable, and where a gap lies, is the plant's word on the same case.")}


def head_lines(frozen, name, sealed, labels, results, prefix):
    bins = {}
    for i in results:
        bins[labels[i]["bin"]] = bins.get(labels[i]["bin"], 0) + 1
    failed = sum("diagnosis" not in r for r in results.values())
    status = ("Sealed: labels' hashes were committed before the first diagnosis, seeds derive from the frozen commit" if sealed
              else "REHEARSAL: not sealed (tree or manifest not committed); it shows mechanics, it is no evidence")
    options, title, physics = CAMPAIGNS[name]
    return [f"# {title}", "", *([physics, ""] if physics else []),
            f"Command `./dev bench blind{options}`; campaign `{name}`, frozen commit `{frozen}`; {time.strftime('%Y-%m-%d')}; {machine()}.",
            f"{status}. Seeds: SHA-256 of the frozen commit and the case's key (`benchmarks/blind/harness/plan.py`).",
            f"{len(results)} cases scored of {len(labels)} sealed ({len(labels) - len(results)} not diagnosed); {failed} diagnoses gave no answer: "
            "a miss where something was to be said, an alarm on null sets. Bins: " + ", ".join(f"{k} {v}" for k, v in sorted(bins.items())) + ".",
            f"Every case stands in `{prefix}/cases.tsv`. What counts as right: `benchmarks/blind/harness/judge.py`.", ""]


DETECTABLE = """Wilson intervals. "aim": reaches the aim; "ok": between aim and failing; "FAILS": beyond. Detectable: an observer who knows the effect's law and size and all of the noise, but not the calibration error, expects 2 ln(likelihood ratio) of at least 25. Material: the effect changes the energy by 1 % or the pose by 0.02 (m, rad, rms); the diagnosis declares a materiality floor, and below it silence is its answer. Separable: an observer who does not know the calibration error, the scatter from run to run and 12 % of each law's form expects at least 25 against every other effect of the catalog and every pair of them, their sizes free (`docs/decisions/0802-blind-benchmark.md`). Pairs are detectable where each effect is, the other one being there; material where both together are, each by itself where the day without it differs by as much. Explainable: a single effect or a pair, detectable and material. Odometry and battery alone: wheel speeds, pose, and the battery's voltage and current. Last campaign: the value of the page that this one replaced, on its own cases. Fresh day: 24 runs of the same machine on another day, driven after the diagnosis; its energy gap with the robot file as it was and as corrected, and the diagnosis of that day with the corrected file. Run times are those of several diagnoses at once, one per core."""

CONTROL_METHODS = """`always_friction` names Coulomb friction whatever happens; `plain_refit` fits the robot file's own parameters and names the one that moved furthest; `stlsq` is sequentially thresholded least squares over the effects' library; `black_box` fits the residual power with a polynomial and names nothing."""


def report_files(frozen, name, sealed, prefix, labels, results, unusable=(), last=None):
    """{path below the results folder: text} of the whole report."""
    cases = cases_of(labels, results)
    power, confusion = scorecard.power(cases), scorecard.confusion(cases)
    told = [(a.probability, a.first in truth_of(l)) for l, a in cases if a.gives_a_name]
    _, _, reliability = calibration(told)
    drawn = figures(cases, power, confusion, reliability)
    picture = lambda title, file: f"![{title}]({prefix}/{file})" if file in drawn else ""
    lines = head_lines(frozen, name, sealed, labels, results, prefix)
    if unusable:
        lines += [f"Left out, their labels hold no finite numbers: {', '.join(unusable)}.", ""]
    lines += ["## Scorecard", ""] + card_table(labels, results, last or {}) + ["", DETECTABLE, ""]
    lines += ["## Controls on the same cases", ""] + control_table(labels, results) + ["", CONTROL_METHODS, ""]
    lines += ["## By robot, protocol and level", ""] + split_table(cases) + [""]
    lines += ["## Confusion", "", picture("confusion", "confusion.svg"), ""] + confusion_lines(confusion) + [""]
    lines += ["## Power", "", picture("power", "power.svg"), ""] + power_lines(power) + [""]
    lines += ["## Probabilities, risk and shrink", "",
              " ".join(filter(None, (picture("reliability", "reliability.svg"), picture("risk and coverage", "risk_coverage.svg"),
                                     picture("shrink", "shrink.svg")))), "",
              "| probability said | share right | answers |", "|---|---|---|"]
    lines += [f"| {p:.2f} | {s:.2f} | {n} |" for p, s, n in reliability]
    files = {f"{prefix}/{file}": text for file, text in drawn.items()}
    files[f"{prefix}/cases.tsv"] = "\n".join(case_lines(labels, results)) + "\n"
    files[f"{prefix}.md"] = "\n".join(lines) + "\n"
    return files


def score(frozen, name, folder, sealed, prefix, partial=False):
    """Write `folder`/`prefix`.md, its plots and the list of all cases. Opens the labels: once per campaign (a score that
    fails before it has written anything has shown nobody anything and does not count)."""
    marker = workspace.sealed_folder(frozen, name) / "opened"
    if sealed and marker.exists():
        sys.exit(f"this campaign was opened and scored on {marker.read_text().strip()}: draw a new one")
    labels, results, unusable = load(frozen, name)
    missing = len(labels) - len(results)
    if missing and not partial:
        sys.exit(f"{missing} cases are not diagnosed yet: call `diagnose` again, or score --partial (which is the only score there will be)")
    files = report_files(frozen, name, sealed, prefix, labels, results, unusable, last_campaign(folder / f"{prefix}.md"))
    marker.write_text(time.strftime("%Y-%m-%d %H:%M:%S") + "\n")
    for path, text in files.items():
        (folder / path).parent.mkdir(parents=True, exist_ok=True)
        (folder / path).write_text(text)
    print(files[f"{prefix}.md"].split("## Controls")[0] + f"{folder / (prefix + '.md')}")
    return missing, sum("diagnosis" not in r for r in results.values())

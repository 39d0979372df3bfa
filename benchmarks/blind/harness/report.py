"""Score a diagnosed campaign once and write the report."""
import json
import pathlib
import platform
import subprocess
import sys
import time

import plots
import scorecard
import seal
import workspace
from judge import Answer, detectable, material
from statistics_of import calibration, median

CONTROLS = ("always_friction", "plain_refit", "stlsq", "black_box")


def load(frozen, name):
    labels = seal.open_labels(frozen, name)
    log = workspace.sealed_folder(frozen, name) / "diagnosed.jsonl"
    if not log.exists():
        sys.exit("nothing is diagnosed yet")
    results = {}
    for line in log.read_text().splitlines():
        entry = json.loads(line)
        results[entry["id"]] = entry
    return labels, results


def card_table(cases, seconds, labels, results):
    rows = scorecard.rates(cases) + scorecard.place_rates(cases) + scorecard.next_run_rates(labels, results)
    rows += scorecard.values(cases, seconds)
    lines = ["| measure | value | 95 % interval | cases | aim / fails | |", "|---|---|---|---|---|---|"]
    return lines + [row.row() for row in rows]


def control_table(labels, results):
    columns = {"joulepath": {i: Answer(r.get("diagnosis")) for i, r in results.items()}}
    for control in CONTROLS:
        answers = {i: Answer(r["controls"][control]) for i, r in results.items() if control in r.get("controls", {})}
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


def split_table(cases):
    """The first measures by level, robot and protocol: where it is weak."""
    lines = ["| part | top-1 | top-1, material | wrong name | false alarm | pairs: both | pairs: both, material | foreign says none fits |", "|---|---|---|---|---|---|---|---|"]
    parts = [(f"level {v}", lambda l, v=v: l["level"] == v) for v in (0, 1)]
    parts += [(v, lambda l, v=v: l["robot"] == v) for v in ("nomad", "warehouse", "small")]
    parts += [(f"{v} runs", lambda l, v=v: l["runs"] == v) for v in (24, 12, 6)]
    for name, inside in parts:
        rates = {r.name: r for r in scorecard.rates([(l, a) for l, a in cases if inside(l)])}
        wanted = [r for key in ("top-1", "wrong name", "false alarm", "pairs: both", "foreign effect: says none")
                  for r in rates.values() if r.name.startswith(key)]
        lines.append(f"| {name} | " + " | ".join(f"{r.value:.2f} ({r.hits}/{r.total})" if r.total else "–" for r in wanted) + " |")
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
                     f"{answer.probability:.3f}\t{results[i].get('seconds', 0):.2f}\t{results[i]['data_sha256'][:16]}")
    return lines


def score(frozen, name, folder, sealed, prefix):
    """Write `folder`/`prefix`.md, its plots and the list of all cases. Opens the labels: once per campaign."""
    marker = workspace.sealed_folder(frozen, name) / "opened"
    if sealed and marker.exists():
        sys.exit(f"this campaign was opened and scored on {marker.read_text().strip()}: draw a new one")
    labels, results = load(frozen, name)
    marker.write_text(time.strftime("%Y-%m-%d %H:%M:%S") + "\n")
    missing = [i for i in labels if i not in results]
    cases = [(labels[i], Answer(results[i].get("diagnosis"))) for i in sorted(results)]
    seconds = [r["seconds"] for r in results.values() if "diagnosis" in r]
    failed = [i for i, r in results.items() if "diagnosis" not in r]
    folder.mkdir(parents=True, exist_ok=True)
    plots_folder = folder / prefix
    plots_folder.mkdir(exist_ok=True)
    power, confusion = scorecard.power(cases), scorecard.confusion(cases)
    _, _, reliability = calibration([(a.probability, a.first in [e["effect"] for e in l["effects"]]) for l, a in cases if a.gives_a_name])
    (plots_folder / "power.svg").write_text(plots.power_plot(power)) if power else None
    (plots_folder / "confusion.svg").write_text(plots.confusion_plot(confusion))
    (plots_folder / "risk_coverage.svg").write_text(plots.line_plot("risk against coverage", "share of all cases answered with a name", "share of wrong names", {"joulepath": scorecard.risk_coverage(cases)}))
    (plots_folder / "reliability.svg").write_text(plots.line_plot("reliability of the probabilities", "probability said", "share right", {"joulepath": [(p, s) for p, s, _ in reliability]}, True))
    shrinks = sorted(a.energy("shrink_fraction") or 0 for l, a in cases if l["bin"] == "single" and detectable(l) and not a.silent and (a.energy("before_percent") or 0) > 2)
    if shrinks:
        curve = [(max(0.0, s), 1 - k / len(shrinks)) for k, s in enumerate(shrinks)]
        (plots_folder / "shrink.svg").write_text(plots.line_plot("held-out energy gap closed", "fraction of the gap closed", "share of cases that close at least this", {"joulepath": curve}))
    (plots_folder / "cases.tsv").write_text("\n".join(case_lines(labels, results)) + "\n")
    bins = {}
    for label, _ in cases:
        bins[label["bin"]] = bins.get(label["bin"], 0) + 1
    status = ("sealed: labels' hashes were committed before the first diagnosis, seeds derive from the frozen commit" if sealed
              else "REHEARSAL: not sealed (tree or manifest not committed); it shows mechanics, it is no evidence")
    lines = ["# Blind benchmark of the diagnosis", "",
             f"Command `./dev bench blind`; campaign `{name}`, frozen commit `{frozen}`; {time.strftime('%Y-%m-%d')}; {machine()}.",
             f"{status}. Seeds: SHA-256 of the frozen commit and the case's key (`benchmarks/blind/harness/plan.py`).",
             f"{len(cases)} cases scored of {len(labels)} sealed ({len(missing)} not diagnosed); {len(failed)} diagnoses failed and count as silent. "
             + "Bins: " + ", ".join(f"{k} {v}" for k, v in sorted(bins.items())) + ".",
             "Every case stands in `" + f"{prefix}/cases.tsv" + "`. What counts as right: `benchmarks/blind/harness/judge.py`.", "",
             "## Scorecard", ""] + card_table(cases, seconds, labels, results) + [
             "", "Wilson intervals. \"aim\": reaches the aim; \"ok\": between aim and failing; \"FAILS\": beyond. Detectable: an observer who knows the effect's law and size and all of the noise, but not the calibration error, expects 2 ln(likelihood ratio) of at least 25. Material: the effect changes the energy by 1 % or the pose by 0.02 (m, rad, rms); the diagnosis declares a materiality floor, and below it silence is its answer.", "",
             "## Controls on the same cases", ""] + control_table(labels, results) + [
             "", "`always_friction` names Coulomb friction whatever happens; `plain_refit` fits the robot file's own parameters and names the one that moved furthest; `stlsq` is sequentially thresholded least squares over the effects' library; `black_box` fits the residual power with a polynomial and names nothing.", "",
             "## By robot, protocol and level", ""] + split_table(cases) + ["",
             "## Confusion", "", f"![confusion]({prefix}/confusion.svg)", ""] + confusion_lines(confusion) + ["",
             "## Power", "", f"![power]({prefix}/power.svg)", ""] + power_lines(power) + ["",
             "## Probabilities, risk and shrink", "", f"![reliability]({prefix}/reliability.svg) ![risk and coverage]({prefix}/risk_coverage.svg)" + (f" ![shrink]({prefix}/shrink.svg)" if shrinks else ""), "",
             "| probability said | share right | answers |", "|---|---|---|"] + [f"| {p:.2f} | {s:.2f} | {n} |" for p, s, n in reliability]
    (folder / f"{prefix}.md").write_text("\n".join(lines) + "\n")
    print(f"{folder / (prefix + '.md')}")
    print("\n".join(card_table(cases, seconds, labels, results)))
    return len(missing), len(failed)

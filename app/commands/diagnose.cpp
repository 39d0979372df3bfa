#include <algorithm>
#include <iostream>
#include <iterator>
#include <sstream>

#include "app/command_line.hpp"
#include "app/commands.hpp"
#include "app/diagnose/changed_simulator.hpp"
#include "app/diagnose/diagnosis_results.hpp"
#include "app/diagnose/left_out_effects.hpp"
#include "app/output_directory.hpp"
#include "app/program_parts.hpp"
#include "app/terminal.hpp"
#include "diagnosis/values/diagnosis.hpp"
#include "model/effects/effect_label.hpp"
#include "scenarios/log_files/corrected_dataset.hpp"
#include "scenarios/log_files/dataset_file.hpp"
#include "scenarios/log_files/log_tables.hpp"
#include "scenarios/log_files/repaired_dataset.hpp"
#include "scenarios/result_files/diagnosis_sentence.hpp"
#include "scenarios/result_files/next_step.hpp"
#include "scenarios/robot_files/robot_file.hpp"

namespace joulepath {
namespace {

std::string percent(double fraction) { return figure(100 * fraction, 3) + " %"; }

std::string cause_text(const Cause& cause) {
  std::string text = effect_label(cause.effect);
  for (const FoundParameter& p : cause.parameters)
    text += "  " + p.name + " = " + figure(p.value, 4) + " [" + figure(p.interval_95.first, 3) + ", " +
            figure(p.interval_95.second, 3) + "]";
  return text;
}

void print_where(std::ostream& out, const Diagnosis& d) {
  Table table({"where", "", "share", "95 %", "bias"});
  for (const char* axis : {"phase", "wheel", "path", "payload", "acceleration", "channel", "direction"}) {
    int rows = 0;
    for (const WhereCell& cell : d.where)
      if (cell.axis == axis && rows++ < 3)
        table.row({axis, cell.value, percent(cell.share_of_gap),
                   percent(cell.interval_95.first) + " to " + percent(cell.interval_95.second),
                   cell.bias_percent ? figure(*cell.bias_percent, 3) + " %" : ""});
  }
  table.print(out);
}

void print_gap(std::ostream& out, const std::string& of, const EnergyGap& e, const Diagnosis& d) {
  out << of << " gap on held-out runs: " << figure(e.before_percent, 3) << " % (bias "
      << figure(e.bias_before_percent, 3) << " %)";
  if (!d.causes.empty()) out << " -> " << figure(e.after_percent, 3) << " %";
  if (!d.causes.empty() && e.before_percent > e.noise_floor_percent)  // of noise alone a share says nothing
    out << ", shrunk by " << percent(e.shrink_fraction) << " [" << percent(e.shrink_interval_95.first) << ", "
        << percent(e.shrink_interval_95.second) << "]";
  out << ", noise floor " << figure(e.noise_floor_percent, 3) << " %\n";
}

/// What was found: causes, or candidates where none is named; unknown causes; small effects.
void print_causes(std::ostream& out, const Diagnosis& d) {
  for (const Cause& cause : d.causes) {
    out << "cause: " << cause_text(cause) << "  probability " << figure(cause.probability, 3) << '\n';
    if (cause.indistinguishable_from.empty()) continue;
    out << "  indistinguishable from:";
    for (const std::string& other : cause.indistinguishable_from) out << ' ' << other;
    out << '\n';
  }
  if (!d.pinned_combination.empty()) out << "  the data determine only: " << d.pinned_combination << '\n';
  if (d.causes.empty() && d.verdict != Verdict::no_gap)
    for (std::size_t k = 0; k < d.ranking.size() && k < 5; ++k)
      out << "candidate: " << d.ranking[k].effect << "  " << figure(d.ranking[k].probability, 3) << '\n';
  for (const UnknownCause& unknown : d.unknowns)
    out << "unknown cause: depends on " << unknown.depends_on << "  probability "
        << figure(unknown.probability, 3) << ", " << percent(unknown.share) << " of the explained gap\n";
  if (d.leftover_significant && d.unknowns.empty()) out << "leftover: " << d.leftover_description << '\n';
  for (const SmallEffect& small : d.below_materiality)
    out << "below materiality: " << small.effect << "  probability " << figure(small.probability, 3)
        << ", evidence " << figure(small.evidence, 3) << ", " << figure(small.size, 2) << " of the floor\n";
}

/// Whose gap is told: that of the motors where they are measured.
std::string measured_energy(const Diagnosis& d) {
  return d.gap.battery_energy ? "the motors' energy" : "the energy";
}

/// What the causes are worth: in plans, against the most flexible model and against a wrong candidate.
void print_worth(std::ostream& out, const Diagnosis& d) {
  const std::string shrinks = " shrinks " + measured_energy(d) + " gap by ";
  if (d.decision_missions > 0)
    out << "decisions: plans with the uncorrected model lose " << figure(d.joules_lost_percent, 2)
        << " % of their energy on " << d.decision_missions << " standard missions\n";
  if (!d.causes.empty())
    out << "ceiling: the most flexible model" << shrinks << percent(d.ceiling_shrink_fraction) << '\n';
  if (!d.control_effect.empty())
    out << "control: " << d.control_effect << " (a wrong candidate)" << shrinks
        << percent(d.control_shrink_fraction) << '\n';
}

void print_summary(std::ostream& out, const Diagnosis& d) {
  for (const std::string& note : d.notes) out << "note: " << note << '\n';
  for (const std::string& artifact : d.artifacts) out << "artifact: " << artifact << '\n';
  out << "verdict: " << paint(out, Paint::bold, verdict_name(d.verdict)) << ". " << diagnosis_meaning(d)
      << ' ' << next_step(d) << '\n';
  if (const std::string simulator = simulator_words(d); !simulator.empty()) out << simulator << '\n';
  for (const std::string& more : {velocity_filter_words(d), runs_apart_words(d)})
    if (!more.empty()) out << more << '\n';
  for (const DataCheck& check : d.data_checks) out << "suspect: " << data_check_text(check) << '\n';
  if (d.verdict == Verdict::data_suspect || !d.foreign_constants.empty()) return;
  print_gap(out, measured_energy(d), d.gap.energy, d);
  if (d.gap.battery_energy) print_gap(out, "the battery's energy", *d.gap.battery_energy, d);
  print_causes(out, d);
  print_worth(out, d);
  print_where(out, d);
  if (!d.next.motions.empty())
    out << "next run: " << d.next.why << " (expected evidence " << figure(d.next.expected_evidence, 3)
        << ", settles the question with a probability of " << figure(d.next.probability_settled, 2)
        << " by the model, not calibrated); joulepath experiment writes it\n";
}

using DiagnosisParts = std::vector<std::unique_ptr<DiagnosisPart>>;

std::string diagnose_examples(const DiagnosisParts& parts) {
  std::string text =
      "  joulepath diagnose runs/dataset.yaml --out out/diagnosis\n"
      "  joulepath diagnose dataset.yaml --robot other.yaml --out out --fail-on-gap\n"
      "  joulepath diagnose dataset.yaml --out out/diagnosis --after changed_simulator\n";
  for (const auto& part : parts) text += example_line("diagnose", part->example());
  return text;
}

class Diagnose : public Command {
 public:
  explicit Diagnose(DiagnosisParts parts)
      : Command({.name = "diagnose",
                 .says = "locate a sim-to-real gap, name its cause, measure how much a correction shrinks it",
                 .examples = diagnose_examples(parts)}),
        parts_(std::move(parts)) {}

  void declare(CommandLine& line) override {
    line.option("dataset", dataset_,
                "dataset file (YAML), or a log alone (" + log_formats() + ") with --robot")
        .required();
    line.option("--out", out_, "directory for diagnosis.json, report.html and the corrected files")
        .required();
    line.option("--robot", robot_, "robot file; replaces the dataset's");
    line.option("--without", without_,
                "remove an effect from the catalog (several: comma-separated, or repeat the option)")
        .comma_separated();
    line.flag("--signals", signals_,
              "write measured and predicted signals of every run into diagnosis.json, for the studio");
    line.option(
        "--after", after_,
        "directory with the logs of the changed simulator, named as those under predicted:; compares them "
        "with diagnosis.json in --out and writes after.json beside it");
    line.flag("--fail-on-gap", fail_on_gap_,
              "exit code 1 unless the verdict is no_gap and no run is left out");
    for (const auto& part : parts_) part->declare(line);
    add_common_flags(line, common_, "qjfu");
  }

  int run() override {
    if (!after_.empty()) return run_after();
    const std::set<std::string> without = left_out_effects(without_);
    std::vector<std::string> files{"diagnosis.json", "report.html", "robot_corrected.yaml",
                                   "dataset_corrected.yaml", "after.json"};
    for (const auto& part : parts_) {
      part->prepare();
      std::ranges::copy(part->files(), std::back_inserter(files));
    }
    OutputDirectory out(out_, files, common_.force);
    const DiagnosisResults results = diagnosis_results(
        read_dataset_or_log(
            dataset_, {.untrusted = common_.untrusted, .cut_long_logs = true, .accept_implausible = true},
            robot_),
        {.without = without});
    const Diagnosis& diagnosis = results.diagnosis;
    out.write("diagnosis.json", signals_ ? results.json_with_signals() : results.json);
    out.write("report.html", results.report());
    if (diagnosis.corrected_robot)
      out.write("robot_corrected.yaml",
                robot_text_like(results.dataset.robot_file, *diagnosis.corrected_robot));
    if (!diagnosis.corrected_instruments.empty())
      out.write("dataset_corrected.yaml",
                corrected_dataset_text(results.dataset, diagnosis.corrected_instruments, out_));
    std::ostringstream more;
    for (const auto& part : parts_) part->write(diagnosis, out, more);
    out.commit();
    if (common_.json)
      std::cout << results.json;
    else if (!common_.quiet)
      print_summary(std::cout, diagnosis), std::cout << more.str() << "results in " << out.path() << '\n';
    const bool gap = diagnosis.verdict != Verdict::no_gap || !diagnosis.runs_apart.empty();
    return fail_on_gap_ && gap ? kInfeasibleOrFailed : kDone;
  }

 private:
  /// Nothing is fitted again: options of a diagnosis have no meaning.
  void refuse_options_of_a_diagnosis() const {
    const auto refuse = [](const std::string& option) {
      throw ConfigError({{option, 0, 0}, "", "a value together with --after", "no such option", ""});
    };
    for (const auto& [option, given] : {std::pair{"--without", !without_.empty()},
                                        {"--signals", signals_},
                                        {"--fail-on-gap", fail_on_gap_}})
      if (given) refuse(option);
    for (const auto& part : parts_)
      if (const std::string option = part->asked_by(); !option.empty()) refuse(option);
  }

  int run_after() {
    refuse_options_of_a_diagnosis();
    OutputDirectory out(out_, {"after.json"}, common_.force);
    const ReadOptions options{
        .untrusted = common_.untrusted, .cut_long_logs = true, .accept_implausible = true};
    const ChangedSimulator after =
        changed_simulator(read_dataset(dataset_, options, robot_), out_ + "/diagnosis.json", after_, options);
    out.write("after.json", after.json);
    out.commit();
    if (common_.json)
      std::cout << after.json;
    else if (!common_.quiet)
      std::cout << after.sentence << '\n';
    return kDone;
  }

  std::string dataset_{}, out_{}, robot_{}, after_{};
  std::vector<std::string> without_{};
  DiagnosisParts parts_;
  bool signals_{}, fail_on_gap_{};
  CommonOptions common_{};
};

}  // namespace

std::unique_ptr<Command> make_diagnose_command() {
  return std::make_unique<Diagnose>(made(extension_parts().diagnosis_parts));
}

}  // namespace joulepath

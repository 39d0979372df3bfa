#include "diagnosis/energies_only/energy_where.hpp"

#include <cmath>
#include <numbers>

#include "diagnosis/where/gap_ledger.hpp"

namespace joulepath {
namespace {

GapAmount amount(double predicted_J, double measured_J, double scatter) {
  const double gap_J = predicted_J - measured_J;
  return {.gap_J = std::abs(gap_J),
          .noise_J = std::sqrt(2 / std::numbers::pi) * scatter * std::abs(measured_J),
          .signed_J = gap_J,
          .measured_J = std::abs(measured_J)};
}

std::string acceleration_text(double acceleration_m_s2) {
  char text[64];
  std::snprintf(text, sizeof text, "%g m/s^2", acceleration_m_s2);
  return text;
}

}  // namespace

std::vector<WhereCell> localize_energy_gap(const std::vector<EnergyRun>& runs, const Robot& robot,
                                           const EnergyNoise& noise, std::size_t bootstrap) {
  GapLedger ledger(runs.size());
  for (std::size_t r = 0; r < runs.size(); ++r) {
    const EnergyRun& run = runs[r];
    const RunJoules predicted = joules_of(run.motion, {.robot = robot});
    const GapAmount both = amount(run.of(predicted), run.measured_J(), noise.sum);
    ledger.book("path", run.path, r, both);
    ledger.book("payload", number_text(run.payload_kg, "kg"), r, both);
    if (run.acceleration_m_s2 > 0)
      ledger.book("acceleration", acceleration_text(run.acceleration_m_s2), r, both);
    ledger.book("run", run.name, r, both);
    if (!run.wheel_J) continue;
    for (Side side : kSides)
      ledger.book("wheel", side_name(side), r,
                  amount(predicted.wheel_J[side], (*run.wheel_J)[side], noise.sum));
  }
  return ledger.cells({"path", "payload", "acceleration", "wheel", "run"}, bootstrap);
}

}  // namespace joulepath

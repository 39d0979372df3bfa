#include "app/plan/loss_table.hpp"

#include <ostream>

#include "app/terminal.hpp"

namespace joulepath {

void print_loss(std::ostream& stream, const Plan& plan, const ControllerLoss& loss) {
  Table table({"", "s", "J", "optimum J", "lost J", "lost"});
  const auto row = [&](const std::string& name, const LossAtTime& at) {
    table.row({name, figure(at.duration_s), figure(at.energy_J, 6), figure(at.optimum_J, 6),
               figure(at.lost_J(), 3), figure(at.lost_percent(), 3) + " %"});
  };
  table.row({"plan", figure(plan.duration_s), figure(plan.energy.total_J(), 6), "", "", ""});
  row("controller, its own time", loss.own_time);
  if (loss.plan_time) row("controller, the plan's time", *loss.plan_time);
  table.print(stream);
  if (!loss.plan_time) stream << "the controller is later than the plan\n";
  if (!loss.broken_limit.empty()) stream << "exceeds a limit: " << loss.broken_limit << "\n";
}

}  // namespace joulepath

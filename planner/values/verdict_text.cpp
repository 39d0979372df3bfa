#include "planner/values/verdict_text.hpp"

#include <sstream>

namespace joulepath {

std::string sentence(const Infeasibility& verdict) {
  std::ostringstream text;
  text.precision(4);
  text << verdict.constraint << " at s = " << verdict.s << " (x " << verdict.x_m << " m, y " << verdict.y_m
       << " m) is missed by " << verdict.amount << " " << verdict.unit;
  for (const auto& [name, value] : verdict.relaxation)
    text << "; smallest change that works: " << name << " = " << value;
  return text.str();
}

bool is_late(const Infeasibility& verdict) {
  return verdict.constraint == "deadline" || verdict.constraint == "duration";
}

std::string leg_text(std::size_t leg, const std::string& to) {
  return std::to_string(leg + 1) + (to.empty() ? "" : " (" + to + ")");
}

}  // namespace joulepath

#pragma once

#include <iosfwd>

#include "planner/controller/controlled_drive.hpp"

namespace joulepath {

/// The energy that a controller without a speed profile loses, as a table for the terminal.
void print_loss(std::ostream& stream, const Plan& plan, const ControllerLoss& loss);

}  // namespace joulepath

#pragma once

#include <vector>

#include "planner/nlp/transcription/problem.hpp"

namespace joulepath {

/// Brakes from a problem's start to a stop: with the constant deceleration that takes `room` of the path, or,
/// where that is more than its limit, with the limit. Other rows of a segment are kept where they leave a
/// choice. Where the grid ends before the robot stands, the last square of the rate is not zero.
/// Writes nodes and squares of the rate; allocates nothing where they have room for the problem's nodes.
void emergency_stop(const nlp::Problem& problem, double room, std::vector<double>& s, std::vector<double>& b);

}  // namespace joulepath

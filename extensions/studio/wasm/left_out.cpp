// Replacements for the parts that the browser build leaves out: those whose libraries are missing (Ipopt, OMPL,
// yaml-cpp, libpng), and plans with a stated confidence, to keep the page small. A question that needs them gets
// an error message.
#include <cstdlib>

#include "planner/confidence/confident_plan.hpp"
#include "planner/nlp/ipopt/ipopt_solver.hpp"
#include "planner/path/search/search.hpp"
#include "scenarios/mission_files/map_file.hpp"
#include "scenarios/mission_files/mission_file.hpp"
#include "scenarios/registry.hpp"
#include "scenarios/text/value_builder.hpp"

namespace joulepath {
namespace {

[[noreturn]] void refuse(const char* what) {
  throw ConfigError({{}, "", what, "the program (joulepath studio)", "the page alone cannot do this"});
}

}  // namespace

namespace nlp {

Solution solve_with_ipopt(const Problem&, const std::vector<double>&, const IpoptOptions&) {
  Solution solution;
  solution.message = "the built-in solver did not converge, and Ipopt is not part of the page";
  return solution;
}

JerkSolution solve_with_ipopt(const JerkProgram&, const IpoptOptions&) {
  JerkSolution solution;
  solution.message = "the built-in solver did not converge, and Ipopt is not part of the page";
  return solution;
}

}  // namespace nlp

Plan confident_plan(const MissionRequest&, const MissionWorld&, const PlanOptions&, const Planning&) {
  refuse("a plan with a stated confidence");
}

SearchResult search_polyline(const FreeSpace&, const SearchRequest&) { refuse("a search for a route"); }
double polyline_cost(const std::vector<Point2>&, const TravelCost&) { refuse("a search for a route"); }

OccupancyGrid read_map(const std::string&, const NamedBy&, const ReadOptions&) { refuse("a map file"); }
std::string map_image_file(const std::string&, const ReadOptions&) { refuse("a map file"); }
/// The page has no extensions. An order would give the mission its stops.
void add_extensions(Registry& registry) {
  registry.mission_keys.push_back(
      {.key = "order", .read = [](MissionRequest&, const Node&) { refuse("a VDA 5050 order"); }});
}
const std::vector<Addition>& known_additions() {
  static const std::vector<Addition> none;
  return none;
}
Value read_yaml_text(const std::string&, std::string_view, int) { refuse("a file in YAML"); }

/// Replaces scenarios/text/parse_number.cpp: this library has no from_chars for floating-point numbers. The
/// JSON parser has checked the text; the locale is "C".
std::optional<double> parse_number(std::string_view text) {
  const std::string copy(text);
  char* end = nullptr;
  const double value = std::strtod(copy.c_str(), &end);
  const bool digits = copy.find_first_not_of("+-.0123456789eE") == std::string::npos;
  if (copy.empty() || !digits || end != copy.c_str() + copy.size() || !(value - value == 0.0))
    return std::nullopt;
  return value;
}

}  // namespace joulepath

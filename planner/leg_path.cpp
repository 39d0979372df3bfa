#include "planner/leg_path.hpp"

#include "planner/path/bezier_chain.hpp"

namespace joulepath {
namespace {

[[noreturn]] void refuse(const ItemMarks& marks, const std::string& key, const std::string& found,
                         const std::string& accepted, const std::string& hint = {}) {
  throw ConfigError({.mark = marks.at(key),
                     .key = marks.key_path(key),
                     .found = found,
                     .accepted = accepted,
                     .hint = hint});
}

LegPath along_bezier(const LegRequest& leg, const Pose& start) {
  const BezierFrame frame =
      leg.path->frame == PathRequest::Frame::start ? BezierFrame::start : BezierFrame::map;
  BezierChainResult chain = bezier_chain(leg.path->bezier_m, start, frame);
  if (!chain.ok()) {
    const BezierFinding& defect = chain.defects.front();
    refuse(leg.marks, "path", defect.message,
           "a chain of cubic Bezier curves without cusps or gaps, at least 1 mm long");
  }
  return {.path = std::move(chain.path), .source = "bezier"};
}

}  // namespace

LegPath leg_path(const LegRequest& leg, std::size_t leg_index, const Pose& start,
                 const MissionRequest& mission, const MissionWorld& world, const PlanOptions& options) {
  if (leg.path) return along_bezier(leg, start);
  (void)leg_index, (void)mission, (void)world, (void)options;
  refuse(leg.marks, "to", "'" + leg.to + "'", "a leg with a path");
}

}  // namespace joulepath

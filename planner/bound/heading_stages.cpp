#include "planner/bound/heading_stages.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace joulepath {
namespace {

constexpr double kRampStage_m = 0.025, kMiddleStage_m = 0.05, kLongMiddleStage_m = 0.15;
constexpr int kMiddleStages = 300;
constexpr double kRampShare = 0.4;  ///< of the way from rest, near rest
constexpr double kFirstStage_m = 0.01;
constexpr double kPartOfAStage = 1.2;  ///< of its nominal length: a longer piece is cut
constexpr double kClosed = 0.8;        ///< of its nominal length: from there on it takes no further part

HeadingRates between(const HeadingRates& from, const HeadingRates& to, double share) {
  return {from.most_J, (1 - share) * from.at + share * to.at};
}

/// One piece on which the rate is concave: its ends and, in the middle, their mean.
void add_piece(HeadingStage& stage, double length_m, const HeadingRates& from, const HeadingRates& to) {
  const double at_m = stage.length_m;
  stage.nodes.push_back({at_m, 0.25 * length_m, from});
  stage.nodes.push_back({at_m + 0.5 * length_m, 0.5 * length_m, between(from, to, 0.5)});
  stage.nodes.push_back({at_m + length_m, 0.25 * length_m, to});
  stage.length_m += length_m;
}

void close(HeadingStage& stage, std::vector<HeadingStage>& stages) {
  if (!(stage.length_m > 0)) return;
  for (HeadingStage::Node& node : stage.nodes) node.offset_m -= 0.5 * stage.length_m;
  stage.group = stages.empty() ? 0 : stages.back().group + 1;
  stages.push_back(std::exchange(stage, {}));
}

void add_middle(std::vector<HeadingStage>& stages, const HeadingRates& rates, double length_m,
                bool optional) {
  const double most = std::max(double{kMiddleStages}, std::ceil(length_m / kLongMiddleStage_m));
  const int parts = static_cast<int>(std::min(std::ceil(length_m / kMiddleStage_m), most));
  if (parts == 0) return;
  HeadingStage stage{.optional = optional};
  add_piece(stage, length_m / parts, rates, rates);
  close(stage, stages);
  for (int k = 1; k < parts; ++k) stages.push_back(HeadingStage(stages.back()));
}

/// The same stage from its other end.
void turn_around(HeadingStage& stage) {
  for (HeadingStage::Node& node : stage.nodes) {
    node.offset_m = -node.offset_m;
    node.rates.at.reverseInPlace();
  }
}

}  // namespace

double HeadingStage::cost_J(double per_rad_J, double least_slope, double most_slope) const {
  double cost_J = 0;
  for (const Node& node : nodes)
    cost_J += node.weight_m * std::min(node.rates(per_rad_J - node.offset_m * least_slope),
                                       node.rates(per_rad_J - node.offset_m * most_slope));
  return cost_J;
}

std::vector<HeadingStage> heading_stages(const RateTable& table, double least_m, double most_m,
                                         bool backward) {
  const std::vector<double>& s = table.line.s_m;
  const double line_m = table.line.length_m();
  std::vector<HeadingStage> stages;
  HeadingStage open;
  for (std::size_t k = 0; k + 1 < s.size(); ++k) {
    const double ds = s[k + 1] - s[k], from_rest_m = std::min(s[k + 1], line_m - s[k]);
    if (k == table.line.peak) {
      close(open, stages);
      add_middle(stages, table.middle, ds + least_m - line_m, false);
      add_middle(stages, table.middle, most_m - least_m, true);
    } else if (ds > 0) {
      const auto& [from, to] = table.pieces[k];
      if (!open.nodes.empty() && open.most_J() != from.most_J) close(open, stages);
      const double stage_m = std::clamp(kRampShare * from_rest_m, kFirstStage_m, kRampStage_m);
      const int parts = static_cast<int>(std::ceil(ds / (kPartOfAStage * stage_m)));
      for (int j = 0; j < parts; ++j) {
        add_piece(open, ds / parts, between(from, to, 1.0 * j / parts), between(from, to, (j + 1.0) / parts));
        if (open.length_m >= kClosed * stage_m) close(open, stages);
      }
    }
  }
  close(open, stages);
  if (!backward) return stages;
  std::reverse(stages.begin(), stages.end());
  std::for_each(stages.begin(), stages.end(), turn_around);
  return stages;
}

}  // namespace joulepath

#include "extensions/onboard/monitor/cause_watch.hpp"

#include <algorithm>
#include <cmath>

#include "model/normal_quantiles.hpp"
#include "model/watt_hours.hpp"

// Design: docs/decisions/0512-monitor.md
namespace joulepath {
namespace {

constexpr std::size_t kLeastWindows = 6, kMostWindows = 200;
constexpr std::size_t kLeastBlocks = 2;        ///< of a change, the one in which it began included
constexpr std::size_t kMostBlocks = 12;        ///< until its size is told, however well it is known
constexpr double kWeighed = 0.1;               ///< relative sigma of a size that is known well enough
constexpr double kStop_s = 0.3;                ///< of standing: ends a block
constexpr double kLongestBlock_s = 60.0;       ///< of driving without a stop
constexpr double kLeastTolerance = 0.01;       ///< of the total mass: no model is better
constexpr double kResistanceTolerance = 0.10;  ///< of the nominal dry friction
constexpr double kDisagrees = 3.0;  ///< sigmas between driving and braking that no payload explains
constexpr double kNoiseForgetting = 0.98, kScatterForgetting = 0.98;
constexpr double kFirstScatter = 2.0, kFirstCount = 4.0;  ///< taken until blocks show their own scatter
constexpr double kMostJump = 9.0;        ///< squared sigmas: one change of payload is one jump
constexpr double kLeastNoise = 1e-4;     ///< of a row, A or W: readings are rounded
constexpr double kUsefulTolerances = 8;  ///< sigma of kg, at most: a turn in place says next to nothing
constexpr double kUsefulSigma = 1.0;     ///< of resistance: a block without any drive says nothing

double relative_sigma(const Robot& robot, const char* key) {
  const auto found = robot.uncertainty.find(key);
  return found == robot.uncertainty.end() ? 0.0 : found->second;
}

/// Mass that a robot file may be wrong by: its own uncertainty, 1 % at least. A torque constant that is 1 %
/// higher looks like 1 % more mass.
double mass_tolerance_kg(const Robot& robot) {
  const double mass_kg = robot.total_mass_kg(0);
  const double sigma =
      std::hypot(relative_sigma(robot, "chassis_mass_kg"), relative_sigma(robot, "torque_constant_Nm_A"));
  return mass_kg * std::max(kLeastTolerance, kNormal95OneSided * sigma);
}

/// Changes of mass beyond the tolerance that are looked for.
std::vector<double> masses_kg(const Robot& robot) {
  std::vector<double> sizes;
  for (const double share : {0.01, 0.02, 0.04, 0.08, 0.16, 0.32})
    sizes.push_back(share * robot.total_mass_kg(0));
  return sizes;
}

std::vector<double> resistances() { return {0.05, 0.1, 0.2, 0.4, 0.8}; }

}  // namespace

void CauseWatch::Pool::add(const Estimate& x) {
  const double weight = 1 / (x.sigma * x.sigma);
  information += weight;
  sum += weight * x.value;
  ++count;
}

Estimate CauseWatch::Pool::mean() const {
  if (count == 0) return {0, kNoLimit};
  return {sum / information, 1 / std::sqrt(information)};
}

CauseWatch::CauseWatch(const Robot& robot, double hours_per_false_alarm)
    : signatures_(robot),
      windows_(robot.geometry),
      tolerance_kg_(mass_tolerance_kg(robot)),
      // Two tests share the rate.
      payload_(tolerance_kg_, masses_kg(robot), 2 * hours_per_false_alarm),
      resistance_(kResistanceTolerance, resistances(), 2 * hours_per_false_alarm),
      block_(signatures_.names().size()),
      suspected_(signatures_.names().size()) {}

std::optional<CauseChange> CauseWatch::add(const MonitorRow& row, double payload_kg) {
  std::optional<CauseChange> change;
  if (block_is_over(row)) change = close_block();
  constexpr double kStanding_rad_s = 0.05;
  const Sided<double>& wheel = row.wheel_speed_rad_s;
  if (std::abs(wheel.left) > kStanding_rad_s || std::abs(wheel.right) > kStanding_rad_s)
    last_turning_s_ = row.time_s;
  if (std::isnan(last_block_end_s_)) last_block_end_s_ = row.time_s;
  if (const auto window = windows_.add(row))
    if (const auto rows = signatures_.equations(*window, payload_kg)) {
      block_.add(*window, *rows);
      if (suspected_.windows() > 0 || payload_.suspicious() || resistance_.suspicious())
        suspected_.add(*window, *rows);
    }
  return change;
}

bool CauseWatch::block_is_over(const MonitorRow& row) const {
  if (block_.windows() < kLeastWindows) return false;
  return row.time_s - last_turning_s_ > kStop_s || row.time_s - block_.begin_s() > kLongestBlock_s ||
         block_.windows() >= kMostWindows;
}

/// 1-sigma of a row: of all blocks so far and of this one, whichever is larger, with room for how little is
/// known of it.
double CauseWatch::noise(const BlockFit::Leftover& leftover) {
  squares_ = kNoiseForgetting * squares_ + leftover.squares;
  freedom_ = kNoiseForgetting * freedom_ + std::max(leftover.freedom, 0.0);
  if (freedom_ < 1) return kAbsent;
  const double room = 1 + 2 * std::sqrt(2 / freedom_);
  const double own = leftover.freedom >= 10 ? leftover.squares / leftover.freedom : 0.0;
  return std::max(kLeastNoise, std::sqrt(std::max(room * squares_ / freedom_, own)));
}

/// Factor on a sigma for what estimates scatter more from block to block than their rows say: the model's
/// small errors differ between one drive and the next. Differences of neighbors do not see a lasting change.
double CauseWatch::scatter(const Estimate& extra_kg) {
  if (before_) {
    const double variance = extra_kg.sigma * extra_kg.sigma + before_->sigma * before_->sigma;
    const double jump = extra_kg.value - before_->value;
    jumps_ = kScatterForgetting * jumps_ + std::min(jump * jump / variance, kMostJump);
    jump_count_ = kScatterForgetting * jump_count_ + 1;
  }
  before_ = extra_kg;
  return std::sqrt(std::max(1.0, (kFirstCount * kFirstScatter + jumps_) / (kFirstCount + jump_count_)));
}

std::optional<CauseChange> CauseWatch::close_block() {
  const double sigma = noise(block_.leftover());
  if (std::isnan(sigma)) {
    block_.reset(signatures_.names().size());
    return std::nullopt;
  }
  BlockEstimate block = block_.estimate(sigma);
  const double hours = (block.end_s - last_block_end_s_) / kSecondsPerHour;
  last_block_end_s_ = block.end_s;
  block_.reset(signatures_.names().size());
  ++blocks_;
  const bool weighs = block.extra_kg.sigma < kUsefulTolerances * tolerance_kg_;
  const double factor = weighs ? scatter(block.extra_kg) : 1.0;
  for (Estimate* x : {&block.extra_kg, &block.disagreement, &block.resistance}) x->sigma *= factor;
  extra_kg_.add(block.extra_kg);
  const bool payload =
      weighs && payload_.add(block.extra_kg.value, block.extra_kg.sigma, hours, block.begin_s);
  const bool useful = block.resistance.sigma < kUsefulSigma;
  const bool resists =
      useful && resistance_.add(block.resistance.value, block.resistance.sigma, hours, block.begin_s);
  pool(block, weighs);
  if (payload && is_weighed()) return payload_or_not(block);
  if (resists && resistance_blocks_ >= kLeastBlocks)
    return other_cause(block, resistance_,
                       "the resistance at constant speed changed, which no payload explains");
  if (!payload_.suspicious() && !resistance_.suspicious()) suspected_.reset(signatures_.names().size());
  return std::nullopt;
}

/// Pools what blocks since the suspected changes say. The block in which a change began is left out: what
/// changes within a block looks different while driving and while braking.
void CauseWatch::pool(const BlockEstimate& block, bool weighs) {
  if (weighs) pool_payload(block);
  if (!(block.resistance.sigma < kUsefulSigma)) return;
  if (resistance_.since_s() >= block.begin_s) {
    resistance_blocks_ = 0;
    suspected_resistance_ = {};
  } else {
    suspected_resistance_.add(block.resistance);
  }
  ++resistance_blocks_;
}

void CauseWatch::pool_payload(const BlockEstimate& block) {
  if (payload_.since_s() >= block.begin_s) {
    payload_blocks_ = 0;
    suspected_kg_ = suspected_disagreement_ = {};
  } else {
    suspected_kg_.add(block.extra_kg);
    suspected_disagreement_.add(block.disagreement);
  }
  ++payload_blocks_;
}

/// Whether the blocks since a suspected change of payload tell its size.
bool CauseWatch::is_weighed() const {
  if (payload_blocks_ < kLeastBlocks) return false;
  const Estimate kg = suspected_kg_.mean();
  return payload_blocks_ >= kMostBlocks ||
         kg.sigma < std::max(0.5 * tolerance_kg_, kWeighed * std::abs(kg.value - payload_.reference()));
}

CauseChange CauseWatch::payload_or_not(const BlockEstimate& block) {
  const Estimate disagreement = suspected_disagreement_.mean();
  const Estimate kg = suspected_kg_.mean();
  // What payload adds while driving it gives back while braking.
  if (std::abs(disagreement.value) > kDisagrees * disagreement.sigma &&
      std::abs(disagreement.value) > tolerance_kg_) {
    unexplained_kg_ =
        std::max({unexplained_kg_, std::abs(disagreement.value), std::abs(kg.value - known_kg_)});
    return other_cause(block, payload_,
                       "accelerating and braking show different masses, where a payload shows the same");
  }
  if (unexplained_kg_ > 0 && std::abs(kg.value - known_kg_) < unexplained_kg_ + tolerance_kg_)
    return other_cause(block, payload_, "the cause found before hides a payload change of this size");
  if (std::abs(kg.value - payload_.reference()) < tolerance_kg_)
    return other_cause(block, payload_,
                       "a part of the drive differed and what followed did not, as on a patch of floor");
  known_kg_ = kg.value;
  CauseChange change{.payload = true,
                     .time_s = block.end_s,
                     .since_s = payload_.since_s(),
                     .extra_kg = kg,
                     .resistance = block.resistance};
  restart();
  payload_.restart(kg.value);
  extra_kg_.add(kg);
  return change;
}

CauseChange CauseWatch::other_cause(const BlockEstimate& block, const EDetector& alarmed,
                                    std::string reason) {
  const int best = suspected_.windows() > 0 ? suspected_.best_other() : -1;
  CauseChange change{
      .payload = false,
      .time_s = block.end_s,
      .since_s = alarmed.since_s(),
      .extra_kg = suspected_kg_.mean(),
      .resistance = suspected_resistance_.count > 0 ? suspected_resistance_.mean() : block.resistance,
      .looks_like = best >= 0 ? signatures_.names()[static_cast<std::size_t>(best)] : std::string(),
      .reason = std::move(reason)};
  // What such a cause seems to weigh is no news afterwards.
  const double reference_kg = &alarmed == &payload_ ? change.extra_kg.value : payload_.reference();
  restart();
  payload_.restart(reference_kg);
  resistance_.restart(change.resistance.value);
  return change;
}

void CauseWatch::restart() {
  suspected_.reset(signatures_.names().size());
  suspected_kg_ = suspected_disagreement_ = suspected_resistance_ = extra_kg_ = {};
  payload_blocks_ = resistance_blocks_ = 0;
}

std::optional<Estimate> CauseWatch::extra_kg() const {
  if (!(extra_kg_.information > 0)) return std::nullopt;
  Estimate mean = extra_kg_.mean();
  mean.sigma = std::hypot(mean.sigma, tolerance_kg_ / kNormal95OneSided);
  return mean;
}

}  // namespace joulepath

#include "planner/joint/joint_newton.hpp"

#include <cmath>

#include "planner/joint/bordered_system.hpp"
#include "planner/joint/clearance_rows.hpp"
#include "planner/joint/interior_rows.hpp"
#include "planner/joint/joint_segment.hpp"
#include "planner/joint/motor_rows.hpp"
#include "planner/joint/path_geometry.hpp"
#include "planner/joint/regularized_step.hpp"
#include "planner/joint/speed_parts.hpp"
#include "planner/joint/start_fit.hpp"

namespace joulepath::joint {
namespace {

using Eigen::Index, Eigen::VectorXd;
using Jet = nlp::JetOf<kSegmentVariables>;

constexpr double kCostScale = 100;         ///< the cost of a start in the program's unit
constexpr double kMostTurn_rad = 0.5;      ///< of a knot's phi in one step
constexpr double kPhiWeight = 10;          ///< of phi in the regularization; of a length: 1/length^2
constexpr double kLeastSquare = 1e-7;      ///< of b, relative to the largest
constexpr double kDisplacementWeight = 2;  ///< of the path's displacement in the regularization: a knot of a
                                           ///< long piece moves all that follows by metres
constexpr double kLeastOfRest = 0.3;       ///< of the other residuals: the least complementarity
constexpr double kFeasible = 0.01;         ///< of residuals relative to the cost, and of the targets (m)
constexpr double kStartShare = 0.6;        ///< of the limits that a start uses
constexpr double kRowWeight = 0.05;        ///< of a row's violation in the merit
constexpr double kStalled = 1e-6;          ///< a shorter step leads nowhere
constexpr double kDeep_m = 0.1;            ///< of a missing clearance: beyond, the way out may be lost
constexpr int kWayOut = 15;                ///< steps until no place may lie deeper than that
constexpr double kNearTolerance = 5;       ///< of a solution whose cost no longer changes
/// A cost that changes by less (relative) in kPatience steps has converged: the rest is a flat valley, which
/// obstacles fold.
constexpr double kLeastGain = 1e-4;
constexpr int kPatience = 8;

/// Whether a row goes below -kDeep_m, or deeper where it was there before.
bool sinks(const std::vector<ClearanceRows::Nearest>& before,
           const std::vector<ClearanceRows::Nearest>& after) {
  for (std::size_t i = 0; i < after.size(); ++i)
    if (after[i].slack_m < std::min(before[i].slack_m, -kDeep_m)) return true;
  return false;
}

}  // namespace

class JointNewton::Steps {
 public:
  Steps(const Start& start, double gap, const VectorXd& squares);
  JointSolution run(const NewtonOptions& options);

 private:
  struct Sums {
    double cost{}, duration_s{}, complementarity{}, primal{}, dual{};
    bool lost{};  ///< a place lies so deep in an obstacle that no direction leads out, or still does after
                  ///< kWayOut steps
    double error() const { return std::max({complementarity, primal, 0.1 * dual}) / std::max(cost, 1e-3); }
    bool is_near(double tolerance) const {
      return complementarity < kNearTolerance * tolerance * cost && primal < tolerance * cost;
    }
  };
  struct Values {
    std::vector<SegmentValues<double>> parts{};
    std::vector<ClearanceRows::Nearest> clearance{};
    std::vector<double> motors{};
    VectorXd errors{};
  };

  void lay_out();
  void begin_speed();
  double cost_J(const VectorXd& squares) const;
  double cap(const SpeedPart& part, double f) const;
  void begin_rows();
  template <class Each>
  void for_bounds(const VectorXd& squares, const VectorXd& parameters, const Each& each);
  const DriveLaw& law(const SpeedPart& part) const { return program_.laws[program_.pieces[part.piece].law]; }
  template <class Real>
  double row_value(std::size_t k, std::size_t r, const SegmentValues<Real>& at) const {
    const RowLaw& row = row_laws_[parts_[k].piece][r];
    const Real& quantity = at.bounded[row.quantity];
    if constexpr (std::is_same_v<Real, double>)
      return 1 + row.slope * quantity;
    else
      return 1 + row.slope * quantity.value;
  }
  double loss(const SpeedPart& part) const { return 1 - law(part).efficiency; }
  template <class Real>
  SegmentValues<Real> values_of(std::size_t k, const VectorXd& squares, const VectorXd& parameters) const;
  Values values(const VectorXd& squares, const VectorXd& parameters) const;

  Sums assemble();
  void look_at(const NewtonOptions& options);
  void add_part(std::size_t k, Sums& sums);
  void add_rows_of_bounds(Sums& sums);
  void direction();
  StepLengths step_rows();
  double merit(const Values& at, const VectorXd& squares, const VectorXd& parameters, double step);
  void search(const StepLengths& lengths);
  void correct(VectorXd& parameters, double step, const VectorXd& errors) const;
  void lower_barrier(double tolerance);

  Program program_;
  double gap_;
  std::vector<std::array<RowLaw, kSegmentRows>> row_laws_{};  ///< per piece
  double scale_{1};                                           ///< program's unit per J
  std::vector<SpeedPart> parts_;
  Index free_{};           ///< number of unknown squares
  double most_square_{1};  ///< scale of b
  VectorXd b_{}, p_{};     ///< squares at all nodes; parameters

  std::vector<SegmentValues<Jet>> jets_{};
  std::vector<std::array<Row, kSegmentRows>> rows_{};
  std::vector<std::array<Recovery, 2>> channels_{};
  std::vector<Row> bounds_{};
  std::vector<Index> held_;  ///< knots that do not move
  ClearanceRows clearance_;
  MotorRows motors_;
  PathGeometry geometry_;
  BorderedSystem system_{};
  VectorXd lambda_{};  ///< multipliers of the targets

  double mu_{};
  std::size_t pairs_{};
  Regularization regularization_{};
  double penalty_{0}, step_{1};

  bool assembled_{};  ///< at the present state
  bool stalled_{};
  Sums sums_{};
  std::array<double, kPatience> recent_J_{};  ///< costs of the last steps
  JointSolution solution_{};
};

JointNewton::Steps::Steps(const Start& start, double gap, const VectorXd& squares)
    : program_(start.program),
      gap_(gap),
      parts_(speed_parts(program_)),
      p_(start.parameters),
      held_(program_.held()),
      clearance_(program_),
      motors_(program_, parts_),
      geometry_(program_) {
  lay_out();
  if (squares.size()) {
    b_ = squares;
  } else {
    follow_waypoints(program_, p_);
    reach_targets(program_, p_, 8);
    begin_speed();
  }
  most_square_ = b_.maxCoeff();
  clearance_.lay_out(p_);
  begin_rows();
  recent_J_.fill(kNoLimit);
}

void JointNewton::Steps::lay_out() {
  for (const Piece& piece : program_.pieces)
    row_laws_.push_back(row_laws(program_.laws[piece.law].limits, piece.sign));
  std::vector<BorderedSystem::Part> unknowns;
  for (const SpeedPart& part : parts_) {
    unknowns.push_back({{part.b0, part.b1}, part.parameters});
    free_ = std::max(free_, part.b1 + 1);
  }
  system_ = BorderedSystem(std::move(unknowns), free_, program_.parameters());
  const Limits& most = program_.laws.front().limits;
  const double fastest = std::isfinite(most.speed_m_s) ? most.speed_m_s : 1.0;
  most_square_ = fastest * fastest;
}

/// Square of the rate that a start has at most at a place.
double JointNewton::Steps::cap(const SpeedPart& part, double f) const {
  const Limits& most = law(part).limits;
  const auto [a, b, l] = part.parameters;
  const PieceRates<double> rates = piece_rates(p_[a], p_[b], program_.half_track_m());
  const double A = std::abs(rates.A(f)) + 1e-9, W = std::abs(rates.W(f)) + 1e-9, length_m = p_[l];
  const auto least = [](double x, double y) { return std::isfinite(y) ? std::min(x, y) : x; };
  double cap = 0.9 * most_square_ / (A * A);
  cap = least(cap, 0.9 * most.speed_m_s * most.speed_m_s / (A * A));
  cap = least(cap, kStartShare * most.lateral_acceleration_m_s2 / (A * W));
  cap = least(cap, kStartShare * most.yaw_rate_rad_s * most.yaw_rate_rad_s / (W * W));
  cap = least(cap, 0.5 * most.yaw_acceleration_rad_s2 * length_m / (std::abs(rates.dW) + 1e-9));
  return least(cap, 0.5 * most.acceleration_m_s2 * length_m / (std::abs(rates.dA) + 1e-9));
}

/// Forward and backward pass at a share of the limits.
void JointNewton::Steps::begin_speed() {
  const auto count = static_cast<Index>(parts_.size());
  b_.setConstant(count + 1, kNoLimit);
  VectorXd gain(count);
  for (Index k = 0; k < count; ++k) {
    const SpeedPart& part = parts_[static_cast<std::size_t>(k)];
    b_[k] = std::min(b_[k], cap(part, part.f0));
    b_[k + 1] = cap(part, part.f1);
    if (part.b0 < 0) b_[k] = 0;
    if (part.b1 < 0) b_[k + 1] = 0;
    const auto [from, to, l] = part.parameters;
    const PieceRates<double> rates = piece_rates(p_[from], p_[to], program_.half_track_m());
    const double A = std::max(std::abs(rates.A(part.f0)), std::abs(rates.A(part.f1))),
                 W = std::max(std::abs(rates.W(part.f0)), std::abs(rates.W(part.f1)));
    const Limits& most = law(part).limits;
    const double along = std::min({most.acceleration_m_s2, most.deceleration_m_s2, most_square_});
    const double turning = std::min(most.yaw_acceleration_rad_s2, most_square_ / program_.half_track_m());
    gain[k] = 2 * p_[l] * (part.f1 - part.f0) *
              std::min(kStartShare * along / (A + 1e-3), 0.4 * turning / (W + 1e-3));
  }
  for (Index k = 0; k < count; ++k) b_[k + 1] = std::min(b_[k + 1], b_[k] + gain[k]);
  for (Index k = count; k-- > 0;) b_[k] = std::min(b_[k], b_[k + 1] + gain[k]);
  for (Index k = 0; k < count; ++k)
    if (parts_[static_cast<std::size_t>(k)].b1 >= 0) b_[k + 1] = std::max(b_[k + 1], 1e-4 * most_square_);
  // Limits may be far above the cheapest speed: from there the method does not find the way to it. Where a
  // second costs nothing there is no such speed.
  constexpr int kMostHalvings = 16;
  double least_J = cost_J(b_);
  for (int halvings = 0; halvings < kMostHalvings; ++halvings) {
    const double slower_J = cost_J(0.5 * b_);
    if (!(slower_J < least_J)) break;
    b_ *= 0.5;
    least_J = slower_J;
  }
}

/// Cost of the present path at these squares of the rate, recovery left out.
double JointNewton::Steps::cost_J(const VectorXd& squares) const {
  double cost_J = 0;
  for (std::size_t k = 0; k < parts_.size(); ++k) {
    const auto v = values_of<double>(k, squares, p_);
    cost_J += law(parts_[k]).price_W * v.duration_s;
    for (const double E : v.energy_J) cost_J += std::max(E, 0.0) / scale_;
  }
  return cost_J;
}

template <class Real>
SegmentValues<Real> JointNewton::Steps::values_of(std::size_t k, const VectorXd& squares,
                                                  const VectorXd& p) const {
  const SpeedPart& part = parts_[k];
  SegmentValues<Real> out;
  evaluate_segment(law(part), variables_of<Real>(part, k, squares, p), part.f0, part.f1, out);
  for (Real& energy : out.energy_J) energy = energy * scale_;
  return out;
}

JointNewton::Steps::Values JointNewton::Steps::values(const VectorXd& squares,
                                                      const VectorXd& parameters) const {
  Values all;
  for (std::size_t k = 0; k < parts_.size(); ++k)
    all.parts.push_back(values_of<double>(k, squares, parameters));
  PathGeometry geometry(program_);
  geometry.place(parameters);
  all.errors = geometry.errors();
  all.clearance = clearance_.nearest(geometry);
  all.motors = motors_.values(squares, parameters);
  return all;
}

/// Calls each(row, value, parameter, sign) for the bounds of squares (parameter: none), knots and lengths.
template <class Each>
void JointNewton::Steps::for_bounds(const VectorXd& squares, const VectorXd& parameters, const Each& each) {
  std::size_t row = 0;
  for (std::size_t k = 0; k < parts_.size(); ++k)
    if (parts_[k].b1 >= 0)
      each(bounds_[row++], squares[static_cast<Index>(k) + 1] / most_square_ - kLeastSquare, parts_[k].b1,
           true, 1 / most_square_);
  for (std::size_t j = 0; j < program_.pieces.size(); ++j) {
    const Piece& piece = program_.pieces[j];
    const double about = piece.straight_rad();
    const bool new_knot = j == 0 || program_.pieces[j - 1].to != piece.from;
    for (const Index knot : {piece.from, piece.to}) {
      if (piece.turns || (knot == piece.from && !new_knot)) continue;
      each(bounds_[row++], program_.most_direction_rad + (parameters[knot] - about), knot, false, 1.0);
      each(bounds_[row++], program_.most_direction_rad - (parameters[knot] - about), knot, false, -1.0);
    }
    const Index length = program_.length_of(j);
    each(bounds_[row++], parameters[length] - program_.shortest_m(j), length, false, 1.0);
  }
}

void JointNewton::Steps::begin_rows() {
  scale_ = kCostScale / cost_J(b_);
  const Values v = values(b_, p_);
  pairs_ = parts_.size() * (kSegmentRows + 4) + v.clearance.size();
  bounds_.resize(static_cast<std::size_t>(free_ + 3 * program_.parameters()));
  std::size_t used = 0;
  for_bounds(b_, p_, [&](Row&, double, Index, bool, double) { ++used; });
  bounds_.resize(used);
  pairs_ += used;
  mu_ = gap_ * kCostScale / static_cast<double>(pairs_);
  for_bounds(b_, p_, [&](Row& row, double value, Index, bool, double) { row.begin(value, 1e-3, mu_); });
  rows_.resize(parts_.size());
  channels_.resize(parts_.size());
  for (std::size_t k = 0; k < parts_.size(); ++k) {
    for (std::size_t r = 0; r < kSegmentRows; ++r) rows_[k][r].begin(row_value(k, r, v.parts[k]), 2e-2, mu_);
    for (std::size_t c = 0; c < 2; ++c) channels_[k][c].begin(v.parts[k].energy_J[c], loss(parts_[k]), mu_);
  }
  clearance_.begin(v.clearance, mu_);
  lambda_.setZero(v.errors.size());
}

void JointNewton::Steps::add_part(std::size_t k, Sums& sums) {
  const SegmentValues<Jet>& x = jets_[k];
  const double price = law(parts_[k]).price_W * scale_, lost = loss(parts_[k]);
  std::array<double, kSegmentVariables> gradient{}, lagrangian{};
  std::array<double, Jet::kTriangle> hessian{};
  const auto add = [&](const Jet& f, double of_gradient, double of_lagrangian, double of_hessian,
                       double of_square) {
    for (std::size_t i = 0, at = 0; i < kSegmentVariables; ++i) {
      gradient[i] += of_gradient * f.d[i];
      lagrangian[i] += of_lagrangian * f.d[i];
      for (std::size_t n = 0; n <= i; ++n, ++at)
        hessian[at] += of_hessian * f.dd[at] + of_square * f.d[i] * f.d[n];
    }
  };
  add(x.duration_s, price, price, price, 0);
  sums.cost += price * x.duration_s.value;
  sums.duration_s += x.duration_s.value;
  for (std::size_t c = 0; c < 2; ++c) {
    Recovery& channel = channels_[k][c];
    add(x.energy_J[c], channel.pull(lost, mu_), 1 - channel.y, 1 - channel.y, channel.stiffness());
    sums.cost += channel.E + lost * channel.zeta;
    sums.complementarity += channel.u * channel.zeta + channel.y * channel.w;
    sums.primal += std::abs(channel.residual()) * channel.y;
    sums.dual += std::abs(lost - channel.u - channel.y) * channel.zeta;
  }
  struct Weights {
    double gradient{}, multiplier{}, stiffness{};
  };
  std::array<Weights, kSegmentQuantities> weights{};
  for (std::size_t r = parts_[k].b1 < 0 ? kCapRows : 0; r < kSegmentRows; ++r) {  // at rest every cap holds
    const Row& row = rows_[k][r];
    const auto [quantity, slope] = row_laws_[parts_[k].piece][r];
    weights[quantity].gradient -= slope * row.push(mu_);
    weights[quantity].multiplier -= slope * row.z;
    weights[quantity].stiffness += slope * slope * row.stiffness();
    sums.complementarity += row.s * row.z;
    sums.primal += std::abs(row.residual()) * row.z;
  }
  for (std::size_t q = parts_[k].b1 < 0 ? kCapQuantities : 0; q < kSegmentQuantities; ++q)
    add(x.bounded[q], weights[q].gradient, weights[q].multiplier, weights[q].multiplier,
        weights[q].stiffness);
  system_.add(k, gradient, lagrangian, hessian);
}

void JointNewton::Steps::add_rows_of_bounds(Sums& sums) {
  for_bounds(b_, p_, [&](Row& row, double value, Index at, bool square, double slope) {
    row.value = value;
    system_.add_bound(square, at, -slope * row.push(mu_), -slope * row.z, slope * slope * row.stiffness());
    sums.complementarity += row.s * row.z;
    sums.primal += std::abs(row.residual()) * row.z;
  });
}

JointNewton::Steps::Sums JointNewton::Steps::assemble() {
  const Index n = program_.parameters();
  system_.clear();
  Sums sums;
  geometry_.differentiate(p_);
  system_.errors = geometry_.errors();
  system_.targets = geometry_.error_gradient();
  jets_.resize(parts_.size());
  for (std::size_t k = 0; k < parts_.size(); ++k) {
    jets_[k] = values_of<Jet>(k, b_, p_);
    for (std::size_t r = 0; r < kSegmentRows; ++r) rows_[k][r].value = row_value(k, r, jets_[k]);
    for (std::size_t c = 0; c < 2; ++c) channels_[k][c].E = jets_[k].energy_J[c].value;
    add_part(k, sums);
  }
  add_rows_of_bounds(sums);
  const auto clear = clearance_.assemble(geometry_, mu_);
  sums.complementarity += clear.complementarity;
  sums.primal += clear.primal;
  const auto motors = motors_.assemble(b_, p_, mu_, system_);
  sums.complementarity += motors.complementarity;
  sums.primal += motors.primal;
  sums.lost = clear.lost || (solution_.steps >= kWayOut && clear.least_m < -kDeep_m);
  geometry_.add_sums(lambda_, system_.g.parameters, system_.lagrangian.parameters, system_.hessian);
  system_.metric = kDisplacementWeight * geometry_.displacement_metric();
  for (Index i = 0; i < n; ++i)
    system_.metric(i, i) += i < program_.knots ? kPhiWeight : 1 / std::max(0.01, p_[i] * p_[i]);
  system_.hold(held_);
  const auto& [of_squares, of_parameters] = system_.lagrangian;
  for (std::size_t k = 0; k < parts_.size(); ++k)
    if (parts_[k].b1 >= 0) sums.dual += std::abs(of_squares[parts_[k].b1]) * b_[static_cast<Index>(k) + 1];
  for (Index i = 0; i < n; ++i) sums.dual += std::abs(of_parameters[i]) * std::max(std::abs(p_[i]), 0.3);
  for (Index i = 0; i < lambda_.size(); ++i)
    sums.primal += std::abs(system_.errors[i]) * std::max(std::abs(lambda_[i]), 20.0);
  return sums;
}

void JointNewton::Steps::direction() {
  system_.solve(regularization_.value());
  VectorXd& dp = system_.step.parameters;
  for (const Index knot : held_) dp[knot] = 0;
  for (Index i = program_.knots; i < dp.size(); ++i)
    if (p_[i] < 1.01 * program_.least_length_m(i)) dp[i] = std::max(dp[i], 0.0);
  system_.follow();
}

StepLengths JointNewton::Steps::step_rows() {
  const VectorXd &db = system_.step.squares, &dp = system_.step.parameters;
  StepLengths lengths;
  for (std::size_t k = 0; k < parts_.size(); ++k) {
    const SpeedPart& part = parts_[k];
    const auto d = changes_of(part, system_.step);
    const auto change = [&](const Jet& f) {
      double sum = 0;
      for (std::size_t i = 0; i < d.size(); ++i) sum += f.d[i] * d[i];
      return sum;
    };
    std::array<double, kSegmentQuantities> changes{};
    for (std::size_t q = 0; q < kSegmentQuantities; ++q) changes[q] = change(jets_[k].bounded[q]);
    for (std::size_t r = part.b1 < 0 ? kCapRows : 0; r < kSegmentRows; ++r) {
      const auto [quantity, slope] = row_laws_[part.piece][r];
      rows_[k][r].step(slope * changes[quantity], mu_, lengths);
    }
    for (std::size_t c = 0; c < 2; ++c)
      channels_[k][c].step(change(jets_[k].energy_J[c]), loss(part), mu_, lengths);
    if (part.b1 >= 0) StepLengths::shorten(lengths.primal, b_[static_cast<Index>(k) + 1], db[part.b1]);
  }
  for_bounds(b_, p_, [&](Row& row, double, Index at, bool square, double slope) {
    row.step(slope * (square ? db : dp)[at], mu_, lengths);
  });
  clearance_.step(geometry_.changes(dp), mu_, lengths);
  motors_.step(system_.step, mu_, lengths);
  for (Index i = 0; i < dp.size(); ++i) {
    const double most = i < program_.knots ? kMostTurn_rad : 0.5 * p_[i] + 0.1;
    if (std::abs(dp[i]) > most) lengths.primal = std::min(lengths.primal, most / std::abs(dp[i]));
    if (i >= program_.knots && dp[i] < 0)
      lengths.primal = std::min(lengths.primal, 0.9 * (p_[i] - program_.least_length_m(i)) / -dp[i]);
  }
  return lengths;
}

double JointNewton::Steps::merit(const Values& at, const VectorXd& squares, const VectorXd& parameters,
                                 double step) {
  double sum = penalty_ * at.errors.lpNorm<1>();
  for (std::size_t k = 0; k < parts_.size(); ++k) {
    sum += law(parts_[k]).price_W * scale_ * at.parts[k].duration_s;
    for (std::size_t c = 0; c < 2; ++c)
      sum += channels_[k][c].merit(step, at.parts[k].energy_J[c], loss(parts_[k]), mu_);
    for (std::size_t r = parts_[k].b1 < 0 ? kCapRows : 0; r < kSegmentRows; ++r)
      sum += rows_[k][r].merit(step, row_value(k, r, at.parts[k]), mu_, kRowWeight);
  }
  for_bounds(squares, parameters, [&](Row& row, double value, Index, bool, double) {
    sum += row.merit(step, value, mu_, kRowWeight);
  });
  return sum + clearance_.merit(at.clearance, step, mu_) + motors_.merit(at.motors, step, mu_, kRowWeight);
}

/// Second-order correction: moves back to what the linearized targets promise ([NocedalWright2006], 18.3).
void JointNewton::Steps::correct(VectorXd& parameters, double step, const VectorXd& errors) const {
  PathGeometry geometry(program_);
  for (int i = 0; i < 2; ++i) {
    geometry.place(parameters);
    const VectorXd excess = geometry.errors() - (1 - step) * errors;
    if (excess.norm() < 1e-7) return;
    const VectorXd back = system_.to_targets(excess);
    if (back.norm() > 0.5 * step * system_.step.parameters.norm() + 1e-12) return;
    parameters -= back;
  }
}

void JointNewton::Steps::search(const StepLengths& lengths) {
  constexpr int kHalvings = 7;
  penalty_ = std::max(0.5 * penalty_, 1.2 * std::max(1.0, system_.multipliers.lpNorm<Eigen::Infinity>()));
  Values now;
  now.errors = system_.errors;
  now.clearance = clearance_.present();
  now.motors = motors_.present();
  for (std::size_t k = 0; k < parts_.size(); ++k) {
    SegmentValues<double>& part = now.parts.emplace_back();
    part.duration_s = jets_[k].duration_s.value;
    for (std::size_t c = 0; c < 2; ++c) part.energy_J[c] = jets_[k].energy_J[c].value;
    for (std::size_t q = 0; q < kSegmentQuantities; ++q) part.bounded[q] = jets_[k].bounded[q].value;
  }
  const double before = merit(now, b_, p_, 0);
  step_ = lengths.primal;
  VectorXd b, p;
  Values next;
  int halvings = 0;
  for (;; ++halvings) {
    b = b_;
    for (std::size_t k = 0; k < parts_.size(); ++k)
      if (parts_[k].b1 >= 0) b[static_cast<Index>(k) + 1] += step_ * system_.step.squares[parts_[k].b1];
    p = p_ + step_ * system_.step.parameters;
    correct(p, step_, system_.errors);
    for (Index i = program_.knots; i < p.size(); ++i) p[i] = std::max(p[i], program_.least_length_m(i));
    next = values(b, p);
    const double after = merit(next, b, p, step_);
    const bool accepted = std::isfinite(after) && after <= before + 1e-7 * std::abs(before) &&
                          !sinks(now.clearance, next.clearance);
    if (accepted || halvings == kHalvings - 1) break;
    step_ *= 0.5;
  }
  regularization_.adapt(step_, halvings);
  for (std::size_t k = 0; k < parts_.size(); ++k) {
    for (std::size_t r = 0; r < kSegmentRows; ++r)
      rows_[k][r].take(step_, lengths.dual, row_value(k, r, next.parts[k]), mu_);
    for (std::size_t c = 0; c < 2; ++c) channels_[k][c].take(step_, lengths.dual, next.parts[k].energy_J[c]);
  }
  for_bounds(b, p,
             [&](Row& row, double value, Index, bool, double) { row.take(step_, lengths.dual, value, mu_); });
  clearance_.take(next.clearance, step_, lengths.dual, mu_);
  motors_.take(next.motors, step_, lengths.dual, mu_);
  lambda_ += step_ * (system_.multipliers - lambda_);
  b_ = std::move(b);
  p_ = std::move(p);
}

/// The barrier falls with the step's length, never below a share of the other residuals.
void JointNewton::Steps::lower_barrier(double tolerance) {
  const auto pairs = static_cast<double>(pairs_ + motors_.size());
  const double rest = std::max(sums_.primal, 0.1 * sums_.dual), last = 0.05 * tolerance * sums_.cost / pairs;
  const double factor = step_ > 0.6 ? std::max(0.1, 1 - step_) : step_ > 0.25 ? 0.5 : 1.0;
  const double aim = std::min(mu_, sums_.complementarity / pairs) * factor;
  mu_ = std::max(last, std::min(mu_, std::max({aim, last, kLeastOfRest * rest / pairs})));
}

void JointNewton::Steps::look_at(const NewtonOptions& options) {
  motors_.join(b_, p_, mu_);
  sums_ = assemble();
  assembled_ = true;
  solution_.cost_J = sums_.cost / scale_;
  solution_.duration_s = sums_.duration_s;
  double& before_J = recent_J_[static_cast<std::size_t>(solution_.steps % kPatience)];
  const bool gains = !(std::abs(before_J - sums_.cost) < kLeastGain * sums_.cost);
  before_J = sums_.cost;
  solution_.converged =
      sums_.error() < options.tolerance || (!gains && !sums_.lost && sums_.is_near(options.tolerance));
  solution_.feasible =
      !sums_.lost && sums_.primal < kFeasible * sums_.cost && system_.errors.norm() < kFeasible;
}

JointSolution JointNewton::Steps::run(const NewtonOptions& options) {
  for (;; ++solution_.steps, assembled_ = false) {
    if (!assembled_) look_at(options);
    const double error = sums_.error();
    if (stalled_ || solution_.converged || sums_.lost || !std::isfinite(error) || error < options.pause ||
        solution_.steps == options.most_steps)
      break;
    const bool settled = sums_.complementarity < 0.05 * sums_.cost && sums_.primal < 0.01 * sums_.cost &&
                         0.1 * sums_.dual < 0.05 * sums_.cost;
    if (settled && (sums_.cost - sums_.complementarity - 0.2 * sums_.dual) / scale_ > options.give_up_J) {
      solution_.feasible = false;
      break;
    }
    direction();
    stalled_ = !system_.step.parameters.allFinite() || !system_.step.squares.allFinite();
    if (stalled_) break;
    search(step_rows());
    stalled_ = step_ < kStalled;
    if (stalled_) break;
    lower_barrier(options.tolerance);
  }
  solution_.parameters = p_;
  solution_.squares = b_;
  return solution_;
}

JointNewton::JointNewton(const Start& start, double gap, const VectorXd& squares)
    : steps_(std::make_unique<Steps>(start, gap, squares)) {}
JointNewton::JointNewton(JointNewton&&) noexcept = default;
JointNewton::~JointNewton() = default;

JointSolution JointNewton::run(const NewtonOptions& options) { return steps_->run(options); }

}  // namespace joulepath::joint

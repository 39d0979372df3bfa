#include "planner/ways/spline_search.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "planner/path/shape/nlopt_run.hpp"
#include "planner/ways/spline_constraints.hpp"

// Method: [Kraft1994]
namespace joulepath {
namespace {

using MemberKind = SplineMember::Kind;

constexpr double kLeastHandle_m = 0.01, kMostHandle_m = 20;
constexpr double kReach_m = 3;  ///< how far a knot may move
constexpr int kRefusedToo = 3;  ///< trials per evaluation at most: splines that are no curves cost little
constexpr double kNotDrivable = 100;  ///< in units of the first cost
/// A search ends that after so many evaluations is dearer than the cost to beat by more than this share.
constexpr struct {
  int evaluations{};
  double excess{};
} kHopeless[] = {{5, 0.10}, {9, 0.03}, {14, 0.01}};

/// Of a constant or a changing spline.
template <class Spline>
auto& value_of(Spline& spline, const SplineMember& member, std::size_t axis) {
  switch (member.kind) {
    case MemberKind::start_heading:
      return spline.start_heading_rad;
    case MemberKind::start_handle:
      return spline.start_handle_m;
    case MemberKind::goal_heading:
      return spline.goal_heading_rad;
    case MemberKind::goal_handle:
      return spline.goal_handle_m;
    default:
      return spline.points_m[member.knot][axis];
  }
}

double slope_of(const SplineSlopes& slopes, const SplineMember& member, std::size_t axis) {
  switch (member.kind) {
    case MemberKind::start_heading:
      return slopes.by_start_heading_rad;
    case MemberKind::start_handle:
      return slopes.by_start_handle_m;
    case MemberKind::goal_heading:
      return slopes.by_goal_heading_rad;
    case MemberKind::goal_handle:
      return slopes.by_goal_handle_m;
    default:
      return slopes.by_point_m[member.knot][axis];
  }
}

bool is_handle(MemberKind kind) {
  return kind == MemberKind::start_handle || kind == MemberKind::goal_handle;
}

class Search {
 public:
  explicit Search(const SplineSearch& search) : search_(search) {}
  std::optional<SplineSearchResult> run();

 private:
  struct Column {
    std::size_t variable{}, axis{};
  };
  struct Trial {
    std::vector<double> x{};
    std::vector<FreeSpline> splines{};
    std::vector<Path> paths{};  ///< empty: a spline is no curve
    double cost{};              ///< NaN: not known yet
  };
  const SplineVariable& variable(std::size_t i) const { return search_.variables[columns_[i].variable]; }
  void take_first();
  const Trial& trial(const std::vector<double>& x);
  double objective(const std::vector<double>& x, std::vector<double>& gradient);
  void constraints(double* result, const std::vector<double>& x, double* gradient);
  void keep(const Trial& here);
  [[nodiscard]] bool hopeless() const;
  std::vector<double> gradient_of(const std::vector<FreeSpline>& at, const std::vector<SplineSlopes>& slopes,
                                  std::size_t only) const;

  const SplineSearch& search_;
  std::vector<Column> columns_{};
  std::vector<double> x_{}, lower_{}, upper_{};
  std::optional<SplineConstraints> constraints_{};
  Trial last_{};
  double scale_{1};
  int evaluations_{};
  double least_{kNoLimit};  ///< cost so far, also of paths that are not free
  std::optional<SplineSearchResult> best_{};
};

void Search::take_first() {
  for (std::size_t v = 0; v < search_.variables.size(); ++v) {
    const SplineMember& member = search_.variables[v].members.front();
    const FreeSpline& spline = search_.first[member.spline];
    for (std::size_t axis = 0; axis < (member.kind == MemberKind::knot ? 2u : 1u); ++axis) {
      const double value = value_of(spline, member, axis);
      columns_.push_back({v, axis});
      if (is_handle(member.kind)) {
        x_.push_back(std::log(std::clamp(value, kLeastHandle_m, kMostHandle_m)));
        lower_.push_back(std::log(kLeastHandle_m));
        upper_.push_back(std::log(kMostHandle_m));
        continue;
      }
      const double reach = member.kind == MemberKind::knot ? kReach_m : std::numbers::pi;
      x_.push_back(value);
      lower_.push_back(value - reach);
      upper_.push_back(value + reach);
    }
  }
}

const Search::Trial& Search::trial(const std::vector<double>& x) {
  if (last_.x == x) return last_;
  last_ = {.x = x, .splines = search_.first, .cost = std::numeric_limits<double>::quiet_NaN()};
  for (std::size_t i = 0; i < x.size(); ++i)
    for (const SplineMember& member : variable(i).members)
      value_of(last_.splines[member.spline], member, columns_[i].axis) =
          is_handle(member.kind) ? std::exp(x[i]) : x[i];
  for (const FreeSpline& spline : last_.splines) {
    std::optional<Path> path = free_spline_path(spline);
    if (!path) {
      last_.paths.clear();
      break;
    }
    last_.paths.push_back(std::move(*path));
  }
  return last_;
}

/// Derivatives by the variables; of one spline's alone where `only` names it.
std::vector<double> Search::gradient_of(const std::vector<FreeSpline>& at,
                                        const std::vector<SplineSlopes>& slopes, std::size_t only) const {
  std::vector<double> gradient(columns_.size(), 0.0);
  for (std::size_t i = 0; i < columns_.size(); ++i)
    for (const SplineMember& member : variable(i).members) {
      if (only < at.size() && member.spline != only) continue;
      const SplineSlopes& of = slopes[only < at.size() ? 0 : member.spline];
      const double factor = is_handle(member.kind) ? value_of(at[member.spline], member, 0) : 1.0;
      gradient[i] += factor * slope_of(of, member, columns_[i].axis);
    }
  return gradient;
}

double Search::objective(const std::vector<double>& x, std::vector<double>& gradient) {
  const Trial& here = trial(x);
  if (!gradient.empty()) std::fill(gradient.begin(), gradient.end(), 0.0);
  if (here.paths.empty()) return std::isfinite(least_) ? 1.1 * least_ / scale_ : kNotDrivable;
  if (std::isnan(here.cost)) {
    ++evaluations_;
    last_.cost = search_.cost(here.paths);
    if (std::isfinite(here.cost)) {
      if (scale_ == 1) scale_ = here.cost;
      keep(here);
      least_ = std::min(least_, here.cost);
    }
    if (hopeless() || evaluations_ >= search_.most_evaluations) throw nlopt::forced_stop();
  }
  if (!std::isfinite(here.cost)) return kNotDrivable;
  if (!gradient.empty()) {
    gradient = gradient_of(here.splines, search_.slopes(here.splines), here.splines.size());
    for (double& part : gradient) part /= scale_;
  }
  return here.cost / scale_;
}

bool Search::hopeless() const {
  if (!std::isfinite(search_.cost_to_beat)) return false;
  const double excess = (least_ - search_.cost_to_beat) / std::abs(search_.cost_to_beat);
  return std::any_of(std::begin(kHopeless), std::end(kHopeless),
                     [&](const auto& at) { return evaluations_ >= at.evaluations && excess > at.excess; });
}

void Search::keep(const Trial& here) {
  if (best_ && here.cost >= best_->cost) return;
  for (const Path& path : here.paths)
    if (search_.checker->least_slack_m(path) < kClearanceMargin_m || search_.checker->first_collision(path))
      return;
  best_ = {.splines = here.splines, .paths = here.paths, .cost = here.cost};
}

void Search::constraints(double* result, const std::vector<double>& x, double* gradient) {
  const Trial& here = trial(x);
  const std::size_t rows = constraints_->rows();
  std::fill(result, result + rows, 0.0);
  if (gradient) std::fill(gradient, gradient + rows * x.size(), 0.0);
  if (here.paths.empty()) return;
  const std::vector<ConstraintRow> at = constraints_->at(here.splines, here.paths, gradient != nullptr);
  for (std::size_t row = 0; row < rows; ++row) {
    result[row] = at[row].value;
    if (!gradient || !at[row].slope) continue;
    const std::size_t spline = at[row].spline;
    const std::vector<double> by =
        gradient_of(here.splines, {spline_slopes(here.splines[spline], *at[row].slope)}, spline);
    std::copy(by.begin(), by.end(), gradient + row * x.size());
  }
}

std::optional<SplineSearchResult> Search::run() {
  take_first();
  if (trial(x_).paths.empty()) return std::nullopt;
  constraints_.emplace(*search_.checker, last_.paths);
  nlopt::opt optimizer(nlopt::LD_SLSQP, static_cast<unsigned>(x_.size()));
  optimizer.set_lower_bounds(lower_);
  optimizer.set_upper_bounds(upper_);
  optimizer.set_min_objective([](const std::vector<double>& x, std::vector<double>& gradient,
                                 void* self) { return static_cast<Search*>(self)->objective(x, gradient); },
                              this);
  optimizer.add_inequality_mconstraint(
      [](unsigned, double* result, unsigned n, const double* x, double* gradient, void* self) {
        static_cast<Search*>(self)->constraints(result, std::vector<double>(x, x + n), gradient);
      },
      this, std::vector<double>(constraints_->rows(), 1e-5));
  optimizer.set_ftol_rel(1e-5);
  optimizer.set_xtol_rel(1e-6);
  optimizer.set_maxeval(kRefusedToo * search_.most_evaluations);
  optimize_as_far_as_possible(optimizer, x_);
  if (best_) best_->evaluations = evaluations_;
  return std::move(best_);
}

}  // namespace

std::optional<SplineSearchResult> minimize(const SplineSearch& search) { return Search(search).run(); }

}  // namespace joulepath

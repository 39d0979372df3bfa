#include "planner/bound/heading_bound.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace joulepath {
namespace {

constexpr double kTurn = 2 * std::numbers::pi;
constexpr int kHeadings = 180;                   ///< on two turns: a left and a right turn end apart
constexpr double kCell = 2 * kTurn / kHeadings;  ///< rad
constexpr double kStage_m = 0.025, kMiddleStage_m = 0.05;
constexpr int kMostMiddleStages = 300;
constexpr double kStageShare = 0.4;  ///< of the way from rest, near rest
constexpr double kFirstStage_m = 0.01;
constexpr int kLevels = 8;  ///< of the price along the motion, on an optional stage
constexpr int kMostPrices = 12;
constexpr double kReach = 2.0;  ///< of the prices searched, in rates of the middle

template <class Array>
auto& at(Array& values, int i) {
  return values[static_cast<std::size_t>(i)];
}

int around(int i) { return i < 0 ? i + kHeadings : i >= kHeadings ? i - kHeadings : i; }

struct HeadingStage {
  double length_m{};
  int group{};           ///< stages of a group are alike
  bool optional{};       ///< a motion may leave a part of it out
  HeadingRates rates{};  ///< means along the stage
};

/// The stages from the given heading on: those of a line whose peak is drawn out to `least_m`, with a further
/// part up to `most_m` that a motion may leave out. Backward, a turn counts with the opposite sign.
class HeadingStages {
 public:
  HeadingStages(const RateTable& table, double least_m, double most_m, bool backward) : table_(table) {
    const std::vector<double>& s = table.line.s_m;
    for (std::size_t k = 0; k + 1 < s.size(); ++k) {
      const double ds = s[k + 1] - s[k], far_m = std::min(s[k + 1], table.line.length_m() - s[k]);
      if (k == table.line.peak) {
        close();
        middle(ds + least_m - table.line.length_m(), false);
        middle(most_m - least_m, true);
      } else {
        add(ds, table.pieces[k][0]);
        add(ds, table.pieces[k][1]);
        if (open_.length_m >= std::clamp(kStageShare * far_m, kFirstStage_m, kStage_m)) close();
      }
    }
    close();
    if (!backward) return;
    std::reverse(stages_.begin(), stages_.end());
    for (HeadingStage& stage : stages_) stage.rates.at.reverseInPlace();
  }
  std::vector<HeadingStage> take() { return std::move(stages_); }

 private:
  /// One end of a piece: the rate is concave along it.
  void add(double length_m, const HeadingRates& rates) {
    if (!(length_m > 0)) return;
    if (open_.length_m > 0 && open_.rates.most_J != rates.most_J) close();
    if (!(open_.length_m > 0)) open_.rates = {rates.most_J, Eigen::ArrayXd::Zero(rates.at.size())};
    open_.length_m += 0.5 * length_m;
    open_.rates.at += 0.5 * length_m * rates.at;
  }

  void middle(double length_m, bool optional) {
    const int parts = std::min(static_cast<int>(std::ceil(length_m / kMiddleStage_m)), kMostMiddleStages);
    for (int k = 0; k < parts; ++k) stages_.push_back({length_m / parts, groups_, optional, table_.middle});
    ++groups_;
  }

  void close() {
    if (!(open_.length_m > 0)) return;
    open_.rates.at /= open_.length_m;
    open_.group = groups_++;
    stages_.push_back(std::exchange(open_, {}));
  }

  const RateTable& table_;
  HeadingStage open_{};
  int groups_{};
  std::vector<HeadingStage> stages_{};
};

/// The convex function of a stage's turn d that is the largest of c_j + q_j d, from below: exact at d = 0, on
/// whole cells such that no chord lies above it, as far as it bends, or up to a given reach.
class TurnKernel {
 public:
  TurnKernel(const Eigen::ArrayXd& prices, const Eigen::ArrayXd& constants, int reach = 0) {
    for (Eigen::Index j = 0; j < prices.size(); ++j) add({prices[j], constants[j]});
    const double widest = std::max(std::abs(bends_.front()), std::abs(bends_.back()));
    const int bent = std::clamp(static_cast<int>(std::ceil(widest / kCell)), 1, kHeadings / 2 - 1);
    reach_ = reach > 0 ? reach : bent;
    values_.assign(static_cast<std::size_t>(2 * reach_ + 1), (*this)(0.0));
    for (const int way : {-1, 1})
      for (int k = 0; k < reach_; ++k)
        at(values_, reach_ + way * (k + 1)) = next_value(way * k, way, at(values_, reach_ + way * k));
  }

  int reach() const { return reach_; }
  double operator()(int cells) const { return at(values_, cells + reach_); }

  struct Line {
    double price{}, constant{};
    double operator()(double d) const { return constant + price * d; }
  };
  /// The function beyond its bends, for turns of one sign.
  const Line& beyond(int way) const { return way > 0 ? lines_.back() : lines_.front(); }

 private:
  /// The upper envelope of lines of rising slope.
  void add(const Line& line) {
    const auto meet = [&](const Line& before) {
      return (before.constant - line.constant) / (line.price - before.price);
    };
    while (!bends_.empty() && meet(lines_.back()) <= bends_.back()) lines_.pop_back(), bends_.pop_back();
    if (!lines_.empty()) bends_.push_back(meet(lines_.back()));
    lines_.push_back(line);
  }

  double operator()(double d) const {
    return lines_[static_cast<std::size_t>(std::upper_bound(bends_.begin(), bends_.end(), d) -
                                           bends_.begin())](d);
  }

  /// At the next cell, on the highest line from `value` that stays below the function.
  double next_value(int cell, int way, double value) const {
    const double from = kCell * cell;
    const auto rise = [&](double d) { return ((*this)(d)-value) / std::abs(d - from); };
    double least = rise(kCell * (cell + way));
    for (const double bend : bends_)
      if (const double ahead = way * (bend - from); ahead > 0 && ahead < kCell)
        least = std::min(least, rise(bend));
    return value + kCell * least;
  }

  std::vector<Line> lines_{};
  std::vector<double> bends_{};  ///< between the lines
  int reach_{};
  std::vector<double> values_{};
};

/// W at the end of all stages, for one price of the place.
class HeadingProgram {
 public:
  HeadingProgram(std::vector<HeadingStage> stages, double anchor_rad, bool reverse)
      : stages_(std::move(stages)), anchor_rad_(anchor_rad), reverse_(reverse) {
    from_.assign(stages_.size() * kHeadings, 0);
  }

  /// For the price `lambda` (J/m).
  void run(const Point2& lambda) {
    size_ = std::hypot(lambda[0], lambda[1]);
    course_ = std::atan2(lambda[1], lambda[0]);
    for (int i = 0; i < kHeadings; ++i) {
      const double along = size_ * std::cos(anchor_rad_ + kCell * i - course_);
      at(forward_, i) = !reverse_ || along >= 0;
      at(along_, i) = reverse_ ? std::abs(along) : along;
    }
    const double first_J = stages_.front().rates.most_J;
    for (int i = 0; i < kHeadings; ++i) at(w_, i) = first_J * kCell * std::min(i, kHeadings - i);
    for (std::size_t k = 0; k < stages_.size(); ++k) step(k);
  }

  double value_J(double turned_rad) const {
    const auto [i, share] = place_of(turned_rad);
    return std::lerp(at(w_, i), at(w_, around(i + 1)), share);
  }
  double least_J() const { return *std::min_element(w_.begin(), w_.end()); }
  double least_rad() const {
    return kCell * static_cast<double>(std::min_element(w_.begin(), w_.end()) - w_.begin());
  }

  /// The place that the cheapest motion to a heading reaches.
  Point2 reached_m(double turned_rad) const {
    const auto [i, share] = place_of(turned_rad);
    int b = at(w_, around(i + 1)) < at(w_, i) ? around(i + 1) : i;
    Point2 reached{0, 0};
    for (std::size_t k = stages_.size(); k-- > 0;) {
      const int from = at_from(k, b);
      if (from != kSkipped) {
        for (const int end : {from, b}) {
          const double ds = 0.5 * stages_[k].length_m * (at(forward_, end) ? 1 : -1),
                       heading = anchor_rad_ + kCell * end;
          reached[0] += ds * std::cos(heading), reached[1] += ds * std::sin(heading);
        }
        b = from;
      }
    }
    return reached;
  }

 private:
  static constexpr int kSkipped = -1;

  const int& at_from(std::size_t k, int b) const {
    return from_[k * kHeadings + static_cast<std::size_t>(b)];
  }
  int& at_from(std::size_t k, int b) { return from_[k * kHeadings + static_cast<std::size_t>(b)]; }

  struct Place {
    int cell{};
    double share{};
  };
  static Place place_of(double turned_rad) {
    const double place = turned_rad / kCell, cell = std::floor(place);
    return {around(static_cast<int>(cell)), place - cell};
  }

  /// Turns beyond the kernels' reach, with the kernel that holds for all headings.
  void turn_further(const std::array<double, kHeadings>& before, std::array<double, kHeadings>& after) const {
    const TurnKernel& any = kernels_.back();
    const int reach = any.reach();
    for (const int way : {-1, 1}) {
      const TurnKernel::Line& line = any.beyond(way);
      const double at_reach_J = line(way * kCell * reach), further_J = way * line.price * kCell;
      double least_J = kNoLimit;
      for (int k = 0; k < 2 * kHeadings; ++k) {
        const int b = (way > 0 ? k : 2 * kHeadings - k) % kHeadings;
        least_J = std::min(least_J + further_J, at(before, around(b - way * reach)) + at_reach_J);
        at(after, b) = std::min(at(after, b), least_J);
      }
    }
  }

  void step(std::size_t k) {
    const HeadingStage& stage = stages_[k];
    if (k == 0 || stage.group != stages_[k - 1].group)
      make_kernels(stage, stage.rates.most_J - 0.5 * stage.length_m * size_);
    if (stage.optional)
      choose(k);
    else
      drive(k);
  }

  void make_kernels(const HeadingStage& stage, double most_J) {
    const Eigen::ArrayXd prices = Eigen::ArrayXd::LinSpaced(stage.rates.at.size(), -most_J, most_J);
    kernels_.clear();
    if (stage.optional)
      make_optional_kernels(stage, prices);
    else
      make_whole_kernels(stage, prices);
  }

  /// The price of the place counts at both ends; what it changes in between acts on the price of a radian as
  /// a shift of (sigma - ds/2) slope, where `slope` is that of lambda.u(heading). Headings that a motion can
  /// pass on the stage are `beyond_rad` from its ends at most: others take more than the kernel says.
  void make_whole_kernels(const HeadingStage& stage, const Eigen::ArrayXd& prices) {
    const double ds = stage.length_m, most_J = stage.rates.most_J;
    const double steepest_rate = std::min(stage.rates(-most_J), stage.rates(most_J));
    const double beyond_rad = ds * (stage.rates.at.maxCoeff() - steepest_rate + 2 * size_) / (2 * most_J);
    const auto kernel = [&](double least_slope, double most_slope, int reach) {
      const double one = 0.5 * ds * std::max(least_slope, -size_),
                   two = 0.5 * ds * std::min(most_slope, size_);
      const HeadingRates& h = stage.rates;
      return TurnKernel(prices, prices.unaryExpr([&](double q) {
        return ds *
               (0.5 * h(q) + 0.25 * (std::min(h(q + one), h(q + two)) + std::min(h(q - one), h(q - two))));
      }),
                        reach);
    };
    const TurnKernel any = kernel(-size_, size_, 0);
    const double band = size_ * std::min(2.0, beyond_rad + (0.5 * any.reach() + 2) * kCell);
    for (int level = 0; level <= kLevels; ++level) {
      const double slope = size_ * (2.0 * level / kLevels - 1), half = band + size_ / kLevels;
      kernels_.push_back(kernel(slope - half, slope + half, any.reach()));
    }
    for (int i = 0; i < 2 * kHeadings; ++i) {
      const double turned = anchor_rad_ + 0.5 * kCell * i - course_;
      double slope = -size_ * std::sin(turned);
      if (reverse_ && std::cos(turned) < 0) slope = -slope;
      const bool kink = reverse_ && size_ * std::abs(std::cos(turned)) <= band;
      at(level_of_, i) = kink ? kLevels + 1 : level_at(slope);
    }
    kernels_.push_back(any);
  }

  /// The part that is driven counts where its rate is below the price of the place, that is the mean of both
  /// ends, each taken with the neighboring cells.
  void make_optional_kernels(const HeadingStage& stage, const Eigen::ArrayXd& prices) {
    const double ds = stage.length_m, shift = 0.5 * ds * size_, bump = size_ * kCell * kCell / 8;
    const Eigen::ArrayXd costs = prices.unaryExpr([&](double q) {
      return ds * 0.5 * (stage.rates(q) + std::min(stage.rates(q - shift), stage.rates(q + shift)));
    });
    const TurnKernel any(prices, (costs - ds * size_).min(0.0));
    for (int level = 0; level < kLevels; ++level)
      kernels_.emplace_back(prices, (costs - ds * size_ * (2.0 * level / kLevels - 1)).min(0.0), any.reach());
    kernels_.push_back(any);
    for (int i = 0; i < kHeadings; ++i)
      at(most_along_, i) =
          bump + std::max({at(along_, around(i - 1)), at(along_, i), at(along_, around(i + 1))});
  }

  std::size_t level_above(double along) const {
    if (!(size_ > 0)) return 0;
    return static_cast<std::size_t>(
        std::clamp(std::ceil((along / size_ + 1) * kLevels / 2), 0.0, 1.0 * kLevels));
  }

  std::size_t level_at(double slope) const {
    if (!(size_ > 0)) return 0;
    return static_cast<std::size_t>(
        std::clamp(std::lround((slope / size_ + 1) * kLevels / 2), 0L, long{kLevels}));
  }

  /// The whole stage, with the price of the place at both ends.
  void drive(std::size_t k) {
    const double half_m = 0.5 * stages_[k].length_m, bump = size_ * kCell * kCell / 8;
    std::array<double, kHeadings> before;
    for (int i = 0; i < kHeadings; ++i) at(before, i) = at(w_, i) - half_m * (at(along_, i) + bump);
    const int reach = kernels_.back().reach();
    for (int b = 0; b < kHeadings; ++b) {
      double best = kNoLimit;
      for (int d = -reach; d <= reach; ++d) {
        const int a = around(b - d), middle = (2 * b - d + 2 * kHeadings) % (2 * kHeadings);
        const double value = at(before, a) + kernels_[at(level_of_, middle)](d);
        if (value < best) best = value, at_from(k, b) = a;
      }
      at(w_, b) = best;
    }
    turn_further(before, w_);
    for (int b = 0; b < kHeadings; ++b) at(w_, b) -= half_m * (at(along_, b) + bump);
  }

  /// The stage or any part of it.
  void choose(std::size_t k) {
    const std::array<double, kHeadings> before = w_;
    const int reach = kernels_.back().reach();
    for (int b = 0; b < kHeadings; ++b) {
      at_from(k, b) = kSkipped;
      for (int d = -reach; d <= reach; ++d) {
        const int a = around(b - d);
        const TurnKernel& kernel = kernels_[level_above(0.5 * (at(most_along_, a) + at(most_along_, b)))];
        if (const double value = at(before, a) + kernel(d); value < at(w_, b))
          at(w_, b) = value, at_from(k, b) = a;
      }
    }
    turn_further(before, w_);
  }

  std::vector<HeadingStage> stages_{};
  double anchor_rad_{};
  bool reverse_{};
  double course_{};
  double size_{};                          ///< of lambda
  std::array<double, kHeadings> along_{};  ///< lambda along the motion
  std::array<bool, kHeadings> forward_{};
  std::vector<TurnKernel> kernels_{};  ///< of the present stage, by the slope or the size of the price
  std::array<std::size_t, 2 * kHeadings> level_of_{};  ///< whole stages: at half cells
  std::array<double, kHeadings> most_along_{};         ///< optional stages
  std::array<double, kHeadings> w_{};
  std::vector<int> from_{};
};

using Polygon = std::vector<Point2>;

double dot(const Point2& a, const Point2& b) { return a[0] * b[0] + a[1] * b[1]; }
Point2 minus(const Point2& a, const Point2& b) { return {a[0] - b[0], a[1] - b[1]}; }

/// The part of a convex polygon on the side of `normal`.
Polygon cut(const Polygon& polygon, const Point2& through, const Point2& normal) {
  Polygon kept;
  for (std::size_t k = 0; k < polygon.size(); ++k) {
    const Point2 &from = polygon[k], &to = polygon[(k + 1) % polygon.size()];
    const double f = dot(normal, minus(from, through)), t = dot(normal, minus(to, through));
    if (f >= 0) kept.push_back(from);
    if ((f > 0 && t < 0) || (f < 0 && t > 0))
      kept.push_back({std::lerp(from[0], to[0], f / (f - t)), std::lerp(from[1], to[1], f / (f - t))});
  }
  return kept;
}

std::optional<Point2> centroid(const Polygon& polygon) {
  double area = 0;
  Point2 sum{0, 0};
  for (std::size_t k = 1; k + 1 < polygon.size(); ++k) {
    const Point2 a = minus(polygon[k], polygon[0]), b = minus(polygon[k + 1], polygon[0]);
    const double cross = a[0] * b[1] - a[1] * b[0];
    area += cross;
    for (std::size_t j : {0u, 1u}) sum[j] += cross * (a[j] + b[j]) / 3;
  }
  if (!(area > 1e-3)) return std::nullopt;
  return Point2{polygon[0][0] + sum[0] / area, polygon[0][1] + sum[1] / area};
}

/// Search for the price of the place: the bound is concave in it, so that half of the prices left is dropped
/// by each.
class PriceSearch {
 public:
  PriceSearch(HeadingProgram& program, const Point2& offset_m, double most)
      : program_(program), offset_m_(offset_m) {
    for (const Point2& corner : {Point2{-1, -1}, Point2{1, -1}, Point2{1, 1}, Point2{-1, 1}})
      prices_.push_back({most * corner[0], most * corner[1]});
  }

  /// The best bound for the goal's heading, or for any.
  double find(std::optional<double> turned_rad, Point2 lambda, double enough_J) {
    Polygon left = prices_;
    double best_J = -kNoLimit;
    for (int k = 0; k < kMostPrices; ++k) {
      program_.run(lambda);
      best_J = std::max(
          best_J, dot(lambda, offset_m_) + (turned_rad ? program_.value_J(*turned_rad) : program_.least_J()));
      if (best_J >= enough_J) break;
      left =
          cut(left, lambda, minus(offset_m_, program_.reached_m(turned_rad.value_or(program_.least_rad()))));
      const std::optional<Point2> next = centroid(left);
      if (!next) break;
      lambda = *next;
    }
    return best_J;
  }

 public:
  HeadingProgram& program_;
  Point2 offset_m_{};
  Polygon prices_{};
};

}  // namespace

double heading_bound(const RateTable& table, const HeadingEnds& ends, double least_m, double most_m,
                     double enough_J) {
  if (!table.bounded) return 0;
  const bool backward = !ends.start_rad;
  const double anchor_rad = backward ? ends.goal_rad.value_or(0) : *ends.start_rad;
  HeadingProgram program(HeadingStages(table, least_m, most_m, backward).take(), anchor_rad, table.reverse);
  const double rate = std::max(table.middle.free(), 0.0),
               way_m = std::hypot(ends.offset_m[0], ends.offset_m[1]);
  const Point2 first =
      way_m > 0 ? Point2{rate * ends.offset_m[0] / way_m, rate * ends.offset_m[1] / way_m} : Point2{0, 0};
  PriceSearch search(program, ends.offset_m, kReach * rate);
  if (backward || !ends.goal_rad) return search.find(std::nullopt, first, enough_J);
  const double turned_rad = std::remainder(*ends.goal_rad - anchor_rad, kTurn);
  const double one_J = search.find(turned_rad, first, enough_J);
  return std::min(one_J, search.find(turned_rad + kTurn, first, one_J));
}

}  // namespace joulepath

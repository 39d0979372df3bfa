#pragma once

#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "planner/nlp/transcription/problem.hpp"

// Method: [PhamPham2018]
namespace joulepath::nlp {

/// Where and why no profile passes.
struct Blocked {
  std::size_t node{};
  std::string_view limit{};
  double needed{};   ///< least square of the rate that the rest of the path needs
  double allowed{};  ///< square of the rate that is possible at most
};

/// The fastest and the slowest profile on a grid.
struct RateEnvelope {
  std::vector<double> fastest{};  ///< squares of the rate
  std::vector<double> slowest{};
  std::optional<Blocked> blocked{};
};

/// A row of a segment at its tangent: alpha b0 + beta b1 <= gamma.
struct HalfPlane {
  double alpha{}, beta{}, gamma{};
  std::string_view limit{};
};

/// Squares of the rate that are possible at a node, and the limits that bound them.
struct SquareSpan {
  double low{}, high{};
  std::string_view low_limit{}, high_limit{};
  void raise(double to, std::string_view limit) {
    if (to > low) low = to, low_limit = limit;
  }
  void lower(double to, std::string_view limit) {
    if (to < high) high = to, high_limit = limit;
  }
};

/// Minimum time by passes over the grid: backward, the squares of the rate from which the end can be
/// reached under every row (an interval per node); forward, the largest (smallest) next square in it.
/// Rows that bend (voltage, power) are linearized at the last sweep's profile and swept again.
///
/// Keeps its storage: problems without more nodes and rows than one before need no memory.
class EnvelopeSweeps {
 public:
  void reserve(std::size_t nodes);
  /// Valid until the next run.
  const RateEnvelope& run(const Problem& problem);

 private:
  void sweep(const Problem& problem, RateEnvelope& envelope);
  [[nodiscard]] std::optional<Blocked> sweep_backward(const Problem& problem);
  [[nodiscard]] std::optional<Blocked> sweep_forward(const Problem& problem, RateEnvelope& envelope) const;
  /// The tangent of a row that bends, taken at a speed that the row forbids, may leave nothing at all (a
  /// voltage is concave in the square of the rate). Where the first sweep is blocked it is tried at slower
  /// and slower profiles before that counts.
  void first_sweep(const Problem& problem);
  [[nodiscard]] std::span<const HalfPlane> planes(std::size_t k) const;

  std::vector<double> at_{};                ///< where rows are linearized
  std::vector<HalfPlane> planes_{};         ///< the last segment's first
  std::vector<std::size_t> first_plane_{};  ///< one past a segment's last
  std::vector<HalfPlane> above_{}, below_{};
  std::vector<SquareSpan> span_{};
  RateEnvelope envelope_{}, next_{};
};

/// The same, once.
[[nodiscard]] RateEnvelope rate_envelope(const Problem& problem);

}  // namespace joulepath::nlp

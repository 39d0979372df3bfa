#include "planner/joint/finer_pieces.hpp"

#include <algorithm>
#include <cmath>

namespace joulepath::joint {
namespace {

using Eigen::Index, Eigen::Vector2d, Eigen::VectorXd;

constexpr double kShortestPart_m = 0.12, kMostCuts = 8;
constexpr double kStraight_rad = 0.05;  ///< of |phi|: a curvature of 0.3 / m on a track of 0.35 m

bool bends(const Piece& piece, const VectorXd& p) {
  return !piece.turns && piece.bend_rad(p) > kStraight_rad;
}

/// Length of the parts of pieces that bend, for about so many pieces in all.
double part_length_m(const Program& program, const VectorXd& p, std::size_t most_pieces) {
  double bending_m = 0;
  for (std::size_t j = 0; j < program.pieces.size(); ++j)
    if (bends(program.pieces[j], p)) bending_m += p[program.length_of(j)];
  if (most_pieces <= program.pieces.size()) return kNoLimit;
  return std::max(kShortestPart_m, bending_m / static_cast<double>(most_pieces - program.pieces.size()));
}

std::size_t parts_of(double length_m, double part_m) {
  return static_cast<std::size_t>(std::clamp(std::ceil(length_m / part_m), 1.0, kMostCuts));
}

/// The finer knots and lengths of a piece: its rates at the cuts lie on the chord between those at its ends.
class CutPiece {
 public:
  CutPiece(const Piece& piece, const VectorXd& p)
      : from_rad_(p[piece.from]), to_rad_(p[piece.to]), first_(rates(from_rad_)), last_(rates(to_rad_)) {}

  double knot_rad(double share) const {
    if (share >= 1) return to_rad_;
    const Vector2d at = chord(share);
    return from_rad_ + std::atan2(first_[0] * at[1] - first_[1] * at[0], first_.dot(at));
  }
  /// Of a part, relative to its share of the piece: the chord's rates are below one.
  double length(double from, double to) const {
    const Vector2d a = chord(from), b = chord(to);
    return (a + b).norm() / (a.normalized() + b.normalized()).norm();
  }

 private:
  static Vector2d rates(double phi_rad) { return {std::cos(phi_rad), std::sin(phi_rad)}; }
  Vector2d chord(double share) const { return (1 - share) * first_ + share * last_; }

  double from_rad_, to_rad_;
  Vector2d first_, last_;
};

}  // namespace

FinerPieces cut(const Program& program, const VectorXd& p, std::size_t most_pieces) {
  FinerPieces finer{.start = {.program = program}};
  std::vector<Piece>& pieces = finer.start.program.pieces;
  pieces.clear();
  const double part_m = part_length_m(program, p, most_pieces);
  std::vector<double> knots, lengths_m;
  std::vector<std::size_t> last_of;
  for (std::size_t j = 0; j < program.pieces.size(); ++j) {
    const Piece& whole = program.pieces[j];
    const double length_m = p[program.length_of(j)];
    const std::size_t parts = bends(whole, p) ? parts_of(length_m, part_m) : 1;
    const CutPiece cuts(whole, p);
    if (j == 0 || program.pieces[j - 1].to != whole.from) knots.push_back(p[whole.from]);
    for (std::size_t i = 0; i < parts; ++i) {
      const double count = static_cast<double>(parts), from = static_cast<double>(i) / count,
                   to = static_cast<double>(i + 1) / count;
      knots.push_back(cuts.knot_rad(to));
      lengths_m.push_back(cuts.length(from, to) * length_m / count);
      Piece& part = pieces.emplace_back(whole);
      part.to = static_cast<Index>(knots.size()) - 1;
      part.from = part.to - 1;
      part.rests_after = whole.rests_after && i + 1 == parts;
    }
    finer.parts.push_back(parts);
    last_of.push_back(pieces.size() - 1);
  }
  for (Target& target : finer.start.program.targets) target.piece = last_of[target.piece];
  for (Waypoint& waypoint : finer.start.program.waypoints) waypoint.piece = last_of[waypoint.piece];
  finer.start.program.knots = static_cast<Index>(knots.size());
  knots.insert(knots.end(), lengths_m.begin(), lengths_m.end());
  finer.start.parameters = Eigen::Map<VectorXd>(knots.data(), static_cast<Index>(knots.size()));
  return finer;
}

VectorXd on_grid(const Program& before, const VectorXd& squares, const FinerPieces& after) {
  std::vector<double> values{squares[0]};
  Index first = 0;
  std::size_t next = 0;
  for (std::size_t j = 0; j < before.pieces.size(); ++j) {
    const auto old_count = static_cast<double>(before.pieces[j].segments);
    const auto parts = static_cast<double>(after.parts[j]);
    for (double part = 0; part < parts; ++part, ++next) {
      const std::size_t segments = after.start.program.pieces[next].segments;
      for (std::size_t i = 1; i <= segments; ++i) {
        const double within = static_cast<double>(i) / static_cast<double>(segments);
        const double at = (part + within) / parts * old_count;
        const double cell = std::min(old_count - 1, std::floor(at));
        const auto k = first + static_cast<Index>(cell);
        values.push_back(squares[k] + (at - cell) * (squares[k + 1] - squares[k]));
      }
    }
    first += static_cast<Index>(before.pieces[j].segments);
  }
  return Eigen::Map<VectorXd>(values.data(), static_cast<Index>(values.size()));
}

}  // namespace joulepath::joint

#pragma once

#include <type_traits>

#include "planner/cache/bytes.hpp"
#include "planner/path/geometry/path.hpp"

namespace joulepath {

/// What a curve's segment is made from.
struct SegmentRecord {
  enum class Kind { linear, cubic, rational, direction };
  Kind kind{};
  Pose start{};
  double length_m{}, curvature_per_m{}, curvature_slope_per_m2{};
  BezierPoints cubic_m{};
  std::vector<RationalBezier::Point> rational{};
  std::array<double, 4> direction{};  ///< of DirectionSegment::Shape, in its order
};

/// What a piece of path is made from: it is built again to the last bit.
struct PieceRecord {
  bool turns{};
  Pose start{};
  double angle_rad{};
  Direction direction{};
  std::vector<SegmentRecord> segments{};
};

[[nodiscard]] PieceRecord record_of(const PathPiece& piece);
[[nodiscard]] PathPiece piece_of(const PieceRecord& record);

template <class Archive>
void each_field(Archive& archive, Pose& value) {
  auto& [x_m, y_m, heading_rad] = value;
  archive(x_m, y_m, heading_rad);
}

template <class Archive>
void each_field(Archive& archive, SegmentRecord& value) {
  auto& [kind, start, length_m, curvature, slope, cubic_m, rational, direction] = value;
  archive(kind);
  if (kind == SegmentRecord::Kind::linear) archive(start, length_m, curvature, slope);
  if (kind == SegmentRecord::Kind::cubic) archive(cubic_m);
  if (kind == SegmentRecord::Kind::rational) archive(rational);
  if (kind == SegmentRecord::Kind::direction) archive(start, direction);
}

template <class Archive>
void each_field(Archive& archive, PieceRecord& value) {
  auto& [turns, start, angle_rad, direction, segments] = value;
  archive(turns);
  if (turns) archive(start, angle_rad);
  if (!turns) archive(direction, segments);
}

template <class Archive>
void each_field(Archive& archive, Path& value) {
  std::vector<PieceRecord> records;
  for (const PathPiece& piece : value.pieces) records.push_back(record_of(piece));
  archive(records);
  if constexpr (std::is_same_v<Archive, ByteReader>) {
    value.pieces.clear();
    if (!archive.failed())
      for (const PieceRecord& record : records) value.pieces.push_back(piece_of(record));
  }
}

}  // namespace joulepath

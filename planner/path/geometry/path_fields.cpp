#include "planner/path/geometry/path_fields.hpp"

namespace joulepath {
namespace {

SegmentRecord record_of_segment(const CurveSegment& segment) {
  if (const auto* linear = std::get_if<LinearCurvature>(&segment))
    return {.kind = SegmentRecord::Kind::linear,
            .start = linear->start(),
            .length_m = linear->length_m(),
            .curvature_per_m = linear->curvature_per_m(),
            .curvature_slope_per_m2 = linear->curvature_slope_per_m2()};
  if (const auto* turning = std::get_if<DirectionSegment>(&segment)) {
    const auto& [from_rad, to_rad, length_m, half_track_m] = turning->shape();
    return {.kind = SegmentRecord::Kind::direction,
            .start = turning->start(),
            .direction = {from_rad, to_rad, length_m, half_track_m}};
  }
  const BezierSegment& bezier = std::get<BezierSegment>(segment);
  if (bezier.rational())
    return {.kind = SegmentRecord::Kind::rational, .rational = bezier.rational()->points};
  return {.kind = SegmentRecord::Kind::cubic, .cubic_m = bezier.points_m()};
}

CurveSegment segment_of_record(const SegmentRecord& record) {
  switch (record.kind) {
    case SegmentRecord::Kind::cubic:
      return BezierSegment(record.cubic_m);
    case SegmentRecord::Kind::rational:
      return BezierSegment::rational({record.rational});
    case SegmentRecord::Kind::direction: {
      const auto& [from_rad, to_rad, length_m, half_track_m] = record.direction;
      return DirectionSegment(record.start, {from_rad, to_rad, length_m, half_track_m});
    }
    case SegmentRecord::Kind::linear:
      break;
  }
  return LinearCurvature(record.start, record.length_m, record.curvature_per_m,
                         record.curvature_slope_per_m2);
}

}  // namespace

PieceRecord record_of(const PathPiece& piece) {
  if (const auto* turn = std::get_if<TurnInPlace>(&piece))
    return {.turns = true, .start = turn->start, .angle_rad = turn->angle_rad};
  const Curve& curve = std::get<Curve>(piece);
  PieceRecord record{.direction = curve.direction()};
  for (const CurveSegment& segment : curve.segments()) record.segments.push_back(record_of_segment(segment));
  return record;
}

PathPiece piece_of(const PieceRecord& record) {
  if (record.turns) return TurnInPlace{record.start, record.angle_rad};
  std::vector<CurveSegment> segments;
  for (const SegmentRecord& segment : record.segments) segments.push_back(segment_of_record(segment));
  return Curve(std::move(segments), record.direction);
}

}  // namespace joulepath

#include "scenarios/mission_files/path_file.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <limits>
#include <utility>

#include "model/median.hpp"
#include "model/printable.hpp"
#include "planner/path/shape/bezier_chain.hpp"
#include "planner/path/shape/pose_path.hpp"
#include "planner/path/shape/waypoint_path.hpp"
#include "scenarios/document_kind.hpp"
#include "scenarios/mission_files/motion_entry.hpp"
#include "scenarios/robot_files/physical_bounds.hpp"
#include "scenarios/text/csv_table.hpp"
#include "scenarios/text/schema_documents.hpp"
#include "scenarios/text/schema_text.hpp"

namespace joulepath {
namespace {

constexpr double kFarPoints_m = 200.0;  ///< between neighbors of a path in a building or a yard, below this

/// Of a tolerance that fits the spacing: a step of a grid is half a cell beside the line that it stands for.
constexpr double kShareOfSpacing = 0.6;
constexpr int kFewestSteps = 3;       ///< a path bends to and fro on purpose less often
constexpr double kUnitLength = 0.01;  ///< a quaternion's length may differ so much from 1

/// The robot's pose at the first control point, in the direction of the first curve (p1, or p2 or p3 where p1
/// is p0).
Pose start_of(const std::vector<BezierPoints>& curves_m) {
  const BezierPoints& p = curves_m.front();
  Pose start{p[0][0], p[0][1], 0.0};
  for (std::size_t i = 1; i < p.size(); ++i) {
    const double x = p[i][0] - p[0][0], y = p[i][1] - p[0][1];
    if (x == 0.0 && y == 0.0) continue;
    start.heading_rad = std::atan2(y, x);
    break;
  }
  return start;
}

/// The cells of a column; a row without a number is an error unless `otherwise` replaces it.
std::vector<double> column_of(const CsvTable& table, const char* name, std::optional<double> otherwise = {}) {
  const std::vector<double>* found = table.find(name);
  if (!found)
    throw ConfigError({{table.file, 1, 1},
                       "",
                       std::string("no column ") + name,
                       "columns x_m and y_m",
                       "optional: corner_radius_m"});
  std::vector<double> cells = *found;
  for (std::size_t row = 0; row < cells.size(); ++row) {
    if (std::abs(cells[row]) > kFarthest_m) {
      char far_m[32];
      std::snprintf(far_m, sizeof far_m, "%.6g", cells[row]);
      throw ConfigError({{table.file, table.line_of_row[row], 1},
                         name,
                         far_m,
                         "at most 1e6 m from the origin",
                         "millimeters, or degrees of latitude?"});
    }
    if (!std::isnan(cells[row])) continue;
    if (!otherwise)
      throw ConfigError({{table.file, table.line_of_row[row], 1}, name, "an empty cell", "a number", ""});
    cells[row] = *otherwise;
  }
  return cells;
}

double coordinate(const Node& point, const char* key) {
  const Node value = point[key];
  if (std::abs(value.number()) > kFarthest_m) value.fail("at most 1e6 m from the origin");
  return value.number();
}

/// A pose of geometry_msgs (Pose, or PoseStamped with its pose inside), turned about the vertical axis.
Pose pose_of(const Node& item) {
  const Node pose = item.find("pose").value_or(item), q = pose["orientation"];
  const double x = q["x"].number(), y = q["y"].number(), z = q["z"].number(), w = q["w"].number();
  if (!(std::abs(std::hypot(std::hypot(x, y), std::hypot(z, w)) - 1) < kUnitLength))
    q.fail("a quaternion of length 1");
  return {coordinate(pose["position"], "x"), coordinate(pose["position"], "y"),
          std::atan2(2 * (w * z + x * y), 1 - 2 * (y * y + z * z))};
}

/// The list of poses of nav_msgs/Path or PoseArray (`poses`), or of our own trajectories (`points`).
std::optional<Node> poses_in(const Node& root) {
  for (const char* key : {"poses", "points"})
    if (const auto list = root.find(key); list && list->kind() == Value::Kind::list) return list;
  return std::nullopt;
}

struct SharpBends {
  double radius_m{std::numeric_limits<double>::infinity()};  ///< the smallest
  int alternations{};  ///< from a bend sharper than the points' spacing to one to the other side
};

SharpBends sharp_bends(const Path& path, double spacing_m) {
  SharpBends bends;
  double side = 0;
  for (const PathPiece& piece : path.pieces) {
    const std::vector<double> at = piece_breakpoints(piece);
    for (std::size_t i = 0; i + 1 < at.size(); ++i)
      for (const double share : {0.0, 0.25, 0.5, 0.75, 1.0}) {
        const double bend_per_m = piece_bend(piece, at[i] + share * (at[i + 1] - at[i])).curvature_per_m;
        bends.radius_m = std::min(bends.radius_m, 1 / std::abs(bend_per_m));
        if (std::abs(bend_per_m) * spacing_m <= 1) continue;
        if (side * bend_per_m < 0) ++bends.alternations;
        side = bend_per_m;
      }
  }
  return bends;
}

/// Notes neighbors that are farther apart than stops in a building or a yard.
void note_far_points(const std::vector<Pose>& points, std::vector<std::string>* notes) {
  std::vector<double> apart_m;
  for (std::size_t i = 0; i + 1 < points.size(); ++i)
    apart_m.push_back(std::hypot(points[i + 1].x_m - points[i].x_m, points[i + 1].y_m - points[i].y_m));
  if (apart_m.size() < 2 || notes == nullptr) return;
  const double median = upper_median(std::move(apart_m));
  if (median >= kFarPoints_m)
    notes->push_back("points of the path are " + four_digits(median) +
                     " m apart (median): are the coordinates in cm, or in mm?");
}

/// Follows points within a tolerance. Where none is stated and the curve bends to and fro more closely than
/// the points are apart (the steps of a grid, noise), the tolerance fits the spacing. Notes say so, and where
/// single bends are so close.
template <class Follow>
WaypointPath fitted(const Follow& follow, const std::vector<Pose>& points, std::optional<double> tolerance_m,
                    std::vector<std::string>* notes) {
  note_far_points(points, notes);
  WaypointPath close = follow(tolerance_m.value_or(kWaypointTolerance_m));
  if (tolerance_m || close.defect || close.exact || points.size() < 2) return close;
  double spacing_m = 0;
  for (std::size_t i = 0; i + 1 < points.size(); ++i)
    spacing_m += std::hypot(points[i + 1].x_m - points[i].x_m, points[i + 1].y_m - points[i].y_m);
  spacing_m /= static_cast<double>(points.size() - 1);
  const SharpBends bends = sharp_bends(close.path, spacing_m);
  const double wide_m = kShareOfSpacing * spacing_m;
  if (!(bends.radius_m < spacing_m && wide_m > kWaypointTolerance_m)) return close;
  std::string note = "points " + four_digits(spacing_m) + " m apart: within " +
                     four_digits(kWaypointTolerance_m) + " m of them the path bends to a radius of " +
                     four_digits(bends.radius_m) + " m, which sets the speed";
  if (bends.alternations >= kFewestSteps)
    if (WaypointPath smooth = follow(wide_m); !smooth.defect) {
      note += "; it is followed within " + four_digits(wide_m) + " m, smallest radius " +
              four_digits(sharp_bends(smooth.path, spacing_m).radius_m) + " m";
      close = std::move(smooth);
    }
  if (notes != nullptr) notes->push_back(note + " (--tolerance sets it)");
  return close;
}

Path path_along(const Node& list, std::optional<double> tolerance_m, std::vector<std::string>* notes) {
  std::vector<Pose> poses;
  for (const Node& item : list.items()) poses.push_back(pose_of(item));
  if (poses.size() < 2) list.fail("two poses or more");
  WaypointPath along =
      fitted([&](double within_m) { return path_along_poses(poses, within_m); }, poses, tolerance_m, notes);
  if (along.defect)
    list.items()[along.defect->waypoint].fail_found(along.defect->found, along.defect->accepted);
  return std::move(along.path);
}

[[noreturn]] void fail_at_row(const CsvTable& table, const WaypointDefect& defect) {
  const int line = defect.waypoint < table.rows() ? table.line_of_row[defect.waypoint] : 1;
  throw ConfigError(
      {{table.file, line, 1}, defect.radius ? "corner_radius_m" : "x_m", defect.found, defect.accepted, ""});
}

/// By headings, corner radii or places alone, whichever columns there are.
WaypointPath path_along(const CsvTable& table, std::optional<double> tolerance_m,
                        std::vector<std::string>* notes) {
  const std::vector<double> x_m = column_of(table, "x_m"), y_m = column_of(table, "y_m");
  std::vector<Point2> waypoints_m;
  std::vector<Pose> poses;
  for (std::size_t row = 0; row < x_m.size(); ++row) {
    waypoints_m.push_back({x_m[row], y_m[row]});
    poses.push_back({x_m[row], y_m[row], 0.0});
  }
  if (table.find("corner_radius_m") != nullptr && tolerance_m)
    throw ConfigError({{table.file, 1, 1},
                       "corner_radius_m",
                       "corner radii together with a tolerance",
                       "one of them",
                       "--tolerance and tolerance_m are for a curve through points"});
  if (table.find("corner_radius_m") != nullptr) note_far_points(poses, notes);
  if (table.find("corner_radius_m") != nullptr)
    return lines_between(waypoints_m, column_of(table, "corner_radius_m", 0.0));
  if (table.find("heading_rad") == nullptr || poses.size() < 2)
    return fitted([&](double within_m) { return curve_through(waypoints_m, within_m); }, poses, tolerance_m,
                  notes);
  const std::vector<double> heading_rad = column_of(table, "heading_rad");
  for (std::size_t row = 0; row < poses.size(); ++row) poses[row].heading_rad = heading_rad[row];
  return fitted([&](double within_m) { return path_along_poses(poses, within_m); }, poses, tolerance_m,
                notes);
}

}  // namespace

Schema path_schema() {
  return with_physical_bounds(
      schema_in(embedded::file_schemas, "path", false, {{"bezier", bezier_schema()}}));
}

bool is_path(const Document& document) {
  const Node root = document.root();
  if (root.kind() != Value::Kind::map) return false;
  const auto line = root.find("schema");
  if (line && line->kind() == Value::Kind::scalar) return line->text().rfind("joulepath/path/", 0) == 0;
  return root.has("bezier_m") || root.has("waypoints") || poses_in(root).has_value();
}

bool is_waypoint_file(const std::string& file) { return std::filesystem::path(file).extension() == ".csv"; }

bool has_waypoints(const std::string& file) {
  const CsvTable table = read_csv(file, [](const std::string&) { return false; });
  const auto has = [&](const char* name) { return std::ranges::count(table.header, name) > 0; };
  return has("x_m") && !has("time_s");
}

Path path_from(const Document& document, const ReadOptions& options, std::vector<std::string>* notes,
               std::optional<double> tolerance_m) {
  const Node root = document.root();
  if (const auto poses = poses_in(root)) return path_along(*poses, tolerance_m, notes);
  check_document(document, "path", path_schema());
  if (const auto file = root.find("waypoints"))
    return read_waypoints(resolve_file(*file, options),
                          tolerance_m ? tolerance_m : root.optional_number("tolerance_m"), NamedBy(*file),
                          notes);
  if (const auto tolerance = root.find("tolerance_m"))
    tolerance->fail("no such key", "only allowed with waypoints:");
  if (tolerance_m)
    throw ConfigError({{"--tolerance", 0, 0},
                       "",
                       "a value together with Bezier curves",
                       "a value only together with points",
                       "curves are followed exactly"});
  const Node curves = root["bezier_m"];
  const std::vector<BezierPoints> bezier_m = read_bezier(curves);
  BezierChainResult chain = bezier_chain(bezier_m, start_of(bezier_m), BezierFrame::map);
  if (!chain.ok()) {
    const BezierFinding& defect = chain.defects.front();
    curves.items()[defect.curve].fail_found(defect.message,
                                            "a cubic Bezier curve without cusps, at least 1 mm long");
  }
  if (notes != nullptr)
    for (const BezierFinding& note : chain.notes) notes->push_back(note.message);
  return std::move(chain.path);
}

Path read_waypoints(const std::string& file, std::optional<double> tolerance_m, const NamedBy& named_by,
                    std::vector<std::string>* notes) {
  if (!is_waypoint_file(file)) {
    const Document document = Document::load(file, named_by);
    const auto poses = poses_in(document.root());
    if (!poses) document.root().fail("a CSV file with columns x_m and y_m, or a nav_msgs/Path");
    return path_along(*poses, tolerance_m, notes);
  }
  const CsvTable table = read_csv(
      file,
      [](const std::string& name) {
        return name == "x_m" || name == "y_m" || name == "corner_radius_m" || name == "heading_rad";
      },
      named_by);
  WaypointPath along = path_along(table, tolerance_m, notes);
  if (along.defect) fail_at_row(table, *along.defect);
  return std::move(along.path);
}

}  // namespace joulepath

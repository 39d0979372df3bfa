#include "scenarios/mission_files/map_file.hpp"

#include <algorithm>
#include <cmath>

#include "model/printable.hpp"
#include "scenarios/document_kind.hpp"
#include "scenarios/robot_files/physical_bounds.hpp"
#include "scenarios/text/image.hpp"
#include "scenarios/text/schema_documents.hpp"
#include "scenarios/text/schema_text.hpp"
#include "scenarios/text/three_digits.hpp"

namespace joulepath {
namespace {

constexpr long kSavedAsUnknown = 205;  ///< of 255: the grey of unknown cells in images of map savers

constexpr double kMostOccupied = 0.75;  ///< of the cells that are free or occupied
constexpr double kMostYaw_rad =
    10.0;  ///< more than a turn: it may be written so, but not in radians by chance

enum class Mode { trinary, scale, raw };

struct Interpretation {
  Mode mode{};
  bool negate{};
  double occupied_threshold{};
  double free_threshold{};
};

std::int8_t cell_value(double shade, bool transparent, const Interpretation& meaning) {
  const double occupancy = meaning.negate ? shade : 1.0 - shade;
  if (meaning.mode == Mode::raw) {
    const double value = std::round(shade * 255.0);
    return value <= 100.0 ? static_cast<std::int8_t>(value) : kUnknownCell;
  }
  if (meaning.mode == Mode::scale && transparent) return kUnknownCell;
  if (occupancy > meaning.occupied_threshold) return 100;
  if (occupancy < meaning.free_threshold) return 0;
  if (meaning.mode == Mode::trinary) return kUnknownCell;
  return static_cast<std::int8_t>(std::rint((occupancy - meaning.free_threshold) /
                                            (meaning.occupied_threshold - meaning.free_threshold) * 100.0));
}

Interpretation read_interpretation(const Node& root) {
  const std::string mode = root.text_or("mode", "trinary"), negate = root.text_or("negate", "0");
  Interpretation meaning{.mode = mode == "scale" ? Mode::scale
                                 : mode == "raw" ? Mode::raw
                                                 : Mode::trinary,
                         .negate = negate == "1" || negate == "true" || negate == "True" || negate == "TRUE",
                         .occupied_threshold = root["occupied_thresh"].number(),
                         .free_threshold = root["free_thresh"].number()};
  if (meaning.free_threshold >= meaning.occupied_threshold)
    root["free_thresh"].fail("a number below occupied_thresh (" + root["occupied_thresh"].text() + ")");
  return meaning;
}

/// The cells of an image's edge, or all of them, that have a value.
double count_of(const Image& image, const Interpretation& meaning, std::int8_t value, bool edge) {
  double count = 0;
  for (int row = 0; row < image.height; ++row)
    for (int column = 0; column < image.width; ++column) {
      const bool at_edge = row == 0 || column == 0 || row + 1 == image.height || column + 1 == image.width;
      if (edge && !at_edge) continue;
      const auto pixel = static_cast<std::size_t>(row) * static_cast<std::size_t>(image.width) +
                         static_cast<std::size_t>(column);
      const bool transparent = !image.transparent.empty() && image.transparent[pixel];
      count += cell_value(image.shade[pixel], transparent, meaning) == value ? 1 : 0;
    }
  return count;
}

/// Floors are mostly free, with walls or unknown cells around them: where most of the known cells are
/// occupied and the edge is free, black and white may be exchanged.
std::string negate_note(const Image& image, const Interpretation& meaning) {
  const double occupied = count_of(image, meaning, 100, false), free = count_of(image, meaning, 0, false);
  if (!(occupied > kMostOccupied * (occupied + free))) return {};
  if (count_of(image, meaning, 100, true) > count_of(image, meaning, 0, true)) return {};
  return "negate: " + std::string(meaning.negate ? "1" : "0") + " makes " +
         three_digits(100.0 * occupied / (occupied + free)) +
         " % of the known cells occupied; are dark and light cells exchanged?";
}

void check_yaw(const Node& yaw) {
  if (std::abs(yaw.number()) > kMostYaw_rad)
    yaw.fail("a yaw from -10 to 10", "in radians; is it in degrees?");
}

}  // namespace

Schema map_schema() { return open(with_physical_bounds(schema_in(embedded::file_schemas, "map", false))); }

std::string map_image_file(const std::string& file, const ReadOptions& options) {
  return resolve_file(Document::load(file).root()["image"], options);
}

std::vector<std::string> map_notes(const std::string& file, const ReadOptions& options) {
  const Document document = Document::load(file);
  std::vector<std::string> notes;
  const Schema schema = map_schema();
  for (const auto& [key, value] : document.root().entries())
    if (std::ranges::find(schema.keys, key, &Schema::Key::name) == schema.keys.end())
      notes.push_back(key + ": not read, as Nav2 does not read it either");
  std::ranges::move(map_doubts(file, options), std::back_inserter(notes));
  return notes;
}

std::vector<std::string> map_doubts(const std::string& file, const ReadOptions& options) {
  const Document document = Document::load(file);
  const Node root = document.root();
  std::vector<std::string> notes;
  const Interpretation meaning = read_interpretation(root);
  if (const double resolution_m = root["resolution"].number(); resolution_m > kCoarsestCell_m)
    notes.push_back("resolution: cells of " + four_digits(resolution_m) +
                    " m are larger than a robot; is it in centimetres?");
  if (meaning.mode == Mode::raw) return notes;
  const Image image = read_image(resolve_file(root["image"], options), NamedBy(root["image"]));
  if (const std::string note = negate_note(image, meaning); !note.empty()) notes.push_back(note);
  const auto saved_as_unknown = std::ranges::count_if(image.shade, [&](double shade) {
    return std::lround(shade * 255) == kSavedAsUnknown && cell_value(shade, false, meaning) == 0;
  });
  if (saved_as_unknown > 0) {
    const std::string share =
        three_digits(100.0 * static_cast<double>(saved_as_unknown) / static_cast<double>(image.shade.size()));
    notes.push_back(
        "free_thresh: " + root["free_thresh"].text() + " counts grey " + std::to_string(kSavedAsUnknown) +
        ", with which map savers mark unknown cells, as free floor: " + share + " % of the cells");
  }
  return notes;
}

OccupancyGrid read_map(const std::string& file, const NamedBy& named_by, const ReadOptions& options) {
  const Document document = Document::load(file, named_by);
  check_document(document, "map", map_schema());
  const Node root = document.root();
  const Interpretation meaning = read_interpretation(root);
  const Image image = read_image(resolve_file(root["image"], options), NamedBy(root["image"]));
  const auto origin = root["origin"].items();
  check_yaw(origin[2]);
  OccupancyGrid grid{.width = image.width,
                     .height = image.height,
                     .resolution_m = root["resolution"].number(),
                     .origin = {origin[0].number(), origin[1].number(), origin[2].number()},
                     .file = file};
  grid.occupancy_percent.resize(image.shade.size());
  const auto width = static_cast<std::size_t>(image.width), height = static_cast<std::size_t>(image.height);
  for (std::size_t row = 0; row < height; ++row)
    for (std::size_t column = 0; column < width; ++column) {
      const std::size_t pixel = (height - 1 - row) * width + column;
      const bool transparent = !image.transparent.empty() && image.transparent[pixel];
      grid.occupancy_percent[row * width + column] = cell_value(image.shade[pixel], transparent, meaning);
    }
  return grid;
}

}  // namespace joulepath

#include "scenarios/log_files/corrected_dataset.hpp"

#include <algorithm>

#include "model/effects/catalog.hpp"
#include "scenarios/log_files/dataset_text.hpp"
#include "scenarios/log_files/log_columns.hpp"
#include "scenarios/text/document.hpp"
#include "scenarios/text/significant.hpp"

namespace joulepath {
namespace {

/// Distortion of a current and of its time stamps by the instruments.
struct Distortion {
  double gain{1.0};
  double offset_A{};
  double delay_s{};
};

Distortion distortion_of(const std::vector<EffectSetting>& instruments, Side side) {
  Distortion distortion;
  const auto add = [&](const auto& effect) {
    if constexpr (requires { effect.current_reading(side); }) {
      const CurrentReading reading = effect.current_reading(side);
      distortion.offset_A += reading.offset_A;
      distortion.gain *= reading.gain;
    }
    if constexpr (requires { effect.channel_delay_s(); }) distortion.delay_s += effect.channel_delay_s();
  };
  for (const EffectSetting& setting : instruments) std::visit(add, make_effect(setting));
  return distortion;
}

/// A column's mapping with the distortion removed: value = ((scale x + offset) - offset_A) / gain, read
/// later.
ColumnSource undone(ColumnSource source, const Distortion& distortion, bool is_current) {
  if (is_current) {
    source.scale /= distortion.gain;
    source.offset = (source.offset - (source.is_unsigned ? 0.0 : distortion.offset_A)) / distortion.gain;
  }
  source.delay_s += distortion.delay_s;
  return source;
}

bool is_logged(const Dataset& dataset, const std::string& column) {
  const LogColumn* known = find_log_column(column);
  return known != nullptr &&
         std::ranges::any_of(dataset.runs, [&](const Run& run) { return !known->of(run.log).empty(); });
}

ColumnSources corrected_sources(const Dataset& dataset, ColumnSources sources,
                                const std::vector<EffectSetting>& instruments) {
  for (Side side : kSides) {
    const Distortion distortion = distortion_of(instruments, side);
    for (const char* channel : {"current", "voltage", "power"}) {
      const bool is_current = channel == std::string("current");
      const std::string unit = is_current ? "_A" : channel == std::string("voltage") ? "_V" : "_W";
      const std::string column = std::string("motor_") + channel + "_" + side_name(side) + unit;
      if (!is_logged(dataset, column) || (!is_current && distortion.delay_s == 0)) continue;
      sources[column] = undone(sources[column], distortion, is_current);
    }
  }
  return sources;
}

std::string comment_on(const EffectSetting& effect) {
  std::string text = "#   " + effect.name;
  if (effect.side) text += std::string(" ") + side_name(*effect.side);
  for (const auto& [key, value] : effect.parameters) text += " " + key + " = " + significant_text(value);
  return text + "\n";
}

}  // namespace

std::string corrected_dataset_text(const Dataset& dataset, const std::vector<EffectSetting>& instruments,
                                   const std::string& directory) {
  const Document document = document_of(dataset);
  const auto columns = document.root().find("columns");
  const ColumnSources sources = columns ? read_column_sources(*columns) : ColumnSources{};
  DatasetEdit edit{.comment = "# Readings as they would be without the instruments' errors:\n",
                   .columns = corrected_sources(dataset, sources, instruments)};
  for (const EffectSetting& effect : instruments) edit.comment += comment_on(effect);
  const std::vector<Node> runs = document.root()["runs"].items();
  for (std::size_t r = 0; r < runs.size(); ++r)
    if (const auto own = runs[r].find("columns")) {
      const ColumnSources corrected =
          corrected_sources(dataset, sources_of_run(runs[r], sources), instruments);
      for (const auto& [name, source] : read_column_sources(*own))
        edit.run_columns[r][name] = corrected.at(name);
    }
  return dataset_text(dataset, edit, directory);
}

}  // namespace joulepath

#include "diagnosis/prediction/dictionary/collector.hpp"

namespace joulepath {

std::vector<DictionaryEntry> dictionary_entries(const DictionaryLayout& layout) {
  DictionaryCollector collector(nullptr, nullptr);
  add_mechanics(collector, layout, nullptr, nullptr);
  add_motors(collector, nullptr, nullptr);
  add_windings(collector, layout, nullptr, nullptr);
  add_supply(collector, layout, nullptr, nullptr);
  add_motion(collector, layout, nullptr, nullptr);
  return collector.entries;
}

std::vector<Eigen::MatrixXd> dictionary_rows(const DictionaryLayout& layout, const RunSignals& signals,
                                             const Robot& robot, const Prediction& prediction) {
  DictionaryCollector collector(&signals, &robot);
  add_mechanics(collector, layout, &signals, &robot);
  add_motors(collector, &robot, &prediction);
  add_windings(collector, layout, &signals, &prediction);
  add_supply(collector, layout, &signals, &prediction);
  add_motion(collector, layout, &signals, &robot);
  return collector.rows;
}

}  // namespace joulepath

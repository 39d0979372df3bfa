#include "app/diagnose/left_out_effects.hpp"

#include <algorithm>
#include <sstream>

#include "app/command.hpp"
#include "model/effects/catalog.hpp"
#include "model/text_of_list.hpp"
#include "scenarios/text/document.hpp"

namespace joulepath {
namespace {

constexpr std::size_t kTellingLength = 4;  ///< least length of a word shared by two names

/// The name of which this one is probably a misspelling, then the names that share a word with it.
std::vector<std::string> names_near(const std::string& name) {
  std::vector<std::string> all, near;
  for (const EffectDescription& effect : effect_catalog()) all.emplace_back(effect.info.name);
  if (const std::string nearest = nearest_word(name, all); !nearest.empty()) near.push_back(nearest);
  std::istringstream words(name);
  for (std::string word; std::getline(words, word, '_');)
    for (const std::string& candidate : all)
      if (word.size() >= kTellingLength && candidate.find(word) != std::string::npos &&
          std::ranges::count(near, candidate) == 0)
        near.push_back(candidate);
  return near;
}

std::string unknown_effect(const std::string& name) {
  const std::string near = text_of_list(names_near(name));
  return "--without: no effect '" + name + "'" +
         (near.empty() ? "; `joulepath effects` lists the names" : " (did you mean " + near + "?)");
}

}  // namespace

std::set<std::string> left_out_effects(const std::vector<std::string>& names) {
  for (const std::string& name : names)
    if (!find_effect(name)) throw UsageError(unknown_effect(name));
  return {names.begin(), names.end()};
}

}  // namespace joulepath

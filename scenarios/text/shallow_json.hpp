#pragma once

#include <nlohmann/json.hpp>
#include <string_view>

namespace joulepath {

/// Whether lists and objects of a JSON text are nested more than `most` deep. Linear in the text.
[[nodiscard]] inline bool nests_deeper(std::string_view text, int most) {
  int depth = 0;
  bool in_string = false;
  for (std::size_t k = 0; k < text.size(); ++k) {
    const char c = text[k];
    if (in_string && c == '\\')
      ++k;
    else if (c == '"')
      in_string = !in_string;
    else if (!in_string && (c == '[' || c == '{') && ++depth > most)
      return true;
    else if (!in_string && (c == ']' || c == '}'))
      --depth;
  }
  return false;
}

/// The values of a text of somebody else: discarded (`is_discarded()`, no object, no list) where it is not
/// JSON or nested more than 64 deep. `note` is asked at each key and value, as by Json::parse. Copying and
/// printing nested values recurse, and each level takes 100 bytes.
template <class Json = nlohmann::json>
[[nodiscard]] Json shallow_json(std::string_view text,
                                const typename Json::parser_callback_t& note = nullptr) {
  constexpr int kMostDepth = 64;
  return nests_deeper(text, kMostDepth) ? Json(Json::value_t::discarded) : Json::parse(text, note, false);
}

}  // namespace joulepath

#include <emscripten/emscripten.h>

#include <memory>
#include <nlohmann/json.hpp>

#include "extensions/studio/answer/grid_json.hpp"
#include "extensions/studio/answer/session.hpp"

namespace {

std::unique_ptr<joulepath::studio::Session>& session() {
  static auto one = std::make_unique<joulepath::studio::Session>(joulepath::MissionWorld{}, "/");
  return one;
}

}  // namespace

extern "C" {

/// Sets the floor (grid_json.hpp) from JSON; returns "" or an error message. The text is valid until the next
/// call.
EMSCRIPTEN_KEEPALIVE const char* joulepath_open(const char* floor) {
  static std::string error;
  error.clear();
  try {
    session() = std::make_unique<joulepath::studio::Session>(
        joulepath::studio::floor_from(nlohmann::json::parse(floor)), "/");
  } catch (const std::exception& problem) {
    error = problem.what();
  }
  return error.c_str();
}

/// The answer to a question (session.hpp). The text is valid until the next call.
EMSCRIPTEN_KEEPALIVE const char* joulepath_answer(const char* question) {
  static std::string answer;
  answer = session()->answer(question);
  return answer.c_str();
}
}

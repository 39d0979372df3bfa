#pragma once

#include <stdexcept>
#include <string>

namespace joulepath {

/// A promise inside the program is broken: a bug of ours, never the user's mistake.
class InternalError : public std::logic_error {
 public:
  using std::logic_error::logic_error;
};

}  // namespace joulepath

/// Checks a promise between parts of the program; kept in Release.
#define JOULEPATH_ASSERT(condition, message)                                                           \
  do {                                                                                                 \
    if (!(condition))                                                                                  \
      throw ::joulepath::InternalError(std::string(__FILE__) + ":" + std::to_string(__LINE__) + ": " + \
                                       (message));                                                     \
  } while (false)

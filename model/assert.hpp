#pragma once

#include <stdexcept>
#include <string>

namespace joulepath {

/// An internal invariant does not hold: a defect of the program, never an error in the input.
class InternalError : public std::logic_error {
 public:
  using std::logic_error::logic_error;
};

}  // namespace joulepath

/// Checks an internal invariant, in release builds too.
#define JOULEPATH_ASSERT(condition, message)                                                           \
  do {                                                                                                 \
    if (!(condition))                                                                                  \
      throw ::joulepath::InternalError(std::string(__FILE__) + ":" + std::to_string(__LINE__) + ": " + \
                                       (message));                                                     \
  } while (false)

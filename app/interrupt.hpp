#pragma once

#include <exception>

namespace joulepath {

/// Ctrl-C at a place where a command can stop.
class Interrupted : public std::exception {
 public:
  [[nodiscard]] const char* what() const noexcept override { return "interrupted"; }
};

/// Ctrl-C ends the program at once with code 130 (results are renamed into place whole, so no half file
/// remains). While a PoliteInterrupt exists, the first Ctrl-C only sets a flag and the second ends the
/// program. A write beyond a limit of file size fails as on a full disk, instead of ending the program.
void install_signal_handlers();

/// During its lifetime the command checks for Ctrl-C.
class PoliteInterrupt {
 public:
  PoliteInterrupt();
  ~PoliteInterrupt();
  PoliteInterrupt(const PoliteInterrupt&) = delete;
  PoliteInterrupt& operator=(const PoliteInterrupt&) = delete;

  [[nodiscard]] static bool requested();
};

}  // namespace joulepath

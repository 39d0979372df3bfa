#pragma once

#include <ostream>
#include <string>
#include <vector>

#include "app/output_directory.hpp"
#include "diagnosis/values/diagnosis.hpp"

namespace joulepath {

class CommandLine;

/// A result of `diagnose` beside its own, which an option of an extension asks for.
class DiagnosisPart {
 public:
  DiagnosisPart() = default;
  DiagnosisPart(const DiagnosisPart&) = delete;
  DiagnosisPart& operator=(const DiagnosisPart&) = delete;
  virtual ~DiagnosisPart() = default;

  [[nodiscard]] virtual std::string example() const = 0;  ///< for the help of `diagnose`
  virtual void declare(CommandLine& line) = 0;
  [[nodiscard]] virtual std::string asked_by() const = 0;  ///< the option that was given; empty: none
  /// Reads what the options name, before the diagnosis. Throws ConfigError.
  virtual void prepare() = 0;
  [[nodiscard]] virtual std::vector<std::string> files() const = 0;  ///< that it may write; after prepare()
  /// Adds its files, and lines to the summary.
  virtual void write(const Diagnosis& diagnosis, OutputDirectory& out, std::ostream& summary) = 0;
};

}  // namespace joulepath

#pragma once

namespace joulepath {

/// The program: parses the command line, runs the command and reports errors on stderr. Returns the exit
/// code. The caller installs the handler of interrupts.
[[nodiscard]] int program_main(int argc, char** argv);

}  // namespace joulepath

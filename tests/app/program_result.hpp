#pragma once

#include <sys/wait.h>

#include <cstdio>
#include <fstream>
#include <string>

#include "tests/scenarios/scratch_directory.hpp"
#include "tests/support/locations.hpp"

namespace joulepath {

/// The result of the program: exit code, standard output, standard error.
struct ProgramResult {
  int code{};
  std::string out{};
  std::string err{};
};

/// The content of a file; empty if there is none.
inline std::string text_of(const std::string& file) {
  std::ifstream stream(file);
  return {std::istreambuf_iterator<char>(stream), {}};
}

/// Runs `joulepath ARGUMENTS` through a shell in an environment with the assignments of `before` only
/// (`NO_COLOR=1`).
inline ProgramResult run_program(const ScratchDirectory& scratch, const std::string& arguments,
                                 const std::string& before = "") {
  const std::string out = scratch.at("stdout"), err = scratch.at("stderr");
  const std::string command = "env -u JOULEPATH_DATA_DIR -u HOME -u XDG_CACHE_HOME " + before +
                              " '" JOULEPATH_PROGRAM "' " + arguments + " >'" + out + "' 2>'" + err + "'";
  const int status = std::system(command.c_str());
  return {WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status), text_of(out), text_of(err)};
}

}  // namespace joulepath

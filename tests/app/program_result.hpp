#pragma once

#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <future>
#include <sstream>
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

/// What `joulepath ARGUMENTS` shows on a terminal: standard output and error in one text, without colors.
/// Empty where the system gives no terminal.
inline std::string shown_on_terminal(const std::string& arguments) {
  const int terminal = ::posix_openpt(O_RDWR | O_NOCTTY);
  if (terminal < 0 || ::grantpt(terminal) != 0 || ::unlockpt(terminal) != 0) return {};
  const std::string name = ::ptsname(terminal);
  const int held = ::open(name.c_str(), O_RDWR | O_NOCTTY);  // reading ends when nobody holds it open
  const std::string command =
      "env -u JOULEPATH_DATA_DIR -u HOME -u XDG_CACHE_HOME NO_COLOR=1 '" JOULEPATH_PROGRAM "' " + arguments +
      " </dev/null >'" + name + "' 2>&1";
  const auto run = std::async(std::launch::async, [&] {
    const int status = std::system(command.c_str());
    ::close(held);
    return status;
  });
  std::string text;
  char part[4096];
  for (ssize_t count = 0; (count = ::read(terminal, part, sizeof part)) > 0;)
    text.append(part, static_cast<std::size_t>(count));
  run.wait();
  ::close(terminal);
  std::string shown;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {  // without the progress that later text replaces
    line.erase(line.find_last_not_of('\r') + 1);
    line.erase(0, line.find_last_of('\r') + 1);
    shown += (line.starts_with("\033[K") ? line.substr(3) : line) + '\n';
  }
  return shown;
}

}  // namespace joulepath

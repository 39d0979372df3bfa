#!/usr/bin/env python3
"""variable_thresholds.py THRESHOLDS.hpp OUT.hpp: the same names as variables that a campaign sets and whose reads it sees."""
import pathlib
import re
import sys

CONSTANT = re.compile(r"^inline constexpr (\S+) (k[A-Z]\w*) = ([^;]+);$", re.MULTILINE)
HEAD = """#pragma once

#include <atomic>
#include <cstddef>
#include <type_traits>
namespace joulepath {

struct Threshold {
  const char* name{};
  double value{};
  bool whole{};
  std::atomic<bool> read{false};
};

template <class Number>
Number read_threshold(Threshold& threshold) {
  if (!threshold.read.load(std::memory_order_relaxed)) threshold.read = true;
  return static_cast<Number>(threshold.value);
}

"""


def main(source, out):
    constants = CONSTANT.findall(pathlib.Path(source).read_text())
    if not constants:
        sys.exit(f"{source}: no constants found")
    rows = [f'    {{"{name}", {value}, std::is_integral_v<{kind}>}},' for kind, name, value in constants]
    macros = [f"#define {name} (::joulepath::read_threshold<{kind}>(::joulepath::kThresholds[{k}]))"
              for k, (kind, name, _) in enumerate(constants)]
    text = HEAD + "\n".join(["inline Threshold kThresholds[] = {", *rows, "};", "", "}  // namespace joulepath", *macros, ""])
    file = pathlib.Path(out)
    file.parent.mkdir(parents=True, exist_ok=True)
    if not file.exists() or file.read_text() != text:  # sources that include it are compiled again
        file.write_text(text)


if __name__ == "__main__":
    main(*sys.argv[1:])

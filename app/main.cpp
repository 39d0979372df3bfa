#include <iostream>

#include "app/interrupt.hpp"
#include "app/program.hpp"

int main(int argc, char** argv) {
  std::ios::sync_with_stdio(false);
  joulepath::install_signal_handlers();
  return joulepath::program_main(argc, argv);
}

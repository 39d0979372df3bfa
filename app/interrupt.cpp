#include "app/interrupt.hpp"

#include <unistd.h>

#include <csignal>

namespace joulepath {
namespace {

volatile std::sig_atomic_t polite = 0;
volatile std::sig_atomic_t pressed = 0;

void on_interrupt(int) {
  if (polite == 0 || pressed != 0) _exit(130);
  pressed = 1;
}

}  // namespace

void install_signal_handlers() {
  std::signal(SIGINT, on_interrupt);
  std::signal(SIGTERM, on_interrupt);
  std::signal(SIGXFSZ, SIG_IGN);
}

PoliteInterrupt::PoliteInterrupt() { polite = 1; }
PoliteInterrupt::~PoliteInterrupt() { polite = 0; }
bool PoliteInterrupt::requested() { return pressed != 0; }

}  // namespace joulepath

#include "tools/plumb/interrupt.h"

#include <csignal>

namespace plumb::tools {
namespace {

volatile std::sig_atomic_t g_requested = 0;

void OnSignal(int signal) {
  g_requested = 1;
  std::signal(signal, SIG_DFL);
}

}  // namespace

InterruptGuard::InterruptGuard() {
  g_requested = 0;
  for (const int signal : {SIGINT, SIGTERM}) std::signal(signal, OnSignal);
}

InterruptGuard::~InterruptGuard() {
  for (const int signal : {SIGINT, SIGTERM}) std::signal(signal, SIG_DFL);
}

bool InterruptGuard::requested() const { return g_requested != 0; }

}  // namespace plumb::tools

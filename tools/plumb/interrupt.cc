#include "tools/plumb/interrupt.h"

#include <csignal>

namespace plumb::tools {
namespace {

volatile std::sig_atomic_t g_requested = 0;
volatile std::sig_atomic_t g_report_requested = 0;

void OnSignal(int signal) {
  g_requested = 1;
  std::signal(signal, SIG_DFL);
}

void OnReportSignal(int) { g_report_requested = 1; }

}  // namespace

InterruptGuard::InterruptGuard() {
  g_requested = 0;
  g_report_requested = 0;
  std::signal(SIGUSR1, OnReportSignal);
  for (const int signal : {SIGINT, SIGTERM}) std::signal(signal, OnSignal);
}

InterruptGuard::~InterruptGuard() {
  for (const int signal : {SIGINT, SIGTERM}) std::signal(signal, SIG_DFL);
  std::signal(SIGUSR1, SIG_IGN);  // what ended writes everything anyway
}

bool InterruptGuard::requested() const { return g_requested != 0; }

bool InterruptGuard::TakeReportRequest() {
  if (g_report_requested == 0) return false;
  g_report_requested = 0;
  return true;
}

}  // namespace plumb::tools

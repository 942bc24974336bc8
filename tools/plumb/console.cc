#include "tools/plumb/console.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cstdio>

namespace plumb::tools {

void Console::Info(const std::string& line) {
  if (quiet_) return;
  EndProgress();
  fmt::print(stderr, "{}\n", line);
}

void Console::Error(const std::string& message) {
  EndProgress();
  fmt::print(stderr, "plumb: error: {}\n", message);
}

void Console::Print(const std::string& text) {
  EndProgress();
  std::fwrite(text.data(), 1, text.size(), stdout);
  std::fflush(stdout);
}

void Console::Progress(const std::string& what, size_t done, size_t total) {
  if (quiet_ || total == 0 || isatty(STDERR_FILENO) == 0) return;
  const int percent = static_cast<int>(100 * done / total);
  if (percent == shown_percent_) return;
  shown_percent_ = percent;
  constexpr size_t kWidth = 40;
  const size_t filled = kWidth * done / total;
  fmt::print(stderr, "\r{} [{}{}] {:3} %", what, std::string(filled, '='), std::string(kWidth - filled, ' '), percent);
  if (done >= total) EndProgress();
}

void Console::EndProgress() {
  if (shown_percent_ >= 0) fmt::print(stderr, "\n");
  shown_percent_ = -1;
}

}  // namespace plumb::tools

// Runs work in a process of its own.
#pragma once

#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdio>
#include <functional>
#include <optional>

namespace plumb::bench {

inline constexpr double kMegabyte = 1e6;

struct Measured {
  double value = 0;              // what the work returned
  double peak_mb = 0, cpu_s = 0;  // of the child
};

// So that its memory is its own. None: the child failed.
inline std::optional<Measured> InChild(const std::function<double()>& work) {
  int ends[2];
  if (pipe(ends) != 0) return std::nullopt;
  std::fflush(nullptr);
  const pid_t child = fork();
  if (child < 0) return std::nullopt;
  if (child == 0) {
    const double value = work();
    const bool told = write(ends[1], &value, sizeof(value)) == sizeof(value);
    _exit(told ? 0 : 1);
  }
  close(ends[1]);
  Measured out;
  const bool heard = read(ends[0], &out.value, sizeof(out.value)) == sizeof(out.value);
  close(ends[0]);
  int status = 0;
  rusage used{};
  wait4(child, &status, 0, &used);
  const auto seconds = [](const timeval& t) { return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec); };
  out.peak_mb = static_cast<double>(used.ru_maxrss) * 1024 / kMegabyte;
  out.cpu_s = seconds(used.ru_utime) + seconds(used.ru_stime);
  if (!heard || !WIFEXITED(status) || WEXITSTATUS(status) != 0) return std::nullopt;
  return out;
}

}  // namespace plumb::bench

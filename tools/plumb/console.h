// What the program says while it works: results go to stdout, everything else to stderr.
#pragma once

#include <cstddef>
#include <string>

namespace plumb::tools {

class Console {
 public:
  void set_quiet(bool quiet) { quiet_ = quiet; }
  [[nodiscard]] bool quiet() const { return quiet_; }

  // One line to stderr; not with --quiet.
  void Info(const std::string& line);
  // One line to stderr, always.
  void Error(const std::string& message);
  // A result, to stdout; `text` brings its own line ends.
  void Print(const std::string& text);
  // A progress bar, only where stderr is a terminal, and not with --quiet. Drawn anew when the shown percentage changes.
  void Progress(const std::string& what, size_t done, size_t total);

 private:
  void EndProgress();

  bool quiet_ = false;
  int shown_percent_ = -1;
};

}  // namespace plumb::tools

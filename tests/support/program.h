// The `plumb` program as a user runs it, for tests that are built with PLUMB_PROGRAM, its path.
#pragma once

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "schema/files.h"

namespace plumb::test {

// A folder to run the program in, removed at the end unless a test failed, whose traces are worth a look.
class ProgramFolder {
 public:
  explicit ProgramFolder(const std::string& name)
      : path_(std::filesystem::path(::testing::TempDir()) / ("plumb_" + name + "." + std::to_string(getpid()))) {
    std::filesystem::remove_all(path_);
    std::filesystem::create_directories(path_);
  }
  ~ProgramFolder() {
    if (::testing::UnitTest::GetInstance()->failed_test_count() == 0) std::filesystem::remove_all(path_);
  }
  ProgramFolder(const ProgramFolder&) = delete;
  ProgramFolder& operator=(const ProgramFolder&) = delete;

  // Runs `plumb ARGUMENTS` in the folder; its exit status, -1 if a signal ended it.
  [[nodiscard]] int Plumb(const std::string& arguments) const {
    const std::string command = "cd '" + path_.string() + "' && '" PLUMB_PROGRAM "' " + arguments;
    const int status = std::system(command.c_str());
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }
  // Fails the test if there is no such file.
  [[nodiscard]] nlohmann::json Json(const std::string& name) const {
    const auto text = ReadFileText((path_ / name).string());
    EXPECT_TRUE(text) << text.error().message;
    return text ? nlohmann::json::parse(*text) : nlohmann::json();
  }
  [[nodiscard]] std::filesystem::path operator/(const std::string& name) const { return path_ / name; }

 private:
  std::filesystem::path path_;
};

// A real plan; the test that asks for it skips if it is not there.
inline std::string SharedPlan(const std::string& name) { return std::string(PLUMB_SOURCE_DIR "/../shared/data/plans/") + name; }

}  // namespace plumb::test

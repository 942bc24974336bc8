// The `plumb` program as a user runs it, for tests that are built with PLUMB_PROGRAM, its path.
#pragma once

#include <gtest/gtest.h>
#include <sys/wait.h>

#include <cstdlib>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "schema/files.h"

namespace plumb::test {

// Runs `plumb ARGUMENTS` in `folder`; its exit status, -1 if a signal ended it.
inline int Plumb(const std::filesystem::path& folder, const std::string& arguments) {
  const std::string command = "cd '" + folder.string() + "' && '" PLUMB_PROGRAM "' " + arguments;
  const int status = std::system(command.c_str());
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

// Fails the test if there is no such file.
inline nlohmann::json ReadJson(const std::filesystem::path& path) {
  const auto text = ReadFileText(path.string());
  EXPECT_TRUE(text) << text.error().message;
  return text ? nlohmann::json::parse(*text) : nlohmann::json();
}

}  // namespace plumb::test

// The program as a user or a script runs it, in a folder of its own with an A-Graph in it. For tests that are built with PLUMB_PROGRAM, its
// path.
#pragma once

#include <gtest/gtest.h>
#include <sys/wait.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "schema/agraph_writer.h"
#include "schema/files.h"
#include "tests/support/house.h"
#include "tests/support/temporary_folder.h"

namespace plumb::test {

struct Outcome {
  int status = -1;
  std::string out, err;
};

class ProgramFixture : public ::testing::Test {
 protected:
  void SetUp() override { ASSERT_TRUE(WriteAGraphFile(test::MakeHouse(), folder_ / "house.agraph")); }

  // `first`: of the shell, before the program.
  Outcome Plumb(const std::string& arguments, const std::string& first = "true") {
    const std::string command =
        "cd '" + folder_.path() + "' && " + first + " && timeout 60 '" PLUMB_PROGRAM "' " + arguments + " > .out 2> .err";
    const int status = std::system(command.c_str());
    Outcome outcome{WIFEXITED(status) ? WEXITSTATUS(status) : -1, Read(".out"), Read(".err")};
    std::filesystem::remove(folder_ / ".out");
    std::filesystem::remove(folder_ / ".err");
    return outcome;
  }
  std::string Read(const std::string& name) { return ReadFileText(folder_ / name).value_or("cannot read " + name); }
  void Write(const std::string& name, std::string_view text) { ASSERT_TRUE(WriteFileAtomically(folder_ / name, text)); }
  std::vector<std::string> Files() {
    std::vector<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(folder_.path())) names.push_back(entry.path().filename());
    std::sort(names.begin(), names.end());
    return names;
  }

  test::TemporaryFolder folder_;
  const std::string golden_ = std::string("'" PLUMB_SOURCE_DIR "/tests/compile/golden/diagnostics/");
};

}  // namespace plumb::test

#include "schema/files.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <filesystem>

#include "tests/support/temporary_folder.h"

namespace plumb {
namespace {

namespace fs = std::filesystem;

TEST(WriteFileAtomically, ReplacesAndLeavesNothingElse) {
  const test::TemporaryFolder folder;
  ASSERT_TRUE(WriteFileAtomically(folder / "a", std::string_view("first")));
  ASSERT_TRUE(WriteFileAtomically(folder / "a", std::string_view("second")));
  EXPECT_EQ(*ReadFileText(folder / "a"), "second");
  EXPECT_EQ(std::distance(fs::directory_iterator(folder.path()), {}), 1);
  EXPECT_EQ(WriteFileAtomically(folder.path(), std::string_view("x")).error().code, ErrorCode::kFileUnwritable);
  EXPECT_EQ(WriteFileAtomically(folder / "no/such", std::string_view("x")).error().code, ErrorCode::kFileUnwritable);
  EXPECT_EQ(std::distance(fs::directory_iterator(folder.path()), {}), 1);
}

TEST(WriteFileAtomically, KeepsLinks) {
  const test::TemporaryFolder folder;
  ASSERT_TRUE(WriteFileAtomically(folder / "target", std::string_view("old")));
  fs::create_symlink("target", folder / "link");
  ASSERT_TRUE(WriteFileAtomically(folder / "link", std::string_view("new")));
  EXPECT_TRUE(fs::is_symlink(folder / "link"));
  EXPECT_EQ(*ReadFileText(folder / "target"), "new");
}

TEST(WriteFileAtomically, WritesIntoPipesAndOpenFiles) {
  const test::TemporaryFolder folder;
  const std::string pipe = folder / "pipe";
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  const int reader = ::open(pipe.c_str(), O_RDONLY | O_NONBLOCK);
  ASSERT_TRUE(WriteFileAtomically(pipe, std::string_view("hello")));
  char text[8] = {};
  EXPECT_EQ(::read(reader, text, sizeof text), 5);
  EXPECT_TRUE(fs::is_fifo(pipe));
  ::close(reader);

  const int file = ::open((folder / "open").c_str(), O_RDWR | O_CREAT, 0600);
  ASSERT_TRUE(WriteFileAtomically("/dev/fd/" + std::to_string(file), std::string_view("hello")));
  ::close(file);
  EXPECT_EQ(*ReadFileText(folder / "open"), "hello");
}

}  // namespace
}  // namespace plumb

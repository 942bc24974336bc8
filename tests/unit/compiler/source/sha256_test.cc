#include "compiler/source/sha256.h"

#include <gtest/gtest.h>

#include <set>

namespace plumb::compiler {
namespace {

// FIPS 180-4 and NIST example vectors.
TEST(Sha256, EqualsPublishedVectors) {
  EXPECT_EQ(Sha256Hex(""), "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
  EXPECT_EQ(Sha256Hex("abc"), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  EXPECT_EQ(Sha256Hex("abcdbcdecdefdefgefghfghighijhijkijkljklmklmnlmnomnopnopq"),
            "248d6a61d20638b8e5c026930c3e6039a33ce45964ff2167f6ecedd419db06c1");
  EXPECT_EQ(Sha256Hex(std::string(1000000, 'a')), "cdc76e5c9914fb9281a1c7e284d73e67f1809a48a497200e046d39ccc7112cd0");
}

// The padding takes one block or two: all lengths around a block's end must differ and stay stable.
TEST(Sha256, HandlesLengthsAroundABlock) {
  EXPECT_EQ(Sha256Hex(std::string(55, 'a')), "9f4390f8d30c2dd92ec9f095b65e2b9ae9b0a925a5258e241c9f1e910f734318");
  EXPECT_EQ(Sha256Hex(std::string(56, 'a')), "b35439a4ac6f0948b6d6f9e3c6af0f5f590ce20f1bde7090ef7970686ec6738a");
  EXPECT_EQ(Sha256Hex(std::string(64, 'a')), "ffe054fe7ae0cb6dc65c3af9b61d5209f439851db43d0ba5997337df154668eb");
  std::set<std::string> seen;
  for (size_t n = 0; n < 200; ++n) seen.insert(Sha256Hex(std::string(n, 'x')));
  EXPECT_EQ(seen.size(), 200u);
}

TEST(Sha256, IsTheSameWithoutTheProcessorsInstructions) {
  std::string text;
  for (size_t n = 0; n < 300; ++n) {
    EXPECT_EQ(Sha256Hex(text, true), Sha256Hex(text)) << n;
    text += static_cast<char>(7 * n * n + 13 * n);
  }
}

}  // namespace
}  // namespace plumb::compiler

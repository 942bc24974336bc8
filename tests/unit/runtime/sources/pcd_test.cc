#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <filesystem>
#include <limits>
#include <random>

#include "runtime/sources/lzf.h"
#include "runtime/sources/recording.h"
#include "schema/files.h"
#include "tests/support/temporary_folder.h"

namespace plumb::runtime {
namespace {

using Bytes = std::vector<uint8_t>;

template <class T>
void Put(Bytes& out, T value) {
  const auto* p = reinterpret_cast<const uint8_t*>(&value);
  out.insert(out.end(), p, p + sizeof(T));
}

Bytes Header(const std::string& fields, const std::string& sizes, const std::string& types, size_t points, const std::string& data) {
  const std::string text = fmt::format("VERSION 0.7\nFIELDS {}\nSIZE {}\nTYPE {}\nWIDTH {}\nHEIGHT 1\nPOINTS {}\nDATA {}\n", fields, sizes,
                                       types, points, points, data);
  return {text.begin(), text.end()};
}

class Pcd : public testing::Test {
 protected:
  Expected<Scan> Parse(const Bytes& bytes, double stamp_s = 100) {
    const std::string path = folder_ / "scan.pcd";
    EXPECT_TRUE(WriteFileAtomically(path, bytes));
    return ReadPcd(path, stamp_s);
  }
  Expected<Scan> Parse(const std::string& text) { return Parse(Bytes(text.begin(), text.end())); }

  test::TemporaryFolder folder_;
};

Scan MakeScan() {
  Scan scan;
  scan.stamp_s = 12.25;
  scan.points = {{1, 2, 3}, {-4.5f, 0, 1e-3f}, {100, -100, 7}};
  scan.intensity = {0, 17.5f, 255};
  scan.ring = {0, 15, 127};
  scan.time_s = {0, 0.05f, 0.0999f};
  return scan;
}

TEST_F(Pcd, ReadsBackWhatItWrote) {
  const Scan scan = MakeScan();
  ASSERT_TRUE(WritePcd(scan, folder_ / "a.pcd"));
  const Expected<Scan> read = ReadPcd(folder_ / "a.pcd", 12.25);
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_EQ(read->points, scan.points);
  EXPECT_EQ(read->intensity, scan.intensity);
  EXPECT_EQ(read->ring, scan.ring);
  EXPECT_EQ(read->time_s, scan.time_s);
  EXPECT_EQ(read->stamp_s, 12.25);
}

TEST_F(Pcd, LeavesOutFieldsThatTheScanLacks) {
  Scan scan = MakeScan();
  scan.intensity.clear();
  scan.time_s.clear();
  ASSERT_TRUE(WritePcd(scan, folder_ / "a.pcd"));
  const Expected<Scan> read = ReadPcd(folder_ / "a.pcd", 0);
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_EQ(read->points, scan.points);
  EXPECT_EQ(read->ring, scan.ring);
  EXPECT_TRUE(read->intensity.empty());
  EXPECT_TRUE(read->time_s.empty());
  scan.ring.pop_back();
  EXPECT_EQ(WritePcd(scan, folder_ / "b.pcd").error().code, ErrorCode::kBadScan);
}

TEST_F(Pcd, DropsPointsWithoutReturn) {
  const float nan = std::numeric_limits<float>::quiet_NaN(), inf = std::numeric_limits<float>::infinity();
  Scan scan = MakeScan();
  scan.points = {{nan, 2, 3}, {0, 0, 0}, {1, inf, 2}};
  for (int i = 0; i < 3; ++i) {
    scan.points.emplace_back(1, 1, static_cast<float>(i));
    scan.intensity.push_back(static_cast<float>(i));
    scan.ring.push_back(static_cast<uint16_t>(i));
    scan.time_s.push_back(0.01f * static_cast<float>(i));
  }
  ASSERT_TRUE(WritePcd(scan, folder_ / "a.pcd"));
  const Expected<Scan> read = ReadPcd(folder_ / "a.pcd", 0);
  ASSERT_TRUE(read);
  ASSERT_EQ(read->points.size(), 3u);
  EXPECT_EQ(read->ring, (std::vector<uint16_t>{0, 1, 2}));
  EXPECT_EQ(read->points[2].z(), 2.0f);
  EXPECT_FLOAT_EQ(read->time_s[2], 0.02f);
}

TEST_F(Pcd, ReadsFieldsOfAnyTypeByName) {
  // An Ouster-like layout: padding, doubles, bytes, nanoseconds, another order.
  Bytes bytes = Header("t z _ x y ring intensity", "4 8 1 8 8 1 2", "U F U F F U U", 2, "binary");
  for (uint32_t i = 0; i < 2; ++i) {
    Put<uint32_t>(bytes, i * 50000000u);
    Put<double>(bytes, 3 + i);
    Put<uint8_t>(bytes, 99);
    Put<double>(bytes, 1 + i);
    Put<double>(bytes, 2 + i);
    Put<uint8_t>(bytes, static_cast<uint8_t>(200 + i));
    Put<uint16_t>(bytes, static_cast<uint16_t>(1000 + i));
  }
  const Expected<Scan> scan = Parse(bytes);
  ASSERT_TRUE(scan) << scan.error().message;
  ASSERT_EQ(scan->points.size(), 2u);
  EXPECT_EQ(scan->points[1], Eigen::Vector3f(2, 3, 4));
  EXPECT_EQ(scan->ring, (std::vector<uint16_t>{200, 201}));
  EXPECT_EQ(scan->intensity[1], 1001.0f);
  EXPECT_FLOAT_EQ(scan->time_s[1], 0.05f);
}

TEST_F(Pcd, ReadsAscii) {
  const Expected<Scan> scan = Parse(std::string("# a comment\nVERSION .7\r\nFIELDS x y z ring\r\nSIZE 4 4 4 2\nTYPE F F F U\n"
                                                "COUNT 1 1 1 1\nWIDTH 2\nHEIGHT 2\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS 4\nDATA ascii\n"
                                                "1 2 3 4\nnan nan nan 0\r\n-1e2 0.5 .25 5\n0 0 0 1"));
  ASSERT_TRUE(scan) << scan.error().message;
  ASSERT_EQ(scan->points.size(), 2u);
  EXPECT_EQ(scan->points[1], Eigen::Vector3f(-100, 0.5f, 0.25f));
  EXPECT_EQ(scan->ring, (std::vector<uint16_t>{4, 5}));
}

TEST_F(Pcd, ReadsCompressed) {
  // Field after field: x = 1, 1; y = 2, 2; z = 3, 3. Each pair as four literals and a copy of four from four back.
  Bytes packed;
  for (float v : {1.0f, 2.0f, 3.0f}) {
    Put<uint8_t>(packed, 3);
    Put<float>(packed, v);
    Put<uint8_t>(packed, 2 << 5);
    Put<uint8_t>(packed, 3);
  }
  Bytes bytes = Header("x y z", "4 4 4", "F F F", 2, "binary_compressed");
  Put<uint32_t>(bytes, static_cast<uint32_t>(packed.size()));
  Put<uint32_t>(bytes, 24);
  bytes.insert(bytes.end(), packed.begin(), packed.end());
  const Expected<Scan> scan = Parse(bytes);
  ASSERT_TRUE(scan) << scan.error().message;
  EXPECT_EQ(scan->points, (std::vector<Eigen::Vector3f>{{1, 2, 3}, {1, 2, 3}}));
  bytes.pop_back();
  EXPECT_FALSE(Parse(bytes));
}

TEST_F(Pcd, RefusesBrokenHeaders) {
  const std::vector<std::string> broken = {
      "",
      "\xff\xd8\xff\xe0 a photo\n",
      std::string(100000, 'x'),
      "FIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nWIDTH 1\nHEIGHT 1\nPOINTS 1\n",                          // no DATA
      "FIELDS x y z\nSIZE 4 4\nTYPE F F F\nPOINTS 0\nDATA ascii\n",                                   // a size is missing
      "FIELDS x y z\nSIZE 4 4 3\nTYPE F F F\nPOINTS 0\nDATA ascii\n",                                 // of three bytes
      "FIELDS x y z\nSIZE 4 4 2\nTYPE F F F\nPOINTS 0\nDATA binary\n",                                // a float of two bytes
      "FIELDS x y z\nSIZE 4 4 4\nTYPE F F Q\nPOINTS 0\nDATA ascii\n",                                 // no such type
      "FIELDS x y\nSIZE 4 4\nTYPE F F\nPOINTS 0\nDATA ascii\n",                                       // no z
      "FIELDS x y z\nTYPE F F F\nPOINTS 0\nDATA ascii\n",                                             // no SIZE
      "FIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nDATA ascii\n",                                           // no POINTS
      "FIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nPOINTS -1\nDATA binary\n",
      "FIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nPOINTS 18446744073709551616\nDATA binary\n",
      "FIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nWIDTH 2\nHEIGHT 3\nPOINTS 5\nDATA binary\n",
      "FIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 99999999\nPOINTS 5\nDATA binary\n",
      "FIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nPOINTS 1\nDATA tar\n",
      "FIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nPOINTS 1\nDATA ascii\n1 2\n",                            // cut off
      "FIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nPOINTS 1\nDATA ascii\n1 2 three\n",
  };
  for (const std::string& text : broken) {
    const Expected<Scan> scan = Parse(text);
    ASSERT_FALSE(scan) << text;
    EXPECT_EQ(scan.error().code, ErrorCode::kBadScan) << text;
    EXPECT_NE(scan.error().message.find("scan.pcd"), std::string::npos);
  }
  EXPECT_EQ(ReadPcd(folder_ / "none.pcd", 0).error().code, ErrorCode::kFileNotFound);
}

// As a full disk leaves it.
TEST_F(Pcd, SaysThatAFileIsEmpty) { EXPECT_NE(Parse(std::string()).error().message.find("is empty"), std::string::npos); }

TEST_F(Pcd, RefusesSizesThatTheFileDoesNotHold) {
  // Two thousand million points announced, none there: must not be allocated either.
  for (const char* data : {"ascii", "binary", "binary_compressed"}) {
    Bytes bytes = Header("x y z", "4 4 4", "F F F", 2000000000, data);
    for (int i = 0; i < 12; ++i) Put<uint8_t>(bytes, 0xff);
    EXPECT_FALSE(Parse(bytes)) << data;
  }
  // Compressed sizes that agree with the header but cannot come out of eight bytes.
  Bytes bytes = Header("x y z", "4 4 4", "F F F", 200000000, "binary_compressed");
  Put<uint32_t>(bytes, 8);
  Put<uint32_t>(bytes, 2400000000u);
  Put<uint64_t>(bytes, 0);
  EXPECT_FALSE(Parse(bytes));
}

TEST_F(Pcd, SurvivesEveryTruncationAndManyCorruptions) {
  ASSERT_TRUE(WritePcd(MakeScan(), folder_ / "a.pcd"));
  const Bytes whole = *ReadFileBytes(folder_ / "a.pcd");
  for (size_t n = 0; n < whole.size(); ++n) EXPECT_FALSE(Parse(Bytes(whole.begin(), whole.begin() + static_cast<ptrdiff_t>(n)))) << n;
  std::mt19937_64 random(1);
  for (int i = 0; i < 2000; ++i) {
    Bytes damaged = whole;
    for (int k = 0; k < 3; ++k) damaged[random() % damaged.size()] = static_cast<uint8_t>(random());
    const Expected<Scan> scan = Parse(damaged);
    if (scan) {
      EXPECT_LE(scan->points.size(), 1000u);
    }
  }
}

TEST(Lzf, CopiesOverlappingRanges) {
  // One literal 'a', then seven copied from one back.
  const Bytes packed = {0, 'a', 5 << 5, 0};
  const std::optional<Bytes> out = DecompressLzf(packed, 8);
  ASSERT_TRUE(out.has_value());
  EXPECT_EQ(*out, Bytes(8, 'a'));
  EXPECT_FALSE(DecompressLzf(packed, 7));
  EXPECT_FALSE(DecompressLzf(packed, 9));
}

TEST(Lzf, RefusesCopiesFromBeforeTheStart) {
  EXPECT_FALSE(DecompressLzf(Bytes{0, 'a', 1 << 5, 1}, 4));
  EXPECT_FALSE(DecompressLzf(Bytes{7 << 5}, 10));
  EXPECT_FALSE(DecompressLzf(Bytes{31, 'a'}, 32));
}

TEST(PcdOfOthers, ReadsACompressedRoom) {
  const std::string path = PLUMB_SOURCE_DIR "/../shared/data/lidar/clouds/room_scan1.pcd";
  if (!std::filesystem::exists(path)) GTEST_SKIP() << "the shared recordings are absent";
  const Expected<Scan> scan = ReadPcd(path, 0);
  ASSERT_TRUE(scan) << scan.error().message;
  EXPECT_EQ(scan->points.size(), 112586u);
  Eigen::AlignedBox3f box;
  for (const Eigen::Vector3f& p : scan->points) box.extend(p);
  EXPECT_GT(box.sizes().minCoeff(), 1.0f);
  EXPECT_LT(box.sizes().maxCoeff(), 30.0f);
}

}  // namespace
}  // namespace plumb::runtime

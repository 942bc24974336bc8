#include "compiler/source/source.h"

#include <gtest/gtest.h>
#include <zlib.h>

#include <filesystem>
#include <utility>
#include <vector>

#include "schema/files.h"

namespace plumb::compiler {
namespace {

std::string Gzip(const std::string& text) {
  z_stream stream{};
  EXPECT_EQ(deflateInit2(&stream, 9, Z_DEFLATED, 16 + MAX_WBITS, 8, Z_DEFAULT_STRATEGY), Z_OK);
  std::string out(deflateBound(&stream, text.size()) + 64, '\0');
  std::string in = text;
  stream.next_in = reinterpret_cast<Bytef*>(in.data());
  stream.avail_in = static_cast<uInt>(in.size());
  stream.next_out = reinterpret_cast<Bytef*>(out.data());
  stream.avail_out = static_cast<uInt>(out.size());
  EXPECT_EQ(deflate(&stream, Z_FINISH), Z_STREAM_END);
  out.resize(stream.total_out);
  deflateEnd(&stream);
  return out;
}

class SourceTest : public ::testing::Test {
 protected:
  std::string Write(const std::string& name, const std::string& bytes) {
    const std::string path = folder_ + "/" + name;
    EXPECT_TRUE(WriteFileAtomically(path, bytes));
    return path;
  }
  void SetUp() override { std::filesystem::create_directories(folder_); }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  std::string folder_ = ::testing::TempDir() + "plumb_source_" + ::testing::UnitTest::GetInstance()->current_test_info()->name();
  DiagnosticSink diagnostics_;
};

TEST_F(SourceTest, PlainAndGzipGiveTheSameSource) {
  const std::string text = "ISO-10303-21;\nHEADER;\n" + std::string(300000, 'x');
  const auto plain = LoadSource(Write("a.ifc", text), diagnostics_);
  const auto packed = LoadSource(Write("b.anything", Gzip(text)), diagnostics_);
  ASSERT_TRUE(plain && packed);
  EXPECT_EQ(plain->bytes, text);
  EXPECT_EQ(packed->bytes, text);
  EXPECT_EQ(plain->sha256, packed->sha256);
  EXPECT_EQ(packed->format, SourceFormat::kIfcStep);
  EXPECT_TRUE(diagnostics_.all().empty());
}

TEST_F(SourceTest, GzipOfSeveralMembersIsReadWhole) {
  const auto source = LoadSource(Write("a.gz", Gzip("ISO-10303-21;") + Gzip("\nDATA;")), diagnostics_);
  ASSERT_TRUE(source);
  EXPECT_EQ(source->bytes, "ISO-10303-21;\nDATA;");
}

TEST_F(SourceTest, BombsStopAtTheLimit) {
  const auto source = LoadSource(Write("bomb.gz", Gzip(std::string(5000000, '0'))), diagnostics_, {.max_unpacked_bytes = 1000000});
  EXPECT_FALSE(source);
  ASSERT_EQ(diagnostics_.all().size(), 1u);
  EXPECT_EQ(diagnostics_.all()[0].kind, DiagnosticKind::kFileTooLarge);
}

TEST_F(SourceTest, LimitHoldsForPlainFilesToo) {
  EXPECT_FALSE(LoadSource(Write("a.ifc", std::string(2000, 'x')), diagnostics_, {.max_bytes = 1000}));
  ASSERT_EQ(diagnostics_.all().size(), 1u);
  EXPECT_EQ(diagnostics_.all()[0].kind, DiagnosticKind::kFileTooLarge);
}

TEST_F(SourceTest, TruncatedAndDamagedGzipAreErrors) {
  std::string packed = Gzip(std::string(100000, 'a') + std::string(1000, 'b'));
  EXPECT_FALSE(LoadSource(Write("cut.gz", packed.substr(0, packed.size() / 2)), diagnostics_));
  packed[packed.size() - 6] ^= 0x55;  // in the checksum
  EXPECT_FALSE(LoadSource(Write("bad.gz", packed), diagnostics_));
  ASSERT_EQ(diagnostics_.all().size(), 2u);
  for (const Diagnostic& d : diagnostics_.all()) EXPECT_EQ(d.kind, DiagnosticKind::kBadCompression);
}

// A ZIP archive of (name, text), deflated or stored.
std::string Zip(const std::vector<std::pair<std::string, std::string>>& entries, bool deflated = true) {
  std::string out, directory;
  const auto u16 = [](std::string& to, size_t value) { to += {static_cast<char>(value), static_cast<char>(value >> 8)}; };
  const auto u32 = [&](std::string& to, size_t value) { u16(to, value & 0xffff), u16(to, value >> 16); };
  for (const auto& [name, text] : entries) {
    const std::string gzip = Gzip(text);
    const std::string packed = deflated ? gzip.substr(10, gzip.size() - 18) : text;
    const size_t crc = crc32_z(0, reinterpret_cast<const Bytef*>(text.data()), text.size());
    const size_t local = out.size();
    // Written in one go: the sizes follow the data, so the local header has none.
    u32(out, 0x04034b50), u16(out, 20), u16(out, 8), u16(out, deflated ? 8 : 0), u32(out, 0), u32(out, 0), u32(out, 0), u32(out, 0);
    u16(out, name.size()), u16(out, 0), out += name + packed;
    u32(directory, 0x02014b50), u16(directory, 20), u16(directory, 20), u16(directory, 8), u16(directory, deflated ? 8 : 0),
        u32(directory, 0);
    u32(directory, crc), u32(directory, packed.size()), u32(directory, text.size()), u16(directory, name.size());
    for (int i = 0; i < 4; ++i) u16(directory, 0);
    u32(directory, 0), u32(directory, local), directory += name;
  }
  const size_t start = out.size();
  out += directory;
  u32(out, 0x06054b50), u32(out, 0), u16(out, entries.size()), u16(out, entries.size()), u32(out, directory.size()), u32(out, start),
      u16(out, 0);
  return out;
}

TEST_F(SourceTest, ThePlanInAnArchiveIsRead) {
  const std::string text = "ISO-10303-21;\nHEADER;\n" + std::string(300000, 'x');
  const auto plain = LoadSource(Write("a.ifc", text), diagnostics_);
  for (const bool deflated : {true, false}) {
    const auto packed =
        LoadSource(Write("b.ifczip", Zip({{"images/", ""}, {"a.txt", "no plan"}, {"House.IFC", text}}, deflated)), diagnostics_);
    ASSERT_TRUE(plain && packed);
    EXPECT_EQ(packed->sha256, plain->sha256);
    EXPECT_EQ(packed->format, SourceFormat::kIfcStep);
  }
  EXPECT_TRUE(diagnostics_.all().empty());
}

TEST_F(SourceTest, APlanOfAnyKindInAnArchiveIsRead) {
  const std::string drawing = "0\nSECTION\n2\nENTITIES\n0\nENDSEC\n0\nEOF\n";
  const auto packed =
      LoadSource(Write("b.zip", Zip({{"__MACOSX/._plan.dxf", "x"}, {"set/PLAN.DXF", drawing}, {"read.me", "hello"}})), diagnostics_);
  ASSERT_TRUE(packed);
  EXPECT_EQ(packed->format, SourceFormat::kDxf);
  EXPECT_FALSE(LoadSource(Write("c.zip", Zip({{"a.dxf", drawing}, {"b.svg", "<svg/>"}})), diagnostics_)) << "which of them?";
}

TEST_F(SourceTest, ArchivesThatGiveNoPlanAreErrors) {
  const std::string text = "ISO-10303-21;" + std::string(1000, 'x');
  const std::string good = Zip({{"a.ifc", text}});
  std::string damaged = good, cut = good.substr(0, good.size() - 30), encrypted = good;
  damaged[40] ^= 0x55;
  encrypted[encrypted.find("PK\x01\x02") + 8] |= 1;
  for (const std::string& bytes :
       {damaged, cut, encrypted, Zip({}), Zip({{"a.ifc", text}, {"b.ifc", text}}), Zip({{"a.txt", text}, {"b.txt", text}})})
    EXPECT_FALSE(LoadSource(Write("bad.ifczip", bytes), diagnostics_));
  ASSERT_EQ(diagnostics_.all().size(), 6u);
  for (const Diagnostic& d : diagnostics_.all()) EXPECT_EQ(d.kind, DiagnosticKind::kBadCompression) << d.message;
}

TEST_F(SourceTest, ArchivesStopAtTheLimit) {
  const std::string text(5000000, '0');
  for (const bool deflated : {true, false})
    EXPECT_FALSE(LoadSource(Write("bomb.ifczip", Zip({{"a.ifc", text}}, deflated)), diagnostics_, {.max_unpacked_bytes = 1000000}));
  ASSERT_EQ(diagnostics_.all().size(), 2u);
  for (const Diagnostic& d : diagnostics_.all()) EXPECT_EQ(d.kind, DiagnosticKind::kFileTooLarge);
}

TEST_F(SourceTest, MissingFileIsAnError) {
  EXPECT_FALSE(LoadSource(folder_ + "/none.ifc", diagnostics_));
  ASSERT_EQ(diagnostics_.all().size(), 1u);
  EXPECT_EQ(diagnostics_.all()[0].kind, DiagnosticKind::kFileUnreadable);
}

TEST(DetectFormat, TellsFormatsByTheirFirstBytes) {
  EXPECT_EQ(DetectFormat("ISO-10303-21;\nHEADER;"), SourceFormat::kIfcStep);
  EXPECT_EQ(DetectFormat("\xef\xbb\xbf\r\n  ISO-10303-21;"), SourceFormat::kIfcStep);
  EXPECT_EQ(DetectFormat("  0\r\nSECTION\r\n  2\r\nHEADER"), SourceFormat::kDxf);
  EXPECT_EQ(DetectFormat("999\nmade by hand\n0\nSECTION\n"), SourceFormat::kDxf);
  EXPECT_EQ(DetectFormat("AC1032\0\0\0"), SourceFormat::kDwg);
  EXPECT_EQ(DetectFormat("<?xml version=\"1.0\"?><svg/>"), SourceFormat::kSvg);
  EXPECT_EQ(DetectFormat("<?xml version=\"1.0\"?><gbXML/>"), SourceFormat::kXml);
  EXPECT_EQ(DetectFormat(std::string_view("PK\x03\x04zip", 7)), SourceFormat::kZip);
  EXPECT_EQ(DetectFormat("ply\nformat ascii 1.0\n"), SourceFormat::kPly);
  EXPECT_EQ(DetectFormat("glTF\x02"), SourceFormat::kGltf);
  EXPECT_EQ(DetectFormat("hello"), SourceFormat::kUnknown);
  EXPECT_EQ(DetectFormat(""), SourceFormat::kUnknown);
}

TEST(IsSupported, RefusesOthersWithAWayOut) {
  DiagnosticSink diagnostics;
  EXPECT_FALSE(IsSupported({.path = "a.dwg", .bytes = "AC1032", .sha256 = {}, .format = SourceFormat::kDwg}, diagnostics));
  ASSERT_EQ(diagnostics.all().size(), 1u);
  EXPECT_EQ(diagnostics.all()[0].kind, DiagnosticKind::kUnknownFormat);
  EXPECT_NE(diagnostics.all()[0].message.find("DWG"), std::string::npos);
  EXPECT_NE(diagnostics.all()[0].hint.find("DXF"), std::string::npos);
  EXPECT_EQ(DetectFormat(std::string_view("\x18\0\0\0PLAG\0\0", 10)), SourceFormat::kAGraph);
}

TEST(IsSupported, QuotesTheBeginningOfWhatItDoesNotKnow) {
  const auto message = [](const std::string& path, std::string bytes) {
    DiagnosticSink diagnostics;
    EXPECT_FALSE(IsSupported({.path = path, .bytes = std::move(bytes), .sha256 = {}, .format = SourceFormat::kUnknown}, diagnostics));
    return diagnostics.all().at(0).message;
  };
  EXPECT_EQ(message("a.ifc", " FILE_SCHEMA\nDATA"),
            "`a.ifc` begins with `FILE_SCHEMA`; an IFC file in STEP syntax begins with `ISO-10303-21;`");
  EXPECT_NE(message("a.pdf", std::string("\x01\xff\0rest of it", 13)).find("begins with the bytes 01 ff 00 72 65 73 74 20; no plan"),
            std::string::npos);
  EXPECT_EQ(message("a.ifc", ""), "`a.ifc` is empty");
}

TEST(SourceOptions, CheckNamesFieldAndRule) {
  EXPECT_EQ(SourceOptions().Check(), "");
  EXPECT_NE(SourceOptions{.max_bytes = 0}.Check().find("max_bytes = 0"), std::string::npos);
}

}  // namespace
}  // namespace plumb::compiler
